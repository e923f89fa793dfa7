//! The same bytes for any number of threads and any order of tiles.

use serde_json::json;
use texrender::{Aov, FinishOptions, Plan, Scene, Settings, TileOrder, prepare, render, save};

use crate::glb::Glb;

/// A lit, textured, normal-mapped, masked and blended scene.
fn rich() -> Glb {
    let mut glb = Glb::new();
    for (node, z) in glb
        .quads_of_three_modes(120)
        .into_iter()
        .zip([0.0, 0.3, 0.6])
    {
        glb.json["nodes"][node]["rotation"] = json!([0.1, z, 0.05, 0.9]);
    }
    glb
}

fn bytes(scene: &Scene, settings: &Settings, threads: usize, name: &str) -> Vec<u8> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    pool.install(|| {
        let plan = Plan::new(scene, settings).unwrap();
        let resources = prepare(scene, &plan).unwrap();
        let film = render(scene, &plan, &resources, &|_| {});
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        let layers: &[Aov] = if name.ends_with("exr") {
            &settings.aovs
        } else {
            &[]
        };
        save(&film, &path, &FinishOptions::default(), layers).unwrap();
        std::fs::read(path).unwrap()
    })
}

#[test]
fn picture_is_the_same_for_any_number_of_threads() {
    let scene = rich().load();
    let settings = Settings {
        width: 150,
        height: 101,
        aovs: Aov::ALL.to_vec(),
        ..Settings::default()
    };
    for name in ["a.png", "a.exr"] {
        let one = bytes(&scene, &settings, 1, name);
        for threads in [2, 7] {
            assert!(
                one == bytes(&scene, &settings, threads, name),
                "{name} on {threads} threads"
            );
        }
    }
}

#[test]
fn picture_is_the_same_for_any_order_of_tiles() {
    let scene = rich().load();
    let rows = Settings {
        width: 150,
        height: 101,
        ..Settings::default()
    };
    let reference = bytes(&scene, &rows, 2, "a.png");
    for seed in [1, 2, 99] {
        let shuffled = Settings {
            tile_order: TileOrder::Shuffled(seed),
            ..rows.clone()
        };
        assert!(
            reference == bytes(&scene, &shuffled, 2, "a.png"),
            "seed {seed}"
        );
    }
}
