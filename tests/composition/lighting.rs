//! Light on materials, through the whole pipeline, against closed forms.

use std::f32::consts::PI;

use glam::Vec3;
use serde_json::json;
use texrender::{EnvironmentSource, Settings};

use crate::glb::{Glb, square};

fn dark(size: u32) -> Settings {
    Settings {
        environment: EnvironmentSource::None,
        ..square(size)
    }
}

/// A quad under one light; the camera looks straight at it.
fn lit_by(light: &serde_json::Value, node: &serde_json::Value, material: serde_json::Value) -> Glb {
    let mut glb = Glb::new();
    let material = glb.push("materials", material);
    glb.quad(0.0, material);
    let mut node = node.clone();
    node["extensions"] = json!({ "KHR_lights_punctual": { "light": 0 } });
    glb.node(node);
    glb.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [light] } });
    glb
}

fn white() -> serde_json::Value {
    json!({ "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 1 } })
}

#[test]
fn directional_light_head_on_is_the_closed_form() {
    // f = (1 − 0.04)/π + 0.04·D·V with D = 1/π and V = 1/4 at roughness 1.
    let glb = lit_by(
        &json!({ "type": "directional", "intensity": 3 }),
        &json!({}),
        white(),
    );
    let expected = 3.0 * (0.96 / PI + 0.04 / (4.0 * PI));
    let found = glb.render(&dark(16)).pixel(8, 8).lit;
    assert!(
        (found - expected).abs().max_element() < 1e-5,
        "{found} and {expected}"
    );
}

#[test]
fn point_light_obeys_the_inverse_square_through_node_transforms() {
    let at = |distance: f32| {
        let light = json!({ "type": "point", "intensity": 4, "color": [1, 0.5, 0] });
        let node = json!({ "translation": [0, 0, distance] });
        lit_by(&light, &node, white())
            .render(&dark(17))
            .pixel(8, 8)
            .lit
    };
    let (near, far) = (at(1.0), at(2.0));
    assert!((near / far - 4.0).x.abs() < 1e-3, "{near} {far}");
    assert!(
        (near.y / near.x - 0.5).abs() < 1e-5 && near.z == 0.0,
        "{near}"
    );
}

#[test]
fn emission_adds_and_its_strength_multiplies() {
    let mut material = white();
    material["emissiveFactor"] = json!([0.5, 0.25, 0]);
    material["extensions"] =
        json!({ "KHR_materials_emissive_strength": { "emissiveStrength": 8 } });
    let mut glb = Glb::new();
    let material = glb.push("materials", material);
    glb.quad(0.0, material);
    let found = glb.render(&dark(16)).pixel(8, 8).lit;
    assert!(
        (found - Vec3::new(4.0, 2.0, 0.0)).abs().max_element() < 1e-6,
        "{found}"
    );
}

#[test]
fn ior_and_specular_extensions_change_the_highlight() {
    let head_on = |extension: serde_json::Value| {
        let mut material = white();
        material["pbrMetallicRoughness"]["baseColorFactor"] = json!([0, 0, 0, 1]);
        material["extensions"] = extension;
        let light = json!({ "type": "directional", "intensity": 4.0 * PI * PI });
        // Black base: what is seen is F₀·D·V·E = F₀·(1/π)·¼·4π² = F₀·π.
        lit_by(&light, &json!({}), material)
            .render(&dark(16))
            .pixel(8, 8)
            .lit
            / PI
    };
    let close = |found: Vec3, expected: [f32; 3]| {
        assert!(
            (found - Vec3::from(expected)).abs().max_element() < 1e-4,
            "{found} {expected:?}"
        );
    };
    close(head_on(json!({})), [0.04; 3]);
    close(
        head_on(json!({ "KHR_materials_ior": { "ior": 2.0 } })),
        [1.0 / 9.0; 3],
    );
    close(
        head_on(json!({ "KHR_materials_specular": { "specularFactor": 0.5 } })),
        [0.02; 3],
    );
    close(
        head_on(json!({ "KHR_materials_specular": { "specularColorFactor": [1, 0.5, 0] } })),
        [0.04, 0.02, 0.0],
    );
}

#[test]
fn specular_glossiness_is_its_own_model() {
    let material = json!({
        "extensions": { "KHR_materials_pbrSpecularGlossiness": {
            "diffuseFactor": [0, 0, 0, 1], "specularFactor": [0.8, 0.4, 0.2], "glossinessFactor": 0,
        } },
    });
    let light = json!({ "type": "directional", "intensity": 4.0 * PI * PI });
    let found = lit_by(&light, &json!({}), material)
        .render(&dark(16))
        .pixel(8, 8)
        .lit
        / PI;
    assert!(
        (found - Vec3::new(0.8, 0.4, 0.2)).abs().max_element() < 1e-4,
        "{found}"
    );
}

#[test]
fn white_metal_in_constant_light_vanishes() {
    // The white furnace: an environment of radiance 1, reflected whole at any roughness.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("furnace.hdr");
    let file = std::fs::File::create(&path).unwrap();
    image::codecs::hdr::HdrEncoder::new(file)
        .encode(&[image::Rgb([1.0f32; 3]); 32 * 16], 32, 16)
        .unwrap();
    for roughness in [0.0, 0.1, 0.3, 0.5, 0.7, 1.0] {
        for metallic in [0.0, 1.0] {
            let mut glb = Glb::new();
            let material = glb.push(
                "materials",
                json!({ "pbrMetallicRoughness": { "metallicFactor": metallic, "roughnessFactor": roughness } }),
            );
            let node = glb.quad(0.0, material);
            glb.json["nodes"][node]["rotation"] = json!([0.0, 0.4, 0.0, 0.9]);
            let settings = Settings {
                environment: EnvironmentSource::File(path.clone()),
                ..square(16)
            };
            let found = glb.render(&settings).pixel(8, 8).lit;
            assert!(
                (found - 1.0).abs().max_element() < 0.01,
                "roughness {roughness}, metallic {metallic}: {found}"
            );
        }
    }
}

#[test]
fn occlusion_dims_the_surroundings_and_not_the_lamps() {
    let build = |strength: f32| {
        let mut glb = lit_by(
            &json!({ "type": "directional", "intensity": 1 }),
            &json!({}),
            white(),
        );
        let texture = glb.texture(1, 1, &[[0, 255, 255, 255]]);
        glb.json["materials"][0]["occlusionTexture"] =
            json!({ "index": texture, "strength": strength });
        glb
    };
    let lamp = build(1.0).render(&dark(16)).pixel(8, 8).lit.x;
    let [none, half, full] =
        [0.0, 0.5, 1.0].map(|s| build(s).render(&square(16)).pixel(8, 8).lit.x);
    assert!((full - lamp).abs() < 1e-6, "{full} {lamp}");
    assert!(
        (half - (none + full) / 2.0).abs() < 1e-5,
        "{none} {half} {full}"
    );
    assert!(none > full + 0.1);
}

#[test]
fn rotating_the_environment_and_the_view_together_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sky.hdr");
    let pixels: Vec<image::Rgb<f32>> = (0..64 * 32)
        .map(|i| image::Rgb([(i % 64) as f32 / 64.0, (i / 64) as f32 / 32.0, 0.3]))
        .collect();
    let file = std::fs::File::create(&path).unwrap();
    image::codecs::hdr::HdrEncoder::new(file)
        .encode(&pixels, 64, 32)
        .unwrap();
    let glb = Glb::new();
    let look = |turn: f64| {
        let angle = turn.to_radians();
        let settings = Settings {
            environment: EnvironmentSource::File(path.clone()),
            environment_rotation: turn as f32,
            background: texrender::Background::Environment,
            view: texrender::View::LookAt {
                eye: glam::DVec3::ZERO,
                // −Z turned counter-clockwise about Y.
                target: glam::DVec3::new(-angle.sin(), 0.0, -angle.cos()),
                fov_y_degrees: 40.0,
            },
            ..square(32)
        };
        glb.render(&settings)
    };
    let (plain, turned) = (look(0.0), look(70.0));
    for y in 0..32 {
        for x in 0..32 {
            let (a, b) = (plain.pixel(x, y).lit, turned.pixel(x, y).lit);
            assert!((a - b).abs().max_element() < 2e-3, "({x}, {y}): {a} {b}");
        }
    }
    // Looking along −Z the map's middle is seen, and s grows to the right.
    let (left, middle, right) = (
        plain.pixel(2, 16).lit,
        plain.pixel(16, 16).lit,
        plain.pixel(29, 16).lit,
    );
    assert!((middle.x - 0.5).abs() < 0.03 && left.x < middle.x && middle.x < right.x);
}
