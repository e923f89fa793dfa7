//! Flat charts: shapes that can be kept are kept, the others neither fold nor overlap.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use texcoord::charts::{
    Disk, FlatChart, FlattenOptions, Surface, Weld, flatten, lscm, make_isometric,
};

use super::meshes;

fn surface(mesh: &meshes::Mesh) -> Surface {
    Surface::of(&mesh.0, &mesh.1, Weld::ByPosition).unwrap()
}

fn whole_disk(mesh: &meshes::Mesh) -> Disk {
    let all: Vec<u32> = (0..mesh.1.len() as u32).collect();
    Disk::of(&surface(mesh), &all).unwrap()
}

fn signed_area(t: &[u32; 3], xy: &[DVec2]) -> f64 {
    let [a, b, c] = t.map(|v| xy[v as usize]);
    0.5 * (b - a).perp_dot(c - a)
}

/// Largest relative difference between an edge's length in the plane and on the surface.
fn worst_edge(disk: &Disk, xy: &[DVec2]) -> f64 {
    let edges = disk
        .triangles()
        .iter()
        .flat_map(|t| [0, 1, 2].map(|k| (t[k], t[(k + 1) % 3])));
    edges.fold(0.0, |worst: f64, (a, b)| {
        let flat = xy[a as usize].distance(xy[b as usize]);
        let there = disk.points()[a as usize].distance(disk.points()[b as usize]);
        worst.max((flat / there - 1.0).abs())
    })
}

/// The plane through the origin spanned by two orthonormal directions.
fn tilted(angle: f64, lean: f64) -> (DVec3, DVec3) {
    let (sa, ca) = libm::sincos(angle);
    let (sl, cl) = libm::sincos(lean);
    (DVec3::new(ca, sa, 0.0), DVec3::new(-sa * cl, ca * cl, sl))
}

/// Charts found to be flat and apart from each other by comparing all pairs of triangles (area of the common part).
fn assert_flat(chart: &FlatChart, limit: f64) {
    for triangle in &chart.triangles {
        assert!(
            signed_area(triangle, &chart.xy) > 0.0,
            "a triangle is folded"
        );
    }
    assert!(chart.triangles.len() == 1 || chart.stretch <= limit);
    let scale = chart.area();
    for (n, one) in chart.triangles.iter().enumerate() {
        for other in &chart.triangles[n + 1..] {
            let common = common_area(
                one.map(|v| chart.xy[v as usize]),
                other.map(|v| chart.xy[v as usize]),
            );
            assert!(
                common <= 1e-9 * scale,
                "{one:?} and {other:?} overlap by {common:e} of {scale:e}"
            );
        }
    }
}

/// Area that two counter-clockwise triangles share: one clipped by the edges of the other (Sutherland & Hodgman 1974).
pub(crate) fn common_area(one: [DVec2; 3], other: [DVec2; 3]) -> f64 {
    let mut polygon = one.to_vec();
    for k in 0..3 {
        let (a, b) = (other[k], other[(k + 1) % 3]);
        let side = |p: DVec2| (b - a).perp_dot(p - a);
        let mut kept = Vec::new();
        for (n, &p) in polygon.iter().enumerate() {
            let q = polygon[(n + 1) % polygon.len()];
            let (sp, sq) = (side(p), side(q));
            if sp >= 0.0 {
                kept.push(p);
            }
            if (sp > 0.0 && sq < 0.0) || (sp < 0.0 && sq > 0.0) {
                kept.push(p + (q - p) * (sp / (sp - sq)));
            }
        }
        polygon = kept;
    }
    let fan = polygon.windows(2).skip(1);
    fan.map(|pair| 0.5 * (pair[0] - polygon[0]).perp_dot(pair[1] - polygon[0]))
        .sum()
}

#[test]
fn a_single_triangle_is_laid_down_as_it_is() {
    let mesh = meshes::pieces(1);
    let charts = flatten(&surface(&mesh), &[0], &FlattenOptions::default());
    assert_eq!(charts.len(), 1);
    assert!((charts[0].area() - 0.5).abs() < 1e-12);
    assert!((charts[0].stretch - 1.0).abs() < 1e-12);
}

#[test]
fn a_closed_surface_is_divided() {
    let mesh = meshes::icosphere(3);
    let all: Vec<u32> = (0..mesh.1.len() as u32).collect();
    let charts = flatten(&surface(&mesh), &all, &FlattenOptions::default());
    assert!(charts.len() >= 2);
    charts.iter().for_each(|chart| assert_flat(chart, 1.02));
}

