//! B-splines and NURBS: the basis against its recursion, surfaces against their sums, circles.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use texcoord::surface::{KnotVector, NurbsSurface, SurfaceError};

use super::strategies::{clamped_knots, knots, nurbs_net, revolved, sphere};

/// The recursion of Cox and de Boor as printed, from the definition of degree 0; 0/0 counts as 0.
fn basis(knots: &[f64], i: usize, p: usize, t: f64) -> f64 {
    if p == 0 {
        // The last span that is not empty holds its end.
        let last = knots[knots.len() - 1];
        let closed = t == last && knots[i + 1] == last;
        return f64::from(u8::from(
            knots[i] <= t && (t < knots[i + 1] || closed) && knots[i] < knots[i + 1],
        ));
    }
    let share = |from: f64, to: f64, n: f64| if to == from { 0.0 } else { n / (to - from) };
    share(
        knots[i],
        knots[i + p],
        (t - knots[i]) * basis(knots, i, p - 1, t),
    ) + share(
        knots[i + 1],
        knots[i + p + 1],
        (knots[i + p + 1] - t) * basis(knots, i + 1, p - 1, t),
    )
}

fn by_recursion(knots: &[KnotVector; 2], control: &[DVec3], weights: &[f64], t: [f64; 2]) -> DVec3 {
    let columns = knots[0].control_points();
    let (mut sum, mut weight) = (DVec3::ZERO, 0.0);
    for (k, (&p, &w)) in control.iter().zip(weights).enumerate() {
        let along =
            |axis: usize, i: usize| basis(knots[axis].knots(), i, knots[axis].degree(), t[axis]);
        let b = w * along(0, k % columns) * along(1, k / columns);
        sum += p * b;
        weight += b;
    }
    sum / weight
}

