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

#[test]
fn environment_is_read_from_exr_as_from_hdr() {
    let folder = tempfile::tempdir().unwrap();
    let pixels: Vec<f32> = (0..64 * 32 * 3).map(|i| (i % 7) as f32).collect();
    let image = image::Rgb32FImage::from_raw(64, 32, pixels).unwrap();
    let found: Vec<Vec3> = ["sky.exr", "sky.hdr"]
        .iter()
        .map(|name| {
            let path = folder.path().join(name);
            image.save(&path).unwrap();
            let mut glb = Glb::new();
            let material = glb.push("materials", white());
            glb.quad(0.0, material);
            let settings = Settings {
                environment: EnvironmentSource::File(path),
                ..square(16)
            };
            glb.render(&settings).pixel(8, 8).lit
        })
        .collect();
    // HDR stores 8 bits a channel.
    assert!(
        ((found[0] - found[1]) / found[0]).abs().max_element() < 0.01,
        "{found:?}"
    );
    assert!(found[0].min_element() > 0.5);
}

#[test]
fn missing_normals_are_flat_per_triangle() {
    // A roof of two slopes without normals, under a light from straight above: each slope has one
    // brightness, that of its own tilt.
    let mut glb = Glb::new();
    let material = glb.push("materials", white());
    let positions = glb.floats(&[
        [-1.0, -1.0, 0.0],
        [0.0, -1.0, 0.5],
        [1.0, -1.0, 0.0],
        [-1.0, 1.0, 0.0],
        [0.0, 1.0, 0.5],
        [1.0, 1.0, 0.0],
    ]);
    let indices = glb.indices(&[0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4]);
    glb.mesh(json!({
        "attributes": { "POSITION": positions }, "indices": indices, "material": material,
    }));
    let turn = 0.2f32;
    glb.node(json!({
        "rotation": [0.0, turn.sin(), 0.0, turn.cos()],
        "extensions": { "KHR_lights_punctual": { "light": 0 } },
    }));
    glb.json["extensions"] =
        json!({ "KHR_lights_punctual": { "lights": [{ "type": "directional", "intensity": 3 }] } });
    let film = glb.render(&dark(32));
    let side = |x: u32| -> Vec<f32> { (1..31).map(|y| film.pixel(x, y).lit.x).collect() };
    for columns in [[2, 13], [18, 29]] {
        let all: Vec<f32> = columns.iter().flat_map(|&x| side(x)).collect();
        assert!(all.iter().all(|v| (v - all[0]).abs() < 1e-5), "{all:?}");
    }
    // The light comes from the right (+X): that slope is brighter, by the cosines of the tilts.
    let slope = |sign: f32| Vec3::new(0.5 * sign, 0.0, 1.0).normalize();
    let light = Vec3::new((2.0 * turn).sin(), 0.0, (2.0 * turn).cos());
    let ratio = film.pixel(24, 16).lit.x / film.pixel(8, 16).lit.x;
    let cosines = slope(1.0).dot(light) / slope(-1.0).dot(light);
    assert!((ratio / cosines - 1.0).abs() < 0.05, "{ratio} {cosines}");
}
