//! The showcase: made by its generator, with all that it promises, and drawn as it was.
//!
//! `TEXRENDER_BLESS=1 cargo test -p texrender-rs --test composition showcase` writes the golden anew.

#[path = "../../crates/texrender/examples/showcase/scene/mod.rs"]
mod scene;

use std::path::{Path, PathBuf};

use glam::Vec3;
use shading::LightKind;
use texrender::scene::{AlphaMode, MaterialModel};
use texrender::{LoadOptions, Scene, Settings, View, load, sampler, shading};

use crate::glb::film;

/// Cells of the golden.
const GRID: (u32, u32) = (24, 14);
/// Pixels along the side of a cell.
const CELL: u32 = 10;
/// Largest root mean square of the differences to the golden, linear.
const MAX_RMSE: f32 = 0.004;
/// Largest difference of one channel of one cell, linear.
const MAX_DIFFERENCE: f32 = 0.03;

fn root(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(file)
}

fn showcase() -> Scene {
    load(root("assets/showcase.glb"), &LoadOptions::default()).unwrap()
}

#[test]
fn generator_makes_the_file_that_is_checked_in() {
    let stored = std::fs::read(root("assets/showcase.glb")).unwrap();
    assert!(
        scene::build() == stored,
        "run `cargo run --release -p texrender-rs --example showcase -- assets/showcase.glb`"
    );
}

#[test]
fn it_holds_one_of_everything() {
    let scene = showcase();
    assert_eq!(scene.warnings, [""; 0]);
    assert_eq!(scene.cameras[0].name, "camera");
    let has_light = |wanted: fn(&LightKind) -> bool| scene.lights.iter().any(|l| wanted(&l.kind));
    assert!(has_light(|k| *k == LightKind::Directional));
    assert!(has_light(|k| *k == LightKind::Point));
    assert!(has_light(|k| matches!(k, LightKind::Spot { .. })));

    let any =
        |wanted: &dyn Fn(&texrender::scene::Material) -> bool| scene.materials.iter().any(wanted);
    assert!(any(&|m| m.alpha_mode == AlphaMode::Opaque));
    assert!(any(&|m| matches!(m.alpha_mode, AlphaMode::Mask { .. })));
    assert!(any(&|m| m.alpha_mode == AlphaMode::Blend));
    assert!(any(&|m| m.double_sided));
    assert!(any(&|m| m.base_color_map.is_some()));
    assert!(any(&|m| m.normal.is_some()));
    assert!(any(&|m| m.emissive_map.is_some()));
    assert!(any(&|m| m.occlusion.is_some_and(|o| o.map.texcoord == 1)));
    assert!(any(&|m| m
        .base_color_map
        .is_some_and(|t| !t.transform.is_identity())));
    assert!(any(&|m| matches!(
        m.model,
        MaterialModel::MetallicRoughness { map: Some(_), .. }
    )));
    assert!(scene.primitives.iter().any(|p| p.tangents.is_some()));
    assert!(scene.primitives.iter().any(|p| p.colors.is_some()));
    assert!(scene.primitives.iter().any(|p| p.texcoords.len() > 1));
    let nearest = sampler::Filter::Nearest;
    assert!(scene.textures.iter().any(|t| t.sampler.magnify == nearest));
    let plan = texrender::Plan::new(&scene, &Settings::default()).unwrap();
    assert!(!plan.tangents.is_empty() && plan.warnings.is_empty());
}

#[test]
fn picture_matches_its_golden() {
    let scene = showcase();
    let settings = Settings {
        width: GRID.0 * CELL,
        height: GRID.1 * CELL,
        view: View::Camera("camera".to_owned()),
        ..Settings::default()
    };
    let (film, _, _) = film(&scene, &settings);
    let found: Vec<f32> = (0..GRID.0 * GRID.1)
        .flat_map(|cell| {
            let corner = (cell % GRID.0 * CELL, cell / GRID.0 * CELL);
            let mut sum = Vec3::ZERO;
            for i in 0..CELL * CELL {
                let pixel = film.pixel(corner.0 + i % CELL, corner.1 + i / CELL);
                sum += (pixel.lit + pixel.unlit).min(Vec3::splat(4.0));
            }
            (sum / (CELL * CELL) as f32).to_array()
        })
        .collect();
    let golden = root("tests/data/showcase.txt");
    if std::env::var_os("TEXRENDER_BLESS").is_some() {
        let lines: Vec<String> = found
            .chunks(3)
            .map(|c| format!("{:.4} {:.4} {:.4}", c[0], c[1], c[2]))
            .collect();
        std::fs::write(&golden, lines.join("\n") + "\n").unwrap();
    }
    let stored: Vec<f32> = std::fs::read_to_string(&golden)
        .unwrap()
        .split_whitespace()
        .map(|x| x.parse().unwrap())
        .collect();
    assert_eq!(stored.len(), found.len());
    let differences: Vec<f32> = found
        .iter()
        .zip(&stored)
        .map(|(a, b)| (a - b).abs())
        .collect();
    let rmse = (differences.iter().map(|d| d * d).sum::<f32>() / differences.len() as f32).sqrt();
    let most = differences.iter().fold(0f32, |a, &b| a.max(b));
    assert!(
        rmse <= MAX_RMSE && most <= MAX_DIFFERENCE,
        "RMSE {rmse:.5}, largest {most:.4}"
    );
}
