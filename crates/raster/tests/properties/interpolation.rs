//! Weights and depth against exact rational arithmetic on the snapped triangle.

use glam::{DVec2, DVec3, DVec4, IVec2, UVec2, Vec2};
use num_rational::BigRational;
use proptest::prelude::*;
use raster::Triangle;

use crate::oracle::{self, distance, exact};
use crate::strategies::{
    SIDE, any_pattern, assembled, clip_at, grid_triangle, on_grid, pattern, viewport, w, whole,
};

/// Error of an attribute in f32, as a fraction of its range.
const ATTRIBUTE_BOUND: f64 = 4.0 / 16_777_216.0;
/// Error of a derivative of (s,t), as a fraction of the exact gradient's length.
const DERIVATIVE_BOUND: f64 = 1e-5;

/// The exact weights at a grid point: e₀/w₀ : e₁/w₁ : e₂/w₂.
fn exact_weights(corners: [IVec2; 3], w: [f64; 3], point: IVec2) -> [BigRational; 3] {
    let p = [corners[0], corners[1], corners[2], point].map(|v| v.to_array().map(i128::from));
    let edges = [
        oracle::area(p[1], p[2], p[3]),
        oracle::area(p[2], p[0], p[3]),
        oracle::area(p[0], p[1], p[3]),
    ];
    let parts = [0, 1, 2].map(|i| exact(edges[i] as f64) / exact(w[i]));
    let sum = &parts[0] + &parts[1] + &parts[2];
    parts.map(|part| part / &sum)
}

fn mixture(weights: &[BigRational; 3], a: [f64; 3]) -> BigRational {
    &weights[0] * exact(a[0]) + &weights[1] * exact(a[1]) + &weights[2] * exact(a[2])
}

