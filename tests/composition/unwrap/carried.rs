//! What is not coordinates stays as it was, and materials look as they did.

use std::path::{Path, PathBuf};

use glam::Vec3;
use serde_json::{Value, json};
use texrender::unwrap::{Report, UnwrapFile, unwrap_file};
use texrender::{FragmentMerging, LoadOptions, Settings, load};

use super::atlas::{area, sound};
use super::raw::{Raw, same_corners, unwrap};
use super::scenes::rich;
use crate::glb::film;

/// Asserts that two files give one picture, every triangle shaded for itself: seams part what neighbours had in common.
fn same_picture(a: &Path, b: &Path) {
    let settings = Settings {
        width: 160,
        height: 90,
        fragments: FragmentMerging::Never,
        ..Settings::default()
    };
    let [a, b] = [a, b].map(|path| {
        let scene = load(path, &LoadOptions::default()).unwrap();
        let (film, ..) = film(&scene, &settings);
        let all = (0..90).flat_map(|y| (0..160).map(move |x| (x, y)));
        let bits = |v: Vec3| v.to_array().map(f32::to_bits);
        all.map(|(x, y)| {
            let p = film.pixel(x, y);
            (bits(p.lit), bits(p.unlit), p.lit_coverage.to_bits())
        })
        .collect::<Vec<_>>()
    });
    let different = a.iter().zip(&b).filter(|(a, b)| a != b).count();
    assert_eq!(different, 0, "pixels differ");
}

#[test]
fn everything_else_survives_in_both_containers() {
    let folder = tempfile::tempdir().unwrap();
    let input = rich().write(folder.path(), "in.glb");
    let before = Raw::read(&input);
    for name in ["out.glb", "out file.gltf"] {
        let output = folder.path().join(name);
        let report = unwrap(&input, &output, &UnwrapFile::default());
        // The name of the .bin file is escaped in the JSON; here it is looked for as it is.
        let after = if name.ends_with("glb") {
            Raw::read(&output)
        } else {
            let json: Value = serde_json::from_slice(&std::fs::read(&output).unwrap()).unwrap();
            assert_eq!(json["buffers"][0]["uri"], "out%20file.bin");
            let buffers = vec![std::fs::read(output.with_extension("bin")).unwrap()];
            Raw { json, buffers }
        };
        let corners = same_corners(&before, &after, &[]);
        assert_eq!(corners.len(), 12 * 7 * 2 + 8 + 5);
        assert_eq!((sound(&corners), report.triangles), (0, corners.len()));
        assert_eq!((report.flips, report.mirrored, report.overlaps), (0, 0, 0));
        assert_eq!(report.sets, [0, 1]);
        let unused = [
            "accessors",
            "bufferViews",
            "buffers",
            "meshes",
            "images",
            "skins",
            "animations",
        ];
        for (key, value) in before.json.as_object().unwrap() {
            if !unused.contains(&key.as_str()) {
                assert_eq!(value, &after.json[key], "{key}");
            }
        }
        assert_eq!(after.json["meshes"][0]["weights"], json!([0.5]));
        // What is referred to by number has kept its content.
        let image = |raw: &Raw| raw.view(&raw.json["images"][0]["bufferView"]).to_vec();
        assert_eq!(image(&before), image(&after));
        let matrices = |raw: &Raw| raw.elements(&raw.json["skins"][0]["inverseBindMatrices"]);
        assert_eq!(matrices(&before), matrices(&after));
        for sampler in 0..2 {
            for key in ["input", "output"] {
                let of =
                    |raw: &Raw| raw.elements(&raw.json["animations"][0]["samplers"][sampler][key]);
                assert_eq!(of(&before), of(&after));
            }
        }
        // Position, normal, st, new st, colour, joints, weights, heat, morph; indices; strip, fan: position, st,
        // indices; lines: 2; matrices; times, turns, weights.
        assert_eq!(
            after.json["accessors"].as_array().unwrap().len(),
            10 + 6 + 2 + 1 + 3
        );
        assert!(report.warnings.iter().any(|w| w.contains("XYZ_notes")));
        same_picture(&input, &output);
    }
}

