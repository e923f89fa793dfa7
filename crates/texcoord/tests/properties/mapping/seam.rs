//! The seam: no jump in the level of detail, and triangles that do not cross it.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use texcoord::mapping::{
    Cylindrical, Mapping, SeamCorner, Spherical, SurfacePoint, TurnConvention, unwrap_seam,
};

use super::strategies::{cylindrical, one_of_each, spherical, vector};

fn lod(mapping: &Mapping, at: &SurfacePoint) -> f64 {
    let lookups = mapping.lookups(at);
    let lookup = lookups.iter().next().unwrap().screen();
    f64::from(lookup.dst_dx.length().max(lookup.dst_dy.length())).log2()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn level_of_detail_does_not_jump_at_the_seam(
        chart in spherical(), around in cylindrical(), radius in 0.1..4.0f64, z in -4.0..4.0f64, dx in vector(0.01), dy in vector(0.01),
    ) {
        prop_assume!(dx.truncate().length() > 1e-4 && dy.truncate().length() > 1e-4);
        for side in [-radius, radius] {
            for mapping in [Mapping::Spherical(chart), Mapping::Cylindrical(around)] {
                let at = |offset: f64| SurfacePoint {
                    dposition_dx: dx,
                    dposition_dy: dy,
                    ..SurfacePoint::new(DVec3::new(side, offset, z), DVec3::X)
                };
                let [left, on, right] = [-1e-9, 0.0, 1e-9].map(|offset| lod(&mapping, &at(offset)));
                prop_assert!((left - right).abs() <= 0.01 && (left - on).abs() <= 0.01, "{left} {on} {right}");
                // And no pixel sees a whole turn: the footprint is that of its step.
                prop_assert!(on <= (0.02 * 2.0 / radius.min(1.0).min(0.1)).log2() + 1.0, "{on}");
            }
        }
    }

    #[test]
    fn unwrapping_leaves_no_edge_over_half_a_turn(
        middle in -3.0..3.0f64, offsets in [-0.25..0.25f64, -0.25..0.25, -0.25..0.25],
        t in [0.0..1.0f64, 0.0..1.0, 0.0..1.0], signed in prop::bool::ANY,
    ) {
        // Three corners within half a turn of each other, wherever the seam is.
        let truth = offsets.map(|offset| middle + offset);
        let wrapped = truth.map(|s| if signed { s - s.round() } else { s - s.floor() });
        let corners = core::array::from_fn(|k| SeamCorner::Regular(DVec2::new(wrapped[k], t[k])));
        let found = unwrap_seam(corners);
        for k in 0..3 {
            let next = (k + 1) % 3;
            let span = (found[k].x - found[next].x) - (truth[k] - truth[next]);
            prop_assert!(span.abs() <= 1e-12, "edge {} is {} off", k, span);
            prop_assert_eq!(found[k].y, t[k]);
            prop_assert!((found[k].x - wrapped[k]).fract() == 0.0 || (found[k].x - wrapped[k] - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn triangles_are_interpolated_as_their_points_map(
        chart in spherical(), around in cylindrical(), centre in vector(1.0),
        edges in [vector(0.02), vector(0.02), vector(0.02)], weights in [0.0..1.0f64, 0.0..1.0, 0.0..1.0],
    ) {
        // A small triangle far from the axis: interpolation and projection differ by its size squared.
        let centre = DVec3::new(centre.x.signum() * 0.5 + centre.x, 0.02 * centre.y, centre.z);
        let corners = edges.map(|e| centre + e);
        let sum: f64 = weights.iter().sum();
        prop_assume!(sum > 0.1);
        let mix = |p: [DVec3; 3]| (p[0] * weights[0] + p[1] * weights[1] + p[2] * weights[2]) / sum;
        for (st, inside) in [
            (chart.triangle(corners).unwrap(), chart.at(mix(corners)).unwrap()),
            (around.triangle(corners).unwrap(), around.at(mix(corners)).unwrap()),
        ] {
            let interpolated = mix(st.map(|st| st.extend(0.0))).truncate();
            let mut difference = interpolated - inside.st();
            difference.x -= difference.x.round();
            prop_assert!(difference.length() <= 0.01, "{interpolated} for {}", inside.st());
        }
    }
}

#[test]
fn pole_corners_take_the_mean_of_the_others() {
    let chart = Spherical::PHI_THETA;
    let (a, b) = (DVec3::new(1.0, 0.1, 1.0), DVec3::new(1.0, -0.3, 1.0));
    let [st_a, st_b, pole] = chart.triangle([a, b, DVec3::Z]).unwrap();
    assert_eq!(pole.y, 0.0);
    assert_eq!(pole.x, (st_a.x + st_b.x) / 2.0);
    assert!(
        (st_a.x
            - st_b.x
            - (libm::atan2(0.1, 1.0) + libm::atan2(0.3, 1.0)) / core::f64::consts::TAU)
            .abs()
            < 1e-15
    );
    // Two corners on the axis: the third's s. Three: as they are.
    let axis = Cylindrical::plain(TurnConvention::FromStart);
    let two = axis
        .triangle([DVec3::ZERO, DVec3::NEG_Y, DVec3::Z])
        .unwrap();
    assert_eq!(two.map(|st| st.x), [0.75; 3]);
    let three = axis
        .triangle([DVec3::ZERO, DVec3::Z, DVec3::NEG_Z])
        .unwrap();
    assert_eq!(three.map(|st| st.x), [0.0; 3]);
}

#[test]
fn a_triangle_around_the_axis_ends_and_stays_finite() {
    let corners = [
        DVec3::X,
        DVec3::new(-0.5, 0.8, 0.0),
        DVec3::new(-0.5, -0.8, 0.0),
    ];
    let st = Spherical::PHI_THETA.triangle(corners).unwrap();
    assert!(st.iter().all(|st| st.is_finite()));
}

#[test]
fn no_mapping_gives_a_coordinate_to_what_is_not_finite() {
    let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    for mapping in one_of_each() {
        for value in bad {
            for axis in DVec3::AXES {
                let position =
                    DVec3::select(axis.cmpeq(DVec3::ONE), DVec3::splat(value), DVec3::ONE);
                let at = SurfacePoint::new(position, DVec3::Z);
                assert_eq!(mapping.at(&at), None, "{position} by {mapping:?}");
                assert!(mapping.lookups(&at).is_empty());
            }
        }
    }
    assert_eq!(
        Spherical::PHI_THETA.triangle([DVec3::X, DVec3::NAN, DVec3::Y]),
        None
    );
}

#[test]
fn no_mapping_panics_on_the_largest_and_smallest_numbers() {
    let extremes = [0.0, -0.0, 5e-324, 1e-300, 1.0, 1e300, f64::MAX, f64::MIN];
    for mapping in one_of_each() {
        for x in extremes {
            for y in extremes {
                for z in extremes {
                    let at = SurfacePoint::new(DVec3::new(x, y, z), DVec3::new(z, x, y));
                    if let Some(mapped) = mapping.at(&at) {
                        assert!(!mapped.stp.is_nan(), "{at:?} by {mapping:?}");
                    }
                }
            }
        }
    }
}