/// A triangle with its pixels that hold a covered sample.
fn covered(triangle: &Triangle, pattern: &raster::SamplePattern) -> Vec<(UVec2, u64)> {
    let mut tile = raster::VisibilityTile::new(pattern);
    tile.reset(whole(viewport()));
    let mut found = Vec::new();
    tile.visit(triangle, |pixel, mask| found.push((pixel, mask)));
    found
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn attributes_match_rational_arithmetic(
        corners in grid_triangle(SIDE), w in [w(), w(), w()], a in [-1e5..1e5f32, -1.0..1.0f32, -64.0..64.0f32], pattern in any_pattern(),
    ) {
        let clip = [0, 1, 2].map(|i| clip_at(viewport(), corners[i], 0.5, w[i]));
        let Some(triangle) = assembled(clip, viewport()).pop() else { return Ok(()) };
        let range = f64::from(a.iter().fold(0.0f32, |m, x| m.max(x.abs())));
        for (pixel, mask) in covered(&triangle, &pattern).into_iter().take(40) {
            let sample = mask.trailing_zeros() as usize;
            let offset = pattern.positions()[sample];
            let truth = exact_weights(corners, w, oracle::sample_at(pixel, offset));
            let found = triangle.weights(pixel, offset).interpolate(a);
            let error = distance(&exact(found.into()), &mixture(&truth, a.map(f64::from)));
            prop_assert!(error <= exact(ATTRIBUTE_BOUND * range), "{found} at {pixel} of {corners:?}, w {w:?}");
        }
    }

    #[test]
    fn derivatives_match_rational_arithmetic(
        corners in grid_triangle(SIDE), w in [w(), w(), w()], st in [[-9.0..9.0f32, -9.0..9.0f32], [-9.0..9.0f32, -9.0..9.0f32], [-9.0..9.0f32, -9.0..9.0f32]],
    ) {
        let clip = [0, 1, 2].map(|i| clip_at(viewport(), corners[i], 0.5, w[i]));
        let Some(triangle) = assembled(clip, viewport()).pop() else { return Ok(()) };
        let centre = IVec2::splat(128);
        for (pixel, _) in covered(&triangle, &pattern(1)).into_iter().take(20) {
            // f = N/D with N and D affine: f(p + h) − f(p) = h·f′·D(p)/D(p + h) exactly, so f′ follows from two points.
            let here = oracle::sample_at(pixel, centre);
            let [by_x, by_y] = [IVec2::X, IVec2::Y].map(|step| slopes(corners, w, here, step, st));
            let found = triangle.weights(pixel, centre).interpolate_st(st.map(Vec2::from_array));
            let gradient = [&by_x, &by_y].into_iter().flatten().map(|s| distance(s, &exact(0.0))).max().expect("four");
            for (truth, found) in [(by_x, found.dst_dx), (by_y, found.dst_dy)] {
                for axis in 0..2 {
                    let error = distance(&exact(found[axis].into()), &truth[axis]);
                    prop_assert!(error <= exact(DERIVATIVE_BOUND) * &gradient, "axis {axis} of {found} at {pixel} of {corners:?}, w {w:?}");
                }
            }
        }
    }

    #[test]
    fn depth_matches_rational_arithmetic(corners in grid_triangle(SIDE), depth in [0.0..=1.0f64, 0.0..=1.0f64, 0.0..=1.0f64], pattern in any_pattern()) {
        let clip = [0, 1, 2].map(|i| clip_at(viewport(), corners[i], depth[i], 1.0));
        let Some(triangle) = assembled(clip, viewport()).pop() else { return Ok(()) };
        for (pixel, mask) in covered(&triangle, &pattern).into_iter().take(40) {
            let offset = pattern.positions()[mask.trailing_zeros() as usize];
            // z/w is affine on the screen: the same mixture with w = 1.
            let truth = mixture(&exact_weights(corners, [1.0; 3], oracle::sample_at(pixel, offset)), depth);
            let found = triangle.depth_at(pixel, offset);
            prop_assert!(distance(&exact(found.into()), &truth) <= exact(1.0 / 16_777_216.0), "{found} at {pixel}");
            let [low, high] = [f64::min, f64::max].map(|pick| depth.into_iter().reduce(pick).expect("three") as f32);
            prop_assert!((low..=high).contains(&found));
        }
    }

    #[test]
    fn shading_weights_are_never_negative(corners in grid_triangle(SIDE), w in [w(), w(), w()], pattern in any_pattern()) {
        let clip = [0, 1, 2].map(|i| clip_at(viewport(), corners[i], 0.5, w[i]));
        let Some(triangle) = assembled(clip, viewport()).pop() else { return Ok(()) };
        for (pixel, mask) in covered(&triangle, &pattern) {
            let at = triangle.weights_at_samples(pixel, mask, &pattern);
            prop_assert!(at.value.min_element() >= 0.0, "{at:?} at {pixel} of {corners:?}");
            prop_assert!((at.value.element_sum() - 1.0).abs() < 1e-15);
            // Where the centre is held it is the centre; else the mean of the samples, on a grid 64 times as fine.
            let count = mask.count_ones() as i32;
            let held = pattern.positions().iter().enumerate().filter(|(s, _)| mask >> s & 1 == 1);
            let sum = held.fold(IVec2::ZERO, |sum, (_, &p)| sum + oracle::sample_at(pixel, p));
            let holds_centre = oracle::covers(corners, oracle::sample_at(pixel, IVec2::splat(128)));
            if holds_centre {
                prop_assert_eq!(at, triangle.weights(pixel, IVec2::splat(128)));
            } else if at != triangle.weights(pixel, IVec2::splat(128)) {
                let mean = sum.as_dvec2() / f64::from(count);
                let truth = weights_in_f64(corners, w, mean);
                prop_assert!((at.value - truth).abs().max_element() <= 1e-9, "{at:?} against {truth} at {pixel} of {corners:?}");
                let step = 1.0 / 1024.0;
                for (axis, slope) in [(DVec2::X, at.dx), (DVec2::Y, at.dy)] {
                    let ahead = weights_in_f64(corners, w, mean + axis * step);
                    let back = weights_in_f64(corners, w, mean - axis * step);
                    let difference = (ahead - back) / (2.0 * step) * 256.0;
                    let error = (difference - slope).abs().max_element();
                    // Where D changes by a fraction d in a step, the difference is off by d² and bent by d.
                    let bend = (ahead + back - 2.0 * truth).abs().max_element();
                    let smooth = bend <= 0.01 * (ahead - back).abs().max_element();
                    prop_assert!(!smooth || error <= 1e-3 * slope.abs().max_element() + 1e-6, "{slope} against {difference}");
                }
            }
        }
    }

    #[test]
    fn neighbours_agree_to_the_bit_on_a_shared_edge(
        ends in [[0i32..200, 0i32..200], [0i32..200, 0i32..200]], apexes in [[-2000i32..9000, -2000i32..9000], [-2000i32..9000, -2000i32..9000]],
        steps in 1i32..60, k in 0i32..60, w in [w(), w(), w(), w()], a in [-1e6..1e6f32, -1e6..1e6f32, -1e6..1e6f32, -1e6..1e6f32],
    ) {
        // Points that divide the edge evenly lie exactly on it.
        let [p, q] = ends.map(IVec2::from_array);
        let (p, q) = (p * steps, q * steps);
        let at = p + (q - p) / steps * (k % (steps + 1));
        let (pixel, offset) = ((at / 256).as_uvec2(), at % 256);
        let [r, s] = apexes.map(IVec2::from_array);
        let clip = |at: IVec2, w: f64| clip_at(viewport(), at, 0.5, w);
        let one = assembled([clip(p, w[0]), clip(q, w[1]), clip(r, w[2])], viewport()).pop();
        let two = assembled([clip(s, w[3]), clip(q, w[1]), clip(p, w[0])], viewport()).pop();
        if let (Some(one), Some(two)) = (one, two) {
            let (b1, b2) = (one.weights(pixel, offset), two.weights(pixel, offset));
            prop_assert_eq!(b1.value.x.to_bits(), b2.value.z.to_bits());
            prop_assert_eq!(b1.value.y.to_bits(), b2.value.y.to_bits());
            prop_assert_eq!(b1.interpolate([a[0], a[1], a[2]]).to_bits(), b2.interpolate([a[3], a[1], a[0]]).to_bits());
        }
    }

    #[test]
    fn pieces_of_a_clipped_triangle_interpolate_as_the_whole(
        corners in [[-8.0..8.0f64, -3.0..-0.5f64, -30.0..8.0f64], [-8.0..8.0f64, -3.0..-0.5f64, -30.0..8.0f64], [-8.0..8.0f64, -3.0..3.0f64, -30.0..8.0f64]],
    ) {
        // The weights at a pixel must name the point of the source triangle that projects there.
        let clip = corners.map(|[x, y, z]| DVec4::new(x, y, 0.1, -z));
        for piece in assembled(clip, viewport()) {
            for (pixel, mask) in covered(&piece, &pattern(4)).into_iter().step_by(7) {
                let offset = pattern(4).positions()[mask.trailing_zeros() as usize];
                let b = piece.weights(pixel, offset).value;
                let point = clip[0] * b.x + clip[1] * b.y + clip[2] * b.z;
                let x = (point.x / point.w + 1.0) * 32.0;
                let y = (1.0 - point.y / point.w) * 32.0;
                let at = oracle::sample_at(pixel, offset).as_dvec2() / 256.0;
                let error = (x - at.x).abs().max((y - at.y).abs());
                // Snapping moves a corner by 1/512 pixel; on a piece thin as a unit the source moves with it.
                prop_assert!(error <= 0.006 , "{error} pixels at {pixel}");
            }
        }
    }
}

