//! Tessellation: no cracks, and within its tolerance.

use std::collections::HashMap;

use glam::{DVec2, DVec3, Vec3};
use proptest::prelude::*;
use texcoord::surface::{
    BezierPatch, KnotVector, NurbsSurface, SurfaceError, SurfaceMesh, tessellate,
};
use texcoord::teapot;

use super::strategies::{BezierNet, bezier_net, sphere};

fn bits(p: Vec3) -> [u32; 3] {
    p.to_array().map(f32::to_bits)
}

/// The parametric triangle's corners as points of the (u,v) plane and of space.
fn corners(mesh: &SurfaceMesh, triangle: [u32; 3]) -> [(DVec2, DVec3); 3] {
    triangle.map(|k| {
        (
            mesh.uv[k as usize].as_dvec2(),
            mesh.positions[k as usize].as_dvec3(),
        )
    })
}

/// Triangles of random patches: where they would need more steps than there are, at twice the tolerance; and what it
/// came to.
fn tessellated(
    patches: &[BezierPatch],
    mut tolerance: f64,
    scale: impl Fn(DVec3) -> f64,
) -> (Vec<SurfaceMesh>, f64) {
    loop {
        match tessellate(patches, tolerance, &scale) {
            Err(SurfaceError::TooFine { .. }) => tolerance *= 2.0,
            meshes => return (meshes.unwrap(), tolerance),
        }
    }
}

/// The largest distance of the surface from its triangles, by a dense net of points in each.
fn largest_error(surface: &impl Fn(DVec2) -> DVec3, mesh: &SurfaceMesh) -> f64 {
    let n = 6;
    let mut largest: f64 = 0.0;
    for &triangle in &mesh.triangles {
        let [a, b, c] = corners(mesh, triangle);
        for i in 0..=n {
            for j in 0..=n - i {
                let [s, t] = [i, j].map(|k| f64::from(k) / f64::from(n));
                let uv = a.0 + (b.0 - a.0) * s + (c.0 - a.0) * t;
                let flat = a.1 + (b.1 - a.1) * s + (c.1 - a.1) * t;
                largest = largest.max(surface(uv).distance(flat));
            }
        }
    }
    largest
}

/// Each directed edge with its number of uses, vertices welded by their bits.
fn directed_edges<'a>(
    meshes: impl IntoIterator<Item = &'a SurfaceMesh>,
) -> HashMap<[[u32; 3]; 2], u32> {
    let mut uses = HashMap::new();
    for mesh in meshes {
        for triangle in &mesh.triangles {
            let at = triangle.map(|k| bits(mesh.positions[k as usize]));
            for k in 0..3 {
                *uses.entry([at[k], at[(k + 1) % 3]]).or_insert(0) += 1;
            }
        }
    }
    uses
}

/// Edges with one triangle; all others must have exactly two, one from each side.
fn boundary<'a>(meshes: impl IntoIterator<Item = &'a SurfaceMesh>) -> Vec<[[u32; 3]; 2]> {
    let uses = directed_edges(meshes);
    for (edge, n) in &uses {
        assert_eq!(*n, 1, "{edge:?} is used {n} times in one direction");
    }
    uses.keys()
        .filter(|[a, b]| !uses.contains_key(&[*b, *a]))
        .copied()
        .collect()
}

/// Rounding of positions and of the triangles' own (u,v) to f32.
fn rounding(patch: &BezierPatch) -> f64 {
    let reach = patch
        .control_points()
        .fold(1.0, |m: f64, p| m.max(p.abs().max_element()));
    let [p, q] = patch.degrees();
    reach * (2.0 + 2.0 * (p + q) as f64) * f64::from(f32::EPSILON)
}

#[test]
fn the_teapot_is_watertight_but_for_its_known_gaps() {
    for tolerance in [0.3, 0.1, 0.03, 0.01, 0.003, 0.001] {
        let meshes = tessellate(&teapot::patches(), tolerance, |_| 1.0).unwrap();
        for edge in boundary(&meshes) {
            let [x, y, z] = edge[0].map(f32::from_bits);
            let radius = x.hypot(y);
            let lid_or_rim = z == 2.4 && (1.25..1.45).contains(&radius);
            let spout = x == 1.7 || ((2.79..=3.21).contains(&x) && z == 2.4);
            let handle = (-1.61..=-1.49).contains(&x) || (-2.01..=-1.89).contains(&x);
            assert!(
                lid_or_rim || spout || handle,
                "open at ({x}, {y}, {z}) for {tolerance}"
            );
        }
    }
}

#[test]
fn the_vessel_closes_where_its_parts_meet() {
    // Body and bottom, patches 12..24: the only open edge is the top of the body.
    let meshes = tessellate(&teapot::patches()[12..24], 0.01, |_| 1.0).unwrap();
    let open = boundary(&meshes);
    assert!(open.len() >= 16);
    for edge in open {
        assert_eq!(edge.map(|end| f32::from_bits(end[2])), [2.4, 2.4]);
    }
}

