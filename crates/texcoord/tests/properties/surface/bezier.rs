//! Patches: the surface against its polynomial, edges that agree to the bit, normals at poles.

use glam::{DVec2, DVec3, Vec2, Vec3};
use proptest::prelude::*;
use texcoord::surface::{BezierPatch, SurfaceError};

use super::strategies::{BezierNet, bezier_net, bicubic};

/// The net read with u and v exchanged.
fn transposed(net: &BezierNet) -> BezierNet {
    let rows = net.control.len() / net.columns;
    let place = |k: usize| (k % rows) * net.columns + k / rows;
    BezierNet {
        columns: rows,
        control: (0..net.control.len())
            .map(|k| net.control[place(k)])
            .collect(),
        weights: (0..net.control.len())
            .map(|k| net.weights[place(k)])
            .collect(),
    }
}

/// The net read with u backwards.
fn reversed(net: &BezierNet) -> BezierNet {
    let mut net = net.clone();
    net.control.chunks_mut(net.columns).for_each(<[_]>::reverse);
    net.weights.chunks_mut(net.columns).for_each(<[_]>::reverse);
    net
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn points_are_those_of_the_polynomial(net in bezier_net(), u in 0.0..=1.0f64, v in 0.0..=1.0f64) {
        let found = net.patch().at(DVec2::new(u, v)).position;
        let truth = net.by_polynomial(u, v);
        prop_assert!((found - truth).abs().max_element() <= 16.0 * 2f64.powi(-50) * 4.0 * 4.0, "{found} for {truth}");
    }

    #[test]
    fn a_component_that_all_control_points_share_comes_back_exactly(
        net in bezier_net(), z in -4.0..4.0f64, u in 0.0..=1.0f64, v in 0.0..=1.0f64,
    ) {
        let mut net = net;
        net.control.iter_mut().for_each(|p| p.z = z);
        net.weights.fill(1.0);
        let at = net.patch().at(DVec2::new(u, v));
        prop_assert_eq!((at.position.z, at.du.z, at.dv.z), (z, 0.0, 0.0));
    }

    #[test]
    fn tangents_are_the_limit_of_differences(net in bezier_net(), u in 0.01..0.99f64, v in 0.01..0.99f64) {
        let at = net.patch().at(DVec2::new(u, v));
        let slope = |f: &dyn Fn(f64) -> DVec3| {
            let pair = |h: f64| (f(h) - f(-h)) / (2.0 * h);
            (pair(5e-4) * 4.0 - pair(1e-3)) / 3.0
        };
        let du = slope(&|h| net.by_polynomial(u + h, v));
        let dv = slope(&|h| net.by_polynomial(u, v + h));
        prop_assert!((at.du - du).length() <= 1e-5 * (1.0 + du.length()), "{} for {}", at.du, du);
        prop_assert!((at.dv - dv).length() <= 1e-5 * (1.0 + dv.length()), "{} for {}", at.dv, dv);
        if at.du.cross(at.dv).length() > 1e-3 * at.du.length() * at.dv.length() {
            prop_assert!((at.normal - at.du.cross(at.dv).normalize()).length() <= 1e-9);
            prop_assert!(at.normal.cross(at.tangent).dot(at.dv) > 0.0);
            prop_assert!(at.tangent.dot(at.du) > 0.0);
        }
    }

    #[test]
    fn frames_are_orthonormal_everywhere(control in bicubic(), collapse in 0u8..6, n in 1u32..9) {
        let mut control = control;
        match collapse {
            0 => control[0] = [control[0][0]; 4],
            1 => control[3] = [control[3][3]; 4],
            2 => control.iter_mut().for_each(|row| row[0] = Vec3::ONE),
            3 => control[1] = control[0],
            4 => control = [[Vec3::ONE; 4]; 4],
            _ => {}
        }
        let grid = BezierPatch::bicubic(control).grid(n);
        for (normal, tangent) in grid.normals.iter().zip(&grid.tangents) {
            prop_assert!((normal.length() - 1.0).abs() <= 1e-6, "{normal}");
            prop_assert!((tangent.length() - 1.0).abs() <= 1e-6, "{tangent}");
            prop_assert!(normal.dot(*tangent).abs() <= 1e-6, "{normal} and {tangent}");
        }
    }

    #[test]
    fn a_shared_edge_is_the_same_bits_whichever_way_it_is_read(
        net in bezier_net(), other in bezier_net(), n in 1u32..40,
    ) {
        // A patch whose last column is the first row of `net`, read backwards; its other columns are its own.
        let rows = net.columns;
        let own = other.control.iter().cycle().zip(other.weights.iter().cycle());
        let mut own = own.map(|(p, w)| (*p, *w));
        let columns = 3;
        let mut neighbour = BezierNet { columns, control: vec![], weights: vec![] };
        for row in 0..rows {
            let edge = (net.control[rows - 1 - row], net.weights[rows - 1 - row]);
            for (p, w) in [own.next().unwrap(), own.next().unwrap(), edge] {
                neighbour.control.push(p);
                neighbour.weights.push(w);
            }
        }
        let (grid, neighbour) = (net.patch().grid(n), neighbour.patch().grid(n));
        for k in 0..=n as usize {
            let size = n as usize + 1;
            let [here, there] = [grid.positions[k], neighbour.positions[(n as usize - k) * size + n as usize]];
            prop_assert_eq!(here.to_array().map(f32::to_bits), there.to_array().map(f32::to_bits), "step {} of {}", k, n);
        }
    }

    #[test]
    fn exchanging_or_reversing_the_parameters_turns_a_patch_inside_out(net in bezier_net()) {
        let here = net.patch().at(DVec2::new(0.25, 0.5));
        prop_assume!(here.du.cross(here.dv).length() > 1e-3 * here.du.length() * here.dv.length());
        for back in [
            reversed(&net).patch().at(DVec2::new(0.75, 0.5)),
            transposed(&net).patch().at(DVec2::new(0.5, 0.25)),
        ] {
            prop_assert!((here.position - back.position).length() <= 1e-13);
            prop_assert!((here.normal + back.normal).length() <= 1e-9);
        }
    }
}

