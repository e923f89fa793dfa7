//! Bad input gets a clear error that names file, place and remedy, an exit status that is not 0, and
//! leaves the output alone.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::json;

use crate::glb::{Glb, pack};

fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_texrender"))
}

/// Renders `scene` with `extra` arguments over a file that exists; returns what the program said.
fn render(folder: &Path, scene: &Path, extra: &[&str]) -> (Output, String) {
    let out = folder.join("out.png");
    std::fs::write(&out, b"untouched").unwrap();
    let output = program()
        .args(["render", "--size", "16x16"])
        .arg(scene)
        .arg("-o")
        .arg(&out)
        .args(extra)
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr.clone()).unwrap();
    (output, said)
}

/// Asserts that a scene is refused with a message that has all of `words`.
fn refused(scene: &Path, folder: &Path, extra: &[&str], words: &[&str]) {
    let (output, said) = render(folder, scene, extra);
    assert!(
        !output.status.success(),
        "{extra:?} accepted; it said: {said}"
    );
    assert!(output.status.code().is_some(), "killed by a signal: {said}");
    for word in words {
        assert!(said.contains(word), "no '{word}' in: {said}");
    }
    assert!(!said.contains("panicked"), "{said}");
    let left = std::fs::read(folder.join("out.png")).unwrap();
    assert_eq!(left, b"untouched", "the output was touched");
    let others = std::fs::read_dir(folder).unwrap().filter(|e| {
        e.as_ref()
            .unwrap()
            .file_name()
            .to_string_lossy()
            .starts_with(".texrender")
    });
    assert_eq!(others.count(), 0, "a temporary file was left");
}

fn refused_glb(glb: &Glb, words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let scene = glb.write(folder.path(), "scene.glb");
    let mut all = vec!["scene.glb"];
    all.extend(words);
    refused(&scene, folder.path(), &[], &all);
}

fn refused_bytes(name: &str, bytes: &[u8], words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join(name);
    std::fs::write(&scene, bytes).unwrap();
    let mut all = vec![name];
    all.extend(words);
    refused(&scene, folder.path(), &[], &all);
}

/// A scene that renders.
fn sound() -> Glb {
    let mut glb = Glb::new();
    let texture = glb.texture(2, 2, &[[255; 4]; 4]);
    let material = glb.unlit_texture(texture);
    glb.quad(0.0, material);
    glb
}

#[test]
fn sound_scene_is_accepted() {
    let folder = tempfile::tempdir().unwrap();
    let scene = sound().write(folder.path(), "scene.glb");
    let (output, said) = render(folder.path(), &scene, &[]);
    assert!(output.status.success(), "{said}");
    assert_eq!(said, "");
    assert!(image::open(folder.path().join("out.png")).is_ok());
}

#[test]
fn missing_file() {
    let folder = tempfile::tempdir().unwrap();
    refused(
        &folder.path().join("nowhere.glb"),
        folder.path(),
        &[],
        &["nowhere.glb", "cannot read"],
    );
}

#[test]
fn truncated_glb_at_any_length() {
    let bytes = sound().bytes();
    for length in [
        0,
        3,
        4,
        11,
        12,
        19,
        20,
        21,
        bytes.len() / 2,
        bytes.len() - 1,
    ] {
        refused_bytes("cut.glb", &bytes[..length], &[]);
    }
    refused_bytes("cut.glb", &bytes[..bytes.len() / 2], &["promises", "bytes"]);
}

#[test]
fn wrong_magic() {
    refused_bytes(
        "text.glb",
        b"solid cube\n",
        &["not a glTF scene", "solid cu"],
    );
    refused_bytes("empty.gltf", b"", &["it is empty"]);
}

#[test]
fn json_syntax_error_has_line_and_column() {
    refused_bytes(
        "broken.gltf",
        b"{\n  \"asset\": { \"version\": \"2.0\" },\n  oops\n}",
        &["broken.gltf:3:3"],
    );
    refused_bytes(
        "type.gltf",
        b"{\n\"asset\": { \"version\": 2 }\n}",
        &["type.gltf:2:"],
    );
    refused_bytes(
        "inside.glb",
        &pack(b"{\"asset\": nope}".to_vec(), b""),
        &["inside.glb:1:"],
    );
}

