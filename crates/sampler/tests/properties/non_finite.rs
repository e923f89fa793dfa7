//! Infinite and NaN texels: counted, and repaired under a named policy.

use glam::UVec2;
use half::f16;
use proptest::prelude::*;
use sampler::{NonFinite, Texels, Transfer};

use crate::strategies::{float_texture, half_texture, integer_texture, made};

proptest! {
    /// Every policy but `Keep` leaves nothing to count, and touches nothing else.
    #[test]
    fn repair_changes_only_what_is_broken(
        texture in prop_oneof![float_texture(), half_texture()], broken in prop::collection::vec(any::<prop::sample::Index>(), 0..6),
        bad in prop::sample::select(vec![f32::NAN, f32::INFINITY, f32::NEG_INFINITY]),
    ) {
        let mut indices: Vec<usize> = broken.iter().map(|index| index.index(texture.texels().len())).collect();
        indices.sort_unstable();
        indices.dedup();
        let texels = match texture.texels() {
            Texels::F32(stored) => {
                let mut stored = stored.clone();
                indices.iter().for_each(|&index| stored[index] = bad);
                Texels::F32(stored)
            }
            Texels::F16(stored) => {
                let mut stored = stored.clone();
                indices.iter().for_each(|&index| stored[index] = f16::from_f32(bad));
                Texels::F16(stored)
            }
            _ => unreachable!("made of floats"),
        };
        let holed = made(texture.size(), texture.channels(), Transfer::Linear, texels);
        prop_assert_eq!(holed.non_finite(), indices.len() as u64);
        for policy in [NonFinite::Zero, NonFinite::BoxAverage] {
            let (repaired, count) = holed.clone().repaired(policy);
            prop_assert_eq!(count, indices.len() as u64);
            prop_assert_eq!(repaired.non_finite(), 0);
            for j in 0..texture.size().y {
                for i in 0..texture.size().x {
                    let first = (j * texture.size().x + i) as usize * usize::from(texture.channels());
                    let touched = indices.iter().any(|&k| (first..first + usize::from(texture.channels())).contains(&k));
                    let ij = UVec2::new(i, j);
                    prop_assert!(touched || repaired.fetch(ij) == texture.fetch(ij));
                }
            }
        }
        prop_assert_eq!(holed.repaired(NonFinite::Keep).1, indices.len() as u64);
    }

    #[test]
    fn integers_are_always_finite(texture in integer_texture()) {
        prop_assert_eq!(texture.non_finite(), 0);
    }
}

#[test]
fn without_a_finite_neighbour_the_average_is_zero() {
    let texture = made(
        UVec2::splat(2),
        1,
        Transfer::Linear,
        Texels::F32(vec![f32::NAN; 4]),
    );
    let (texture, count) = texture.repaired(NonFinite::BoxAverage);
    assert_eq!((texture.texels(), count), (&Texels::F32(vec![0.0; 4]), 4));
}
