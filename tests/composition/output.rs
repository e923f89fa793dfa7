//! Pictures out: formats, backgrounds, tone, AOVs and statistics, through the program.

use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};

use crate::glb::Glb;

/// Left half red at alpha 1, over nothing.
fn half_red() -> Glb {
    let mut glb = Glb::new();
    let material = glb.unlit([1.0, 0.0, 0.0, 1.0]);
    let positions = glb.floats(&[
        [-1.0, -1.0, 0.0],
        [0.0, -1.0, 0.0],
        [-1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ]);
    glb.mesh(json!({ "attributes": { "POSITION": positions }, "material": material, "mode": 5 }));
    glb
}

fn run(folder: &Path, glb: &Glb, out: &str, extra: &[&str]) -> String {
    let scene = glb.write(folder, "scene.glb");
    let output = Command::new(env!("CARGO_BIN_EXE_texrender"))
        .current_dir(folder)
        .arg("render")
        .arg(scene)
        .args(["-o", out, "--size", "32x32"])
        .args(extra)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    assert!(
        !said.contains('\r') && !said.contains('\u{1b}'),
        "no progress bar in a pipe: {said}"
    );
    String::from_utf8(output.stdout).unwrap()
}

fn at(folder: &Path, name: &str, x: u32, y: u32) -> [f32; 4] {
    image::open(folder.join(name))
        .unwrap()
        .into_rgba32f()
        .get_pixel(x, y)
        .0
}

#[test]
fn every_format_holds_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    for (name, tolerance) in [
        ("a.png", 0.0),
        ("a.jpg", 0.03),
        ("a.webp", 0.0),
        ("a.hdr", 0.01),
        ("a.exr", 0.0),
    ] {
        run(folder.path(), &half_red(), name, &["--background", "black"]);
        let (left, right) = (
            at(folder.path(), name, 4, 16),
            at(folder.path(), name, 28, 16),
        );
        for (found, expected) in left
            .iter()
            .zip([1.0, 0.0, 0.0, 1.0])
            .chain(right.iter().zip([0.0, 0.0, 0.0, 1.0]))
        {
            assert!(
                (found - expected).abs() <= tolerance,
                "{name}: {left:?} {right:?}"
            );
        }
    }
}

#[test]
fn sixteen_bit_png_and_transparency() {
    let folder = tempfile::tempdir().unwrap();
    run(
        folder.path(),
        &half_red(),
        "a.png",
        &["--bit-depth", "16", "--background", "transparent"],
    );
    let picture = image::open(folder.path().join("a.png")).unwrap();
    assert_eq!(picture.color(), image::ColorType::Rgba16);
    let picture = picture.into_rgba16();
    assert_eq!(picture.get_pixel(4, 4).0, [65535, 0, 0, 65535]);
    assert_eq!(picture.get_pixel(28, 4).0, [0, 0, 0, 0]);
}

#[test]
fn antialiased_edges_are_straight_alpha() {
    let folder = tempfile::tempdir().unwrap();
    let mut glb = half_red();
    // Half a pixel to the right.
    glb.json["nodes"][1]["translation"] = json!([1.0 / 32.0, 0, 0]);
    run(
        folder.path(),
        &glb,
        "a.png",
        &["--samples", "4", "--background", "transparent"],
    );
    let edge = image::open(folder.path().join("a.png"))
        .unwrap()
        .into_rgba8();
    assert_eq!(edge.get_pixel(16, 16).0, [255, 0, 0, 128]);
}

#[test]
fn unlit_colours_ignore_exposure_and_tone() {
    let folder = tempfile::tempdir().unwrap();
    let mut glb = Glb::new();
    let texels: Vec<[u8; 4]> = (0..=255).map(|c| [c, 255 - c, 128, 255]).collect();
    let texture = glb.texture(256, 1, &texels);
    let material = glb.unlit_texture(texture);
    glb.quad(0.0, material);
    // The camera of the scene sees the quad and nothing else: a texel a column.
    for tonemap in ["neutral", "aces", "none"] {
        let settings = [
            "--tonemap",
            tonemap,
            "--exposure",
            "-2",
            "--size",
            "256x256",
            "--filter",
            "nearest",
        ];
        run(folder.path(), &glb, "a.png", &settings);
        let picture = image::open(folder.path().join("a.png"))
            .unwrap()
            .into_rgb8();
        for (x, _, pixel) in picture.enumerate_pixels() {
            let code = x as u8;
            assert_eq!(pixel.0, [code, 255 - code, 128], "{tonemap}, column {x}");
        }
    }
}

#[test]
fn exposure_doubles_lit_light_by_the_stop() {
    let folder = tempfile::tempdir().unwrap();
    let mut glb = Glb::new();
    let material = glb.push(
        "materials",
        json!({ "pbrMetallicRoughness": { "metallicFactor": 0 } }),
    );
    glb.quad(0.0, material);
    run(folder.path(), &glb, "a.exr", &[]);
    run(folder.path(), &glb, "b.exr", &["--exposure", "1"]);
    let (a, b) = (
        at(folder.path(), "a.exr", 16, 16),
        at(folder.path(), "b.exr", 16, 16),
    );
    assert!(
        a[0] > 0.1 && (b[0] / a[0] - 2.0).abs() < 1e-5,
        "{a:?} {b:?}"
    );
}