#[test]
fn accessor_out_of_bounds() {
    let mut glb = sound();
    glb.json["accessors"][0]["count"] = json!(1_000_000);
    refused_glb(&glb, &["accessors[0]", "1000000 elements", "past the end"]);
    let mut glb = sound();
    glb.json["accessors"][0]["count"] = json!(1_000_000_000_000u64);
    refused_glb(&glb, &["accessors[0]", "--max-memory"]);
    let mut glb = sound();
    glb.json["accessors"][0]["byteOffset"] = json!(u32::MAX);
    refused_glb(&glb, &["accessors[0]"]);
    let mut glb = sound();
    glb.json["bufferViews"][1]["byteOffset"] = json!(123_456_789);
    refused_glb(&glb, &["bufferViews[1]", "outside"]);
    let mut glb = sound();
    glb.json["bufferViews"][1]["byteLength"] = json!(u64::MAX);
    refused_glb(&glb, &[]);
}

#[test]
fn accessor_of_the_wrong_shape() {
    let mut glb = sound();
    glb.json["accessors"][0]["type"] = json!("VEC2");
    refused_glb(&glb, &["accessors[0]", "2 components", "3 are needed"]);
    let mut glb = sound();
    glb.json["accessors"][2]["count"] = json!(3);
    refused_glb(&glb, &["TEXCOORD_0", "3 elements", "4 positions"]);
    let mut glb = sound();
    glb.json["accessors"][3]["componentType"] = json!(5126);
    refused_glb(&glb, &["accessors[3]", "unsigned"]);
}

#[test]
fn index_out_of_range() {
    let mut glb = sound();
    let indices = glb.indices(&[0, 1, 2, 0, 2, 60000]);
    glb.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    refused_glb(
        &glb,
        &["meshes[0].primitives[0].indices", "60000", "4 vertices"],
    );
    let mut glb = sound();
    glb.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(99);
    refused_glb(&glb, &["meshes[0].primitives[0].attributes.POSITION", "99"]);
    let mut glb = sound();
    glb.json["meshes"][0]["primitives"][0]["material"] = json!(7);
    refused_glb(&glb, &["meshes[0].primitives[0].material"]);
    let mut glb = sound();
    glb.json["textures"][0]["source"] = json!(7);
    refused_glb(&glb, &["textures[0].source"]);
    let mut glb = sound();
    glb.json["nodes"][1]["mesh"] = json!(7);
    refused_glb(&glb, &["nodes[1].mesh"]);
}

#[test]
fn cyclic_nodes() {
    let mut glb = sound();
    glb.json["nodes"][1]["children"] = json!([1]);
    refused_glb(&glb, &["nodes[1]", "tree"]);
    let mut glb = sound();
    glb.push("nodes", json!({ "children": [1] }));
    glb.json["nodes"][1]["children"] = json!([2]);
    refused_glb(&glb, &["its own ancestor"]);
    let mut glb = sound();
    glb.push("nodes", json!({ "children": [1] }));
    glb.push("nodes", json!({ "children": [1] }));
    refused_glb(&glb, &["nodes[3].children", "tree"]);
}

#[test]
fn deep_hierarchy_does_not_overflow_the_stack() {
    let mut glb = sound();
    let mut child = 1;
    for _ in 0..50_000 {
        child = glb.push("nodes", json!({ "children": [child] }));
    }
    glb.json["scenes"][0]["nodes"] = json!([0, child]);
    let folder = tempfile::tempdir().unwrap();
    let scene = glb.write(folder.path(), "deep.glb");
    let (output, said) = render(folder.path(), &scene, &[]);
    assert!(output.status.success(), "{said}");
}

