//! Documents and settings that random mutation broke something with, each made again in code.

use serde_json::json;
use texrender::{EnvironmentSource, FinishOptions, LoadOptions, Settings, save};

use crate::glb::{Glb, square};

#[test]
fn an_image_without_a_mime_type_is_told_from_its_bytes() {
    let mut glb = Glb::new();
    let texture = glb.texture(1, 1, &[[255, 0, 0, 255]]);
    glb.json["images"][0]
        .as_object_mut()
        .unwrap()
        .remove("mimeType");
    let material = glb.unlit_texture(texture);
    glb.quad(0.0, material);
    let scene = glb.load();
    assert!(
        scene.warnings.iter().any(|w| w.contains("images[0]")),
        "{:?}",
        scene.warnings
    );
    assert_eq!(glb.render(&square(2)).pixel(0, 0).unlit, glam::Vec3::X);
}

#[test]
fn an_image_without_a_source_is_refused_by_name() {
    let mut glb = Glb::new();
    let texture = glb.texture(1, 1, &[[255; 4]]);
    glb.json["images"][0] = json!({ "mimeType": "image/png" });
    let material = glb.unlit_texture(texture);
    glb.quad(0.0, material);
    let error = glb.load_with(&LoadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("images[0]"), "{error}");
}

#[test]
fn radiance_beyond_an_hdr_file_is_held_at_its_ends() {
    // 2¹²⁶ brightened by 4 stops is infinite; 2⁻¹²⁶ darkened by 4 is below the least exponent.
    for (strength, exposure, low, high) in
        [(8.507e37, 4.0, 1e38, 2e38), (1.2e-38, -4.0, 0.0, 1e-37)]
    {
        let mut glb = Glb::new();
        let material = glb.push(
            "materials",
            json!({
                "emissiveFactor": [1, 1, 1],
                "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": strength } },
            }),
        );
        glb.quad(0.0, material);
        let film = glb.render(&Settings {
            environment: EnvironmentSource::None,
            ..square(2)
        });
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.hdr");
        let options = FinishOptions {
            exposure,
            ..FinishOptions::default()
        };
        save(&film, &path, &options, &[]).unwrap();
        let picture = image::open(&path).unwrap().into_rgb32f();
        let red = picture.get_pixel(0, 0)[0];
        assert!((low..=high).contains(&red), "{strength} {exposure}: {red}");
    }
}