/// A parameter 0..=1 in the domain of the knots.
fn in_domain(knots: &KnotVector, t: f64) -> f64 {
    let [low, high] = knots.domain();
    low + (high - low) * t
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn basis_functions_are_those_of_the_recursion_and_sum_to_one(knots in knots(), t in 0.0..=1.0f64) {
        let t = in_domain(&knots, t);
        let (first, found) = knots.basis(t);
        prop_assert_eq!(found.len(), knots.degree() + 1);
        let ulps = knots.degree() as f64 * f64::EPSILON;
        prop_assert!((found.iter().sum::<f64>() - 1.0).abs() <= ulps, "{found:?}");
        prop_assert!(found.iter().all(|b| (0.0..=1.0 + ulps).contains(b)), "{found:?}");
        for i in 0..knots.control_points() {
            let truth = basis(knots.knots(), i, knots.degree(), t);
            let found = i.checked_sub(first).and_then(|k| found.get(k)).copied().unwrap_or(0.0);
            prop_assert!((found - truth).abs() <= 1e-13, "{i}: {found} for {truth}");
        }
    }

    #[test]
    fn slopes_of_the_basis_are_the_limit_of_differences(knots in knots(), t in 0.001..0.999f64) {
        let t = in_domain(&knots, t);
        let h = 1e-5;
        prop_assume!(knots.knots().iter().all(|knot| (knot - t).abs() > 2.0 * h));
        let (first, found) = knots.basis_derivatives(t);
        let largest = found.iter().fold(1.0f64, |m, b| m.max(b.abs()));
        prop_assert!(found.iter().sum::<f64>().abs() <= 1e-12 * largest);
        let at = |offset: f64| knots.basis(t + offset).1;
        for (k, found) in found.iter().enumerate() {
            let pair = |h: f64| (at(h)[k] - at(-h)[k]) / (2.0 * h);
            let truth = (pair(h) * 4.0 - pair(2.0 * h)) / 3.0;
            prop_assert!((found - truth).abs() <= 1e-5 * largest, "{}: {} for {}", first + k, found, truth);
        }
    }

    #[test]
    fn surfaces_are_their_sums(
        (knots, control, weights) in nurbs_net(knots(), knots()), u in 0.0..=1.0f64, v in 0.0..=1.0f64,
    ) {
        let surface = NurbsSurface::new(knots.clone(), &control, &weights).unwrap();
        let found = surface.at(DVec2::new(u, v));
        let truth = by_recursion(&knots, &control, &weights, [in_domain(&knots[0], u), in_domain(&knots[1], v)]);
        prop_assert!((found.position - truth).abs().max_element() <= 8.0 * 2f64.powi(-50) * 4.0 * 4.0, "{} for {}", found.position, truth);
    }

    #[test]
    fn tangents_are_the_limit_of_differences(
        (knots, control, weights) in nurbs_net(knots(), knots()), u in 0.01..0.99f64, v in 0.01..0.99f64,
    ) {
        let h = 1e-5;
        for (axis, t) in [u, v].into_iter().enumerate() {
            let [low, high] = knots[axis].domain();
            let t = in_domain(&knots[axis], t);
            prop_assume!(knots[axis].knots().iter().all(|knot| (knot - t).abs() > 3.0 * h * (high - low)));
        }
        let truth = |u: f64, v: f64| by_recursion(&knots, &control, &weights, [in_domain(&knots[0], u), in_domain(&knots[1], v)]);
        let slope = |f: &dyn Fn(f64) -> DVec3| {
            let pair = |h: f64| (f(h) - f(-h)) / (2.0 * h);
            (pair(h) * 4.0 - pair(2.0 * h)) / 3.0
        };
        let found = NurbsSurface::new(knots.clone(), &control, &weights).unwrap().at(DVec2::new(u, v));
        let (du, dv) = (slope(&|h| truth(u + h, v)), slope(&|h| truth(u, v + h)));
        let scale = 1.0 + du.length().max(dv.length());
        prop_assert!((found.du - du).length() <= 1e-5 * scale, "{} for {}", found.du, du);
        prop_assert!((found.dv - dv).length() <= 1e-5 * scale, "{} for {}", found.dv, dv);
        prop_assert!((found.normal.length() - 1.0).abs() <= 1e-14 && found.normal.dot(found.tangent).abs() <= 1e-14);
    }

    #[test]
    fn bezier_patches_are_the_surface(
        (knots, control, weights) in nurbs_net(knots(), knots()), s in 0.0..=1.0f64, t in 0.0..=1.0f64,
    ) {
        let surface = NurbsSurface::new(knots.clone(), &control, &weights).unwrap();
        for (patch, [low, high]) in surface.bezier_patches() {
            let local = DVec2::new(s, t);
            let here = surface.at(low + (high - low) * local).position;
            let there = patch.at(local).position;
            // Extraction divides by spans as small as 1/100 of their neighbours.
            prop_assert!((here - there).length() <= 1e-10, "{here} for {there}");
        }
    }

    #[test]
    fn surfaces_that_share_an_edge_share_the_control_points_of_its_pieces(
        (knots_a, control_a, weights_a) in nurbs_net(clamped_knots(), clamped_knots()), across in clamped_knots(), shift in -2.0..2.0f64, backwards in prop::bool::ANY,
    ) {
        // A second surface whose row v = 0 is that of the first, as it is or read backwards with its knots; else its own.
        let columns = knots_a[0].control_points();
        let along = if backwards {
            let reversed = knots_a[0].knots().iter().rev().map(|t| 4.0 - t).collect();
            KnotVector::new(knots_a[0].degree(), reversed).unwrap()
        } else {
            knots_a[0].clone()
        };
        let row = |k: usize| if backwards { columns - 1 - k } else { k };
        let mut control = Vec::new();
        let mut weights = Vec::new();
        for i in 0..across.control_points() {
            for j in 0..columns {
                control.push(control_a[row(j)] + DVec3::Z * shift * i as f64);
                weights.push(weights_a[row(j)] * (1.0 + 0.25 * i as f64));
            }
        }
        let one = NurbsSurface::new(knots_a, &control_a, &weights_a).unwrap();
        let two = NurbsSurface::new([along, across], &control, &weights).unwrap();
        let edge = |surface: &NurbsSurface, columns: usize| -> Vec<[u64; 3]> {
            let pieces = surface.bezier_patches();
            let first_row = pieces.iter().take_while(|(_, [low, _])| low.y == 0.0);
            let points = first_row.flat_map(|(patch, _)| patch.control_points().take(columns).collect::<Vec<_>>());
            points.map(|p| p.to_array().map(|x| (x + 0.0).to_bits())).collect()
        };
        let degree = one.bezier_patches()[0].0.degrees()[0];
        let (here, mut there) = (edge(&one, degree + 1), edge(&two, degree + 1));
        if backwards {
            there.reverse();
        }
        prop_assert_eq!(here, there);
    }
}

fn tube(heights: [f64; 2], radii: [f64; 2]) -> NurbsSurface {
    let profile = [0, 1].map(|k| [radii[k], heights[k], 1.0]);
    revolved(KnotVector::bezier(1).unwrap(), &profile)
}

#[test]
fn a_circle_is_exact() {
    let tube = tube([0.0, 2.0], [1.0, 1.0]);
    for k in 0..=10_000 {
        let at = tube.at(DVec2::new(f64::from(k) / 10_000.0, 0.25));
        let radius = at.position.truncate().length();
        assert!((radius - 1.0).abs() <= 1e-15, "{radius:e} at {k}");
        assert!((at.normal - at.position * DVec3::new(1.0, 1.0, 0.0)).length() <= 1e-14);
        assert!((at.position.z - 0.5).abs() <= 1e-15);
    }
    for (patch, _) in tube.bezier_patches() {
        for k in 0..=1000 {
            let radius = patch
                .at(DVec2::new(f64::from(k) / 1000.0, 0.5))
                .position
                .truncate()
                .length();
            assert!((radius - 1.0).abs() <= 1e-15, "{radius:e} at {k}");
        }
    }
}

