//! Laws of the punctual lights.

use glam::Vec3;
use proptest::prelude::*;
use shading::{LightKind, PunctualLight};

fn lamp(kind: LightKind, range: Option<f32>) -> PunctualLight {
    PunctualLight {
        kind,
        intensity: Vec3::ONE,
        position: Vec3::ZERO,
        direction: Vec3::NEG_Y,
        range,
    }
}

proptest! {
    #[test]
    fn point_light_obeys_the_inverse_square(d in 0.01f32..100.0) {
        let incident = lamp(LightKind::Point, None).incident(Vec3::new(d, 0.0, 0.0)).unwrap();
        prop_assert!((incident.illuminance.x * d * d - 1.0).abs() < 1e-5);
        prop_assert!((incident.direction + Vec3::X).length() < 1e-6);
    }

    #[test]
    fn range_ends_the_light_and_only_dims_it(range in 0.1f32..100.0, t in 0.0f32..2.0) {
        let point = Vec3::new(range * t, 0.0, 0.0);
        let limited = lamp(LightKind::Point, Some(range)).incident(point);
        if t >= 1.0 {
            prop_assert!(limited.is_none());
        } else if let (Some(limited), Some(free)) = (limited, lamp(LightKind::Point, None).incident(point)) {
            prop_assert!(limited.illuminance.x <= free.illuminance.x);
        }
    }

    #[test]
    fn spot_is_a_point_light_inside_and_nothing_outside(
        inner in 0.0f32..0.7, width in 0.05f32..0.8, angle in 0.0f32..3.1,
    ) {
        let kind = LightKind::Spot { inner_cone_radians: inner, outer_cone_radians: inner + width };
        let point = Vec3::new(angle.sin(), -angle.cos(), 0.0);
        match lamp(kind, None).incident(point) {
            None => prop_assert!(angle > inner + width - 2e-3),
            Some(i) if angle < inner - 1e-3 => prop_assert!((i.illuminance.x - 1.0).abs() < 1e-4),
            Some(i) => prop_assert!(i.illuminance.x <= 1.0001 && angle < inner + width + 2e-3),
        }
    }
}

#[test]
fn a_point_on_the_lamp_receives_nothing() {
    assert!(lamp(LightKind::Point, None).incident(Vec3::ZERO).is_none());
}

#[test]
fn directional_light_is_the_same_everywhere() {
    let sun = lamp(LightKind::Directional, None);
    let here = sun.incident(Vec3::ZERO).unwrap();
    assert_eq!(here, sun.incident(Vec3::splat(1e6)).unwrap());
    assert_eq!(here.direction, Vec3::Y);
}
