//! The program: its files, its words, its bytes.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::{Value, json};
use texrender::texcoord::charts::{AtlasSize, PackOptions, UnwrapOptions};
use texrender::unwrap::UnwrapFile;

use super::atlas::sound;
use super::raw::{Raw, number, same_corners, unwrap};
use super::scenes::{placed, rich, sheet};

/// Runs the program with words divided by spaces.
fn run(folder: &Path, words: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_texrender"))
        .current_dir(folder)
        .arg("unwrap")
        .args(words.split(' '))
        .output()
        .unwrap()
}

/// Runs it on the rich scene and has everything written; returns what it said.
fn everything(folder: &Path, threads: u32) -> String {
    rich().write(folder, "in.glb");
    let output = run(
        folder,
        &format!(
            "in.glb -o out.glb --threads {threads} --report r.json --atlas a.png --checker c.png \
             --size 512 --padding 3 --levels 2"
        ),
    );
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn bytes_are_the_same_on_any_threads() {
    let folder = tempfile::tempdir().unwrap();
    let made = [1, 2].map(|threads| {
        everything(folder.path(), threads);
        ["out.glb", "a.png", "c.png"].map(|name| std::fs::read(folder.path().join(name)).unwrap())
    });
    assert!(made[0] == made[1]);
}

#[test]
fn report_and_pictures_say_what_was_made() {
    let folder = tempfile::tempdir().unwrap();
    let said = everything(folder.path(), 2);
    assert!(said.starts_with("out.glb: 181 triangles in "), "{said}");
    let report = std::fs::read(folder.path().join("r.json")).unwrap();
    let report: Value = serde_json::from_slice(&report).unwrap();
    let keys = "triangles charts utilisation l2_stretch linf_stretch conformal area flips mirrored overlaps \
                seam_length seconds";
    for key in keys.split(' ') {
        assert!(report[key].is_number(), "{key} in {report}");
    }
    let sizes = (number(&report["triangles"]), number(&report["size"]));
    assert_eq!(sizes, (181, 512));
    // The atlas shows as much as charts cover.
    let atlas = image::open(folder.path().join("a.png")).unwrap().to_rgb8();
    assert_eq!(atlas.dimensions(), (512, 512));
    let dark = atlas.get_pixel(0, 0);
    let covered = atlas.pixels().filter(|p| *p != dark).count() as f64 / (512.0 * 512.0);
    let utilisation = report["utilisation"].as_f64().unwrap();
    assert!(
        (covered - utilisation).abs() < 0.01,
        "{covered} {utilisation}"
    );
    // Light and dark cells of the checkerboard, both tinted, before a background that is not.
    let checker = image::open(folder.path().join("c.png")).unwrap().to_rgb8();
    let shows = |test: &dyn Fn([u8; 3]) -> bool| checker.pixels().filter(|p| test(p.0)).count();
    assert!(shows(&|[r, g, b]| r.max(g) > 150 && g != b) > 2000);
    assert!(shows(&|[r, g, b]| r.max(g) < 120 && g != b) > 2000);
}

#[test]
fn a_file_can_be_replaced_by_its_own_unwrapping() {
    let folder = tempfile::tempdir().unwrap();
    let path = rich().write(folder.path(), "in.glb");
    let before = Raw::read(&path);
    let options = UnwrapFile {
        charts: UnwrapOptions {
            pack: PackOptions {
                size: AtlasSize::Texels(256),
                ..PackOptions::default()
            },
            ..UnwrapOptions::default()
        },
        ..UnwrapFile::default()
    };
    let first = unwrap(&path, &path, &options);
    assert_eq!(sound(&same_corners(&before, &Raw::read(&path), &[])), 0);
    assert_eq!(first.size, 256);
    // Once more, into the next set: the seams of the first do not matter to the second.
    let second = unwrap(&path, &path, &options);
    assert_eq!(second.sets, [1, 2]);
    assert_eq!(first.charts, second.charts);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// Files that unwrap, and files that do not.
fn broken_files(folder: &Path) {
    let (positions, indices) = sheet(3);
    let whole = || placed(&[(&positions, &indices)], &[json!({ "mesh": 0 })]);
    whole().write(folder, "in.glb");
    let points = [[0.0; 3], [0.0, 1.0, 0.0], [0.0, 2.0, 0.0]];
    placed(&[(&points, &[0, 1, 2])], &[]).write(folder, "flat.glb");
    let mut lines = placed(&[(&points, &[0, 1, 1, 2])], &[]);
    lines.json["meshes"][0]["primitives"][0]["mode"] = json!(1);
    lines.write(folder, "lines.glb");
    let mut short = whole();
    let normals = short.floats(&[[0.0f32, 0.0, 1.0]; 3]);
    short.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(normals);
    short.write(folder, "short.glb");
    let mut bare = whole();
    bare.json["meshes"][0]["primitives"][0]["attributes"] = json!({});
    bare.write(folder, "bare.glb");
    let mut draco = whole();
    draco.json["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    draco.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    draco.write(folder, "draco.glb");
}

/// Asserts that each line of words is refused with a message that holds what stands beside it, and that no file is left.
fn refused(cases: &[(&str, &str)]) {
    let folder = tempfile::tempdir().unwrap();
    broken_files(folder.path());
    let files = std::fs::read_dir(folder.path()).unwrap().count();
    for (words, expected) in cases {
        let output = run(folder.path(), words);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success(), "{words}: {said}");
        assert!(output.status.code().is_some(), "{words}: {said}");
        assert!(said.contains(expected), "{words}: {said}");
        assert!(!said.contains("panicked"), "{words}: {said}");
        let left = std::fs::read_dir(folder.path()).unwrap().count();
        assert_eq!(left, files, "{words}");
    }
}

#[test]
fn options_that_cannot_be_are_refused() {
    refused(&[
        ("in.glb -o out.obj", "use .glb or .gltf"),
        ("in.glb -o nowhere/out.glb", "does not exist"),
        ("in.glb -o out.glb --report no/r.json", "does not exist"),
        ("in.glb -o out.glb --atlas a.jpg", "end the name in .png"),
        ("in.glb -o out.glb --checker a.gif", "names no format"),
        ("in.glb -o out.glb --max-stretch 1", "--max-stretch"),
        ("in.glb -o out.glb --max-stretch NaN", "--max-stretch"),
        ("in.glb -o out.glb --utilisation 1.5", "--utilisation"),
        ("in.glb -o out.glb --levels 40", "--levels"),
        ("in.glb -o out.glb --padding 4000000000", "--padding"),
        ("in.glb -o out.glb --size 0", "must be in 1..="),
        ("in.glb -o out.glb --size 16 --padding 64", "do not fit"),
        ("in.glb -o out.glb --density -1", "--density"),
        (
            "in.glb -o out.glb --density 40 --size 64",
            "images of 64 texels",
        ),
        ("in.glb -o out.glb --max-memory 10KiB", "MiB"),
        (
            "in.glb -o out.glb --method lscm",
            "choose isometric or pairs",
        ),
        (
            "in.glb -o out.glb --method pairs --effort quick",
            "drop one",
        ),
    ]);
}

#[test]
fn files_that_cannot_be_unwrapped_are_refused() {
    refused(&[
        ("none.glb -o out.glb", "cannot read none.glb"),
        (
            "flat.glb -o out.glb",
            "flat.glb: meshes: none of the 1 triangles has an area",
        ),
        (
            "lines.glb -o out.glb",
            "lines.glb: meshes: have no triangle",
        ),
        ("bare.glb -o out.glb", "have no triangle"),
        (
            "short.glb -o out.glb",
            "attributes.NORMAL: has 3 elements, and there are 16",
        ),
        ("draco.glb -o out.glb", "KHR_draco_mesh_compression"),
    ]);
}
