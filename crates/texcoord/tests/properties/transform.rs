//! Texture transforms against the published example and the formula in f64.

use core::f32::consts::FRAC_PI_2;

use glam::{DVec2, Vec2};
use proptest::prelude::*;
use texcoord::{AffineTransform, ScreenCoordinate, TextureTransform};

use crate::strategies::st;

proptest! {
    #[test]
    fn derivatives_go_through_as_differences_do(
        offset in st(10.0), rotation in -7.0..7.0f32, scale in st(8.0), at in st(100.0), dx in st(0.1), dy in st(0.1),
    ) {
        let affine = TextureTransform { offset, rotation, scale }.affine();
        let here = ScreenCoordinate { st: at.into(), dst_dx: dx, dst_dy: dy };
        let moved = |d: Vec2| affine.apply(ScreenCoordinate { st: here.st + DVec2::from(d), ..here }).st;
        let found = affine.apply(here);
        for (difference, slope) in [(moved(dx) - found.st, found.dst_dx), (moved(dy) - found.st, found.dst_dy)] {
            prop_assert!((difference - DVec2::from(slope)).length() <= 1e-6, "{difference} against {slope}");
        }
    }

    #[test]
    fn the_order_is_scale_then_rotation_then_offset(
        offset in st(10.0), rotation in -7.0..7.0f32, scale in st(8.0), at in st(100.0),
    ) {
        let here = ScreenCoordinate { st: at.into(), ..Default::default() };
        let scaled = TextureTransform { scale, ..Default::default() };
        let rotated = TextureTransform { rotation, ..Default::default() };
        let shifted = TextureTransform { offset, ..Default::default() };
        let in_steps = shifted.apply(rotated.apply(scaled.apply(here))).st;
        let at_once = TextureTransform { offset, rotation, scale }.apply(here).st;
        prop_assert!((in_steps - at_once).length() <= 1e-9, "{in_steps} against {at_once}");
    }
}

#[test]
fn the_published_example_uses_the_lower_left_quadrant() {
    // KHR_texture_transform's first example: offset (0,1), a quarter turn, scale ½. T is down, so the lower
    // left quadrant is s in 0..½, t in ½..1.
    let quadrant = TextureTransform {
        offset: Vec2::new(0.0, 1.0),
        rotation: FRAC_PI_2,
        scale: Vec2::splat(0.5),
    };
    for (before, after) in [
        (DVec2::new(0.0, 0.0), DVec2::new(0.0, 1.0)),
        (DVec2::new(1.0, 0.0), DVec2::new(0.0, 0.5)),
        (DVec2::new(0.0, 1.0), DVec2::new(0.5, 1.0)),
        (DVec2::new(1.0, 1.0), DVec2::new(0.5, 0.5)),
    ] {
        let at = quadrant.apply(ScreenCoordinate {
            st: before,
            ..Default::default()
        });
        assert!(
            (at.st - after).length() < 1e-7,
            "{before} went to {}",
            at.st
        );
    }
}

#[test]
fn the_default_changes_nothing() {
    let at = ScreenCoordinate {
        st: DVec2::new(1e6 + 1e-9, -3.25),
        dst_dx: Vec2::new(1e-20, 3.0),
        dst_dy: Vec2::new(-0.5, 1e20),
    };
    assert!(TextureTransform::default().is_identity());
    assert_eq!(TextureTransform::default().apply(at), at);
    assert_eq!(AffineTransform::IDENTITY.apply(at), at);
    let scaled = TextureTransform {
        scale: Vec2::new(1.0, 2.0),
        ..Default::default()
    };
    assert!(!scaled.is_identity());
}
