//! The showcase: its generator writes the stored file, it holds what it is meant to show, and its
//! picture is the one that was looked at.

use std::path::PathBuf;

use glam::Vec3;
use mipmap::SamplerState;
use sampler::{AddressMode, Filter};
use shading::LightKind;
use texrender::sampler::transfer::linear_to_srgb;
use texrender::scene::{AlphaMode, Coordinates, Material, MaterialModel, Texture, TextureUse};
use texrender::{LoadOptions, Plan, Scene, Settings, View, load, mipmap, sampler, shading};

use crate::glb::film;

#[path = "../../crates/texrender/examples/showcase/scene/mod.rs"]
pub(crate) mod generator;

/// Cells of the golden, and pixels along a side of one.
const GRID: (u32, u32) = (24, 14);
const CELL: u32 = 14;
/// Largest root mean square of the differences to the golden, in display units of 0..=1.
const MAX_RMSE: f32 = 0.004;
/// Largest difference of one channel of one cell.
const MAX_DIFFERENCE: f32 = 0.03;
/// Unit of the stored numbers.
const STORED_UNIT: f32 = 1.0 / 1000.0;

fn repository() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

pub(crate) fn showcase() -> Scene {
    load(
        repository().join("assets/showcase.glb"),
        &LoadOptions::default(),
    )
    .unwrap()
}

/// The picture of its camera, small.
fn settings() -> Settings {
    Settings {
        width: GRID.0 * CELL,
        height: GRID.1 * CELL,
        view: View::Camera("camera".to_owned()),
        ..Settings::default()
    }
}

#[test]
fn the_generator_reproduces_the_stored_file() {
    let stored = std::fs::read(repository().join("assets/showcase.glb")).unwrap();
    let made = generator::build();
    let first = stored.iter().zip(&made).position(|(a, b)| a != b);
    assert!(
        made == stored,
        "{} bytes made, {} stored, first difference at {first:?}; write it anew with \
         `cargo run --release -p texrender-rs --example showcase -- assets/showcase.glb`",
        made.len(),
        stored.len()
    );
}

#[test]
fn the_showcase_loads_and_plans_without_warnings() {
    let scene = showcase();
    assert_eq!(scene.warnings, Vec::<String>::new());
    let plan = Plan::new(&scene, &settings()).unwrap();
    assert_eq!(plan.warnings, Vec::<String>::new());
}

/// The scene for timing is as heavy as is said of it, but for the side of its textures.
#[test]
fn the_heavy_scene_is_heavy() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("heavy.glb");
    std::fs::write(&path, generator::build_heavy(8)).expect("writes");
    let scene = texrender::load(&path, &LoadOptions::default()).expect("loads");
    let triangles: usize = scene.primitives.iter().map(|p| p.indices.len()).sum();
    assert!(triangles >= 150_000, "{triangles} triangles");
    assert_eq!(scene.images.len(), 36);
    let plan = Plan::new(&scene, &Settings::default()).expect("plans");
    assert_eq!(plan.warnings, Vec::<String>::new());
}

#[test]
fn the_showcase_is_small() {
    let bytes = std::fs::metadata(repository().join("assets/showcase.glb"))
        .unwrap()
        .len();
    assert!(bytes < 4_000_000, "{bytes} bytes");
    let scene = showcase();
    let count = |i: &texrender::scene::Instance| scene.primitives[i.primitive].indices.len();
    let triangles: usize = scene.instances.iter().map(count).sum();
    assert!(
        (10_000..60_000).contains(&triangles),
        "{triangles} triangles"
    );
}

#[test]
fn the_showcase_has_every_kind_of_surface() {
    let materials = showcase().materials;
    let any = |what: fn(&Material) -> bool| materials.iter().any(what);
    assert!(any(|m| m.alpha_mode == AlphaMode::Opaque));
    assert!(any(|m| matches!(m.alpha_mode, AlphaMode::Mask { .. })));
    assert!(any(|m| m.alpha_mode == AlphaMode::Blend));
    assert!(any(|m| m.double_sided) && any(|m| !m.double_sided));
    assert!(any(|m| m.model == MaterialModel::Unlit));
    assert!(any(|m| m.base_color_map.is_some()));
    assert!(any(|m| m.normal.is_some()));
    assert!(any(
        |m| m.emissive_map.is_some() && m.emissive.max_element() > 1.0
    ));
    assert!(any(|m| m
        .occlusion
        .is_some_and(|o| o.map.coordinates == Coordinates::Set(1))));
    assert!(any(|m| metallic_roughness(m).is_some()));
    assert!(any(|m| m
        .base_color_map
        .is_some_and(|map| !map.transform.is_identity())));
}

fn metallic_roughness(material: &Material) -> Option<TextureUse> {
    match material.model {
        MaterialModel::MetallicRoughness { map, .. } => map,
        _ => None,
    }
}