#[test]
fn missing_and_corrupt_images() {
    let mut glb = sound();
    glb.json["images"][0] = json!({ "uri": "nowhere.png" });
    let folder = tempfile::tempdir().unwrap();
    let scene = glb.write(folder.path(), "scene.glb");
    refused(&scene, folder.path(), &[], &["nowhere.png"]);

    for (bytes, words) in [
        (b"not an image at all".to_vec(), ["images[0]", "PNG, JPEG"]),
        (
            {
                let noise: Vec<[u8; 4]> = (0..4096u32)
                    .map(|i| i.wrapping_mul(2_654_435_761).to_le_bytes())
                    .collect();
                let mut png = crate::glb::png(64, 64, &noise);
                png.truncate(png.len() / 2);
                png
            },
            ["images[0]", "damaged"],
        ),
    ] {
        let mut glb = sound();
        let view = glb.view(&bytes);
        glb.json["images"][0]["bufferView"] = json!(view);
        let scene = glb.write(folder.path(), "scene.glb");
        refused(&scene, folder.path(), &[], &words);
    }
}

/// A PNG whose header says how large it is, and nothing else.
fn png_header(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".to_vec();
    bytes.extend(width.to_be_bytes());
    bytes.extend(height.to_be_bytes());
    bytes.extend([8, 6, 0, 0, 0]);
    let crc = bytes[12..].iter().fold(u32::MAX, |crc, &b| {
        (0..8).fold(crc ^ u32::from(b), |c, _| {
            if c & 1 == 1 {
                0xEDB8_8320 ^ (c >> 1)
            } else {
                c >> 1
            }
        })
    });
    bytes.extend((!crc).to_be_bytes());
    // An empty data chunk, so that readers go on to trust the header.
    bytes.extend(b"\0\0\0\0IDAT\x35\xAF\x06\x1E");
    bytes
}

#[test]
fn image_header_that_promises_more_than_the_memory_limit() {
    let mut glb = sound();
    let view = glb.view(&png_header(60_000, 60_000));
    glb.json["images"][0]["bufferView"] = json!(view);
    refused_glb(&glb, &["--max-memory", "MiB"]);
}

#[test]
fn absurd_sizes() {
    let folder = tempfile::tempdir().unwrap();
    let scene = sound().write(folder.path(), "scene.glb");
    for size in ["0x16", "16x0", "1000000x1000000", "4294967295x1", "32769x1"] {
        refused(&scene, folder.path(), &["--size", size], &["32768"]);
    }
    for size in ["16", "x", "5x-1", "1e9x1", "99999999999999999999x1"] {
        refused(
            &scene,
            folder.path(),
            &["--size", size],
            &["--size", "1920x1080"],
        );
    }
    refused(
        &scene,
        folder.path(),
        &["--size", "32768x32768"],
        &["MiB", "--max-memory"],
    );
    refused(
        &scene,
        folder.path(),
        &["--size", "2048x2048", "--max-memory", "1MiB"],
        &["--max-memory"],
    );
}

#[test]
fn uris_that_leave_the_folder_or_the_machine() {
    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().join("scene");
    std::fs::create_dir_all(inside.join("a")).unwrap();
    std::fs::write(
        folder.path().join("secret.png"),
        crate::glb::png(1, 1, &[[255; 4]]),
    )
    .unwrap();
    let absolute = folder.path().join("secret.png");
    for uri in [
        "../secret.png",
        "a/../../secret.png",
        "%2e%2e/secret.png",
        absolute.to_str().unwrap(),
    ] {
        let mut glb = sound();
        glb.json["images"][0] = json!({ "uri": uri });
        let scene = glb.write(&inside, "scene.glb");
        refused(
            &scene,
            folder.path(),
            &[],
            &["images[0].uri", "folder", "--allow-outside"],
        );
        let (output, said) = render(folder.path(), &scene, &["--allow-outside"]);
        assert!(output.status.success(), "{said}");
    }
    for uri in [
        "http://localhost/a.png",
        "https://example.org/a.png",
        "ftp://a/b",
        "file:///etc/hostname",
    ] {
        let mut glb = sound();
        glb.json["images"][0] = json!({ "uri": uri });
        let scene = glb.write(&inside, "scene.glb");
        refused(
            &scene,
            folder.path(),
            &["--allow-outside"],
            &["images[0].uri", "remote", "network"],
        );
    }
}

