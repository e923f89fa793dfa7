//! Footprint axes: hard cases B1 and B2.

use glam::{UVec2, Vec2};
use mipmap::footprint_axes;
use proptest::prelude::*;

use crate::oracle::singular_values;
use crate::strategies::{jacobian, odd_derivative};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// B2: aspects to 10⁶ and beyond, every rotation, scales 1e-20 to 1e20.
    #[test]
    fn axes_are_the_singular_values(j in jacobian(), w in 1u32..16384, h in 1u32..16384) {
        let size = UVec2::new(w, h);
        let axes = footprint_axes(size, j.dst_dx, j.dst_dy);
        let [major, minor] = singular_values(size, j.dst_dx, j.dst_dy);
        prop_assert!((f64::from(axes.major) - major).abs() <= 1e-6 * major, "{axes:?} {major}");
        if minor > 1e-37 && minor * 1e8 > major {
            prop_assert!((f64::from(axes.minor) - minor).abs() <= 1e-6 * minor, "{axes:?} {minor}");
        }
        prop_assert!(axes.minor <= axes.major);
    }

    #[test]
    fn direction_is_the_major_axis(j in jacobian(), w in 1u32..2000, h in 1u32..2000) {
        let size = UVec2::new(w, h);
        let axes = footprint_axes(size, j.dst_dx, j.dst_dy);
        prop_assume!(axes.major > 1e-30 && axes.anisotropy() > 1.01);
        let along = axes.direction.as_dvec2() * size.as_dvec2();
        prop_assert!((along.length() / f64::from(axes.major) - 1.0).abs() < 1e-5);
        // Jᵀu has length `major` only for the left singular vector.
        let u = along.normalize();
        let [a, b] = [j.dst_dx, j.dst_dy].map(|d| (d.as_dvec2() * size.as_dvec2()).dot(u));
        prop_assert!((a.hypot(b) / f64::from(axes.major) - 1.0).abs() < 1e-5);
    }

    #[test]
    fn axes_are_never_nan(dst_dx in odd_derivative(), dst_dy in odd_derivative(), w: u32, h: u32) {
        let axes = footprint_axes(UVec2::new(w, h), dst_dx, dst_dy);
        prop_assert!(!axes.major.is_nan() && !axes.minor.is_nan() && axes.direction.is_finite());
        prop_assert!(axes.anisotropy() >= 1.0);
    }
}

#[test]
fn b1_a_zero_footprint_has_no_axes() {
    let axes = footprint_axes(UVec2::splat(64), Vec2::ZERO, Vec2::ZERO);
    assert_eq!(
        (axes.major, axes.minor, axes.direction),
        (0.0, 0.0, Vec2::ZERO)
    );
    assert_eq!(axes.anisotropy(), 1.0);
}

#[test]
fn b1_a_line_footprint_has_no_minor_axis() {
    let size = UVec2::splat(64);
    for direction in [Vec2::X, Vec2::Y, Vec2::ONE, Vec2::new(3.0, -1.0)] {
        let line = direction / 64.0;
        for (dx, dy) in [
            (line, Vec2::ZERO),
            (Vec2::ZERO, line),
            (line, line),
            (line, line * -0.5),
        ] {
            let axes = footprint_axes(size, dx, dy);
            assert_eq!(axes.minor, 0.0, "{dx} {dy}");
            assert_eq!(axes.anisotropy(), f32::INFINITY);
            assert!(axes.direction.perp_dot(direction).abs() < 1e-6);
        }
    }
}

#[test]
fn unbounded_derivatives_are_unbounded_footprints() {
    for bad in [
        Vec2::new(f32::NAN, 0.0),
        Vec2::new(0.0, f32::INFINITY),
        Vec2::NEG_INFINITY,
    ] {
        let axes = footprint_axes(UVec2::splat(8), bad, Vec2::X);
        assert_eq!((axes.major, axes.minor), (f32::INFINITY, f32::INFINITY));
        assert_eq!((axes.direction, axes.anisotropy()), (Vec2::ZERO, 1.0));
    }
}

/// B2: every aspect and turn of the catalogue, at scales from 1e-20 to 1e20: both axes within 1e-6, at bounded cost.
#[test]
fn b2_axes_hold_over_aspects_turns_and_scales() {
    let turns = (0..16).map(|k| f64::from(k) * std::f64::consts::PI / 8.0);
    for turn in turns {
        for aspect in [1.0, 1.0 + 1e-6, 1.0 - 1e-6, 8.0, 16.0, 1e3, 1e6] {
            for scale in [1e-20, 1e-6, 1.0, 1e6, 1e20] {
                let [dx, dy] = crate::strategies::turned(turn, 0.3 * turn, scale, scale / aspect);
                let (dx, dy) = (dx.as_vec2(), dy.as_vec2());
                let [major, minor] = singular_values(UVec2::splat(64), dx, dy);
                let axes = footprint_axes(UVec2::splat(64), dx, dy);
                let near =
                    |got: f32, expected: f64| (f64::from(got) / expected - 1.0).abs() <= 1e-6;
                assert!(
                    near(axes.major, major),
                    "{turn} {aspect} {scale}: {} {major}",
                    axes.major
                );
                assert!(
                    near(axes.minor, minor),
                    "{turn} {aspect} {scale}: {} {minor}",
                    axes.minor
                );
            }
        }
    }
}
