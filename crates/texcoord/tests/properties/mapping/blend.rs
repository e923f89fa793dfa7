//! Facets and their blend.

use glam::DVec3;
use proptest::prelude::*;
use texcoord::mapping::{
    BackFacets, CubeFace, Facets, Mapping, MappingError, SurfacePoint, Triplanar,
};

use super::strategies::{backs, direction, vector};

/// Two roundings in the sum of powers, one in each quotient, two in the test's own sum.
const SUM_BOUND: f64 = 2.5 * f64::EPSILON;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn weights_sum_to_one_and_are_the_powers_of_the_normal(
        normal in direction(), k in 1.0..9.0f64, backs in backs(), size in -300..300i32,
    ) {
        let blend = Triplanar::new(k, backs).unwrap();
        let found = blend.at(DVec3::ONE, normal * 10f64.powi(size)).unwrap();
        prop_assert!((found.weights.element_sum() - 1.0).abs() <= SUM_BOUND);
        prop_assert!(found.weights.min_element() >= 0.0);
        let powers = normal.abs().to_array().map(|n| n.powf(k));
        let truth = DVec3::from_array(powers) / powers.iter().sum::<f64>();
        prop_assert!((found.weights - truth).abs().max_element() <= 1e-14, "{} for {}", found.weights, truth);
    }

    #[test]
    fn slopes_of_weights_are_the_limit_of_differences(normal in direction(), k in 1.0..9.0f64, axis in 0..3usize) {
        prop_assume!(normal.abs().min_element() > 0.01);
        let blend = Triplanar::new(k, BackFacets::Readable).unwrap();
        let at = |h: f64| blend.at(DVec3::ONE, normal + DVec3::AXES[axis] * h).unwrap();
        let pair = |h: f64| (at(h).weights - at(-h).weights) / (2.0 * h);
        let truth = (pair(1e-4) * 4.0 - pair(2e-4)) / 3.0;
        let found = at(0.0).weights_by_normal.col(axis);
        prop_assert!((found - truth).length() <= 1e-5 * (1.0 + found.length()), "{} for {}", found, truth);
    }

    #[test]
    fn a_facet_lies_on_the_plane_nearest_to_its_normal(p in vector(4.0), normal in direction(), backs in backs()) {
        let facets = Facets { backs };
        let mapped = facets.at(p, normal).unwrap();
        let face = mapped.face.unwrap();
        let [s, t, outward] = facets.frame(face);
        prop_assert!(normal.dot(outward) >= normal.abs().max_element());
        prop_assert_eq!(mapped.stp.truncate().to_array(), [p.dot(s), p.dot(t)]);
        prop_assert_eq!([0, 1].map(|k| mapped.by_position.row(k)), [s, t]);
        // Readable from outside: s, t and the outward normal turn right-handed.
        let handed = s.cross(t).dot(outward);
        let mirrored = backs == BackFacets::Mirrored && outward.element_sum() < 0.0;
        prop_assert_eq!(handed, if mirrored { -1.0 } else { 1.0 });
        // The blend holds the same plane.
        let blend = Triplanar::new(4.0, backs).unwrap().at(p, normal).unwrap();
        prop_assert_eq!(blend.planes[face.axis()].stp, mapped.stp);
        prop_assert_eq!(blend.weights.max_position(), face.axis());
    }

    #[test]
    fn a_blend_looks_up_only_planes_with_weight(p in vector(4.0), normal in direction(), keep in 1..8u8) {
        let mask = DVec3::new(f64::from(keep & 1), f64::from(keep >> 1 & 1), f64::from(keep >> 2));
        let blend = Mapping::Triplanar(Triplanar::new(2.0, BackFacets::Readable).unwrap());
        let normal = (normal + DVec3::splat(3.0)) * mask;
        let lookups = blend.lookups(&SurfacePoint::new(p, normal));
        prop_assert_eq!(lookups.iter().count() as u32, keep.count_ones());
        let sum: f64 = lookups.iter().map(|lookup| lookup.weight).sum();
        prop_assert!((sum - 1.0).abs() <= SUM_BOUND);
    }
}

#[test]
fn a_normal_without_direction_weighs_all_planes_alike() {
    let blend = Triplanar::new(4.0, BackFacets::Readable).unwrap();
    for normal in [
        DVec3::ZERO,
        DVec3::NAN,
        DVec3::INFINITY,
        DVec3::new(0.0, f64::NAN, 1.0),
    ] {
        let found = blend.at(DVec3::ONE, normal).unwrap();
        assert_eq!(found.weights, DVec3::splat(1.0 / 3.0), "{normal}");
        assert_eq!(found.weights_by_normal, glam::DMat3::ZERO);
    }
    let even = blend.at(DVec3::ONE, DVec3::NEG_ONE).unwrap();
    assert_eq!(even.weights, DVec3::splat(1.0 / 3.0));
    assert_eq!(even.planes[0].face, Some(CubeFace::NegX));
}

#[test]
fn the_sharpest_blend_is_one_plane() {
    let blend = Triplanar::new(1024.0, BackFacets::Mirrored).unwrap();
    let found = blend.at(DVec3::ONE, DVec3::new(0.4, 1.0, -0.3)).unwrap();
    assert_eq!(found.weights, DVec3::Y);
}

#[test]
fn ties_between_planes_go_to_z_then_y() {
    let facets = Facets::default();
    let face = |n: DVec3| facets.at(DVec3::ZERO, n).unwrap().face.unwrap();
    assert_eq!(face(DVec3::ONE), CubeFace::PosZ);
    assert_eq!(face(DVec3::new(-1.0, -1.0, 0.5)), CubeFace::NegY);
    assert_eq!(face(DVec3::ZERO), CubeFace::PosZ);
}

#[test]
fn sharpness_out_of_range_is_refused() {
    for value in [0.0, 0.999, 1025.0, f64::NAN, f64::INFINITY, -2.0] {
        let refused = Triplanar::new(value, BackFacets::Readable);
        assert!(
            matches!(refused, Err(MappingError::Sharpness { .. })),
            "{value}"
        );
    }
}

#[test]
fn the_back_of_a_plane_runs_the_other_way_in_s_alone() {
    let p = DVec3::new(1.0, 2.0, 3.0);
    let st = |backs, n: DVec3| Facets { backs }.at(p, n).unwrap().st().to_array();
    for (axis, front) in [
        (DVec3::X, [2.0, 3.0]),
        (DVec3::Y, [-1.0, 3.0]),
        (DVec3::Z, [1.0, 2.0]),
    ] {
        for backs in [BackFacets::Readable, BackFacets::Mirrored] {
            assert_eq!(st(backs, axis), front);
        }
        assert_eq!(st(BackFacets::Readable, -axis), [-front[0], front[1]]);
        assert_eq!(st(BackFacets::Mirrored, -axis), front);
    }
}
