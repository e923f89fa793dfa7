//! Screen-linear interpolation, its error, and subdivision until it is perspective.

use fearless_simd::{Level, dispatch};
use glam::DVec3;
use num_rational::BigRational;
use proptest::prelude::*;
use texcoord::packet::F64x16;
use texcoord::planes::{CoordinatePlanes, ScreenEdges};
use texcoord::{
    Interpolation, perspective_parameter, perspective_weights, screen_linear_error,
    subdivided_parameter, subdivision_levels,
};

use crate::oracle::{distance, edge_parameter, edges, exact, interpolate};
use crate::strategies::{ScreenTriangle, fraction, screen_triangle, w};

/// 2⁻⁵³.
const HALF_ULP: f64 = f64::EPSILON / 2.0;

/// The largest error of the pieces after `levels` halvings, by brute force over every piece near both ends.
fn error_after(levels: u32, w0: f64, w1: f64) -> f64 {
    let pieces = libm::ldexp(1.0, levels as i32);
    let ends = (0..8).flat_map(|k| [f64::from(k), pieces - 1.0 - f64::from(k)]);
    let error = |k: f64| {
        let [a, b] = [k / pieces, (k + 1.0) / pieces].map(|s| w0 + (w1 - w0) * s);
        // The middle of the curve in this piece, where the derivation puts it.
        let t = b.sqrt() / (a.sqrt() + b.sqrt());
        (t * a / (b + t * (a - b)) - t).abs() / pieces
    };
    ends.filter(|k| (0.0..pieces).contains(k))
        .map(error)
        .fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn the_error_is_a_bound_that_is_reached(t in fraction(), w0 in w(), w1 in w()) {
        let bound = screen_linear_error(w0, w1);
        let off = distance(&edge_parameter(t, w0, w1), &exact(t));
        prop_assert!(off <= exact(bound) * (exact(1.0) + exact(8.0 * HALF_ULP)) + exact(1e-300), "{t} is off by more");
        let worst = w1.sqrt() / (w0.sqrt() + w1.sqrt());
        let reached = distance(&edge_parameter(worst, w0, w1), &exact(worst));
        prop_assert!(reached >= exact(bound) * exact(1.0 - 1e-9) - exact(4.0 * HALF_ULP));
    }

    #[test]
    fn no_point_of_a_triangle_is_farther_off_than_its_extreme_edge(triangle in screen_triangle()) {
        let area: i64 = edges(&triangle).iter().sum();
        let w = triangle.inv_w.recip();
        let bound = exact(screen_linear_error(w.min_element(), w.max_element()) + 1e-12);
        // An attribute that is 1 at some corners and 0 at the others has range 1.
        for corners in 1..7u8 {
            let f = [0, 1, 2].map(|k| f64::from(corners >> k & 1));
            let linear: i64 = (0..3).map(|k| edges(&triangle)[k] * f[k] as i64).sum();
            let linear = BigRational::new(linear.into(), area.into());
            prop_assert!(distance(&interpolate(&triangle, f)[0], &linear) <= bound);
        }
    }

    #[test]
    fn levels_are_enough_and_one_less_is_not(w0 in w(), w1 in w(), exponent in 1..44i32) {
        let tolerance = libm::ldexp(1.3, -exponent);
        let levels = subdivision_levels(w0, w1, tolerance).unwrap();
        prop_assert!(error_after(levels, w0, w1) <= tolerance * (1.0 + 1e-6) + 4.0 * HALF_ULP, "{levels} are too few");
        if levels > 0 {
            prop_assert!(error_after(levels - 1, w0, w1) >= tolerance * (1.0 - 1e-6), "{levels} are too many");
        }
    }

    #[test]
    fn subdivided_edges_keep_their_tolerance(t in fraction(), w0 in w(), w1 in w(), exponent in 1..40i32) {
        let tolerance = libm::ldexp(1.0, -exponent);
        let levels = subdivision_levels(w0, w1, tolerance).unwrap();
        let found = subdivided_parameter(t, w0, w1, levels);
        let off = distance(&exact(found), &edge_parameter(t, w0, w1));
        prop_assert!(off <= exact(tolerance + libm::ldexp(1.0, -48)));
    }

    #[test]
    fn four_forms_of_interpolation_agree(steps in 4..11u32, k in 0..16usize, w0 in w(), w1 in w()) {
        // A pixel k of n along the bottom edge of a right triangle, n a power of two: t is exact.
        let n = f64::from(1u32 << steps);
        let t = k as f64 / n;
        let truth = edge_parameter(t, w0, w1);
        let relative = |units: f64| exact(units * HALF_ULP) * &truth;

        // 1. The law of the edge.
        let by_law = exact(perspective_parameter(t, w0, w1));
        prop_assert!(distance(&by_law, &truth) <= relative(6.0));

        // 2. Barycentric weights; 1/w is rounded once more on each side.
        let inv_w = DVec3::new(w0, w1, 1.0).recip();
        let values = DVec3::new(n - k as f64, k as f64, 0.0);
        let by_weights = perspective_weights(values, DVec3::ZERO, DVec3::ZERO, inv_w).value.y;
        prop_assert!(distance(&exact(by_weights), &truth) <= relative(10.0));

        // 3. Plane equations, within m·2⁻⁴⁸ of their range.
        let plane_edges = ScreenEdges { origin: [n, 0.0, 0.0], dx: [-1.0, 1.0, 0.0], dy: [-1.0, 0.0, 1.0] };
        let planes = CoordinatePlanes::new(&plane_edges, inv_w.to_array(), [[0.0; 2], [1.0; 2], [0.0; 2]]);
        let row: [f64; 16] = dispatch!(Level::new(), simd => {
            let [s, _] = planes.packet(simd, [0.0; 2]).st;
            F64x16::to_array(s)
        });
        let d = values.dot(inv_w);
        let m = (n * inv_w.x).max(16.0 * inv_w.y) / d;
        let bound = libm::ldexp(m + 1.0, -48);
        prop_assert!(distance(&exact(row[k]), &truth) <= exact(bound), "{} off {t}", row[k]);

        // 4. Subdivision, in the limit.
        let limit = exact(subdivided_parameter(t, w0, w1, 100));
        prop_assert!(distance(&limit, &truth) <= exact(libm::ldexp(1.0, -48)));
    }

    #[test]
    fn screen_linear_weights_are_the_barycentrics(triangle in screen_triangle()) {
        let ScreenTriangle { inv_w, .. } = triangle;
        let values = edges(&triangle);
        let area: i64 = values.iter().sum();
        let vector = DVec3::from_array(values.map(|e| e as f64));
        let found = perspective_weights(vector, DVec3::ZERO, DVec3::ZERO, Interpolation::ScreenLinear.inv_w(inv_w));
        for (found, edge) in found.value.to_array().into_iter().zip(values) {
            let truth = BigRational::new(edge.into(), area.into());
            prop_assert!(distance(&exact(found), &truth) <= exact(8.0 * HALF_ULP) * truth);
        }
    }
}

