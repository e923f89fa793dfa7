//! Surfaces: faults are found and counted, charts partition what is sound, disks are disks.

use std::collections::BTreeSet;

use glam::Vec3;
use proptest::prelude::*;
use texcoord::charts::{ChartError, Disk, FaceFault, Segmentation, Surface, SurfaceReport, Weld};

use super::meshes;

fn surface(mesh: &meshes::Mesh) -> Surface {
    Surface::of(&mesh.0, &mesh.1, Weld::ByPosition).unwrap()
}

/// Vertices − edges + faces, by sets.
fn euler(triangles: &[[u32; 3]]) -> i64 {
    let vertices: BTreeSet<u32> = triangles.iter().flatten().copied().collect();
    let edges: BTreeSet<(u32, u32)> = triangles
        .iter()
        .flat_map(|t| [0, 1, 2].map(|k| (t[k].min(t[(k + 1) % 3]), t[k].max(t[(k + 1) % 3]))))
        .collect();
    vertices.len() as i64 - edges.len() as i64 + triangles.len() as i64
}

/// Faces that hang together by edges run both ways, by repeated sweeps.
fn is_connected(surface_faces: &[u32], triangles: &[[u32; 3]], positions: &[Vec3]) -> bool {
    let directed = |f: u32| {
        let p = triangles[f as usize].map(|v| {
            (positions[v as usize] + Vec3::ZERO)
                .to_array()
                .map(f32::to_bits)
        });
        [(p[0], p[1]), (p[1], p[2]), (p[2], p[0])]
    };
    let mut rest: Vec<u32> = surface_faces[1..].to_vec();
    let mut border: BTreeSet<_> = directed(surface_faces[0]).into();
    loop {
        let before = rest.len();
        rest.retain(|&f| {
            let edges = directed(f);
            let meets = edges.iter().any(|&(a, b)| border.contains(&(b, a)));
            if meets {
                border.extend(edges);
            }
            !meets
        });
        if rest.is_empty() || rest.len() == before {
            return rest.is_empty();
        }
    }
}

#[test]
fn each_fault_is_named_and_counted() {
    let positions = [
        Vec3::ZERO,
        Vec3::X,
        Vec3::Y,
        Vec3::NAN,
        Vec3::X * 2.0,
        Vec3::X,
        Vec3::INFINITY,
    ];
    let triangles = [
        [0, 1, 2],
        [0, 1, 3],
        [0, 1, 4],
        [0, 1, 1],
        [0, 1, 5],
        [1, 2, 0],
        [0, 5, 2],
        [0, 1, 9],
        [0, 2, 6],
    ];
    let surface = surface(&(positions.to_vec(), triangles.to_vec()));
    let faults: Vec<_> = (0..9).map(|f| surface.fault(f)).collect();
    assert_eq!(
        faults,
        [
            None,
            Some(FaceFault::NotFinite),
            Some(FaceFault::NoArea),
            Some(FaceFault::NoArea),
            Some(FaceFault::NoArea),
            Some(FaceFault::DuplicateOf(0)),
            Some(FaceFault::DuplicateOf(0)),
            Some(FaceFault::MissingVertex),
            Some(FaceFault::NotFinite),
        ]
    );
    let expected = SurfaceReport {
        missing_vertex: 1,
        not_finite: 2,
        no_area: 3,
        duplicate: 2,
        ..SurfaceReport::default()
    };
    assert_eq!(*surface.report(), expected);
}

#[test]
fn an_edge_of_three_faces_and_a_turned_neighbour_are_cut() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NEG_Y, Vec3::Z];
    let three = surface(&(positions.to_vec(), vec![[0, 1, 2], [1, 0, 3], [0, 1, 4]]));
    assert_eq!(three.report().non_manifold_edges, 1);
    assert_eq!(Segmentation::of(&three).charts.len(), 3);
    let turned = surface(&(positions.to_vec(), vec![[0, 1, 2], [0, 1, 3]]));
    assert_eq!(turned.report().inconsistent_edges, 1);
    assert_eq!(Segmentation::of(&turned).charts.len(), 2);
}

