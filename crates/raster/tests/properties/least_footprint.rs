//! The least footprint against what every shaded point of random triangles sees.

use glam::{DVec2, DVec3, DVec4, IVec2, UVec2};
use proptest::prelude::*;
use raster::{Cull, LeastFootprint, Triangle, assemble_triangle};
use texcoord::Weights;

use crate::strategies::{
    SIDE, any_pattern, assembled, clip_at, grid_triangle, pattern, viewport, w, whole,
};

/// Aspect up to which derivatives in f32 keep the bound.
const FOLLOWED: f64 = 128.0;

/// Singular values of the derivatives, the greater one first: by the angle that diagonalises JᵀJ.
fn axes(dx: DVec2, dy: DVec2) -> [f64; 2] {
    let angle = 0.5 * (2.0 * dx.dot(dy)).atan2(dx.length_squared() - dy.length_squared());
    let (sin, cos) = angle.sin_cos();
    let [a, b] = [dx * cos + dy * sin, dy * cos - dx * sin].map(DVec2::length);
    [a.max(b), a.min(b)]
}

/// In f64.
fn exact(weights: &Weights, attribute: &[DVec2; 3]) -> [DVec2; 2] {
    [weights.dx, weights.dy].map(|d| attribute[0] * d.x + attribute[1] * d.y + attribute[2] * d.z)
}

/// In f32, from the edges at corner 0.
fn rounded(weights: &Weights, [p, q, r]: &[DVec2; 3]) -> [DVec2; 2] {
    let [first, second] = [*q - *p, *r - *p].map(|edge| edge.as_vec2());
    [weights.dx, weights.dy].map(|d| {
        let d = d.as_vec3();
        (first * d.y + second * d.z).as_dvec2()
    })
}

/// Weights wherever the renderer may shade a triangle: at centres, means and samples, the masks told by visibility.
fn shaded(triangle: &Triangle, pattern: &raster::SamplePattern) -> Vec<Weights> {
    let mut tile = raster::VisibilityTile::new(pattern);
    tile.reset(whole(viewport()));
    let mut found = Vec::new();
    tile.visit(triangle, |pixel: UVec2, mask| {
        found.push(triangle.weights_at_samples(pixel, mask, pattern));
        for (sample, &offset) in pattern.positions().iter().enumerate() {
            if mask >> sample & 1 == 1 {
                found.push(triangle.weights(pixel, offset));
            }
        }
    });
    found
}

fn attribute() -> impl Strategy<Value = [DVec2; 3]> {
    let corner = || [-300.0..300.0f32, -300.0..300.0f32];
    let spread = prop_oneof![Just(1.0f32), Just(1e-2), Just(1e-4), Just(1e3)];
    ([corner(), corner(), corner()], spread, 0u8..6).prop_map(|(corners, spread, kind)| {
        let [a, b, c] = corners.map(|[x, y]| DVec2::new((x * spread).into(), (y * spread).into()));
        match kind {
            0 => [a, b, a + (b - a) * 0.5 + (c - a) * 1e-3],
            1 => [a, a + DVec2::X * 64.0, a + DVec2::Y * 64.0],
            _ => [a, b, c],
        }
    })
}

/// Corners that lie off the grid, from near the eye to far away.
fn anywhere() -> impl Strategy<Value = [DVec4; 3]> {
    let corner = || {
        let place = [-1.6..1.6f64, -1.6..1.6f64];
        let depth = prop_oneof![2 => 0.5..20.0f64, 1 => 1.0..1.2f64, 1 => -0.5..0.5f64];
        (place, depth).prop_map(|([x, y], w)| DVec4::new(x * w.abs(), y * w.abs(), 0.6, w))
    };
    let small = (
        corner(),
        [[-1.0..1.0f64, -1.0..1.0f64], [-1.0..1.0f64, -1.0..1.0f64]],
        -12.0..-1.0f64,
    )
        .prop_map(|(a, offsets, scale)| {
            let around = |[x, y]: [f64; 2]| a + DVec4::new(x, y, 0.0, 0.3 * x) * scale.exp2();
            [a, around(offsets[0]), around(offsets[1])]
        });
    prop_oneof![2 => [corner(), corner(), corner()], 2 => small]
}

