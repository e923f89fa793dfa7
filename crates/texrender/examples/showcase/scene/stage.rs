//! Camera, lights, floor, sky and mist.

use std::f32::consts::{FRAC_PI_4, TAU};

use glam::{UVec2, Vec2, Vec3, Vec4};
use serde_json::{Value, json};

use super::glb::{Document, Magnify, Wrap};
use super::layout::{EYE, FLOOR_PLAN, FOV_Y, LANTERN, TARGET, TEAPOT, aim};
use super::materials::{FLOOR_TILES, floor_color, floor_normal, floor_surface};
use super::mesh::Mesh;
use super::paint::sin_cos;
use super::{occlusion, shadow, sky};

/// Half the side of the floor, and the distance of the sky.
const FAR: f32 = 400.0;
/// Side of a floor tile.
const TILE: f32 = 0.52;

pub(super) fn camera_and_lights(document: &mut Document) {
    document.camera(
        "camera",
        json!({
            "type": "perspective",
            "perspective": { "yfov": FOV_Y, "aspectRatio": 16.0 / 9.0, "znear": 0.05, "zfar": 1000 },
        }),
        json!({ "translation": EYE.to_array(), "rotation": aim(EYE, TARGET).to_array() }),
    );
    document.light(
        "sun",
        json!({ "type": "directional", "color": [1.0, 0.86, 0.66], "intensity": 0.8 }),
        json!({ "rotation": aim(Vec3::new(0.6, 0.55, -0.65), Vec3::ZERO).to_array() }),
    );
    let lamp = Vec3::new(-3.0, 4.4, 1.9);
    document.light(
        "spot on the teapot",
        json!({
            "type": "spot", "color": [1.0, 0.95, 0.88], "intensity": 26.0, "range": 20.0,
            "spot": { "innerConeAngle": 0.14, "outerConeAngle": 0.40 },
        }),
        json!({ "translation": lamp.to_array(), "rotation": aim(lamp, TEAPOT + Vec3::Y * 0.4).to_array() }),
    );
    document.light(
        "candle",
        json!({ "type": "point", "color": [1.0, 0.55, 0.22], "intensity": 2.2, "range": 9.0 }),
        json!({ "translation": LANTERN.to_array() }),
    );
}

pub(super) fn floor(document: &mut Document) {
    let repeat = [Wrap::Repeat; 2];
    let size = UVec2::splat(512);
    let color = document.texture("floor colour", &floor_color(size), repeat, Magnify::Linear);
    let surface = document.texture(
        "floor surface",
        &floor_surface(size / 2),
        repeat,
        Magnify::Linear,
    );
    let normal = document.texture("floor normal", &floor_normal(size), repeat, Magnify::Linear);
    let shade = occlusion::floor(size);
    let shade = document.texture("floor occlusion", &shade, [Wrap::Clamp; 2], Magnify::Linear);
    // The mesh has 0..1 over the whole floor; tiles lie across the corner.
    let tiles = 2.0 * FAR / (TILE * FLOOR_TILES as f32);
    let laid = |texture: usize| {
        json!({ "index": texture, "extensions": { "KHR_texture_transform": {
            "scale": [tiles, tiles], "rotation": FRAC_PI_4, "offset": [0.13, 0.4],
        } } })
    };
    let floor = document.material(
        "floor",
        json!({
            "pbrMetallicRoughness": {
                "baseColorTexture": laid(color), "metallicRoughnessTexture": laid(surface),
            },
            "normalTexture": laid(normal),
            "occlusionTexture": { "index": shade, "texCoord": 1 },
        }),
    );
    let ground = Mesh::grid(8, 8, |at| {
        let p = (at * 2.0 - 1.0) * FAR;
        (
            Vec3::new(p.x, 0.0, -p.y),
            Vec3::Y,
            Vec2::new(at.x, 1.0 - at.y),
        )
    });
    let dark = document.shadow("floor shadow", &shadow::floor(size));
    let half = shadow::FLOOR_HALF;
    let veil = Mesh::quad(Vec3::Y * 0.003, Vec3::X * half, Vec3::NEG_Z * half);
    let parts = [(&ground.with_plan(FLOOR_PLAN), floor), (&veil, dark)];
    let mesh = document.mesh("floor", &parts);
    document.node("floor", json!({ "mesh": mesh }));
}

pub(super) fn sky(document: &mut Document) {
    let painted = sky::sky(UVec2::new(1024, 512));
    let painted = document.texture(
        "sky",
        &painted,
        [Wrap::Mirror, Wrap::Clamp],
        Magnify::Linear,
    );
    let material = document.material("sky", unlit(json!({
        "pbrMetallicRoughness": { "baseColorTexture": { "index": painted } }, "doubleSided": true,
    })));
    // Six pictures round the horizon, every other one mirrored; the first is ahead of the camera.
    let top = 0.222 * FAR;
    let bottom = -top * sky::GROUND / (1.0 - sky::GROUND);
    let mut screen = ring(0.9 * FAR, &[bottom, top]);
    for uv in &mut screen.uv {
        uv.x = uv.x * 6.0 + 0.5;
    }
    let mesh = document.mesh("sky", &[(&screen, material)]);
    document.node("sky", json!({ "mesh": mesh }));
    mist(document);
}

/// Veils of mist on the far floor: unlit, blended, densest at the horizon.
fn mist(document: &mut Document) {
    let material = document.material(
        "mist",
        unlit(json!({
            "alphaMode": "BLEND", "doubleSided": true,
            "pbrMetallicRoughness": { "metallicFactor": 0 },
        })),
    );
    let color = sky::HORIZON.to_array().map(|c| libm::powf(c, 2.2));
    for (radius, density) in [
        (16.0, 0.2),
        (28.0, 0.3),
        (50.0, 0.45),
        (90.0, 0.6),
        (170.0, 0.8),
        (300.0, 0.9),
    ] {
        let eye = EYE.y;
        let rows = [0.0, 0.35 * eye, 0.7 * eye, eye, 1.5 * eye, 2.6 * eye];
        let weights = [0.0, 0.25, 0.7, 1.0, 0.6, 0.0];
        let veil = ring(radius, &rows).with_colors(|p| {
            let row = rows.iter().position(|y| *y == p.y).unwrap_or(0);
            Vec4::new(color[0], color[1], color[2], density * weights[row])
        });
        let mesh = document.mesh("mist", &[(&veil, material)]);
        document.node("mist", json!({ "mesh": mesh }));
    }
}

fn unlit(mut material: Value) -> Value {
    material["extensions"] = json!({ "KHR_materials_unlit": {} });
    material
}

/// A wall round the origin, seen from inside: s grows to the right from straight ahead (−Z), t down.
fn ring(radius: f32, rows: &[f32]) -> Mesh {
    let last = rows.len() - 1;
    Mesh::grid(96, last as u32, |at| {
        let (sin, cos) = sin_cos(TAU * at.x);
        let inward = Vec3::new(-sin, 0.0, cos);
        let y = rows[(at.y * last as f32).round() as usize];
        (
            -inward * radius + Vec3::Y * y,
            inward,
            Vec2::new(at.x, 1.0 - at.y),
        )
    })
}
