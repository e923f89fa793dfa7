//! Interpolation against exact rational arithmetic.

use glam::{DVec3, Vec2, Vec3, Vec4};
use num_rational::BigRational;
use proptest::prelude::*;
use texcoord::{Weights, perspective_parameter, perspective_weights};

use crate::oracle::{self, distance, exact, magnitude};
use crate::strategies::{ScreenTriangle, corner_st, fraction, screen_triangle, w};

/// The bound that issue 2 sets: error as a fraction of the attribute range.
const ATTRIBUTE_BOUND: f64 = 4.0 / 16_777_216.0;
/// Relative bound of a derivative of (s,t), measured on the length of the exact gradient.
const DERIVATIVE_BOUND: f64 = 1e-5;
/// 2⁻⁵³.
const HALF_ULP: f64 = f64::EPSILON / 2.0;

fn weights(triangle: &ScreenTriangle) -> Weights {
    let vector = |e: [i64; 3]| DVec3::from_array(e.map(|x| x as f64));
    let [dx, dy] = oracle::edge_gradients(triangle);
    perspective_weights(
        vector(oracle::edges(triangle)),
        vector(dx),
        vector(dy),
        triangle.inv_w,
    )
}

fn largest(values: &[BigRational]) -> BigRational {
    let magnitudes = values.iter().map(magnitude);
    magnitudes.fold(exact(0.0), |a, b| if a > b { a } else { b })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn edge_parameter_matches_rational_arithmetic(t in fraction(), w0 in w(), w1 in w()) {
        let s = perspective_parameter(t, w0, w1);
        let truth = oracle::edge_parameter(t, w0, w1);
        prop_assert!(distance(&exact(s), &truth) <= exact(6.0 * HALF_ULP) * &truth, "s = {s:e}");
        prop_assert!((0.0..=1.0).contains(&s));
    }

    #[test]
    fn edge_parameter_grows_with_t(a in fraction(), b in fraction(), w0 in w(), w1 in w()) {
        // Neighbours a few ulps apart may round to either order: ask for the bound, not for more.
        let (low, high) = (a.min(b), a.max(b));
        let [s0, s1] = [low, high].map(|t| perspective_parameter(t, w0, w1));
        prop_assert!(s0 <= s1 * (1.0 + 12.0 * HALF_ULP), "{s0:e} > {s1:e}");
    }

    #[test]
    fn weights_match_rational_arithmetic(triangle in screen_triangle()) {
        let found = weights(&triangle);
        for i in 0..3 {
            let mut one_hot = [0.0; 3];
            one_hot[i] = 1.0;
            let truth = &oracle::interpolate(&triangle, one_hot)[0];
            let error = distance(&exact(found.value[i]), truth);
            prop_assert!(error <= exact(8.0 * HALF_ULP) * truth, "weight {i} of {found:?}");
        }
    }

    #[test]
    fn weights_sum_to_one_and_their_slopes_to_zero(triangle in screen_triangle()) {
        let Weights { value, dx, dy } = weights(&triangle);
        prop_assert!(value.min_element() >= 0.0 && value.max_element() <= 1.0);
        prop_assert!((value.element_sum() - 1.0).abs() <= 3.0 * HALF_ULP, "{value}");
        for slope in [dx, dy] {
            let rounding = 4.0 * HALF_ULP * slope.abs().max_element();
            prop_assert!(slope.element_sum().abs() <= rounding, "{slope}");
        }
    }

    #[test]
    fn attributes_stay_within_four_units_of_f32(triangle in screen_triangle(), a in [-1e6..1e6f32, -1.0..1.0f32, -64.0..64.0f32]) {
        let found = f64::from(weights(&triangle).interpolate(a));
        let truth = &oracle::interpolate(&triangle, a.map(f64::from))[0];
        let range = f64::from(a.iter().fold(0.0f32, |m, x| m.max(x.abs())));
        prop_assert!(distance(&exact(found), truth) <= exact(ATTRIBUTE_BOUND * range));
        let (low, high) = (a[0].min(a[1]).min(a[2]), a[0].max(a[1]).max(a[2]));
        prop_assert!((f64::from(low)..=f64::from(high)).contains(&found), "{found} outside {a:?}");
    }

    #[test]
    fn coordinates_and_their_derivatives_match_rational_arithmetic(triangle in screen_triangle(), st in corner_st()) {
        let found = weights(&triangle).interpolate_st(st);
        let truth = [0, 1].map(|axis| oracle::interpolate(&triangle, st.map(|c| f64::from(c[axis]))));
        let reach = f64::from(st.iter().fold(0.0f32, |m, c| m.max(c.abs().max_element())));
        for (axis, truth) in truth.iter().enumerate() {
            let error = distance(&exact(found.st[axis]), &truth[0]);
            prop_assert!(error <= exact(libm::ldexp(reach, -49)), "st[{axis}] of {found:?}");
        }
        let gradient = largest(&[&truth[0][1..], &truth[1][1..]].concat());
        for (by, slope) in [(1, found.dst_dx), (2, found.dst_dy)] {
            for (axis, truth) in truth.iter().enumerate() {
                let error = distance(&exact(slope[axis].into()), &truth[by]);
                prop_assert!(error <= exact(DERIVATIVE_BOUND) * &gradient, "axis {axis}, by {by}: {found:?}");
            }
        }
    }

    #[test]
    fn derivatives_agree_with_a_finite_difference(triangle in screen_triangle(), step in 1e-4..1e-3f64) {
        // Independent of the closed form: weights at two points left and right of the middle, in f64.
        let centroid = DVec3::splat(1.0);
        let [dx, _] = oracle::edge_gradients(&triangle).map(|e| DVec3::from_array(e.map(|x| x as f64)));
        let doubled_area = oracle::edges(&triangle).iter().sum::<i64>() as f64;
        let slope = 3.0 * dx / doubled_area;
        let step = step / slope.abs().max_element().max(1e-30);
        let inv_w = DVec3::new(1.0, 0.7, 1.6);
        let at = |offset: f64| perspective_weights(centroid + slope * offset, slope, DVec3::ZERO, inv_w);
        let difference = (at(step).value - at(-step).value) / (2.0 * step);
        let error = (difference - at(0.0).dx).abs().max_element();
        prop_assert!(error <= 1e-5 * slope.abs().max_element(), "{difference} against {}", at(0.0).dx);
    }

    #[test]
    fn both_triangles_along_a_shared_edge_get_the_same_bits(
        ends in [[-4096i64..4096, -4096..4096], [-4096i64..4096, -4096..4096]],
        apexes in [[-9000i64..9000, -9000..9000], [-9000i64..9000, -9000..9000]],
        (steps, k) in (2i64..64).prop_flat_map(|n| (Just(n), 0..=n)),
        w in [w(), w(), w(), w()],
        a in [-1e6..1e6f32, -1e6..1e6f32, -1e6..1e6f32, -1e6..1e6f32],
    ) {
        let [p, q] = ends.map(|end| end.map(|x| x * steps));
        let apexes = apexes.map(|apex| apex.map(|x| x * steps));
        let point = [0, 1].map(|axis| p[axis] + (q[axis] - p[axis]) / steps * k);
        let inv_w = w.map(f64::recip);
        // The second triangle sees the edge from its other side and from another corner.
        let one = ScreenTriangle { corners: [p, q, apexes[0]], point, inv_w: DVec3::new(inv_w[0], inv_w[1], inv_w[2]) };
        let two = ScreenTriangle { corners: [apexes[1], q, p], point, inv_w: DVec3::new(inv_w[3], inv_w[1], inv_w[0]) };
        prop_assume!(oracle::edges(&one).iter().sum::<i64>() != 0 && oracle::edges(&two).iter().sum::<i64>() != 0);
        let oriented = |t: &ScreenTriangle| {
            let e = oracle::edges(t);
            let sign = e.iter().sum::<i64>().signum();
            let edges = DVec3::from_array(e.map(|x| (x * sign) as f64));
            perspective_weights(edges, DVec3::ZERO, DVec3::ZERO, t.inv_w)
        };
        let (one, two) = (oriented(&one), oriented(&two));
        prop_assert_eq!(one.value.x.to_bits(), two.value.z.to_bits());
        prop_assert_eq!(one.value.y.to_bits(), two.value.y.to_bits());
        let values = [one.interpolate([a[0], a[1], a[2]]), two.interpolate([a[3], a[1], a[0]])];
        prop_assert_eq!(values[0].to_bits(), values[1].to_bits());
    }

    #[test]
    fn a_constant_comes_back_exactly(triangle in screen_triangle(), c in any::<f32>().prop_filter("finite", |c| c.is_finite())) {
        let weights = weights(&triangle);
        prop_assert_eq!(weights.interpolate([c; 3]), c);
        let st = weights.interpolate_st([Vec2::splat(c); 3]);
        prop_assert_eq!((st.dst_dx, st.dst_dy), (Vec2::ZERO, Vec2::ZERO));
    }

    #[test]
    fn a_piece_interpolates_as_its_source(triangle in screen_triangle(), f in [[fraction(), fraction()], [fraction(), fraction()], [fraction(), fraction()]], a in [-8.0..8.0f32, -8.0..8.0f32, -8.0..8.0f32]) {
        let corners = f.map(|[x, y]| DVec3::new(x * (1.0 - y), (1.0 - x) * (1.0 - y), y));
        let piece = weights(&triangle);
        let attribute = DVec3::from_array(a.map(f64::from));
        let directly = (0..3).map(|i| piece.value[i] * attribute.dot(corners[i])).sum::<f64>();
        let through_source = f64::from(piece.remapped(corners).interpolate(a));
        prop_assert!((directly - through_source).abs() <= 1e-6, "{directly} against {through_source}");
    }
}

