//! The whole way: whatever the mesh, coordinates are there, in range, unfolded, apart, and the same again.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::{Vec2, Vec3};
use proptest::prelude::*;
use texcoord::charts::{
    Atlas, AtlasSize, ChartError, Density, Distortion, Effort, PackOptions, Progress, Segmentation,
    Surface, UnwrapOptions, Weld, flatten, in_order, unwrap,
};

use super::meshes;
use super::touched::{assert_apart, owners};

fn unwrapped(mesh: &meshes::Mesh, options: &UnwrapOptions) -> Atlas {
    unwrap(&mesh.0, &mesh.1, options, &in_order, &|_| {}).unwrap()
}

fn figures(mesh: &meshes::Mesh, atlas: &Atlas) -> Distortion {
    let surface = Surface::of(&mesh.0, &mesh.1, Weld::ByPosition).unwrap();
    let image = |chart: &Option<u32>| chart.map_or(0, |c| atlas.images[c as usize]);
    let images: Vec<u32> = atlas.charts.iter().map(image).collect();
    Distortion::of(&surface, &atlas.corner_st(), &images)
}

/// What holds for every mesh.
fn assert_sound(mesh: &meshes::Mesh, atlas: &Atlas, gap: u32) {
    assert_eq!(
        (atlas.triangles.len(), atlas.charts.len()),
        (mesh.1.len(), mesh.1.len())
    );
    let st = atlas.corner_st();
    for p in st.as_flattened() {
        assert!(
            p.is_finite() && p.cmpge(Vec2::ZERO).all() && p.cmple(Vec2::ONE).all(),
            "{p}"
        );
    }
    for (new, old) in atlas.triangles.iter().zip(&mesh.1) {
        assert_eq!(new.map(|v| atlas.sources[v as usize]), *old);
    }
    for ([a, b, c], chart) in st.iter().zip(&atlas.charts) {
        let [a, b, c] = [a, b, c].map(|p| p.as_dvec2());
        assert!(
            chart.is_none() || (b - a).perp_dot(c - a) <= 0.0,
            "mirrored"
        );
    }
    let figures = figures(mesh, atlas);
    assert_eq!(
        (figures.flipped, figures.mirrored_charts, figures.overlaps),
        (0, 0, 0)
    );
    for image in 0..atlas.packing.images {
        let shown = |c: &Option<u32>| c.filter(|&c| atlas.images[c as usize] == image);
        let charts: Vec<Option<u32>> = atlas.charts.iter().map(shown).collect();
        assert_apart(
            atlas.packing.size,
            &owners(atlas.packing.size, &st, &charts),
            gap,
        );
    }
}

/// Small images, so that touching texels can be searched one by one.
fn small() -> UnwrapOptions {
    UnwrapOptions {
        pack: PackOptions {
            size: AtlasSize::Texels(512),
            padding: 2,
            levels: 0,
            effort: Effort::Quick,
            ..PackOptions::default()
        },
        min_utilisation: 0.5,
        ..UnwrapOptions::default()
    }
}