#[test]
fn welding_by_index_leaves_equal_positions_apart() {
    let positions = [
        Vec3::ZERO,
        Vec3::X,
        Vec3::Y,
        Vec3::X,
        -Vec3::ZERO,
        Vec3::NEG_Y,
    ];
    let triangles = [[0, 1, 2], [3, 4, 5]];
    let charts = |weld| {
        let surface = Surface::of(&positions, &triangles, weld).unwrap();
        Segmentation::of(&surface).charts.len()
    };
    assert_eq!((charts(Weld::ByPosition), charts(Weld::ByIndex)), (1, 2));
}

#[test]
fn a_closed_surface_is_no_disk_and_one_face_less_is() {
    for mesh in [
        meshes::icosphere(2),
        meshes::torus(12, 9, 0.4),
        meshes::genus_five(),
    ] {
        let surface = surface(&mesh);
        let all: Vec<u32> = (0..mesh.1.len() as u32).collect();
        assert!(Disk::of(&surface, &all).is_none());
        let disk = Disk::of(&surface, &all[1..]).unwrap();
        assert_eq!(disk.faces(), &all[1..]);
        assert_eq!(euler(disk.triangles()), 1);
    }
}

#[test]
fn faces_apart_are_no_disk() {
    let surface = surface(&meshes::pieces(2));
    assert!(Disk::of(&surface, &[0, 1]).is_none());
    assert!(Disk::of(&surface, &[]).is_none());
}

#[test]
fn a_tube_is_opened_along_a_short_seam() {
    // A closed cylinder of 40 columns and 6 rows: the seam runs along its height of 1.5.
    let mut mesh = meshes::cylinder(40, 6, std::f64::consts::TAU);
    for row in 0..=6 {
        mesh.0[row * 41 + 40] = mesh.0[row * 41];
    }
    let surface = surface(&mesh);
    let all: Vec<u32> = (0..mesh.1.len() as u32).collect();
    let disk = Disk::of(&surface, &all).unwrap();
    assert_eq!(euler(disk.triangles()), 1);
    assert_eq!(disk.points().len(), 40 * 7 + 7);
}

#[test]
fn no_faces_and_only_faulty_faces_make_no_charts() {
    let empty = surface(&(Vec::new(), Vec::new()));
    assert!(Segmentation::of(&empty).charts.is_empty());
    let faulty = surface(&(vec![Vec3::NAN; 3], vec![[0, 1, 2]]));
    assert!(Segmentation::of(&faulty).charts.is_empty());
}

#[test]
fn errors_say_what_to_do() {
    let error = ChartError::TooManyTriangles {
        count: 2_000_000_000,
    };
    assert!(error.to_string().contains("split the mesh"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn charts_partition_the_sound_faces_and_hang_together(
        mesh in prop_oneof![meshes::soup(), meshes::surface()],
    ) {
        let surface = surface(&mesh);
        let charts = Segmentation::of(&surface).charts;
        let mut all: Vec<u32> = charts.concat();
        all.sort_unstable();
        let sound: Vec<u32> = (0..mesh.1.len() as u32)
            .filter(|&f| surface.fault(f).is_none())
            .collect();
        prop_assert_eq!(all, sound);
        for chart in charts {
            prop_assert!(is_connected(&chart, &mesh.1, &mesh.0));
        }
    }

    #[test]
    fn a_disk_has_every_face_once_and_no_handle(mesh in meshes::surface()) {
        let surface = surface(&mesh);
        for chart in Segmentation::of(&surface).charts {
            if let Some(disk) = Disk::of(&surface, &chart) {
                prop_assert_eq!(disk.faces(), &chart[..]);
                prop_assert_eq!(euler(disk.triangles()), 1);
            }
        }
    }
}