/// A wall at z = −2 that fills the view, with every kind of AOV output.
fn wall_with_aovs(folder: &Path) {
    let mut glb = Glb::new();
    let texture = glb.texture(2, 2, &[[255; 4]; 4]);
    let material = glb.unlit_texture(texture);
    glb.quad(-2.0, material);
    let aovs = [
        "depth=a.exr",
        "normal=a.exr",
        "st=st.exr",
        "id=id.png",
        "mip=both.exr",
        "depth=both.exr",
    ];
    let arguments: Vec<&str> = aovs.iter().flat_map(|&a| ["--aov", a]).collect();
    run(folder, &glb, "a.exr", &arguments);
}

#[test]
fn aovs_are_files_of_their_own_or_channels_of_the_exr() {
    let folder = tempfile::tempdir().unwrap();
    wall_with_aovs(folder.path());
    let names = |file: &str| {
        let meta = exr::meta::MetaData::read_from_file(folder.path().join(file), false).unwrap();
        let mut names: Vec<String> = meta.headers[0]
            .channels
            .list
            .iter()
            .map(|c| c.name.to_string())
            .collect();
        names.sort();
        names
    };
    assert_eq!(
        names("a.exr"),
        ["B", "G", "R", "depth.Z", "normal.X", "normal.Y", "normal.Z"]
    );
    assert_eq!(names("st.exr"), ["U", "V"]);
    assert_eq!(names("both.exr"), ["depth.Z", "mip.level"]);
    assert!(image::open(folder.path().join("id.png")).is_ok());
}

#[test]
fn aovs_hold_depth_normals_and_coordinates() {
    let folder = tempfile::tempdir().unwrap();
    wall_with_aovs(folder.path());
    let channel = |file: &str, name: &str| -> Vec<f32> {
        let image =
            exr::prelude::read_first_flat_layer_from_file(folder.path().join(file)).unwrap();
        let channels = &image.layer_data.channel_data.list;
        let found = channels
            .iter()
            .find(|c| c.name.to_string() == name)
            .unwrap();
        found.sample_data.values_as_f32().collect()
    };
    // The camera stands at z = 10 and looks along −Z.
    assert!(
        channel("a.exr", "depth.Z")
            .iter()
            .all(|d| (d - 12.0).abs() < 1e-4)
    );
    assert!(
        channel("a.exr", "normal.Z")
            .iter()
            .all(|n| (n - 1.0).abs() < 1e-6)
    );
    let (u, v) = (channel("st.exr", "U"), channel("st.exr", "V"));
    for y in 0..32 {
        for x in 0..32 {
            let expected = ((x as f32 + 0.5) / 32.0, (y as f32 + 0.5) / 32.0);
            let found = (u[y * 32 + x], v[y * 32 + x]);
            assert!((found.0 - expected.0).abs() < 1e-5 && (found.1 - expected.1).abs() < 1e-5);
        }
    }
}

#[test]
fn statistics_are_whole() {
    let folder = tempfile::tempdir().unwrap();
    let text = run(
        folder.path(),
        &half_red(),
        "a.png",
        &["--stats", "-", "--threads", "2"],
    );
    let stats: Value = serde_json::from_str(&text).unwrap();
    for stage in ["load", "plan", "prepare", "render", "finish", "total"] {
        assert!(
            stats["milliseconds"][stage].as_f64().unwrap() >= 0.0,
            "{stage}"
        );
    }
    assert_eq!(stats["threads"], 2);
    assert_eq!(stats["images_listed"], 0);
    assert_eq!(stats["prepare"]["images_decoded"], 0);
    assert_eq!(stats["prepare"]["environment_tables_built"], 0);
    assert_eq!(stats["render"]["triangles_in"], 2);
    assert_eq!(stats["render"]["triangles_visible"], 2);
    assert!(stats["render"]["pixels_shaded"].as_u64().unwrap() >= 16 * 32);
    if cfg!(target_os = "linux") {
        assert!(stats["peak_memory_bytes"].as_u64().unwrap() > 1 << 20);
    }
    run(
        folder.path(),
        &half_red(),
        "a.png",
        &["--stats", "stats.json"],
    );
    let file = std::fs::read_to_string(folder.path().join("stats.json")).unwrap();
    assert!(serde_json::from_str::<Value>(&file).is_ok());
}

#[test]
fn inspect_says_what_and_why() {
    let folder = tempfile::tempdir().unwrap();
    let mut glb = Glb::new();
    let used = glb.texture(4, 2, &[[255; 4]; 8]);
    glb.texture(8, 8, &[[255; 4]; 64]);
    glb.json["images"][1]["name"] = json!("spare");
    let material = glb.unlit_texture(used);
    glb.json["materials"][0]["name"] = json!("poster");
    glb.quad(0.0, material);
    let scene = glb.write(folder.path(), "scene.glb");
    let output = Command::new(env!("CARGO_BIN_EXE_texrender"))
        .arg("inspect")
        .arg(scene)
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success());
    for word in [
        "images[0]",
        "4x2",
        "base colour of 'poster'",
        "spare",
        "not opened",
        "environment none",
        "0 'front'",
    ] {
        assert!(text.contains(word), "no '{word}' in:\n{text}");
    }
}

#[test]
fn existing_output_is_replaced_whole() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.png"), vec![7u8; 1 << 20]).unwrap();
    run(folder.path(), &half_red(), "a.png", &[]);
    assert!(image::open(folder.path().join("a.png")).is_ok());
    let files = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(files, 2, "the scene and the picture, nothing temporary");
}