#[test]
fn hard_meshes_by_name() {
    let square = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
    let two_sided: Vec<[u32; 3]> = vec![[0, 1, 2], [0, 2, 3], [2, 1, 0], [3, 2, 0]];
    let huge: Vec<Vec3> = square.iter().map(|&p| p * 3e38).collect();
    let tiny: Vec<Vec3> = square.iter().map(|&p| p * 1e-38).collect();
    let far: Vec<Vec3> = square.iter().map(|&p| p + Vec3::splat(1e6)).collect();
    let halves = vec![[0, 1, 2], [0, 2, 3]];
    let scales = [1e38, 1e20, 1.0, 1e-10, 1e-30, 1e-38];
    let mixed: Vec<Vec3> = scales.iter().flat_map(|&s| square.map(|p| p * s)).collect();
    let mixed_faces =
        (0..6).flat_map(|k| [[4 * k, 4 * k + 1, 4 * k + 2], [4 * k, 4 * k + 2, 4 * k + 3]]);
    let bow_tie = vec![[0, 1, 2], [0, 3, 4]];
    let meshes = [
        ("empty", (vec![], vec![])),
        ("only points", (square.to_vec(), vec![])),
        ("one triangle", (square.to_vec(), vec![[0, 1, 2]])),
        ("two-sided", (square.to_vec(), two_sided)),
        ("huge", (huge, halves.clone())),
        ("tiny", (tiny, halves.clone())),
        ("far away", (far, halves)),
        ("mixed scales", (mixed, mixed_faces.collect())),
        (
            "bow tie",
            (
                [&square[..], &[Vec3::new(-1.0, 1.0, 0.0)]].concat(),
                bow_tie,
            ),
        ),
        ("genus 5", meshes::genus_five()),
        ("icosphere", meshes::icosphere(4)),
        ("thin torus", meshes::torus(60, 6, 0.02)),
        ("spindle", meshes::torus(24, 24, 1.0)),
        ("fat torus", meshes::torus(40, 30, 0.95)),
        ("saddle fan", meshes::fan(60, 3.0)),
        (
            "cubes that meet at an edge",
            meshes::cubes(&[[0, 0, 0], [1, 1, 0]]),
        ),
        ("one cube", meshes::cubes(&[[0, 0, 0]])),
    ];
    for (name, mesh) in meshes {
        let atlas = unwrapped(&mesh, &small());
        assert_sound(&mesh, &atlas, 2);
        let figures = figures(&mesh, &atlas);
        assert!(
            figures.l2_stretch <= 1.02 + 1e-4,
            "{name}: {}",
            figures.l2_stretch
        );
    }
}

#[test]
fn small_charts_join_their_neighbours() {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for patch in texcoord::teapot::patches() {
        let grid = patch.grid(8);
        let base = positions.len() as u32;
        positions.extend(grid.positions);
        triangles.extend(grid.triangles.iter().map(|t| t.map(|v| v + base)));
    }
    let surface = Surface::of(&positions, &triangles, Weld::ByPosition).unwrap();
    let options = UnwrapOptions {
        min_utilisation: 0.0,
        ..UnwrapOptions::default()
    };
    let alone: usize = Segmentation::of(&surface)
        .charts
        .iter()
        .map(|chart| flatten(&surface, chart, &options.flatten).len())
        .sum();
    let atlas = unwrapped(&(positions, triangles), &options);
    assert!(
        atlas.images.len() + 5 <= alone,
        "{} of {alone}",
        atlas.images.len()
    );
}

#[test]
fn a_hub_and_needles_end_in_bounded_time() {
    // 3000 needles around each pole; systems without an order for hubs would be dense.
    let can = meshes::torus(3000, 3, 0.3);
    let fan = meshes::fan(3000, 0.0);
    for mesh in [can, fan] {
        assert_sound(&mesh, &unwrapped(&mesh, &small()), 2);
    }
}

#[test]
fn many_pieces_end_in_bounded_time() {
    let mesh = meshes::pieces(3000);
    let atlas = unwrapped(&mesh, &UnwrapOptions::default());
    assert_eq!(atlas.images.len(), 3000);
    let figures = figures(&mesh, &atlas);
    assert_eq!(
        (figures.flipped, figures.overlaps, figures.charts),
        (0, 0, 3000)
    );
}

#[test]
fn a_mesh_of_many_parts_keeps_one_density() {
    let mut mesh = meshes::icosphere(3);
    let (positions, triangles) = meshes::noisy_grid(20, 20, 0.1, 1.0);
    let base = mesh.0.len() as u32;
    mesh.0
        .extend(positions.iter().map(|&p| p * 0.2 + Vec3::splat(4.0)));
    mesh.1.extend(triangles.iter().map(|t| t.map(|v| v + base)));
    let figures = figures(&mesh, &unwrapped(&mesh, &UnwrapOptions::default()));
    assert!(
        figures.l2_stretch < 1.02 && figures.area_mean < 1.1,
        "{figures:?}"
    );
}

#[test]
fn the_image_is_used_as_asked() {
    for mesh in [
        meshes::icosphere(4),
        meshes::torus(60, 40, 0.4),
        meshes::noisy_grid(40, 40, 0.3, 0.0),
    ] {
        let figures = figures(&mesh, &unwrapped(&mesh, &UnwrapOptions::default()));
        assert!(figures.utilisation >= 0.66 - 1e-3, "{figures:?}");
    }
}

