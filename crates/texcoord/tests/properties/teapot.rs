//! The teapot against what is known of it.

use std::collections::HashMap;

use glam::{DVec2, DVec3, Vec2, Vec3};
use texcoord::surface::BezierPatch;
use texcoord::teapot;

const STEPS: u32 = 16;

/// Positions of a point as bits, −0 and 0 told apart.
fn bits(p: Vec3) -> [u32; 3] {
    p.to_array().map(f32::to_bits)
}

fn bounds(patches: &[BezierPatch]) -> (Vec3, Vec3) {
    let points = patches.iter().flat_map(|p| p.grid(64).positions);
    points.fold((Vec3::MAX, Vec3::MIN), |(low, high), p| {
        (low.min(p), high.max(p))
    })
}

#[test]
fn its_bounding_box_is_the_published_one() {
    let (low, high) = bounds(&teapot::patches());
    // The spout's lip reaches 3.434; handle, body, bottom and knob touch their control points.
    assert!((low - Vec3::new(-3.0, -2.0, 0.0)).length() < 1e-6, "{low}");
    assert!(
        (high - Vec3::new(3.434, 2.0, 3.15)).length() < 1e-3,
        "{high}"
    );
}

#[test]
fn its_control_points_are_the_published_ones() {
    let patches = teapot::patches();
    let count = |p: Vec3| {
        patches
            .iter()
            .flat_map(|patch| patch.control_points())
            .filter(|q| q.as_vec3() == p)
            .count()
    };
    // Points as printed in the list of 306, each where two patches meet and share it, or inside one.
    for (point, uses) in [
        (Vec3::new(1.4, 0.0, 2.4), 2),
        (Vec3::new(0.784, -1.4, 2.4), 1),
        (Vec3::new(-0.749, 1.3375, 2.53125), 1),
        (Vec3::new(0.45, -0.8, 3.15), 1),
        (Vec3::new(-1.425, 0.798, 0.0), 1),
        (Vec3::new(3.525, 0.0, 2.49375), 2),
        (Vec3::new(-2.7, -0.3, 1.575), 1),
        (Vec3::new(0.0, 0.0, 3.15), 16),
        (Vec3::new(0.0, 0.0, 0.0), 16),
    ] {
        assert_eq!(count(point), uses, "{point}");
    }
    let mut distinct: Vec<_> = patches
        .iter()
        .flat_map(|patch| patch.control_points())
        .map(|p| bits(p.as_vec3()))
        .collect();
    distinct.sort_unstable();
    distinct.dedup();
    // 306 entries in the published list: some are repeated there, for parts that only touch.
    assert_eq!(distinct.len(), 290);
}

/// How often each segment of the tessellation occurs, in either direction; collapsed ones are left out.
fn segment_counts(patches: &[BezierPatch]) -> HashMap<[[u32; 3]; 2], u32> {
    let mut counts = HashMap::new();
    for grid in patches.iter().map(|p| p.grid(STEPS)) {
        for corners in &grid.triangles {
            let at = corners.map(|k| bits(grid.positions[k as usize]));
            if at[0] == at[1] || at[1] == at[2] || at[2] == at[0] {
                continue;
            }
            for i in 0..3 {
                let mut ends = [at[i], at[(i + 1) % 3]];
                ends.sort_unstable();
                *counts.entry(ends).or_insert(0) += 1;
            }
        }
    }
    counts
}

#[test]
fn it_is_closed_but_for_its_known_gaps() {
    let counts = segment_counts(&teapot::patches());
    assert!(
        counts.values().all(|&n| n <= 2),
        "more than two triangles at a segment"
    );
    let open: Vec<_> = counts
        .iter()
        .filter(|&(_, &n)| n == 1)
        .map(|(ends, _)| ends)
        .collect();
    // Open: the lid's edge and the rim's inner edge (4 patches each), both ends of handle and spout (2 each).
    assert_eq!(open.len() as u32, (4 + 4 + 4 + 4) * STEPS);
    for ends in open {
        let [x, y, z] = ends[0].map(f32::from_bits);
        let radius = Vec2::new(x, y).length();
        let lid_or_rim = z == 2.4 && (1.29..1.45).contains(&radius);
        let spout = x == 1.7 || ((2.79..=3.21).contains(&x) && z == 2.4);
        let handle = (-1.61..=-1.49).contains(&x) || (-2.01..=-1.89).contains(&x);
        assert!(lid_or_rim || spout || handle, "open at ({x}, {y}, {z})");
    }
}

#[test]
fn its_normals_point_away_from_the_axis_on_the_body() {
    // Patches 12..20 are the body.
    for grid in teapot::patches()[12..20].iter().map(|p| p.grid(STEPS)) {
        for (p, n) in grid.positions.iter().zip(&grid.normals) {
            assert!(p.x * n.x + p.y * n.y > 0.0, "normal {n} at {p}");
        }
    }
}

#[test]
fn its_handle_and_spout_face_outward() {
    for (grid, mid_z) in teapot::patches()[24..]
        .iter()
        .map(|p| (p.grid(2), p.at(DVec2::splat(0.5)).position.y))
    {
        // The middle of a half tube is its farthest point from the plane y = 0.
        let normal = grid.normals[4];
        assert!(
            f64::from(normal.y) * mid_z > 0.0,
            "{normal} on the side of y = {mid_z}"
        );
    }
}

#[test]
fn its_poles_have_the_axis_for_normal() {
    let patches = teapot::patches();
    for u in [0.0, 0.1, 0.5, 0.9, 1.0] {
        for quarter in 0..4 {
            let knob = patches[quarter].at(DVec2::new(u, 1.0)).normal;
            let bottom = patches[20 + quarter].at(DVec2::new(u, 0.0)).normal;
            assert!((knob - DVec3::Z).length() < 1e-6, "knob {knob}");
            assert!((bottom + DVec3::Z).length() < 1e-6, "bottom {bottom}");
        }
    }
}

#[test]
fn its_winding_agrees_with_its_normals() {
    for grid in teapot::patches().iter().map(|p| p.grid(STEPS)) {
        for corners in &grid.triangles {
            let [a, b, c] = corners.map(|k| grid.positions[k as usize]);
            let cross = (b - a).cross(c - a);
            let normal = corners
                .iter()
                .map(|&k| grid.normals[k as usize])
                .sum::<Vec3>();
            assert!(
                cross.length() < 1e-6 || cross.dot(normal) > 0.0,
                "{a} {b} {c}"
            );
        }
    }
}