/// Snapped corners, slivers among them, and others.
fn corners() -> impl Strategy<Value = [DVec4; 3]> {
    let snapped = (grid_triangle(SIDE), [w(), w(), w()])
        .prop_map(|(corners, w)| [0, 1, 2].map(|i| clip_at(viewport(), corners[i], 0.5, w[i])));
    let off_grid = (
        grid_triangle(SIDE),
        [w(), w(), w()],
        [
            [-1.0..1.0f64, -1.0..1.0f64],
            [-1.0..1.0f64, -1.0..1.0f64],
            [-1.0..1.0f64, -1.0..1.0f64],
        ],
    )
        .prop_map(|(corners, w, by)| {
            [0, 1, 2].map(|i| {
                let off = DVec2::from_array(by[i]) / f64::from(128 * SIDE);
                clip_at(viewport(), corners[i], 0.5, w[i]) + (off * w[i]).extend(0.0).extend(0.0)
            })
        });
    prop_oneof![snapped, off_grid, anywhere()]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    /// Nothing that is drawn sees less, neither in f64 nor in f32.
    #[test]
    fn no_shaded_point_has_a_smaller_footprint(
        clip in corners(), attribute in attribute(), pattern in any_pattern(), cull in prop_oneof![Just(Cull::None), Just(Cull::Back)],
    ) {
        let bound = LeastFootprint::new(viewport()).of(clip, cull, attribute);
        let mut triangles = Vec::new();
        assemble_triangle(0, clip, &viewport(), cull, &mut triangles);
        for triangle in triangles {
            for weights in shaded(&triangle, &pattern) {
                let [_, minor] = { let [dx, dy] = exact(&weights, &attribute); axes(dx, dy) };
                prop_assert!(minor >= bound * (1.0 - 1e-9), "{minor} is less than {bound}");
                let [dx, dy] = rounded(&weights, &attribute);
                let [major, minor] = axes(dx, dy);
                // What clipping left has edges of its own.
                let whole = triangle.planes().piece.is_none();
                prop_assert!(!whole || minor >= bound || major > FOLLOWED * minor, "{minor} in f32 is less than {bound}");
            }
        }
    }

    /// For triangles of some pixels and texels it is nearly what is seen at their corners, less what slivers lose.
    #[test]
    fn the_bound_is_close(
        corners in [[0.1..0.4f64, 0.1..0.4f64], [0.6..0.9f64, 0.1..0.4f64], [0.1..0.9f64, 0.6..0.9f64]], depth in 1.0..50.0f64,
        slope in [-0.1..0.1f64, -0.1..0.1f64, -0.1..0.1f64], density in 0.25..8.0f64,
    ) {
        let side = f64::from(SIDE);
        let place = corners.map(DVec2::from_array);
        let clip = [0, 1, 2].map(|i| {
            let w = depth * (1.0 + slope[i]);
            DVec4::new((2.0 * place[i].x - 1.0) * w, (1.0 - 2.0 * place[i].y) * w, 0.1, w)
        });
        let attribute = place.map(|p| p * side * density);
        let bound = LeastFootprint::new(viewport()).of(clip, Cull::None, attribute);
        let triangle = assembled(clip, viewport()).pop().expect("it is visible");
        // At its corners, extrapolated by less than a pixel.
        let least = place.map(|p| {
            let at = (p * side * 256.0).floor().as_ivec2().clamp(IVec2::ZERO, IVec2::splat(64 * 256 - 1));
            let [dx, dy] = exact(&triangle.weights((at / 256).as_uvec2(), at % 256), &attribute);
            axes(dx, dy)[1]
        });
        let least = DVec3::from_array(least).min_element();
        // What the bound gives up for rounding, as its docs say: all of it where the triangle is a sliver.
        let [t1, t2] = [attribute[1] - attribute[0], attribute[2] - attribute[0]];
        let given_up = (t1.length_squared() + t2.length_squared()) / (1024.0 * t1.perp_dot(t2).abs());
        prop_assert!(bound <= least * 1.01 && bound >= least * (0.6 - given_up), "{bound} for {least}");
    }
}

#[test]
fn what_is_not_drawn_bounds_nothing() {
    let least = LeastFootprint::new(viewport());
    let texels = [DVec2::ZERO, DVec2::X, DVec2::Y];
    let place =
        |x: f64| [(x, 0.0), (x + 1.0, 0.0), (x, 1.0)].map(|(x, y)| DVec4::new(x, y, 0.5, 1.0));
    assert_eq!(least.of(place(1.5), Cull::None, texels), f64::INFINITY);
    let mut odd = place(0.0);
    odd[1].x = f64::NAN;
    assert_eq!(least.of(odd, Cull::None, texels), f64::INFINITY);
    let flat = [place(0.0)[0], place(0.0)[1], place(0.3)[0]];
    assert_eq!(least.of(flat, Cull::None, texels), f64::INFINITY);
    let [a, b, c] = place(0.0);
    assert!(least.of([a, b, c], Cull::Back, texels) > 0.0);
    assert_eq!(least.of([a, c, b], Cull::Back, texels), f64::INFINITY);
    assert!(least.of([a, c, b], Cull::None, texels) < f64::INFINITY);
}

#[test]
fn an_attribute_without_area_is_bounded_by_zero() {
    let least = LeastFootprint::new(viewport());
    let place = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| DVec4::new(x, y, 0.5, 1.0));
    for odd in [DVec2::NAN, DVec2::INFINITY, DVec2::ZERO, DVec2::X * 0.5] {
        assert_eq!(
            least.of(place, Cull::None, [DVec2::ZERO, DVec2::X, odd]),
            0.0,
            "{odd}"
        );
    }
}

#[test]
fn a_plane_seen_from_above_keeps_its_density() {
    // Eight texels a pixel at the near edge, more beyond: the far part does not loosen the bound.
    let row = |y: f64, w: f64| [-1.0, 1.0].map(|x| DVec4::new(x * 2.0, y * w, 0.1, w));
    let [[a, b], [c, _]] = [row(-1.0, 1.0), row(0.5, 10.0)];
    let texels = [(-1.0, 0.0), (1.0, 0.0), (-1.0, 9.0)].map(|(x, y)| DVec2::new(x, y) * 512.0);
    let bound = LeastFootprint::new(viewport()).of([a, b, c], Cull::None, texels);
    let triangle = assembled([a, b, c], viewport())
        .pop()
        .expect("it is visible");
    let least = shaded(&triangle, &pattern(1)).into_iter().map(|weights| {
        let [dx, dy] = exact(&weights, &texels);
        axes(dx, dy)[1]
    });
    let least = least.fold(f64::INFINITY, f64::min);
    assert!(bound <= least && bound > 0.5 * least, "{bound} for {least}");
}