#[test]
fn the_showcase_has_two_uv_sets_colours_and_both_kinds_of_tangents() {
    let scene = showcase();
    let any = |what: fn(&texrender::scene::Primitive) -> bool| scene.primitives.iter().any(what);
    assert!(any(|p| p.texcoords.len() == 2));
    assert!(any(|p| p.colors.is_some()));
    let bumpy = |from_file: bool| {
        scene
            .primitives
            .iter()
            .any(|p| scene.material(p).normal.is_some() && p.tangents.is_some() == from_file)
    };
    assert!(bumpy(true), "a normal map on tangents of the file");
    assert!(bumpy(false), "a normal map on generated tangents");
}

#[test]
fn the_showcase_wraps_in_every_way_and_magnifies_in_both() {
    let textures = showcase().textures;
    let any = |what: fn(&SamplerState) -> bool| {
        textures
            .iter()
            .any(|t| matches!(t, Texture::Image(t) if what(&t.sampler)))
    };
    assert!(any(|s| s.address.modes == [AddressMode::Repeat; 2]));
    assert!(any(|s| s.address.modes == [AddressMode::MirrorRepeat; 2]));
    assert!(any(|s| s.address.modes == [AddressMode::ClampToEdge; 2]));
    assert!(any(|s| s.magnify == Filter::Nearest));
    assert!(any(|s| s.magnify == Filter::Bilinear));
}

#[test]
fn the_showcase_has_three_kinds_of_lights_and_a_named_camera() {
    let scene = showcase();
    let any = |what: fn(&LightKind) -> bool| scene.lights.iter().any(|l| what(&l.kind));
    assert!(any(|k| matches!(k, LightKind::Directional)));
    assert!(any(|k| matches!(k, LightKind::Point)));
    assert!(any(|k| matches!(k, LightKind::Spot { .. })));
    let names: Vec<&str> = scene.cameras.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["camera"]);
}

/// `TEXRENDER_BLESS=1 cargo test -p texrender-rs --test composition showcase` writes the golden anew:
/// the mean colour of each cell, row by row, in thousandths of display units.
#[test]
fn the_showcase_matches_its_golden() {
    let path = repository().join("tests/data/showcase.txt");
    let found = cells(&showcase());
    if std::env::var_os("TEXRENDER_BLESS").is_some() {
        std::fs::write(&path, written(&found)).unwrap();
    }
    let stored = read(&std::fs::read_to_string(&path).unwrap());
    assert_eq!(found.len(), stored.len());
    let mut sum = 0.0;
    let mut worst = (0.0, 0);
    for (i, (found, stored)) in found.iter().zip(&stored).enumerate() {
        let difference = (*found - *stored).abs();
        sum += difference.length_squared();
        if difference.max_element() > worst.0 {
            worst = (difference.max_element(), i as u32);
        }
    }
    let rmse = (sum / (3 * found.len()) as f32).sqrt();
    let (most, cell) = worst;
    let place = (cell % GRID.0, cell / GRID.0);
    assert!(
        rmse <= MAX_RMSE && most <= MAX_DIFFERENCE,
        "RMSE {rmse}, at most {most} in cell {place:?}"
    );
}

/// Mean display colour of each cell before tone mapping, cut off at 1.
fn cells(scene: &Scene) -> Vec<Vec3> {
    let (film, _, _) = film(scene, &settings());
    let shown = |x, y| {
        let pixel = film.pixel(x, y);
        let light = (pixel.lit + pixel.unlit).min(Vec3::ONE);
        Vec3::from(light.to_array().map(linear_to_srgb))
    };
    (0..GRID.0 * GRID.1)
        .map(|i| {
            let (x, y) = (i % GRID.0 * CELL, i / GRID.0 * CELL);
            let sum: Vec3 = (0..CELL * CELL)
                .map(|k| shown(x + k % CELL, y + k / CELL))
                .sum();
            sum / (CELL * CELL) as f32
        })
        .collect()
}

fn written(cells: &[Vec3]) -> String {
    let cell = |c: &Vec3| {
        let [r, g, b] = (*c / STORED_UNIT).round().to_array().map(|x| x as u32);
        format!("{r},{g},{b}")
    };
    let rows = cells.chunks(GRID.0 as usize);
    rows.map(|row| row.iter().map(cell).collect::<Vec<_>>().join(" ") + "\n")
        .collect()
}

fn read(text: &str) -> Vec<Vec3> {
    text.split_whitespace()
        .map(|cell| {
            let mut channels = cell
                .split(',')
                .map(|x| x.parse::<f32>().unwrap() * STORED_UNIT);
            Vec3::from_array(std::array::from_fn(|_| channels.next().unwrap()))
        })
        .collect()
}
