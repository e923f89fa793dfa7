//! Patches: the surface against de Casteljau, edges that agree to the bit, normals at poles.

use glam::{DVec3, Vec2, Vec3};
use proptest::prelude::*;
use texcoord::BicubicPatch;

use crate::strategies::bicubic_patch;

/// De Casteljau's construction in f64: repeated halfway points, no polynomial.
fn de_casteljau(p: [DVec3; 4], t: f64) -> DVec3 {
    let mut points = p.to_vec();
    while points.len() > 1 {
        points = points
            .windows(2)
            .map(|pair| pair[0].lerp(pair[1], t))
            .collect();
    }
    points[0]
}

fn by_construction(patch: &BicubicPatch, u: f64, v: f64) -> DVec3 {
    de_casteljau(
        patch
            .control
            .map(|row| de_casteljau(row.map(DVec3::from), u)),
        v,
    )
}

/// The patch read with u and v backwards or exchanged.
fn transposed(patch: &BicubicPatch) -> BicubicPatch {
    BicubicPatch {
        control: core::array::from_fn(|i| core::array::from_fn(|j| patch.control[j][i])),
    }
}

fn reversed(mut patch: BicubicPatch) -> BicubicPatch {
    patch.control.iter_mut().for_each(|row| row.reverse());
    patch
}

proptest! {
    #[test]
    fn points_match_the_construction(patch in bicubic_patch(), u in 0.0..=1.0f32, v in 0.0..=1.0f32) {
        let truth = by_construction(&patch, u.into(), v.into());
        let error = (DVec3::from(patch.point(Vec2::new(u, v))) - truth).abs().max_element();
        prop_assert!(error <= 4.0 * f64::from(f32::EPSILON), "{error:e}");
    }

    #[test]
    fn tangents_match_differences(patch in bicubic_patch(), u in 0.01..0.99f32, v in 0.01..0.99f32) {
        let (du, dv) = patch.tangents(Vec2::new(u, v));
        let (u, v, h) = (f64::from(u), f64::from(v), 1e-4);
        let along_u = (by_construction(&patch, u + h, v) - by_construction(&patch, u - h, v)) / (2.0 * h);
        let along_v = (by_construction(&patch, u, v + h) - by_construction(&patch, u, v - h)) / (2.0 * h);
        prop_assert!((DVec3::from(du) - along_u).length() <= 1e-5, "{du} against {along_u}");
        prop_assert!((DVec3::from(dv) - along_v).length() <= 1e-5, "{dv} against {along_v}");
    }

    #[test]
    fn normals_are_unit_everywhere(patch in bicubic_patch(), collapse in 0u8..6, n in 1u32..9) {
        let mut patch = patch;
        match collapse {
            0 => patch.control[0] = [patch.control[0][0]; 4],
            1 => patch.control[3] = [patch.control[3][3]; 4],
            2 => patch.control.iter_mut().for_each(|row| row[0] = Vec3::ONE),
            3 => patch.control[1] = patch.control[0],
            4 => patch.control = [[Vec3::ONE; 4]; 4],
            _ => {}
        }
        for normal in patch.tessellate(n).normals {
            prop_assert!((normal.length() - 1.0).abs() <= 1e-6, "{normal}");
        }
    }

    #[test]
    fn a_shared_edge_is_the_same_bits_whichever_way_it_is_read(patch in bicubic_patch(), other in bicubic_patch(), n in 1u32..40) {
        // `other` takes over the first row of `patch` as its last column, read backwards.
        let mut other = transposed(&other);
        for (k, row) in other.control.iter_mut().enumerate() {
            row[3] = patch.control[0][3 - k];
        }
        let (grid, neighbour) = (patch.tessellate(n), other.tessellate(n));
        for k in 0..=n as usize {
            let size = n as usize + 1;
            let [here, there] = [grid.positions[k], neighbour.positions[(n as usize - k) * size + n as usize]];
            prop_assert_eq!(here.to_array().map(f32::to_bits), there.to_array().map(f32::to_bits), "step {} of {}", k, n);
        }
    }

    #[test]
    fn reading_a_patch_backwards_turns_it_inside_out(patch in bicubic_patch()) {
        let uv = Vec2::new(0.25, 0.5);
        let back = reversed(patch).normal(Vec2::new(0.75, 0.5));
        prop_assert!((patch.normal(uv) + back).length() <= 1e-5);
    }
}

#[test]
fn the_normal_of_a_flat_patch_is_where_u_cross_v_points() {
    let flat = BicubicPatch {
        control: core::array::from_fn(|i| {
            core::array::from_fn(|j| Vec3::new(j as f32, i as f32, 7.0))
        }),
    };
    assert_eq!(flat.normal(Vec2::new(0.3, 0.8)), Vec3::Z);
    let grid = flat.tessellate(3);
    assert_eq!(grid.uv[5], Vec2::new(1.0 / 3.0, 1.0 / 3.0));
    for corners in &grid.triangles {
        let [a, b, c] = corners.map(|k| grid.positions[k as usize]);
        assert!((b - a).cross(c - a).z > 0.0);
    }
}

#[test]
fn a_pole_takes_the_limit_from_inside() {
    // A cone's tip: the last row is one point, the others half circles of control points.
    let cone = BicubicPatch {
        control: core::array::from_fn(|i| {
            let r = (3 - i) as f32;
            let z = i as f32;
            [[-r, 0.0], [-r, -r], [r, -r], [r, 0.0]].map(|[x, y]| Vec3::new(x, y, z))
        }),
    };
    for u in [0.0, 0.25, 0.5, 1.0] {
        let (du, _) = cone.tangents(Vec2::new(u, 1.0));
        assert_eq!(du, Vec3::ZERO);
        let at_tip = cone.normal(Vec2::new(u, 1.0));
        let below = cone.normal(Vec2::new(u, 0.999));
        assert!(
            (at_tip - below).length() < 1e-3,
            "{at_tip} against {below} at u = {u}"
        );
    }
}

#[test]
#[should_panic(expected = "a patch is divided into 1..=1024 steps, got 0")]
fn no_steps_are_refused() {
    let _ = texcoord::teapot::patches()[0].tessellate(0);
}