/// Weights at a point in grid units, by areas in f64.
fn weights_in_f64(corners: [IVec2; 3], w: [f64; 3], point: DVec2) -> DVec3 {
    let p = corners.map(|v| v.as_dvec2() - point);
    let parts = DVec3::new(
        p[1].perp_dot(p[2]) / w[0],
        p[2].perp_dot(p[0]) / w[1],
        p[0].perp_dot(p[1]) / w[2],
    );
    parts / parts.element_sum()
}

/// Exact derivative of (s,t) per pixel along a step of one grid unit.
fn slopes(
    corners: [IVec2; 3],
    w: [f64; 3],
    here: IVec2,
    step: IVec2,
    st: [[f32; 2]; 3],
) -> [BigRational; 2] {
    let [b0, b1] = [here, here + step].map(|p| exact_weights(corners, w, p));
    // D at both points, up to a common factor: Σ eᵢ/wᵢ = A / Σ bᵢ·wᵢ, with A the same at both.
    let [d0, d1] = [&b0, &b1].map(|b| exact(1.0) / mixture(b, w));
    [0, 1].map(|axis| {
        let f = st.map(|c| f64::from(c[axis]));
        (mixture(&b1, f) - mixture(&b0, f)) * &d1 / &d0 * exact(256.0)
    })
}

#[test]
fn an_empty_mask_stands_for_the_centre() {
    let corners = [(0, 0), (0, 2048), (2048, 0)].map(|(x, y)| IVec2::new(x, y));
    let triangle = on_grid(corners, viewport()).expect("has area");
    let (inside, outside) = (UVec2::new(1, 1), UVec2::new(40, 40));
    let four = pattern(4);
    assert_eq!(
        triangle.weights_at_samples(inside, 0, &four),
        triangle.weights(inside, IVec2::splat(128))
    );
    let held = triangle.weights_at_samples(outside, 0, &four).value;
    assert!(held.min_element() >= 0.0 && held.is_finite());
}

#[test]
fn derivatives_count_rows_downwards() {
    // t grows downwards over eight pixels, s to the right.
    let corners = [(0, 0), (0, 2048), (2048, 0)].map(|(x, y)| IVec2::new(x, y));
    let triangle = on_grid(corners, viewport()).expect("has area");
    let st = [Vec2::ZERO, Vec2::Y, Vec2::X];
    let at = triangle
        .weights(UVec2::new(1, 2), IVec2::splat(128))
        .interpolate_st(st);
    assert_eq!(at.st.as_vec2(), Vec2::new(1.5, 2.5) / 8.0);
    assert_eq!((at.dst_dx, at.dst_dy), (Vec2::X / 8.0, Vec2::Y / 8.0));
}

#[test]
fn the_far_half_of_a_receding_triangle_is_seen_in_fewer_pixels() {
    let clip = [(0, 0, 1.0), (0, 2048, 1.0), (2048, 0, 3.0)]
        .map(|(x, y, w)| clip_at(viewport(), IVec2::new(x, y), 0.5, w));
    let triangle = assembled(clip, viewport()).pop().expect("has area");
    // Halfway along the top edge from w = 1 to w = 3: s = ¼.
    let b = triangle.weights(UVec2::new(4, 0), IVec2::ZERO).value;
    assert!(
        (b - DVec3::new(0.75, 0.0, 0.25)).abs().max_element() < 1e-15,
        "{b}"
    );
}
