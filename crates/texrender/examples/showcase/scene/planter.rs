//! A planter of bricks with ivy on a trellis.

use glam::{UVec2, Vec2, Vec3};
use serde_json::json;

use super::glb::{Document, Magnify, Wrap};
use super::layout::{PLANTER, yaw};
use super::materials;
use super::mesh::Mesh;
use super::noise::random;
use super::paint::sin_cos;

const REPEAT: [Wrap; 2] = [Wrap::Repeat; 2];

pub(super) fn add(document: &mut Document, stone: usize, stem: usize) {
    let brick = brick(document);
    let bars = materials::trellis(UVec2::splat(256));
    let bars = document.texture("trellis", &bars, REPEAT, Magnify::Linear);
    let trellis = masked(document, "trellis", bars, 0.6);
    let leaf = materials::leaf(UVec2::splat(256));
    let leaf = document.texture("ivy", &leaf, [Wrap::Clamp; 2], Magnify::Linear);
    let leaf = masked(document, "ivy", leaf, 0.45);

    let (half, height) = (PLANTER.half, PLANTER.height);
    let box_half = Vec3::new(half.x, 0.5 * height, half.y);
    let body = Mesh::block(Vec3::Y * (0.5 * height), box_half, 0.62);
    let cap = Mesh::block(
        Vec3::Y * (height + 0.03),
        Vec3::new(half.x + 0.04, 0.03, half.y + 0.04),
        1.0,
    );
    let screen = screen(height);
    let (mut stems, leaves) = ivy(height);
    stems.add(&frame(height));
    let parts = [
        (&body, brick),
        (&cap, stone),
        (&screen, trellis),
        (&stems, stem),
        (&leaves, leaf),
    ];
    let mesh = document.mesh("planter", &parts);
    document.node(
        "planter",
        json!({
            "mesh": mesh, "translation": [PLANTER.centre.x, 0.0, PLANTER.centre.y],
            "rotation": yaw(PLANTER.yaw).to_array(),
        }),
    );
}

fn brick(document: &mut Document) -> usize {
    let size = UVec2::splat(512);
    let color = document.texture(
        "brick colour",
        &materials::brick_color(size),
        REPEAT,
        Magnify::Linear,
    );
    let normal = document.texture(
        "brick normal",
        &materials::brick_normal(size),
        REPEAT,
        Magnify::Linear,
    );
    document.material(
        "brick",
        json!({
            "pbrMetallicRoughness": {
                "baseColorTexture": { "index": color }, "metallicFactor": 0, "roughnessFactor": 0.9,
            },
            "normalTexture": { "index": normal },
        }),
    )
}

fn masked(document: &mut Document, name: &str, texture: usize, roughness: f64) -> usize {
    document.material(
        name,
        json!({
            "alphaMode": "MASK", "alphaCutoff": 0.5, "doubleSided": true,
            "pbrMetallicRoughness": {
                "baseColorTexture": { "index": texture }, "metallicFactor": 0, "roughnessFactor": roughness,
            },
        }),
    )
}

/// The trellis over a box of height `foot`.
fn screen(foot: f32) -> Mesh {
    let mut screen = Mesh::quad(
        Vec3::new(0.0, foot + 0.93, -0.06),
        Vec3::X * 0.82,
        Vec3::Y * 0.90,
    );
    for uv in &mut screen.uv {
        *uv *= Vec2::new(0.82, 0.90) * 3.2;
    }
    screen
}

/// Posts and rails about the trellis.
fn frame(foot: f32) -> Mesh {
    let mut frame = Mesh::default();
    for side in [-0.84, 0.84] {
        let post = Vec3::new(side, foot + 0.96, -0.06);
        frame.add(&Mesh::block(post, Vec3::new(0.03, 0.96, 0.03), 1.0));
    }
    for y in [0.08, 1.83] {
        let rail = Vec3::new(0.0, foot + y, -0.06);
        frame.add(&Mesh::block(rail, Vec3::new(0.84, 0.025, 0.025), 1.0));
    }
    frame
}

/// Vines that climb from `foot`, and their leaves.
fn ivy(foot: f32) -> (Mesh, Mesh) {
    let (mut stems, mut leaves) = (Mesh::default(), Mesh::default());
    for vine in 0..7 {
        let r = |seed| random(vine, 0, seed);
        let height = 0.75 + 1.15 * r(301);
        let root = -0.72 + 0.24 * vine as f32;
        let path: Vec<Vec3> = (0..24)
            .map(|k| {
                let y = k as f32 / 23.0;
                let sway = 0.16 * sin_cos(5.0 * y + 6.0 * r(302)).0 * (0.3 + y);
                Vec3::new(root + sway, foot + y * height, 0.03 * sin_cos(14.0 * y).0)
            })
            .collect();
        stems.add(&Mesh::tube(&path, 0.009, 6));
        let count = (height * 23.0) as i32;
        for k in 0..count {
            let r = |seed| random(vine, k, seed);
            let at = path[(k as f32 / count as f32 * 23.0) as usize];
            let side = if k % 2 == 0 { 1.0 } else { -1.0 };
            let offset = Vec3::new(
                side * (0.03 + 0.09 * r(311)),
                0.05 * (r(312) - 0.5),
                0.02 + 0.06 * r(313),
            );
            let hang = side * (0.3 + 1.1 * r(314));
            let size = (0.12 + 0.10 * r(315)) * (1.0 - 0.35 * k as f32 / count as f32);
            leaves.add(&leaf(at + offset, hang, r(316) - 0.3, size));
        }
    }
    // Over the edge of the box.
    for k in 0..26 {
        let r = |seed| random(k, 9, seed);
        let at = Vec3::new(
            -0.8 + 1.6 * r(321),
            foot + 0.07 - 0.13 * r(322),
            0.24 + 0.06 * r(323),
        );
        leaves.add(&leaf(at, 1.6 * (r(324) - 0.5), 0.5, 0.14 + 0.07 * r(325)));
    }
    (stems, leaves)
}

/// A leaf folded along its middle, hanging from `foot`, turned by `hang` and tipped forward by `tip`.
fn leaf(foot: Vec3, hang: f32, tip: f32, size: f32) -> Mesh {
    let (sin, cos) = sin_cos(hang);
    let (lean, level) = sin_cos(0.9 * tip);
    let down = Vec3::new(sin * level, -cos * level, lean);
    let right = Vec3::new(-cos, -sin, 0.0);
    let front = right.cross(down);
    Mesh::grid(2, 2, |at| {
        let across = at.x - 0.5;
        let fold = 0.35 * across.abs() - 0.25 * at.y * at.y;
        let position = foot + (right * across + down * at.y + front * fold) * size;
        let normal = (front - right * (0.5 * across) + down * (0.3 * at.y)).normalize();
        (position, normal, Vec2::new(at.x, 1.0 - at.y))
    })
}
