//! What stands on the table: the teapot and three spheres.

use glam::{Mat3, UVec2, Vec3, Vec4};
use serde_json::json;

use super::glb::{Document, Magnify, Wrap};
use super::layout::{SPHERES, TABLE_HEIGHT, TEAPOT, TEAPOT_SCALE, TEAPOT_YAW, yaw};
use super::mesh::Mesh;
use super::paint::sin_cos;
use super::{ceramic, materials, teapot};

const REPEAT: [Wrap; 2] = [Wrap::Repeat; 2];
const CLAMP: [Wrap; 2] = [Wrap::Clamp; 2];

pub(super) fn add(document: &mut Document) {
    add_teapot(document);
    add_spheres(document);
}

fn add_teapot(document: &mut Document) {
    let big = UVec2::splat(1024);
    let small = UVec2::splat(512);
    let mut glazed = |name: &str, color: Vec<u8>, surface: Vec<u8>, wrap: [Wrap; 2]| {
        let color = document.texture(&format!("{name} colour"), &color, wrap, Magnify::Linear);
        let surface = document.texture(&format!("{name} surface"), &surface, wrap, Magnify::Linear);
        document.material(
            name,
            json!({
                "pbrMetallicRoughness": {
                    "baseColorTexture": { "index": color },
                    "metallicRoughnessTexture": { "index": surface },
                },
                "occlusionTexture": { "index": surface },
                "doubleSided": true,
            }),
        )
    };
    let wrap = [Wrap::Repeat, Wrap::Clamp];
    let vessel = glazed(
        "vessel",
        ceramic::vessel_color(big),
        ceramic::vessel_surface(small),
        wrap,
    );
    let limbs = glazed(
        "limbs",
        ceramic::limb_color(small),
        ceramic::limb_surface(small / 2),
        wrap,
    );
    let parts = (teapot::vessel(TEAPOT_SCALE), teapot::limbs(TEAPOT_SCALE));
    let mesh = document.mesh("teapot", &[(&parts.0, vessel), (&parts.1, limbs)]);
    document.node(
        "teapot",
        json!({
            "mesh": mesh, "translation": TEAPOT.to_array(), "rotation": yaw(TEAPOT_YAW).to_array(),
        }),
    );
}

fn add_spheres(document: &mut Document) {
    let size = UVec2::splat(512);
    let grounded = materials::grounded(UVec2::new(4, 64));
    let grounded = document.texture("grounded", &grounded, CLAMP, Magnify::Linear);
    let tiled = |texture: usize, s: f32, t: f32| json!({ "index": texture, "extensions": { "KHR_texture_transform": { "scale": [s, t] } } });

    let hammered = materials::hammered_normal(size / 2);
    let hammered = document.texture("hammered normal", &hammered, REPEAT, Magnify::Linear);
    let tarnish = materials::copper_surface(size / 2);
    let tarnish = document.texture("copper surface", &tarnish, REPEAT, Magnify::Linear);
    let copper = document.material(
        "hammered copper",
        json!({
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.86, 0.37, 0.20, 1.0],
                "metallicRoughnessTexture": tiled(tarnish, 2.0, 1.0),
            },
            "normalTexture": tiled(hammered, 2.0, 1.0),
            "occlusionTexture": { "index": grounded },
        }),
    );
    let scratched = materials::scratched_normal(size);
    let scratched = document.texture("scratched normal", &scratched, REPEAT, Magnify::Linear);
    let steel = document.material(
        "scratched steel",
        json!({
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.80, 0.81, 0.83, 1.0], "metallicFactor": 1, "roughnessFactor": 0.09,
            },
            "normalTexture": tiled(scratched, 3.0, 1.5),
            "occlusionTexture": { "index": grounded },
        }),
    );
    let plastic = document.material(
        "plastic",
        json!({
            "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 0.12 },
            "occlusionTexture": { "index": grounded },
        }),
    );
    let names = ["copper sphere", "steel sphere", "plastic sphere"];
    for (k, (at, radius)) in SPHERES.into_iter().enumerate() {
        let mut ball = Mesh::sphere(Vec3::ZERO, radius, 64, 32);
        match k {
            2 => {
                ball.tangents.clear();
                ball = ball.with_colors(|p| swirl(p / radius));
            }
            // Tangents of the copper are made by the reader.
            0 => ball.tangents.clear(),
            _ => {}
        }
        let material = [copper, steel, plastic][k];
        let mesh = document.mesh(names[k], &[(&ball, material)]);
        let place = Vec3::new(at.x, TABLE_HEIGHT + radius, at.y);
        document.node(
            names[k],
            json!({ "mesh": mesh, "translation": place.to_array() }),
        );
    }
}

/// Colours that run into each other, linear.
fn swirl(p: Vec3) -> Vec4 {
    let p = Mat3::from_cols(Vec3::X, Vec3::new(0.0, 0.8, 0.6), Vec3::new(0.0, -0.6, 0.8)) * p;
    let angle = libm::atan2f(p.z, p.x) + 2.2 * p.y;
    let palette = [
        Vec3::new(0.90, 0.10, 0.06),
        Vec3::new(0.95, 0.55, 0.05),
        Vec3::new(0.05, 0.45, 0.42),
    ];
    let color: Vec3 = (0u8..3)
        .map(|k| {
            let (_, cos) = sin_cos(angle - f32::from(k) * std::f32::consts::TAU / 3.0);
            palette[usize::from(k)] * (1.0 / 3.0 + 2.0 / 3.0 * cos).max(0.0)
        })
        .sum();
    color.extend(1.0)
}