#[test]
fn a_developable_mesh_stays_whole() {
    let mesh = meshes::cylinder(40, 8, 5.0);
    let options = UnwrapOptions {
        min_utilisation: 0.0,
        ..UnwrapOptions::default()
    };
    let atlas = unwrapped(&mesh, &options);
    let figures = figures(&mesh, &atlas);
    assert_eq!((atlas.images.len(), figures.seam_length), (1, 0.0));
    assert!(figures.linf_stretch < 1.0001);
}

#[test]
fn duplicates_share_coordinates_and_other_faults_lie_at_the_corner() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NAN];
    let triangles = [[0, 1, 2], [2, 0, 1], [0, 1, 3], [0, 0, 1], [0, 1, 77]];
    let mesh = (positions.to_vec(), triangles.to_vec());
    let atlas = unwrapped(&mesh, &small());
    let st = atlas.corner_st();
    assert_eq!(st[1], [st[0][2], st[0][0], st[0][1]]);
    assert_eq!(st[2..], [[Vec2::ZERO; 3]; 3]);
    assert_eq!(atlas.charts, [Some(0), None, None, None, None]);
    assert_sound(&mesh, &atlas, 2);
}

#[test]
fn threads_and_their_order_change_nothing() {
    let mesh = meshes::torus(50, 30, 0.5);
    let options = UnwrapOptions::default();
    let expected = unwrapped(&mesh, &options);
    let backwards = |count: usize, task: &(dyn Fn(usize) + Sync)| (0..count).rev().for_each(task);
    let some = |count: usize, task: &(dyn Fn(usize) + Sync)| (0..count).step_by(2).for_each(task);
    let threads = |count: usize, task: &(dyn Fn(usize) + Sync)| {
        let next = AtomicUsize::new(0);
        std::thread::scope(|scope| {
            for _ in 0..3 {
                scope.spawn(|| {
                    while let k @ 0.. = next.fetch_add(1, Ordering::Relaxed)
                        && k < count
                    {
                        task(k);
                    }
                });
            }
        });
    };
    let again = |for_each: texcoord::charts::ForEach<'_>| {
        unwrap(&mesh.0, &mesh.1, &options, for_each, &|_| {}).unwrap()
    };
    assert!(
        again(&backwards) == expected && again(&some) == expected && again(&threads) == expected
    );
}

#[test]
fn progress_counts_up_to_all_faces() {
    let mesh = meshes::icosphere(3);
    let seen = Mutex::new(Vec::new());
    unwrap(&mesh.0, &mesh.1, &small(), &in_order, &|p| {
        seen.lock().unwrap().push(p)
    })
    .unwrap();
    let seen = seen.into_inner().unwrap();
    assert_eq!(seen[0], Progress::Segmenting);
    assert!(seen.contains(&Progress::Flattened {
        faces: 1280,
        of: 1280
    }));
    assert!(matches!(seen.last(), Some(Progress::Packing { .. })));
}

#[test]
fn a_density_beyond_all_images_is_an_error() {
    let mesh = meshes::icosphere(3);
    for density in [1e5, 1e30] {
        let mut options = small();
        options.pack.density = Density::TexelsPerUnit(density);
        let unwrapped = unwrap(&mesh.0, &mesh.1, &options, &in_order, &|_| {});
        assert!(
            matches!(unwrapped, Err(ChartError::NoRoom { .. })),
            "{density}"
        );
    }
}

#[test]
fn a_density_is_kept_over_several_images() {
    let mesh = meshes::icosphere(3);
    let mut options = small();
    options.pack.density = Density::TexelsPerUnit(300.0);
    let atlas = unwrapped(&mesh, &options);
    assert!(atlas.packing.images > 1 && atlas.packing.density == 300.0);
    assert_sound(&mesh, &atlas, 2);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_soup_and_every_surface_is_unwrapped(mesh in prop_oneof![meshes::soup(), meshes::surface()]) {
        let atlas = unwrapped(&mesh, &small());
        assert_sound(&mesh, &atlas, 2);
        prop_assert_eq!(&unwrapped(&mesh, &small()), &atlas);
    }
}
