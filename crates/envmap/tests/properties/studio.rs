//! What the neutral studio promises.

use envmap::{studio, studio_radiance};
use glam::{DVec3, UVec2, Vec3};
use proptest::prelude::*;

use crate::oracle::irradiance;
use crate::strategies::direction;

proptest! {
    #[test]
    fn the_studio_is_grey_positive_and_bounded(d in direction(), scale in 1e-3..1e3f32) {
        let radiance = studio_radiance(d * scale);
        prop_assert!(radiance.x == radiance.y && radiance.y == radiance.z);
        prop_assert!(radiance.x >= 0.29 && radiance.x < 8.0, "{radiance}");
    }

    #[test]
    fn the_map_is_the_function(d in direction()) {
        let map = studio(512);
        prop_assert!((map.radiance(d) - studio_radiance(d)).abs().max_element() < 0.1, "{d}");
    }
}

#[test]
fn white_looks_right_from_every_side() {
    let white = |normal: DVec3| {
        irradiance(normal, |d| f64::from(studio_radiance(d).x)) / std::f64::consts::PI
    };
    let sides = [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z, DVec3::Y];
    for normal in sides {
        let value = white(normal);
        println!("{normal}: {value}");
        assert!((0.6..=1.2).contains(&value), "{normal}: {value}");
    }
    println!("down {}", white(DVec3::NEG_Y));
    assert!(white(DVec3::NEG_Y) >= 0.3);
    // The key stands on the camera's left, above, in front.
    let key = DVec3::new(-1.0, 1.0, 1.0).normalize();
    let others = [
        DVec3::new(1.0, 1.0, 1.0),
        DVec3::new(-1.0, 1.0, -1.0),
        DVec3::new(-1.0, -1.0, 1.0),
    ];
    println!("key {}", white(key));
    assert!(
        others
            .iter()
            .all(|other| white(key) > 1.1 * white(other.normalize()))
    );
}

#[test]
fn an_odd_sized_studio_is_still_a_map() {
    assert_eq!(studio(0).size(), UVec2::ONE);
    assert_eq!(studio(9).size(), UVec2::new(9, 4));
    assert!(studio(1).radiance(Vec3::Y).x > 0.0);
}
