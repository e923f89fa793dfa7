//! What stands round the table.

use glam::{UVec2, Vec2, Vec3};
use serde_json::json;

use super::glb::{Document, Magnify, Wrap};
use super::layout::{PANES, TOPIARIES, yaw};
use super::mesh::Mesh;
use super::{chest, lantern, materials, planter};

const REPEAT: [Wrap; 2] = [Wrap::Repeat; 2];
const CLAMP: [Wrap; 2] = [Wrap::Clamp; 2];

pub(super) fn add(document: &mut Document) {
    let stone = plain(document, "stone", [0.62, 0.57, 0.50], 0.85);
    let iron = plain(document, "iron", [0.045, 0.045, 0.05], 0.42);
    let stem = plain(document, "stem", [0.16, 0.10, 0.06], 0.9);
    planter::add(document, stone, stem);
    chest::add(document);
    lantern::add(document, iron);
    panes(document, stone);
    topiaries(document, stem);
}

/// A dielectric of one linear colour.
pub(super) fn plain(
    document: &mut Document,
    name: &str,
    [r, g, b]: [f64; 3],
    roughness: f64,
) -> usize {
    document.material(
        name,
        json!({ "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0, "roughnessFactor": roughness,
        } }),
    )
}

/// Two panes of stained glass that cross.
fn panes(document: &mut Document, stone: usize) {
    let palettes = [
        [
            [0.16, 0.50, 0.62],
            [0.30, 0.70, 0.72],
            [0.20, 0.36, 0.66],
            [0.60, 0.82, 0.78],
        ],
        [
            [0.92, 0.50, 0.16],
            [0.86, 0.28, 0.20],
            [0.96, 0.74, 0.30],
            [0.70, 0.20, 0.34],
        ],
    ];
    for (k, (pane, palette)) in PANES.iter().zip(palettes).enumerate() {
        let name = ["cool pane", "warm pane"][k];
        let size = UVec2::new(256, 384);
        let glass = materials::glass(size, palette.map(Vec3::from), 401 + 10 * k as u32);
        let glass = document.texture(name, &glass, CLAMP, Magnify::Linear);
        let material = document.material(
            name,
            json!({
                "alphaMode": "BLEND", "doubleSided": true,
                "pbrMetallicRoughness": {
                    "baseColorTexture": { "index": glass }, "metallicFactor": 0, "roughnessFactor": 0.08,
                },
            }),
        );
        let half = 0.5 * pane.height - 0.04;
        let sheet = Mesh::quad(
            Vec3::Y * (half + 0.08),
            Vec3::X * pane.half.x,
            Vec3::Y * half,
        );
        let sill = Mesh::block(
            Vec3::Y * 0.04,
            Vec3::new(pane.half.x + 0.03, 0.04, 0.05),
            1.0,
        );
        let mesh = document.mesh(name, &[(&sill, stone), (&sheet, material)]);
        document.node(
            name,
            json!({
                "mesh": mesh, "translation": [pane.centre.x, 0.0, pane.centre.y],
                "rotation": yaw(pane.yaw).to_array(),
            }),
        );
    }
}

/// An avenue of clipped trees in pots.
fn topiaries(document: &mut Document, stem: usize) {
    let size = UVec2::splat(256);
    let color = document.texture(
        "foliage colour",
        &materials::foliage(size),
        REPEAT,
        Magnify::Linear,
    );
    let normal = document.texture(
        "foliage normal",
        &materials::foliage_normal(size),
        REPEAT,
        Magnify::Linear,
    );
    let foliage = document.material(
        "foliage",
        json!({
            "pbrMetallicRoughness": {
                "baseColorTexture": { "index": color }, "metallicFactor": 0, "roughnessFactor": 0.8,
            },
            "normalTexture": { "index": normal },
        }),
    );
    let clay = plain(document, "terracotta", [0.52, 0.22, 0.12], 0.8);
    let pot = Mesh::turned(
        &[
            &[[0.0, 0.0], [0.22, 0.0]],
            &[[0.22, 0.0], [0.27, 0.15], [0.30, 0.34]],
            &[[0.33, 0.34], [0.345, 0.37], [0.33, 0.41]],
            &[[0.33, 0.41], [0.0, 0.39]],
        ],
        32,
        Vec2::ONE,
    );
    let trunk = Mesh::tube(&[Vec3::Y * 0.35, Vec3::Y * 0.8], 0.035, 10);
    let mut crown = Mesh::sphere(Vec3::Y * 1.12, 0.44, 32, 18);
    crown.tangents.clear();
    for (p, uv) in crown.positions.iter_mut().zip(&mut crown.uv) {
        let bump = super::noise::noise(*uv, glam::IVec2::splat(11), 501) - 0.5;
        *p += (*p - Vec3::Y * 1.12) * (0.12 * bump);
        *uv *= Vec2::new(2.0, 1.0);
    }
    let mesh = document.mesh(
        "topiary",
        &[(&pot, clay), (&trunk, stem), (&crown, foliage)],
    );
    for (k, at) in (0u8..).zip(TOPIARIES) {
        let place = [at.x, 0.0, at.y];
        document.node(
            "topiary",
            json!({ "mesh": mesh, "translation": place, "rotation": yaw(f32::from(k) * 1.7).to_array() }),
        );
    }
}