#[cfg(unix)]
#[test]
fn links_that_leave_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().join("scene");
    std::fs::create_dir(&inside).unwrap();
    let secret = folder.path().join("secret.png");
    std::fs::write(&secret, crate::glb::png(1, 1, &[[255; 4]])).unwrap();
    std::os::unix::fs::symlink(&secret, inside.join("link.png")).unwrap();
    let mut glb = sound();
    glb.json["images"][0] = json!({ "uri": "link.png" });
    let scene = glb.write(&inside, "scene.glb");
    refused(&scene, folder.path(), &[], &["link.png", "--allow-outside"]);
}

#[test]
fn output_that_cannot_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let scene = sound().write(folder.path(), "scene.glb");
    for (out, word) in [
        (folder.path().join("nowhere/out.png"), "does not exist"),
        (folder.path().join("out.xyz"), ".png"),
        (folder.path().join("out"), ".png"),
    ] {
        let output = program()
            .arg("render")
            .arg(&scene)
            .arg("-o")
            .arg(&out)
            .output()
            .unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && said.contains(word), "{said}");
        assert!(!out.exists());
    }
}

#[test]
fn required_extension_is_named() {
    let mut glb = sound();
    glb.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    refused_glb(&glb, &["KHR_draco_mesh_compression", "not supported"]);
}

#[test]
fn settings_out_of_range() {
    let folder = tempfile::tempdir().unwrap();
    let scene = sound().write(folder.path(), "scene.glb");
    for (extra, words) in [
        (&["--samples", "3"][..], &["--samples"][..]),
        (&["--camera", "nobody"], &["nobody", "'front'"]),
        (&["--camera", "5"], &["'5'", "'front'"]),
        (&["--fov", "180"], &["--fov", "180"]),
        (&["--fov", "nan"], &["--fov"]),
        (&["--elevation", "91"], &["--elevation"]),
        (&["--distance", "0"], &["--distance"]),
        (&["--eye", "0,0,1", "--target", "0,0,1"], &["--eye"]),
        (&["--eye", "0,0,1"], &["--target"]),
        (&["--filter", "aniso:0"], &["--filter", "64"]),
        (&["--background", "red-ish"], &["#rrggbb"]),
        (&["--background", "env", "--env", "none"], &["--background"]),
        (&["--env", "nowhere.hdr"], &["nowhere.hdr"]),
        (&["--aov", "colour=a.png"], &["depth, normal"]),
        (&["--threads", "0"], &["--threads"]),
        (&["--exposure", "inf"], &["--exposure"]),
        (&["--bit-depth", "12"], &["8 or 16"]),
        (&["--nonsense"], &["--nonsense"]),
    ] {
        refused(&scene, folder.path(), extra, words);
    }
}

#[test]
fn formats_refuse_what_they_cannot_hold() {
    let folder = tempfile::tempdir().unwrap();
    let scene = sound().write(folder.path(), "scene.glb");
    for (name, extra, word) in [
        ("a.jpg", &["--background", "transparent"][..], "alpha"),
        ("a.hdr", &["--background", "transparent"], "alpha"),
        ("a.jpg", &["--bit-depth", "16"], "16 bits"),
        ("a.webp", &["--bit-depth", "16"], "16 bits"),
    ] {
        let out = folder.path().join(name);
        let output = program()
            .arg("render")
            .arg(&scene)
            .arg("-o")
            .arg(&out)
            .args(extra)
            .output()
            .unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(
            !output.status.success() && said.contains(word),
            "{name}: {said}"
        );
        assert!(!out.exists());
    }
}

#[test]
fn nothing_visible_renders_the_background_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let empty = Glb::new().write(folder.path(), "empty.glb");
    let (output, said) = render(folder.path(), &empty, &["--background", "#ff8000"]);
    assert!(
        output.status.success() && said.contains("nothing is visible"),
        "{said}"
    );
    let picture = image::open(folder.path().join("out.png"))
        .unwrap()
        .into_rgb8();
    assert!(picture.pixels().all(|p| p.0 == [255, 128, 0]));
}