#[test]
fn vectors_are_interpolated_component_by_component() {
    let weights = perspective_weights(
        DVec3::new(2.0, 1.0, 1.0),
        DVec3::ZERO,
        DVec3::ZERO,
        DVec3::ONE,
    );
    assert_eq!(
        weights.interpolate_vec3([Vec3::X * 4.0, Vec3::Y * 4.0, Vec3::Z * 4.0]),
        Vec3::new(2.0, 1.0, 1.0)
    );
    assert_eq!(
        weights.interpolate_vec4([Vec4::X * 4.0, Vec4::Y * 4.0, Vec4::W * 4.0]),
        Vec4::new(2.0, 1.0, 0.0, 1.0)
    );
}

#[test]
fn a_point_without_area_gets_thirds_and_no_derivatives() {
    let nan = DVec3::splat(f64::NAN);
    for (edges, inv_w) in [
        (DVec3::ZERO, DVec3::ONE),
        (DVec3::ONE, DVec3::ZERO),
        (nan, DVec3::ONE),
        (DVec3::ONE, nan),
        (DVec3::splat(f64::INFINITY), DVec3::ONE),
        (DVec3::ONE, DVec3::splat(f64::INFINITY)),
        (-DVec3::ONE, DVec3::ONE),
    ] {
        let weights = perspective_weights(edges, DVec3::ONE, DVec3::ONE, inv_w);
        assert_eq!(weights.value, DVec3::splat(1.0 / 3.0), "{edges} {inv_w}");
        assert_eq!((weights.dx, weights.dy), (DVec3::ZERO, DVec3::ZERO));
    }
}

#[test]
fn an_edge_with_both_ends_at_the_eye_is_divided_evenly() {
    assert_eq!(perspective_parameter(0.25, 0.0, 0.0), 0.25);
    assert!(perspective_parameter(f64::NAN, 1.0, 1.0).is_nan());
}

#[test]
fn a_coordinate_of_a_million_keeps_its_fraction_of_a_texel() {
    let weights = perspective_weights(
        DVec3::new(3.0, 1.0, 0.0),
        DVec3::ZERO,
        DVec3::ZERO,
        DVec3::ONE,
    );
    let st = weights
        .interpolate_st([Vec2::splat(1e6), Vec2::splat(1e6 + 0.0625), Vec2::ZERO])
        .st;
    // A quarter of 1/16, where f32 holds only sixteenths.
    assert!((st.x - (1e6 + 0.015_625)).abs() < 1e-9, "{st}");
}
