//! Nearest covered texels against a search through all of them.

use proptest::prelude::*;
use texcoord::charts::NearestCovered;

fn squared_distance(width: usize, a: usize, b: usize) -> usize {
    let (x, y) = (
        (a % width).abs_diff(b % width),
        (a / width).abs_diff(b / width),
    );
    x * x + y * y
}

#[test]
fn nothing_covered_changes_nothing() {
    let nearest = NearestCovered::of(3, &[false; 6]);
    let mut texels = [1, 2, 3, 4, 5, 6];
    nearest.fill(&mut texels);
    assert_eq!(texels, [1, 2, 3, 4, 5, 6]);
    assert_eq!(nearest.source(4), None);
}

#[test]
fn an_image_without_texels_is_allowed() {
    NearestCovered::of(0, &[]).fill::<u8>(&mut []);
    NearestCovered::of(5, &[]).fill::<u8>(&mut []);
}

proptest! {
    #[test]
    fn the_source_is_covered_and_no_other_is_nearer(
        width in 1usize..24, height in 0usize..24, density in 0.0..0.3f64, seed in any::<u64>(),
    ) {
        let mut state = seed | 1;
        let covered: Vec<bool> = (0..width * height)
            .map(|_| {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                ((state >> 33) as f64) < density * f64::from(1u32 << 31)
            })
            .collect();
        let nearest = NearestCovered::of(width, &covered);
        let sources: Vec<usize> = (0..covered.len()).filter(|&t| covered[t]).collect();
        let mut filled: Vec<usize> = (0..covered.len()).collect();
        nearest.fill(&mut filled);
        for (texel, &value) in filled.iter().enumerate() {
            let least = sources.iter().map(|&s| squared_distance(width, texel, s)).min();
            let found = nearest.source(texel);
            prop_assert_eq!(found.map(|s| squared_distance(width, texel, s)), least);
            prop_assert!(found.is_none_or(|s| covered[s]));
            prop_assert_eq!(value, found.unwrap_or(texel));
        }
    }
}
