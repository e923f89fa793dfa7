//! Lat-long to cube: hard case F4.

use envmap::latlong_texel_solid_angle;
use glam::{UVec2, Vec3};
use proptest::prelude::*;

use crate::oracle::energy;
use crate::strategies::{cube, latlong};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// One texel 10⁶ brighter, anywhere: by area where the map is finer, by lookups where it is coarser.
    #[test]
    fn f4_a_hot_texel_keeps_its_energy(
        height in prop::sample::select(vec![32u32, 48, 63, 64, 128]), s in 0.0..1.0f64, t in 0.0..1.0f64,
    ) {
        let size = UVec2::new(height * 2, height);
        let hot = (glam::DVec2::new(s, t) * size.as_dvec2()).as_uvec2().min(size - 1);
        let map = latlong(size, |ij| if ij == hot { Vec3::splat(1e6) } else { Vec3::splat(0.5) });
        let expected = 4.0 * std::f64::consts::PI * 0.5 + (1e6 - 0.5) * latlong_texel_solid_angle(size, hot.y);
        let got = energy(&cube(&map, 16)).x;
        prop_assert!((got / expected - 1.0).abs() < 0.005, "{hot} of {size}: {}", got / expected);
    }

    #[test]
    fn constants_stay_constant(height in 1u32..70, size in 1u32..20, value in 0.0..1e5f32) {
        let map = latlong(UVec2::new(height * 2 + 1, height), |_| Vec3::new(value, 1.0, 0.1));
        for face in envmap::CubeFace::ALL {
            for texel in envmap::resample_latlong_face(&map, size, face) {
                prop_assert_eq!(texel, Vec3::new(value, 1.0, 0.1));
            }
        }
    }
}

#[test]
fn a_smooth_map_is_reproduced_on_every_face() {
    // Linear in the direction, so each texel's mean is its centroid's value.
    let light = |d: Vec3| Vec3::new(2.0 + d.x, 2.0 + d.y, 2.0 + d.z);
    let size = UVec2::new(512, 256);
    let map = latlong(size, |ij| {
        light(envmap::latlong_st_to_direction(
            (ij.as_vec2() + 0.5) / size.as_vec2(),
        ))
    });
    for cube_size in [5, 32] {
        let cube = cube(&map, cube_size);
        for face in envmap::CubeFace::ALL {
            for (k, texel) in (0..).zip(cube.face(face)) {
                let st =
                    (UVec2::new(k % cube_size, k / cube_size).as_vec2() + 0.5) / cube_size as f32;
                let expected = light(envmap::cube_to_direction(face, st));
                // The mean of directions over a texel is shorter than its centre by h²/12 and more, h = 2/size; and a map
                // texel is constant over its 0.012.
                let tolerance = 0.5 / (cube_size * cube_size) as f32 + 0.006;
                assert!(
                    (texel - expected).abs().max_element() < tolerance,
                    "{face:?} {st}: {texel} {expected}"
                );
            }
        }
    }
}

#[test]
fn wide_maps_are_halved_by_solid_angle() {
    let size = UVec2::new(4096, 16);
    let hot = UVec2::new(1234, 0);
    let map = latlong(size, |ij| {
        if ij == hot {
            Vec3::splat(1e6)
        } else {
            Vec3::ZERO
        }
    });
    let got = energy(&cube(&map, 8)).x;
    let expected = 1e6 * latlong_texel_solid_angle(size, 0);
    assert!((got / expected - 1.0).abs() < 0.005, "{}", got / expected);
}

#[test]
fn an_empty_cube_has_no_texels() {
    let map = latlong(UVec2::new(8, 4), |_| Vec3::ONE);
    assert!(envmap::resample_latlong_face(&map, 0, envmap::CubeFace::PosX).is_empty());
}
