//! Inputs that seek trouble: extreme ratios of w, slivers, points near edges and corners.

use glam::{DVec3, Vec2};
use proptest::prelude::*;

/// Clip-space w with ratios up to 2²⁰, extremes often.
pub(crate) fn w() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => (0.0..20.0f64).prop_map(|e| (1.0 + e / 20.0) * f64::from(1u32 << (e as u32))),
        1 => Just(1.0),
        1 => Just(f64::from(1u32 << 20)),
        1 => (0u32..1000).prop_map(|ulps| f64::from_bits(1.0f64.to_bits() + u64::from(ulps))),
    ]
}

/// A fraction in 0..=1, crowded at both ends.
pub(crate) fn fraction() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => 0.0..=1.0f64,
        1 => Just(0.0),
        1 => Just(1.0),
        1 => (1i32..60).prop_map(|e| libm::ldexp(1.0, -e)),
        1 => (1i32..53).prop_map(|e| 1.0 - libm::ldexp(1.0, -e)),
    ]
}

/// A triangle on the integer sub-pixel grid and a grid point inside it or on its border.
#[derive(Clone, Debug)]
pub(crate) struct ScreenTriangle {
    pub(crate) corners: [[i64; 2]; 3],
    pub(crate) point: [i64; 2],
    pub(crate) inv_w: DVec3,
}

/// Triangles from a sub-pixel to 2²⁴ units, slivers included, with a point that they hold.
pub(crate) fn screen_triangle() -> impl Strategy<Value = ScreenTriangle> {
    let corner = |reach: i64| [-reach..=reach, -reach..=reach];
    let size = prop_oneof![Just(8i64), Just(1 << 12), Just(1 << 20), Just(1 << 23)];
    let shape = size.prop_flat_map(move |reach| {
        (
            corner(reach),
            corner(reach),
            corner(reach),
            0u8..4,
            -2i64..=2,
        )
    });
    (shape, [fraction(), fraction()], [w(), w(), w()]).prop_filter_map(
        "a triangle with area",
        |((a, b, c, kind, off), f, w)| {
            // Kind 0 is a sliver: the third corner next to the line through the others.
            let c = if kind == 0 {
                [(a[0] + b[0]) / 2 + off, (a[1] + b[1]) / 2 + 1]
            } else {
                c
            };
            let corners = [a, b, c];
            let doubled = edge(a, b, c);
            let corners = match doubled {
                0 => return None,
                n if n < 0 => [a, c, b],
                _ => corners,
            };
            let point = held_point(corners, f)?;
            Some(ScreenTriangle {
                corners,
                point,
                inv_w: DVec3::from_array(w).recip(),
            })
        },
    )
}

/// A grid point of the triangle near the given mixture of its corners, or a corner.
fn held_point(corners: [[i64; 2]; 3], f: [f64; 2]) -> Option<[i64; 2]> {
    let (u, v) = if f[0] + f[1] > 1.0 {
        (1.0 - f[0], 1.0 - f[1])
    } else {
        (f[0], f[1])
    };
    let mix = |axis: usize| {
        let [a, b, c] = corners.map(|p| p[axis] as f64);
        (a + (b - a) * u + (c - a) * v).round() as i64
    };
    let point = [mix(0), mix(1)];
    let inside = (0..3).all(|i| edge(corners[(i + 1) % 3], corners[(i + 2) % 3], point) >= 0);
    Some(if inside { point } else { corners[0] })
}

/// Twice the signed area of a, b, p.
pub(crate) fn edge(a: [i64; 2], b: [i64; 2], p: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

/// Texture coordinates of three corners, from one texel to far repeats.
pub(crate) fn corner_st() -> impl Strategy<Value = [Vec2; 3]> {
    let range = prop_oneof![Just(1.0f32), Just(64.0), Just(1e6)];
    range.prop_flat_map(|r| [st(r), st(r), st(r)])
}

pub(crate) fn st(reach: f32) -> impl Strategy<Value = Vec2> {
    (-reach..=reach, -reach..=reach).prop_map(|(s, t)| Vec2::new(s, t))
}