#[test]
fn a_sphere_is_exact() {
    let sphere = sphere();
    for i in 0..=100 {
        for j in 0..=100 {
            let at = sphere.at(DVec2::new(f64::from(i) / 100.0, f64::from(j) / 100.0));
            assert!(
                (at.position.length() - 1.0).abs() <= 1e-15,
                "{i} {j}: {}",
                at.position
            );
            assert!(
                (at.normal - at.position).length() <= 1e-8,
                "{i} {j}: {}",
                at.normal
            );
        }
    }
}

#[test]
fn a_cone_has_a_normal_at_its_tip() {
    let cone = tube([0.0, 1.0], [1.0, 0.0]);
    for k in 0..16 {
        let u = f64::from(k) / 16.0 + 0.01;
        let (tip, side) = (cone.at(DVec2::new(u, 1.0)), cone.at(DVec2::new(u, 0.5)));
        assert_eq!(tip.du, DVec3::ZERO);
        assert!(
            (tip.normal - side.normal).length() < 1e-12,
            "{} for {}",
            tip.normal,
            side.normal
        );
        assert!((tip.tangent - side.tangent).length() < 1e-12);
    }
}

#[test]
fn parameters_beyond_the_domain_are_those_of_its_edge() {
    let tube = tube([0.0, 2.0], [1.0, 1.0]);
    let at = |u: f64, v: f64| tube.at(DVec2::new(u, v)).position;
    assert_eq!(at(-3.0, 7.0), at(0.0, 1.0));
    assert_eq!(at(f64::NAN, f64::INFINITY), at(0.0, 1.0));
    assert_eq!(at(0.0, 1.0), DVec3::new(1.0, 0.0, 2.0));
    let knots = KnotVector::bezier(2).unwrap();
    assert_eq!(knots.basis(f64::NAN), knots.basis(0.0));
    assert_eq!(knots.basis(1.0), (0, vec![0.0, 0.0, 1.0]));
}

#[test]
fn knots_without_sense_are_refused_with_their_place() {
    use SurfaceError::{Degree, EmptyDomain, KnotCount, KnotMultiplicity, KnotOrder};
    let refused = |degree, knots: &[f64]| KnotVector::new(degree, knots.to_vec()).unwrap_err();
    assert_eq!(refused(0, &[0.0, 1.0]), Degree { degree: 0 });
    assert_eq!(refused(256, &[0.0; 600]), Degree { degree: 256 });
    assert_eq!(
        KnotVector::bezier(usize::MAX).unwrap_err(),
        Degree { degree: usize::MAX }
    );
    assert_eq!(
        refused(2, &[0.0, 0.0, 0.0, 1.0, 1.0]),
        KnotCount {
            count: 5,
            degree: 2,
            least: 6
        }
    );
    assert_eq!(
        refused(1, &[0.0, 0.0, 2.0, 1.5, 3.0, 3.0]),
        KnotOrder {
            index: 3,
            value: 1.5,
            before: 2.0
        }
    );
    assert!(matches!(
        refused(1, &[0.0, f64::NAN, 1.0, 1.0]),
        KnotOrder { index: 1, .. }
    ));
    assert!(matches!(
        refused(1, &[0.0, 0.0, 1.0, f64::INFINITY]),
        KnotOrder { index: 3, .. }
    ));
    assert_eq!(
        refused(2, &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0]),
        KnotMultiplicity {
            index: 5,
            value: 1.0,
            count: 3,
            most: 2
        }
    );
    assert!(matches!(
        refused(1, &[0.0, 0.0, 0.0, 1.0, 1.0]),
        KnotMultiplicity {
            index: 2,
            most: 2,
            ..
        }
    ));
    assert_eq!(
        refused(2, &[0.0, 0.0, 1.0, 1.0, 2.0, 2.0]),
        EmptyDomain {
            first: 2,
            last: 3,
            value: 1.0
        }
    );
}

#[test]
fn refusals_say_what_where_and_what_to_do() {
    assert_eq!(
        KnotVector::new(1, vec![0.0, 0.0, 2.0, 1.5, 3.0, 3.0])
            .unwrap_err()
            .to_string(),
        "knot 3 is 1.5, after 2; knots must be finite and must not fall"
    );
    let knots = KnotVector::bezier(1).unwrap();
    let three = NurbsSurface::b_spline([knots.clone(), knots], &[DVec3::ZERO; 3]);
    assert!(matches!(
        three,
        Err(SurfaceError::Net {
            count: 3,
            columns: 2,
            rows: 2,
            ..
        })
    ));
}
