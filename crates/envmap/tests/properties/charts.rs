//! Charts there and back, and solid angles. Hard case F1.

use envmap::{
    CubeFace, cube_texel_solid_angle, cube_to_direction, direction_to_cube,
    direction_to_latlong_st, latlong_st_to_direction, latlong_texel_solid_angle,
};
use glam::{UVec2, Vec2, Vec3};
use proptest::prelude::*;

use crate::strategies::direction;

proptest! {
    #[test]
    fn latlong_comes_back(direction in direction(), scale in 1e-30..1e30f32) {
        let st = direction_to_latlong_st(direction * scale);
        prop_assert!((0.0..=1.0).contains(&st.x) && (0.0..=1.0).contains(&st.y), "{st}");
        let back = latlong_st_to_direction(st);
        prop_assert!(back.distance(direction) < 2e-6, "{direction} {back}");
    }

    #[test]
    fn latlong_st_is_within_its_bound(direction in direction()) {
        let d = direction.as_dvec3();
        prop_assume!(d.x.hypot(d.z) > 1e-3);
        let s = 0.5 + d.x.atan2(-d.z) / std::f64::consts::TAU;
        let t = d.x.hypot(d.z).atan2(d.y) / std::f64::consts::PI;
        let st = direction_to_latlong_st(direction);
        prop_assert!((f64::from(st.x) - s).abs() < 3e-7 && (f64::from(st.y) - t).abs() < 3e-7);
    }

    #[test]
    fn cube_comes_back(direction in direction(), scale in 1e-30..1e30f32) {
        let (face, st) = direction_to_cube(direction * scale);
        prop_assert!((0.0..=1.0).contains(&st.x) && (0.0..=1.0).contains(&st.y), "{st}");
        let back = cube_to_direction(face, st);
        prop_assert!(back.distance(direction) < 4e-7, "{direction} {back}");
    }

    #[test]
    fn cube_st_comes_back(k in 0usize..6, s in 0.001..0.999f32, t in 0.001..0.999f32) {
        let face = CubeFace::ALL[k];
        let (again, st) = direction_to_cube(cube_to_direction(face, Vec2::new(s, t)));
        prop_assert_eq!(again, face);
        prop_assert!(st.distance(Vec2::new(s, t)) < 3e-7);
    }
}

#[test]
fn the_compass_of_a_latlong_map() {
    let at = |direction| direction_to_latlong_st(direction);
    assert_eq!(at(Vec3::NEG_Z), Vec2::new(0.5, 0.5));
    assert_eq!(at(Vec3::X), Vec2::new(0.75, 0.5));
    assert_eq!(at(Vec3::NEG_X), Vec2::new(0.25, 0.5));
    assert_eq!(at(Vec3::Y), Vec2::new(0.5, 0.0));
    assert_eq!(at(Vec3::NEG_Y), Vec2::new(0.5, 1.0));
    assert!([0.0, 1.0].contains(&at(Vec3::Z).x));
    assert_eq!(at(Vec3::ZERO), Vec2::splat(0.5));
    assert_eq!(at(Vec3::NAN), Vec2::splat(0.5));
    assert_eq!(at(Vec3::INFINITY), Vec2::splat(0.5));
}

#[test]
fn f1_ties_between_faces_go_to_z_then_y() {
    assert_eq!(direction_to_cube(Vec3::ONE).0, CubeFace::PosZ);
    assert_eq!(direction_to_cube(Vec3::NEG_ONE).0, CubeFace::NegZ);
    assert_eq!(
        direction_to_cube(Vec3::new(1.0, -1.0, 0.5)).0,
        CubeFace::NegY
    );
    assert_eq!(
        direction_to_cube(Vec3::ZERO),
        (CubeFace::PosZ, Vec2::splat(0.5))
    );
    assert_eq!(
        direction_to_cube(Vec3::NAN),
        (CubeFace::PosZ, Vec2::splat(0.5))
    );
    assert_eq!(
        direction_to_cube(Vec3::INFINITY),
        (CubeFace::PosZ, Vec2::splat(0.5))
    );
}

#[test]
fn f1_axes_are_the_centres_of_their_faces() {
    let axes = [
        Vec3::X,
        Vec3::NEG_X,
        Vec3::Y,
        Vec3::NEG_Y,
        Vec3::Z,
        Vec3::NEG_Z,
    ];
    for (face, axis) in CubeFace::ALL.into_iter().zip(axes) {
        assert_eq!(direction_to_cube(axis), (face, Vec2::splat(0.5)));
        assert_eq!(cube_to_direction(face, Vec2::splat(0.5)), axis);
    }
    // Vulkan's table: on +X, s grows with −z and t with −y; on +Y, s with +x and t with +z.
    assert!(cube_to_direction(CubeFace::PosX, Vec2::new(1.0, 0.5)).z < 0.0);
    assert!(cube_to_direction(CubeFace::PosX, Vec2::new(0.5, 1.0)).y < 0.0);
    assert!(cube_to_direction(CubeFace::PosY, Vec2::new(1.0, 0.5)).x > 0.0);
    assert!(cube_to_direction(CubeFace::PosY, Vec2::new(0.5, 1.0)).z > 0.0);
}

#[test]
fn solid_angles_sum_to_the_sphere() {
    let sphere = 4.0 * std::f64::consts::PI;
    for size in [1, 2, 7, 64, 257] {
        let face: f64 = (0..size * size)
            .map(|k| cube_texel_solid_angle(size, UVec2::new(k % size, k / size)))
            .sum();
        assert!((6.0 * face - sphere).abs() < 1e-11, "{size}: {face}");
    }
    for size in [UVec2::new(1, 1), UVec2::new(4, 2), UVec2::new(101, 63)] {
        let map: f64 = (0..size.y)
            .map(|j| f64::from(size.x) * latlong_texel_solid_angle(size, j))
            .sum();
        assert!((map - sphere).abs() < 1e-11, "{size}: {map}");
    }
}

#[test]
fn a_centre_texel_is_over_five_times_a_corner_texel() {
    let ratio =
        cube_texel_solid_angle(1001, UVec2::splat(500)) / cube_texel_solid_angle(1001, UVec2::ZERO);
    assert!((ratio - 27f64.sqrt()).abs() < 0.02, "{ratio}");
}