#[test]
fn the_teapot_is_within_its_tolerance() {
    for tolerance in [0.3, 0.03, 0.003] {
        let patches = teapot::patches();
        let meshes = tessellate(&patches, tolerance, |_| 1.0).unwrap();
        for (patch, mesh) in patches.iter().zip(&meshes) {
            let found = largest_error(&|uv| patch.at(uv).position, mesh);
            assert!(
                found <= tolerance + rounding(patch),
                "{found} for {tolerance}"
            );
        }
    }
}

#[test]
fn a_smaller_tolerance_costs_in_proportion() {
    // The error falls with the square of the step: triangles grow as 1/tolerance, not faster.
    let count = |tolerance: f64| {
        let meshes = tessellate(&teapot::patches(), tolerance, |_| 1.0).unwrap();
        meshes
            .iter()
            .map(|mesh| mesh.triangles.len())
            .sum::<usize>() as f64
    };
    let (coarse, fine) = (count(0.01), count(0.0001));
    assert!(
        (50.0..150.0).contains(&(fine / coarse)),
        "{coarse} and {fine}"
    );
}

#[test]
fn poles_keep_their_texture_coordinate_to_each_triangle() {
    let patches = teapot::patches();
    let mesh = &tessellate(&patches[..1], 0.01, |_| 1.0).unwrap()[0];
    let pole = bits(Vec3::new(0.0, 0.0, 3.15));
    let mut fans = 0;
    for triangle in &mesh.triangles {
        let at_pole = triangle
            .iter()
            .find(|&&k| bits(mesh.positions[k as usize]) == pole);
        if let Some(&k) = at_pole {
            let us = triangle.map(|k| mesh.uv[k as usize].x);
            let (low, high) = us
                .iter()
                .fold((1.0f32, 0.0f32), |(l, h), &u| (l.min(u), h.max(u)));
            assert!(high - low < 0.5, "a triangle at the pole spans {us:?}");
            assert!((mesh.normals[k as usize] - Vec3::Z).length() < 1e-5);
            fans += 1;
        }
    }
    assert!(fans >= 3, "{fans} triangles at the pole");
}

#[test]
fn flat_patches_are_two_triangles() {
    let square = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::ONE.with_z(0.0)].to_vec();
    let patch = BezierPatch::new(2, square).unwrap();
    let mesh = &tessellate(&[patch], 1e-9, |_| 1.0).unwrap()[0];
    assert_eq!((mesh.triangles.len(), mesh.positions.len()), (2, 4));
    assert_eq!(mesh.normals, [Vec3::Z; 4]);
    assert_eq!(mesh.tangents, [Vec3::X; 4]);
}

#[test]
fn a_bulge_between_straight_edges_is_still_divided() {
    // Straight edges of one step each; the middle stands 4 high.
    let mut control = Vec::new();
    for i in 0..3 {
        for j in 0..3 {
            let z = if (i, j) == (1, 1) { 16.0 } else { 0.0 };
            control.push(DVec3::new(f64::from(j), f64::from(i), z));
        }
    }
    let patch = BezierPatch::new(3, control).unwrap();
    for tolerance in [1.0, 0.1, 0.01] {
        let mesh = &tessellate(core::slice::from_ref(&patch), tolerance, |_| 1.0).unwrap()[0];
        assert_eq!(boundary([mesh]).len(), 4);
        let found = largest_error(&|uv| patch.at(uv).position, mesh);
        assert!(
            found <= tolerance + rounding(&patch),
            "{found} for {tolerance}"
        );
    }
}

#[test]
fn tolerances_and_scales_without_sense_are_refused() {
    let patches = teapot::patches();
    for bad in [0.0, -1.0, f64::NAN] {
        assert!(
            matches!(
                tessellate(&patches, bad, |_| 1.0),
                Err(SurfaceError::Tolerance { .. })
            ),
            "{bad}"
        );
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(
            matches!(
                tessellate(&patches, 0.1, |_| bad),
                Err(SurfaceError::Scale { .. })
            ),
            "{bad}"
        );
    }
    assert!(matches!(
        tessellate(&patches, 1e-12, |_| 1.0),
        Err(SurfaceError::TooFine { .. })
    ));
    assert!(matches!(
        tessellate(&patches, 5e-324, |_| 1e300),
        Err(SurfaceError::TooFine { .. })
    ));
    // Out of sight, and any error allowed.
    for (tolerance, scale) in [(0.1, 0.0), (f64::INFINITY, 1.0)] {
        let meshes = tessellate(&patches, tolerance, |_| scale).unwrap();
        assert!(meshes.iter().all(|mesh| mesh.triangles.len() <= 8));
        assert!(meshes.iter().any(|mesh| !mesh.triangles.is_empty()));
    }
}

#[test]
fn patches_without_area_make_no_triangles() {
    let point = BezierPatch::bicubic([[Vec3::ONE; 4]; 4]);
    let mesh = &tessellate(&[point], 0.1, |_| 1.0).unwrap()[0];
    assert!(mesh.triangles.is_empty());
}

