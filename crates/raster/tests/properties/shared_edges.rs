//! Every sample of a mesh has one owner, whatever the mesh, the pattern and the winding.

use glam::{DVec4, IVec2};
use proptest::prelude::*;
use raster::{Cull, Rect, SamplePattern, Triangle, assemble_triangle};

use crate::oracle::count;
use crate::strategies::{
    COUNTS, Mesh, SIDE, any_pattern, clip_at, lattice, pattern, rect, viewport, w, whole,
};

fn triangles(mesh: &Mesh, weights: &[f64]) -> Vec<Triangle> {
    let mut out = Vec::new();
    for (source, corners) in (0u32..).zip(&mesh.triangles) {
        let clip =
            corners.map(|k| clip_at(viewport(), mesh.points[k], 0.5, weights[k % weights.len()]));
        assemble_triangle(source, clip, &viewport(), Cull::None, &mut out);
    }
    out
}

fn once(triangles: &[Triangle], area: Rect, pattern: &SamplePattern) -> Result<(), TestCaseError> {
    let counts = count(triangles, area, pattern);
    for (sample, n) in counts.plain.iter() {
        prop_assert_eq!(n, 1, "owners of sample {:?}", sample);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn a_flat_mesh_owns_every_sample_once(mesh in lattice(SIDE, 500), pattern in any_pattern(), w in [w(), w(), w()]) {
        // 500 units of jitter cannot fold cells of at least 2560 units.
        once(&triangles(&mesh, &w), whole(viewport()), &pattern)?;
    }

    #[test]
    fn a_folded_mesh_owns_every_sample_once_front_minus_back(mesh in lattice(SIDE, 9000), pattern in any_pattern(), w in [w(), w(), w()]) {
        let counts = count(&triangles(&mesh, &w), whole(viewport()), &pattern);
        for (sample, n) in counts.signed.iter() {
            prop_assert_eq!(n, 1, "fronts minus backs at sample {:?}", sample);
        }
    }

    #[test]
    fn a_reversed_mesh_owns_every_sample_once(mesh in lattice(SIDE, 500), pattern in any_pattern()) {
        let mut mesh = mesh;
        mesh.triangles.iter_mut().for_each(|corners| corners.reverse());
        once(&triangles(&mesh, &[1.0]), whole(viewport()), &pattern)?;
    }

    #[test]
    fn a_mesh_of_pixel_sized_triangles_owns_every_sample_once(offset in [-700i32..700, -700i32..700], shear in -40i32..40, pattern in any_pattern()) {
        // 40 × 40 cells of about a third of a pixel around an 8 × 8 area: hundreds of corners inside.
        let n = 30;
        let at = |k: usize| {
            let (column, row) = ((k % (n + 1)) as i32, (k / (n + 1)) as i32);
            IVec2::new(column * 137 + row * shear / 30 + offset[0] - 800, row * 151 + offset[1] - 800)
        };
        let points: Vec<IVec2> = (0..(n + 1) * (n + 1)).map(at).collect();
        let cells = (0..n * n).map(|c| c / n * (n + 1) + c % n);
        let triangles_of = |a: usize| [[a, a + n + 1, a + n + 2], [a, a + n + 2, a + 1]];
        let mesh = Mesh { points, triangles: cells.flat_map(triangles_of).collect() };
        let found = triangles(&mesh, &[1.0]);
        once(&found, rect([3, 3], [8, 8]), &pattern)?;
    }

    #[test]
    fn a_fan_owns_every_sample_once(hub in [0i32..16_384, 0i32..16_384], n in 3usize..1000, pattern in any_pattern()) {
        // Spokes to a square around the target, in order; every triangle meets at the hub.
        let (low, side) = (-2048i32, 20_480i32);
        let rim = |k: usize| {
            let along = (4 * side as usize * k / n) as i32;
            let (edge, step) = (along / side, along % side);
            match edge {
                0 => IVec2::new(low, low + step),
                1 => IVec2::new(low + step, low + side),
                2 => IVec2::new(low + side, low + side - step),
                _ => IVec2::new(low + side - step, low),
            }
        };
        let mut points: Vec<IVec2> = (0..n).map(rim).collect();
        points.push(IVec2::from_array(hub));
        let mut corners = Vec::new();
        for k in 0..n {
            corners.push([n, k, (k + 1) % n]);
        }
        let mesh = Mesh { points, triangles: corners };
        let counts = count(&triangles(&mesh, &[1.0]), whole(viewport()), &pattern);
        if n >= 40 {
            prop_assert!(counts.plain.all(1));
        }
        // With fewer spokes the fan's border cuts the target and may leave the hub outside: fronts and backs then overlap.
        for (sample, found) in counts.signed.iter() {
            prop_assert!((-1..=1).contains(&found), "sample {:?} has {} owners", sample, found);
        }
    }
}

#[test]
fn a_quad_over_the_whole_target_has_no_seam() {
    // The quad of DRTK's issue 9: two triangles from corner to corner, where f32 edges left holes.
    for size in [1u32, 2, 3, 37, 64, 512, 1023] {
        let view = raster::Viewport::new(size, size).expect("allowed");
        let corner = |x: f64, y: f64| DVec4::new(x, y, 0.5, 1.0);
        let [a, b, c, d] = [
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ];
        for halves in [
            [[a, b, c], [a, c, d]],
            [[a, b, d], [b, c, d]],
            [[c, b, a], [d, c, a]],
        ] {
            let mut out = Vec::new();
            for clip in halves {
                assemble_triangle(0, clip, &view, Cull::None, &mut out);
            }
            let counts = count(&out, whole(view), &pattern(1));
            assert!(counts.plain.all(1), "a seam at size {size}");
        }
    }
}

#[test]
fn every_pattern_is_owned_once_on_a_crowded_corner() {
    // Eight triangles meet on a sample of each pattern.
    for n in COUNTS {
        let pattern = pattern(n);
        for &at in pattern.positions() {
            let hub = IVec2::new(16 * 256, 16 * 256) + at;
            let around = [
                (-1, -1),
                (-1, 0),
                (-1, 1),
                (0, 1),
                (1, 1),
                (1, 0),
                (1, -1),
                (0, -1),
            ]
            .map(|(x, y)| hub + IVec2::new(x, y) * 1024);
            let mut points = around.to_vec();
            points.push(hub);
            let mesh = Mesh {
                points,
                triangles: (0..8).map(|k| [8, k, (k + 1) % 8]).collect(),
            };
            let counts = count(
                &triangles(&mesh, &[1.0]),
                rect([14, 14], [18, 18]),
                &pattern,
            );
            assert!(counts.plain.all(1), "{n} samples, hub {hub}");
        }
    }
}