#[test]
fn more_stretch_allowed_makes_fewer_charts() {
    let mesh = meshes::noisy_grid(24, 24, 0.3, 1.0);
    let all: Vec<u32> = (0..mesh.1.len() as u32).collect();
    let count = |max_stretch| flatten(&surface(&mesh), &all, &FlattenOptions { max_stretch }).len();
    let counts = [1.002, 1.004, 1.02].map(count);
    assert!(counts[0] > counts[1] && counts[1] > counts[2], "{counts:?}");
}

#[test]
fn a_surface_that_conformal_maps_fold_is_flattened_whole() {
    // Spikes several times as high as cells are wide.
    let mesh = meshes::patch(14, 14, |p| {
        let spike = libm::fmod(libm::fabs(libm::sin(p.x * 431.0 + p.y * 977.0)) * 1e4, 1.0);
        DVec3::new(p.x, p.y, 0.6 * spike)
    });
    let disk = whole_disk(&mesh);
    let conformal = lscm(&disk).unwrap();
    assert!(
        disk.triangles()
            .iter()
            .any(|t| signed_area(t, &conformal) <= 0.0)
    );
    let all: Vec<u32> = (0..mesh.1.len() as u32).collect();
    let charts = flatten(&surface(&mesh), &all, &FlattenOptions { max_stretch: 10.0 });
    assert_eq!(charts.len(), 1);
    assert_flat(&charts[0], 10.0);
}

#[test]
fn needles_do_not_stop_the_descent() {
    // A cylinder piece of triangles 1:600.
    let mesh = meshes::cylinder(300, 1, 3.0);
    let disk = whole_disk(&mesh);
    let mut xy = lscm(&disk).unwrap();
    make_isometric(&disk, &mut xy);
    assert!(worst_edge(&disk, &xy) < 1e-4);
}

#[test]
fn a_folded_start_is_left_alone() {
    let disk = whole_disk(&meshes::cylinder(6, 2, 2.0));
    let mirrored: Vec<DVec2> = lscm(&disk)
        .unwrap()
        .iter()
        .map(|p| DVec2::new(-p.x, p.y))
        .collect();
    let mut xy = mirrored.clone();
    make_isometric(&disk, &mut xy);
    assert_eq!(xy, mirrored);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn lscm_gives_a_planar_mesh_back(
        columns in 2u32..16, rows in 2u32..16, angle in 0.0..6.0f64, lean in 0.0..6.0f64, bend in 0.0..0.3f64,
    ) {
        let (x, y) = tilted(angle, lean);
        let mesh = meshes::patch(columns, rows, |p| {
            // Uneven columns, so that triangles differ.
            let u = p.x + bend * p.x * p.y;
            x * u + y * (p.y + bend * libm::sin(5.0 * p.x)) * 0.7
        });
        let disk = whole_disk(&mesh);
        let xy = lscm(&disk).unwrap();
        prop_assert!(worst_edge(&disk, &xy) < 2e-6, "{:e}", worst_edge(&disk, &xy));
        prop_assert!(disk.triangles().iter().all(|t| signed_area(t, &xy) > 0.0));
    }

    #[test]
    fn a_developable_surface_becomes_isometric_from_a_bad_start(
        columns in 3u32..30, rows in 1u32..10, angle in 0.3..6.0f64, sx in 0.3..3.0f64, shear in -1.0..1.0f64,
    ) {
        let disk = whole_disk(&meshes::cylinder(columns, rows, angle));
        let start = lscm(&disk).unwrap();
        let mut xy: Vec<DVec2> = start.iter().map(|p| DVec2::new(sx * p.x + shear * p.y, p.y)).collect();
        make_isometric(&disk, &mut xy);
        prop_assert!(worst_edge(&disk, &xy) < 1e-4, "{:e}", worst_edge(&disk, &xy));
    }

    #[test]
    fn no_chart_folds_overlaps_or_stretches(
        mesh in prop_oneof![meshes::surface(), meshes::soup()], max_stretch in 1.003..1.1f64,
    ) {
        let surface = surface(&mesh);
        let all: Vec<u32> = (0..mesh.1.len() as u32).collect();
        let charts = flatten(&surface, &all, &FlattenOptions { max_stretch });
        let mut faces: Vec<u32> = charts.iter().flat_map(|c| c.faces.clone()).collect();
        faces.sort_unstable();
        let sound: Vec<u32> = all.into_iter().filter(|&f| surface.fault(f).is_none()).collect();
        prop_assert_eq!(faces, sound);
        for chart in &charts {
            assert_flat(chart, max_stretch);
        }
    }
}