/// The folder of shared assets, or a word on what is skipped.
fn assets() -> Option<PathBuf> {
    let folder = std::env::var_os("TEXRENDER_ASSETS").map(PathBuf::from);
    if folder.is_none() {
        println!("skipped: TEXRENDER_ASSETS is not set");
    }
    folder
}

/// Unwraps a model into another folder; asserts that it is sound and looks as before.
fn model(input: &Path, name: &str) -> (Report, Raw) {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join(name);
    let report = unwrap(input, &output, &UnwrapFile::default());
    let (before, after) = (Raw::read(input), Raw::read(&output));
    let corners = same_corners(&before, &after, &[]);
    let flat = sound(&corners);
    assert!(flat <= report.faulty_faces + report.collapsed, "{report:?}");
    assert_eq!((report.flips, report.mirrored, report.overlaps), (0, 0, 0));
    assert_eq!(corners.len(), report.triangles);
    let area = area(&corners);
    assert!(
        (area - report.utilisation).abs() < 1e-6,
        "{area} {report:?}"
    );
    same_picture(input, &output);
    (report, after)
}

#[test]
fn shared_models_keep_their_looks() {
    let Some(folder) = assets() else { return };
    let folder = folder.join("gltf");
    for (path, name, stretch) in [
        ("Avocado/glTF/Avocado.gltf", "a.glb", 1.02),
        ("BoxTextured/glTF/BoxTextured.gltf", "a b.glb", 1.0001),
        ("BoxTextured/glTF-Binary/BoxTextured.glb", "a.gltf", 1.0001),
        ("BoxInterleaved/glTF/BoxInterleaved.gltf", "a.gltf", 1.0001),
        (
            "TriangleWithoutIndices/glTF/TriangleWithoutIndices.gltf",
            "a.glb",
            1.0001,
        ),
        ("VertexColorTest/glTF/VertexColorTest.gltf", "a.glb", 1.02),
        (
            "NormalTangentTest/glTF/NormalTangentTest.gltf",
            "a.glb",
            1.02,
        ),
    ] {
        let (report, after) = model(&folder.join(path), name);
        assert!(report.l2_stretch <= stretch, "{path}: {report:?}");
        // Written elsewhere, the file stands alone.
        let images = after.json["images"].as_array().into_iter().flatten();
        for image in images {
            assert!(image.get("uri").is_none() && image["mimeType"] == "image/png");
        }
    }
}

#[test]
fn the_showcase_keeps_its_looks() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/showcase.glb");
    let (report, _) = model(&path, "showcase.glb");
    assert!(
        report.l2_stretch < 1.03 && report.triangles > 1000,
        "{report:?}"
    );
}

#[test]
fn images_beside_the_file_stay_there() {
    let folder = tempfile::tempdir().unwrap();
    let mut glb = rich();
    std::fs::write(
        folder.path().join("pic ture.png"),
        crate::glb::png(1, 1, &[[9; 4]]),
    )
    .unwrap();
    glb.json["images"][0] = json!({ "uri": "pic%20ture.png", "name": "beside" });
    let input = glb.write(folder.path(), "in.glb");
    let inside = tempfile::tempdir().unwrap();
    let unwrapping = unwrap_file(&input, &UnwrapFile::default(), &|_| {}).unwrap();
    unwrapping.save(folder.path().join("out.glb")).unwrap();
    unwrapping.save(inside.path().join("out.glb")).unwrap();
    let beside = Raw::read(&folder.path().join("out.glb"));
    assert_eq!(beside.json["images"][0], glb.json["images"][0]);
    let inside = Raw::read(&inside.path().join("out.glb"));
    let image = &inside.json["images"][0];
    assert_eq!(
        (&image["mimeType"], &image["name"]),
        (&json!("image/png"), &json!("beside"))
    );
    assert_eq!(
        inside.view(&image["bufferView"]),
        crate::glb::png(1, 1, &[[9; 4]])
    );
}