#[test]
fn the_normal_of_a_flat_patch_is_where_u_cross_v_points() {
    let flat = BezierPatch::bicubic(core::array::from_fn(|i| {
        core::array::from_fn(|j| Vec3::new(j as f32, i as f32, 7.0))
    }));
    let at = flat.at(DVec2::new(0.3, 0.8));
    assert_eq!((at.normal, at.position.z), (DVec3::Z, 7.0));
    assert!((at.tangent - DVec3::X).length() < 1e-15);
    let grid = flat.grid(3);
    assert_eq!(grid.uv[5], Vec2::new(1.0 / 3.0, 1.0 / 3.0));
    for corners in &grid.triangles {
        let [a, b, c] = corners.map(|k| grid.positions[k as usize]);
        assert!((b - a).cross(c - a).z > 0.0);
    }
}

#[test]
fn a_pole_takes_the_limit_from_inside() {
    // A cone's tip: the last row is one point, the others half circles of control points.
    let cone = BezierPatch::bicubic(core::array::from_fn(|i| {
        let r = (3 - i) as f32;
        let z = i as f32;
        [[-r, 0.0], [-r, -r], [r, -r], [r, 0.0]].map(|[x, y]| Vec3::new(x, y, z))
    }));
    for u in [0.0, 0.25, 0.5, 1.0] {
        let at_tip = cone.at(DVec2::new(u, 1.0));
        assert_eq!((at_tip.du, at_tip.position), (DVec3::ZERO, DVec3::Z * 3.0));
        let below = cone.at(DVec2::new(u, 0.999));
        for (limit, near) in [
            (at_tip.normal, below.normal),
            (at_tip.tangent, below.tangent),
        ] {
            assert!(
                (limit - near).length() < 1e-3,
                "{limit} against {near} at u = {u}"
            );
        }
    }
}

#[test]
#[should_panic(expected = "a patch is divided into 1..=1024 steps, got 0")]
fn no_steps_are_refused() {
    let _ = texcoord::teapot::patches()[0].grid(0);
}

#[test]
fn nets_that_are_no_patch_are_refused() {
    let flat: Vec<DVec3> = (0..6)
        .map(|k| DVec3::new(f64::from(k % 3), f64::from(k / 3), 0.0))
        .collect();
    let refused = |columns, control: &[DVec3], weights: &[f64]| {
        BezierPatch::rational(columns, control.to_vec(), weights.to_vec()).unwrap_err()
    };
    assert_eq!(BezierPatch::new(3, flat.clone()).unwrap().degrees(), [2, 1]);
    for (columns, direction, count) in [(0, 'u', 0), (1, 'u', 1), (6, 'v', 1), (usize::MAX, 'v', 0)]
    {
        let found = refused(columns, &flat, &[1.0; 6]);
        assert_eq!(
            found,
            SurfaceError::TooFewPoints {
                direction,
                count,
                least: 2
            }
        );
    }
    assert!(matches!(
        refused(3, &[flat.clone(), vec![DVec3::ONE]].concat(), &[1.0; 7]),
        SurfaceError::Net {
            what: "control points",
            ..
        }
    ));
    assert!(matches!(
        refused(3, &flat, &[1.0; 5]),
        SurfaceError::Net {
            what: "weights",
            count: 5,
            ..
        }
    ));
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let found = refused(3, &flat, &[1.0, 1.0, 1.0, 1.0, bad, 1.0]);
        assert!(
            matches!(found, SurfaceError::Weight { index: 4, .. }),
            "{found}"
        );
    }
    let mut torn = flat;
    torn[2].y = f64::NAN;
    assert_eq!(
        refused(3, &torn, &[1.0; 6]).to_string(),
        "control point 2 is not finite"
    );
}

#[test]
fn parameters_that_are_no_number_pass_through() {
    let patch = &texcoord::teapot::patches()[0];
    let at = patch.at(DVec2::NAN);
    assert!(at.position.is_nan());
}