#[test]
fn a_nurbs_surface_is_tessellated_as_one() {
    // A wave of three by four spans.
    let [u, v] = [7, 8].map(|spans| {
        let inside = (1..spans - 3).map(f64::from);
        let knots = [0.0; 4]
            .into_iter()
            .chain(inside)
            .chain([f64::from(spans - 3); 4]);
        KnotVector::new(3, knots.collect()).unwrap()
    });
    let (columns, rows) = (u.control_points(), v.control_points());
    let mut control = Vec::new();
    let mut weights = Vec::new();
    for i in 0..rows {
        for j in 0..columns {
            let z = ((i * 7 + j * 5) % 4) as f64 * 0.5;
            control.push(DVec3::new(j as f64, i as f64, z));
            weights.push(1.0 + ((i + j) % 3) as f64 * 0.5);
        }
    }
    let surface = NurbsSurface::new([u, v], &control, &weights).unwrap();
    for tolerance in [0.1, 0.01] {
        let meshes = surface.tessellate(tolerance, |_| 1.0).unwrap();
        for edge in boundary(&meshes) {
            for end in edge {
                let [x, y, _] = end.map(f32::from_bits);
                let outside =
                    x == 0.0 || y == 0.0 || x == (columns - 1) as f32 || y == (rows - 1) as f32;
                assert!(outside, "open at ({x}, {y}) for {tolerance}");
            }
        }
        for mesh in &meshes {
            let found = largest_error(&|uv| surface.at(uv).position, mesh);
            assert!(found <= tolerance + 1e-5, "{found} for {tolerance}");
        }
    }
}

#[test]
fn a_sphere_of_nurbs_is_closed_and_within_its_tolerance() {
    let sphere = sphere();
    for tolerance in [0.3, 0.1, 0.01, 0.001] {
        let meshes = sphere.tessellate(tolerance, |_| 1.0).unwrap();
        assert_eq!(
            boundary(&meshes),
            Vec::<[[u32; 3]; 2]>::new(),
            "{tolerance}"
        );
        for mesh in &meshes {
            let found = largest_error(&|uv| sphere.at(uv).position, mesh);
            assert!(found <= tolerance + 1e-6, "{found} for {tolerance}");
            for (normal, position) in mesh.normals.iter().zip(&mesh.positions) {
                assert!(
                    (*normal - *position).length() < 1e-6,
                    "{normal} at {position}"
                );
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_patch_is_within_its_tolerance_and_whole(net in bezier_net(), exponent in 0..4i32) {
        let patch = net.patch();
        let tolerance = libm::ldexp(1.0, -exponent);
        let (meshes, tolerance) = tessellated(core::slice::from_ref(&patch), tolerance, |_| 1.0);
        let mesh = &meshes[0];
        let found = largest_error(&|uv| patch.at(uv).position, mesh);
        prop_assert!(found <= tolerance + rounding(&patch), "{} for {}", found, tolerance);
        // Inside no edge is open: its border is one loop through the four corners.
        let open = boundary([mesh]);
        let on_border = |k: u32| {
            let uv = mesh.uv[k as usize];
            uv.x == 0.0 || uv.x == 1.0 || uv.y == 0.0 || uv.y == 1.0
        };
        let border: std::collections::HashSet<_> = (0..mesh.positions.len() as u32)
            .filter(|&k| on_border(k))
            .map(|k| bits(mesh.positions[k as usize]))
            .collect();
        prop_assert_eq!(open.len(), border.len());
        prop_assert!(open.iter().flatten().all(|end| border.contains(end)));
    }

    #[test]
    fn neighbours_share_their_edge_at_any_tolerance_and_scale(
        net in bezier_net(), other in bezier_net(), exponent in 0..7i32, seen in 0.1..2.0f64,
    ) {
        // The neighbour's last column is the first row of `net`, read backwards.
        let rows = net.columns;
        let mut own = other.control.iter().cycle().zip(other.weights.iter().cycle());
        let mut neighbour = BezierNet { columns: 4, control: vec![], weights: vec![] };
        for row in (0..rows).rev() {
            for _ in 0..3 {
                let (p, w) = own.next().unwrap();
                neighbour.control.push(*p);
                neighbour.weights.push(*w);
            }
            neighbour.control.push(net.control[row]);
            neighbour.weights.push(net.weights[row]);
        }
        let tolerance = libm::ldexp(1.0, -exponent);
        let eye = DVec3::new(9.0, -8.0, 7.0);
        let patches = [net.patch(), neighbour.patch()];
        let (meshes, _) = tessellated(&patches, tolerance, |p| seen * 10.0 / p.distance(eye));
        let along = |mesh: &SurfaceMesh, on_edge: &dyn Fn(DVec2) -> Option<f64>| -> Vec<[u32; 3]> {
            let mut found: Vec<_> = (0..mesh.positions.len())
                .filter_map(|k| Some((on_edge(mesh.uv[k].as_dvec2())?, bits(mesh.positions[k]))))
                .collect();
            found.sort_by(|a, b| a.0.total_cmp(&b.0));
            found.dedup();
            found.into_iter().map(|(_, position)| position).collect()
        };
        let here = along(&meshes[0], &|uv| (uv.y == 0.0).then_some(uv.x));
        let there = along(&meshes[1], &|uv| (uv.x == 1.0).then_some(1.0 - uv.y));
        prop_assert_eq!(here, there);
    }
}
