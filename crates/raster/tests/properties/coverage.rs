//! Coverage against brute force: the fill rule, slivers, tiles against the whole.

use glam::IVec2;
use proptest::prelude::*;
use raster::{SamplePattern, Triangle, Viewport, VisibilityTile};

use crate::oracle;
use crate::strategies::{
    SIDE, any_pattern, clip_at, grid_triangle, on_grid, pattern, rect, viewport, whole,
};

/// The masks that a triangle leaves in an empty tile, pixel by pixel.
fn masks(triangle: Option<&Triangle>, area: raster::Rect, pattern: &SamplePattern) -> Vec<u64> {
    let mut tile = VisibilityTile::new(pattern);
    tile.reset(area);
    if let Some(triangle) = triangle {
        tile.draw(0, triangle);
    }
    area.pixels().map(|pixel| tile.covered(pixel)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn coverage_is_exact(corners in grid_triangle(SIDE), pattern in any_pattern()) {
        let area = whole(viewport());
        let found = masks(on_grid(corners, viewport()).as_ref(), area, &pattern);
        for (pixel, found) in area.pixels().zip(found) {
            let truth = oracle::mask(corners, pixel, &pattern);
            prop_assert_eq!(found, truth, "pixel {} of {:?}: {:b} {:b}", pixel, corners, found, truth);
        }
    }

    #[test]
    fn tiles_together_are_the_whole(corners in grid_triangle(SIDE), pattern in any_pattern(), step in 1u32..40) {
        let triangle = on_grid(corners, viewport());
        let area = whole(viewport());
        let at_once = masks(triangle.as_ref(), area, &pattern);
        for (pixel, mask) in area.pixels().zip(at_once) {
            // The tile of this size that holds the pixel; checking its first pixel covers each tile once.
            let min = pixel / step * step;
            if pixel == min {
                let part = rect(min.to_array(), (min + step).min(area.max).to_array());
                let parts = masks(triangle.as_ref(), part, &pattern);
                for (place, found) in part.pixels().zip(parts) {
                    let truth = oracle::mask(corners, place, &pattern);
                    prop_assert_eq!(found, truth, "pixel {} in tile {:?}", place, part);
                }
                prop_assert_eq!(mask, oracle::mask(corners, pixel, &pattern));
            }
        }
    }

    #[test]
    fn coverage_does_not_depend_on_winding(corners in grid_triangle(SIDE), pattern in any_pattern()) {
        let [a, b, c] = corners;
        let area = whole(viewport());
        let one = masks(on_grid([a, b, c], viewport()).as_ref(), area, &pattern);
        let other = masks(on_grid([c, b, a], viewport()).as_ref(), area, &pattern);
        prop_assert_eq!(one, other);
    }

    #[test]
    fn a_target_of_16k_by_1_is_exact(x in [0i32..16_384 * 256, 0i32..16_384 * 256, 0i32..16_384 * 256], y in [-99_999i32..99_999, -99_999i32..99_999, -99_999i32..99_999]) {
        for (view, flip) in [(Viewport::new(16_384, 1), false), (Viewport::new(1, 16_384), true)] {
            let view = view.expect("allowed");
            let corners = [0, 1, 2].map(|i| if flip { IVec2::new(y[i], x[i]) } else { IVec2::new(x[i], y[i]) });
            let found = masks(on_grid(corners, view).as_ref(), whole(view), &pattern(4));
            for (pixel, found) in whole(view).pixels().zip(found) {
                prop_assert_eq!(found, oracle::mask(corners, pixel, &pattern(4)), "pixel {} of {:?}", pixel, corners);
            }
        }
    }
}

#[test]
fn top_and_left_edges_own_their_samples() {
    // A square of two pixels with its corners on pixel centres: one sample on each edge, one on each corner.
    let [a, b, c, d] =
        [(128, 128), (640, 128), (640, 640), (128, 640)].map(|(x, y)| IVec2::new(x, y));
    let area = rect([0, 0], [4, 4]);
    let one = pattern(1);
    let halves = [[a, d, b], [b, d, c]]
        .map(|corners| masks(on_grid(corners, viewport()).as_ref(), area, &one));
    let both: Vec<u64> = halves[0]
        .iter()
        .zip(&halves[1])
        .map(|(x, y)| x + y)
        .collect();
    // Rows and columns 0 and 1 are owned, row and column 2 (bottom and right edge) are not.
    assert_eq!(both, [1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
}

#[test]
fn an_edge_through_a_thousand_pixel_centres_is_owned_on_one_side() {
    let view = Viewport::new(1024, 1024).expect("allowed");
    let (a, b) = (
        IVec2::new(128, 128),
        IVec2::new(128 + 1000 * 256, 128 + 1000 * 256),
    );
    let left = on_grid([a, IVec2::new(a.x, b.y), b], view).expect("has area");
    let right = on_grid([a, b, IVec2::new(b.x, a.y)], view).expect("has area");
    let counts = oracle::count(&[left, right], whole(view), &pattern(1));
    let on_diagonal = (1..1000u32).map(|k| counts.plain.of([k, k], 0));
    assert!(on_diagonal.into_iter().all(|n| n == 1));
}

#[test]
fn a_sliver_of_half_a_square_unit_covers_what_it_covers() {
    // The smallest triangle of the grid, and needles of aspect 10⁴, around a pixel's centre.
    for corners in [
        [(128, 128), (129, 128), (128, 129)],
        [(127, 127), (129, 128), (128, 129)],
        [(0, 128), (16_384, 128), (16_384, 129)],
        [(0, 127), (16_384, 130), (8_000, 129)],
    ] {
        let corners = corners.map(|(x, y)| IVec2::new(x, y));
        let area = whole(viewport());
        for count in crate::strategies::COUNTS {
            let found = masks(on_grid(corners, viewport()).as_ref(), area, &pattern(count));
            let truth: Vec<u64> = area
                .pixels()
                .map(|p| oracle::mask(corners, p, &pattern(count)))
                .collect();
            assert_eq!(found, truth, "{corners:?}");
        }
    }
}

#[test]
fn the_largest_target_does_not_overflow() {
    let view = Viewport::new(32_768, 32_768).expect("allowed");
    let far = 65_536 * 256;
    let corners = [(-far, -far), (-far, far), (far, far)].map(|(x, y)| IVec2::new(x, y));
    let triangle = on_grid(corners, view).expect("has area");
    for corner in [[0, 0], [32_760, 0], [0, 32_760], [32_760, 32_760]] {
        let area = rect(corner, corner.map(|k| k + 8));
        let found = masks(Some(&triangle), area, &pattern(16));
        let truth: Vec<u64> = area
            .pixels()
            .map(|p| oracle::mask(corners, p, &pattern(16)))
            .collect();
        assert_eq!(found, truth, "at {corner:?}");
    }
}

#[test]
fn snapping_rounds_to_nearest_and_ties_to_even() {
    let view = viewport();
    // 0.5 units goes to 0, 1.5 units to 2: the left edge at 0 or 2 decides whether the first unit is inside.
    for (units, snapped) in [
        (0.49, 0),
        (0.5, 0),
        (0.51, 1),
        (1.5, 2),
        (2.5, 2),
        (-0.5, 0),
        (-1.5, -2),
    ] {
        let mut clip =
            [(0, 0), (0, 4096), (4096, 0)].map(|(x, y)| clip_at(view, IVec2::new(x, y), 0.5, 1.0));
        for corner in &mut clip[..2] {
            corner.x += units / 128.0 / f64::from(SIDE);
        }
        let found = crate::strategies::assembled(clip, view)
            .pop()
            .expect("has area");
        let edge = found
            .weights(glam::UVec2::ZERO, IVec2::new(snapped, 64))
            .value
            .z;
        assert_eq!(edge, 0.0, "{units} units should snap to {snapped}");
    }
}
