//! What stands round the table: planter, ivy, crate, lantern, glass, clipped trees.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Mat3, UVec2, Vec2, Vec3};
use serde_json::json;

use super::glb::{Document, Magnify, Wrap};
use super::layout::{CRATE, LANTERN, LANTERN_POST, PANES, PLANTER, TOPIARIES, yaw};
use super::materials;
use super::mesh::Mesh;
use super::noise::random;
use super::paint::sin_cos;

const REPEAT: [Wrap; 2] = [Wrap::Repeat; 2];
const CLAMP: [Wrap; 2] = [Wrap::Clamp; 2];

pub(super) fn add(document: &mut Document) {
    let stone = plain(document, "stone", [0.62, 0.57, 0.50], 0.85);
    let iron = plain(document, "iron", [0.045, 0.045, 0.05], 0.42);
    let stem = plain(document, "stem", [0.16, 0.10, 0.06], 0.9);
    planter(document, stone, stem);
    a_crate(document);
    lantern(document, iron);
    panes(document, stone);
    topiaries(document, stem);
}

fn plain(document: &mut Document, name: &str, [r, g, b]: [f64; 3], roughness: f64) -> usize {
    document.material(
        name,
        json!({ "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0, "roughnessFactor": roughness,
        } }),
    )
}

fn planter(document: &mut Document, stone: usize, stem: usize) {
    let size = UVec2::splat(512);
    let color = document.texture("brick colour", &materials::brick_color(size), REPEAT, Magnify::Linear);
    let normal = document.texture("brick normal", &materials::brick_normal(size), REPEAT, Magnify::Linear);
    let brick = document.material(
        "brick",
        json!({
            "pbrMetallicRoughness": {
                "baseColorTexture": { "index": color }, "metallicFactor": 0, "roughnessFactor": 0.9,
            },
            "normalTexture": { "index": normal },
        }),
    );
    let bars = materials::trellis(UVec2::splat(256));
    let bars = document.texture("trellis", &bars, REPEAT, Magnify::Linear);
    let trellis = masked(document, "trellis", bars, 0.6);
    let leaf = materials::leaf(UVec2::splat(256));
    let leaf = document.texture("ivy", &leaf, CLAMP, Magnify::Linear);
    let leaf = masked(document, "ivy", leaf, 0.45);

    let (half, height) = (PLANTER.half, PLANTER.height);
    let box_half = Vec3::new(half.x, 0.5 * height, half.y);
    let body = Mesh::block(Vec3::Y * (0.5 * height), box_half, 0.62);
    let cap = Mesh::block(
        Vec3::Y * (height + 0.03),
        Vec3::new(half.x + 0.04, 0.03, half.y + 0.04),
        1.0,
    );
    let mut screen = Mesh::quad(Vec3::new(0.0, height + 0.93, -0.06), Vec3::X * 0.82, Vec3::Y * 0.90);
    for uv in &mut screen.uv {
        *uv *= Vec2::new(0.82, 0.90) * 3.2;
    }
    let (stems, leaves) = ivy(height);
    let parts = [(&body, brick), (&cap, stone), (&screen, trellis), (&stems, stem), (&leaves, leaf)];
    let mesh = document.mesh("planter", &parts);
    document.node(
        "planter",
        json!({
            "mesh": mesh, "translation": [PLANTER.centre.x, 0.0, PLANTER.centre.y],
            "rotation": yaw(PLANTER.yaw).to_array(),
        }),
    );
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
            let offset = Vec3::new(side * (0.03 + 0.09 * r(311)), 0.05 * (r(312) - 0.5), 0.02 + 0.06 * r(313));
            let hang = side * (0.3 + 1.1 * r(314));
            let size = (0.12 + 0.10 * r(315)) * (1.0 - 0.35 * k as f32 / count as f32);
            leaves.add(&leaf(at + offset, hang, r(316) - 0.3, size));
        }
    }
    // Over the edge of the box.
    for k in 0..26 {
        let r = |seed| random(k, 9, seed);
        let at = Vec3::new(-0.8 + 1.6 * r(321), foot + 0.07 - 0.13 * r(322), 0.24 + 0.06 * r(323));
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

fn a_crate(document: &mut Document) {
    let picture = materials::picture();
    let picture = document.texture("picture", &picture, CLAMP, Magnify::Nearest);
    let panel = document.material(
        "picture",
        json!({ "pbrMetallicRoughness": {
            "baseColorTexture": { "index": picture }, "metallicFactor": 0, "roughnessFactor": 0.35,
        } }),
    );
    let boards = plain(document, "painted wood", [0.20, 0.055, 0.045], 0.5);
    let brass = document.material(
        "brass",
        json!({ "pbrMetallicRoughness": {
            "baseColorFactor": [0.89, 0.69, 0.36, 1.0], "metallicFactor": 1, "roughnessFactor": 0.3,
        } }),
    );
    let half = CRATE.half.x;
    let middle = Vec3::Y * half;
    let core = Mesh::block(middle, Vec3::splat(half - 0.03), 1.0);
    let mut frame = Mesh::default();
    let mut corners = Mesh::default();
    // Twelve edges, eight corners.
    for a in [-1.0, 1.0] {
        for b in [-1.0, 1.0] {
            let (at, long, thin) = (half - 0.04, half - 0.08, 0.04);
            frame.add(&Mesh::block(middle + Vec3::new(a * at, b * at, 0.0), Vec3::new(thin, thin, long), 1.0));
            frame.add(&Mesh::block(middle + Vec3::new(a * at, 0.0, b * at), Vec3::new(thin, long, thin), 1.0));
            frame.add(&Mesh::block(middle + Vec3::new(0.0, a * at, b * at), Vec3::new(long, thin, thin), 1.0));
            for c in [-1.0, 1.0] {
                let corner = Vec3::new(a, b, c) * (half - 0.042);
                corners.add(&Mesh::block(middle + corner + Vec3::Y * 0.004, Vec3::splat(0.046), 1.0));
            }
        }
    }
    let (out, side) = (half - 0.022, half - 0.08);
    let mut pictures = Mesh::default();
    for (right, up) in [(Vec3::X, Vec3::Y), (Vec3::NEG_X, Vec3::Y), (Vec3::NEG_Z, Vec3::Y), (Vec3::Z, Vec3::Y), (Vec3::X, Vec3::NEG_Z)] {
        pictures.add(&Mesh::quad(middle + right.cross(up) * out, right * side, up * side));
    }
    let parts = [(&core, boards), (&frame, boards), (&corners, brass), (&pictures, panel)];
    let mesh = document.mesh("crate", &parts);
    document.node(
        "crate",
        json!({
            "mesh": mesh, "translation": [CRATE.centre.x, 0.0, CRATE.centre.y],
            "rotation": yaw(CRATE.yaw).to_array(),
        }),
    );
}

fn lantern(document: &mut Document, iron: usize) {
    // A post that bends into a hook over the lantern.
    let reach = 0.5 * (LANTERN_POST.x - LANTERN.x);
    let top = 2.42;
    let mut path: Vec<Vec3> = (0..6).map(|k| LANTERN_POST + Vec3::Y * (top * k as f32 / 5.0)).collect();
    for k in 1..=20 {
        let (sin, cos) = sin_cos(PI * k as f32 / 20.0);
        path.push(LANTERN_POST + Vec3::new(reach * (cos - 1.0), top + 0.30 * sin, 0.0));
    }
    let mut post = Mesh::tube(&path, 0.022, 12);
    let chain = [Vec3::new(LANTERN.x, top, LANTERN.z), Vec3::new(LANTERN.x, LANTERN.y + 0.26, LANTERN.z)];
    post.add(&Mesh::tube(&chain, 0.008, 8));
    // A scroll in the bend.
    let scroll: Vec<Vec3> = (0..40)
        .map(|k| {
            let t = k as f32 / 39.0;
            let (sin, cos) = sin_cos(-FRAC_PI_2 + 2.6 * PI * t);
            let r = 0.17 * (1.0 - 0.75 * t);
            LANTERN_POST + Vec3::new(-0.02 - 0.17 + r * cos, top - 0.12 + r * sin, 0.0)
        })
        .collect();
    post.add(&Mesh::tube(&scroll, 0.012, 8));
    let foot = Mesh::turned(
        &[&[[0.22, 0.0], [0.22, 0.03]], &[[0.22, 0.03], [0.19, 0.045], [0.07, 0.07], [0.03, 0.13], [0.022, 0.2]]],
        32,
        Vec2::ONE,
    );
    post.add(&foot.placed(Mat3::IDENTITY, LANTERN_POST));

    let paper = materials::lantern(UVec2::splat(512));
    let paper = document.texture("lantern", &paper, REPEAT, Magnify::Linear);
    let shell = document.material(
        "paper lantern",
        json!({
            "pbrMetallicRoughness": {
                "baseColorTexture": { "index": paper }, "baseColorFactor": [0.55, 0.42, 0.30, 1.0],
                "metallicFactor": 0, "roughnessFactor": 0.8,
            },
            "emissiveTexture": { "index": paper },
            "emissiveFactor": [1.0, 0.62, 0.30],
            "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 1.5 } },
        }),
    );
    let mut caps = Mesh::turned(&[&[[0.10, 0.225], [0.12, 0.225], [0.12, 0.26]], &[[0.12, 0.26], [0.02, 0.285]]], 32, Vec2::ONE);
    caps.add(&Mesh::turned(&[&[[0.0, -0.27], [0.10, -0.27]], &[[0.10, -0.27], [0.10, -0.225]]], 32, Vec2::ONE));
    let post_mesh = document.mesh("post", &[(&post, iron)]);
    document.node("post", json!({ "mesh": post_mesh }));
    let mut globe = Mesh::sphere(Vec3::ZERO, 1.0, 64, 32);
    globe.tangents.clear();
    let mesh = document.mesh("lantern", &[(&globe, shell)]);
    document.node(
        "lantern",
        json!({ "mesh": mesh, "translation": LANTERN.to_array(), "scale": [0.31, 0.25, 0.31] }),
    );
    let mesh = document.mesh("caps", &[(&caps, iron)]);
    document.node("caps", json!({ "mesh": mesh, "translation": LANTERN.to_array() }));
}

fn panes(document: &mut Document, stone: usize) {
    let palettes = [
        [[0.16, 0.50, 0.62], [0.30, 0.70, 0.72], [0.20, 0.36, 0.66], [0.60, 0.82, 0.78]],
        [[0.92, 0.50, 0.16], [0.86, 0.28, 0.20], [0.96, 0.74, 0.30], [0.70, 0.20, 0.34]],
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
        let sheet = Mesh::quad(Vec3::Y * (half + 0.08), Vec3::X * pane.half.x, Vec3::Y * half);
        let sill = Mesh::block(Vec3::Y * 0.04, Vec3::new(pane.half.x + 0.03, 0.04, 0.05), 1.0);
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

fn topiaries(document: &mut Document, stem: usize) {
    let size = UVec2::splat(256);
    let color = document.texture("foliage colour", &materials::foliage(size), REPEAT, Magnify::Linear);
    let normal = document.texture("foliage normal", &materials::foliage_normal(size), REPEAT, Magnify::Linear);
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
    let mut crown = Mesh::sphere(Vec3::Y * 1.12, 0.44, 40, 24);
    crown.tangents.clear();
    for (p, uv) in crown.positions.iter_mut().zip(&mut crown.uv) {
        let bump = super::noise::noise(*uv, glam::IVec2::splat(11), 501) - 0.5;
        *p += (*p - Vec3::Y * 1.12) * (0.12 * bump);
        *uv *= Vec2::new(2.0, 1.0);
    }
    let mesh = document.mesh("topiary", &[(&pot, clay), (&trunk, stem), (&crown, foliage)]);
    for (k, at) in (0u8..).zip(TOPIARIES) {
        let place = [at.x, 0.0, at.y];
        document.node(
            "topiary",
            json!({ "mesh": mesh, "translation": place, "rotation": yaw(f32::from(k) * 1.7).to_array() }),
        );
    }
}