#[test]
fn depths_and_tolerances_without_sense_have_their_documented_results() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(screen_linear_error(bad, 1.0), 1.0);
        assert_eq!(screen_linear_error(1.0, bad), 1.0);
        assert_eq!(subdivision_levels(bad, 1.0, 0.1), None);
        assert_eq!(subdivision_levels(1.0, bad, 0.1), None);
    }
    for tolerance in [0.0, -1.0, f64::NAN] {
        assert_eq!(subdivision_levels(1.0, 2.0, tolerance), None);
    }
    assert_eq!(subdivision_levels(2.0, 2.0, 1e-300), Some(0));
    assert_eq!(subdivision_levels(1.0, 2.0, f64::INFINITY), Some(0));
    assert!(subdivision_levels(5e-324, f64::MAX, 5e-324).is_some());
    assert!(subdivided_parameter(f64::NAN, 1.0, 2.0, 3).is_nan());
    assert_eq!(subdivided_parameter(1.0, 1.0, 2.0, u32::MAX), 1.0);
    assert_eq!(subdivided_parameter(0.0, 1.0, 2.0, u32::MAX), 0.0);
}

#[test]
fn a_far_end_keeps_its_digits() {
    // Near t = 1 an edge with a ratio of 2²⁰ is a million times as steep: rounding of 1 − t must not show.
    let (t, w0, w1) = (0.999_998_092_651_367_2, 1.0, 1_040_185.511_467_099_4);
    let found = subdivided_parameter(t, w0, w1, subdivision_levels(w0, w1, 1e-14).unwrap());
    let off = distance(&exact(found), &edge_parameter(t, w0, w1));
    assert!(off <= exact(1e-14 + libm::ldexp(1.0, -48)));
}
