//! A crate with a picture on every side, its texels as large as stamps.

use glam::Vec3;
use serde_json::json;

use super::garden::plain;
use super::glb::{Document, Magnify, Wrap};
use super::layout::{CRATE, yaw};
use super::mesh::Mesh;
use super::picture;

pub(super) fn add(document: &mut Document) {
    let picture = picture::picture();
    let picture = document.texture("picture", &picture, [Wrap::Clamp; 2], Magnify::Nearest);
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
    let (frame, corners) = frame(half);
    let pictures = pictures(half);
    let parts = [
        (&core, boards),
        (&frame, boards),
        (&corners, brass),
        (&pictures, panel),
    ];
    let mesh = document.mesh("crate", &parts);
    document.node(
        "crate",
        json!({
            "mesh": mesh, "translation": [CRATE.centre.x, 0.0, CRATE.centre.y],
            "rotation": yaw(CRATE.yaw).to_array(),
        }),
    );
}

/// Twelve edges and eight corners.
fn frame(half: f32) -> (Mesh, Mesh) {
    let middle = Vec3::Y * half;
    let mut frame = Mesh::default();
    let mut corners = Mesh::default();
    for a in [-1.0, 1.0] {
        for b in [-1.0, 1.0] {
            let (at, long, thin) = (half - 0.04, half - 0.08, 0.04);
            frame.add(&Mesh::block(
                middle + Vec3::new(a * at, b * at, 0.0),
                Vec3::new(thin, thin, long),
                1.0,
            ));
            frame.add(&Mesh::block(
                middle + Vec3::new(a * at, 0.0, b * at),
                Vec3::new(thin, long, thin),
                1.0,
            ));
            frame.add(&Mesh::block(
                middle + Vec3::new(0.0, a * at, b * at),
                Vec3::new(long, thin, thin),
                1.0,
            ));
            for c in [-1.0, 1.0] {
                let corner = Vec3::new(a, b, c) * (half - 0.042);
                corners.add(&Mesh::block(
                    middle + corner + Vec3::Y * 0.004,
                    Vec3::splat(0.046),
                    1.0,
                ));
            }
        }
    }
    (frame, corners)
}

/// Sides and top.
fn pictures(half: f32) -> Mesh {
    let middle = Vec3::Y * half;
    let (out, side) = (half - 0.022, half - 0.08);
    let mut pictures = Mesh::default();
    for (right, up) in [
        (Vec3::X, Vec3::Y),
        (Vec3::NEG_X, Vec3::Y),
        (Vec3::NEG_Z, Vec3::Y),
        (Vec3::Z, Vec3::Y),
        (Vec3::X, Vec3::NEG_Z),
    ] {
        pictures.add(&Mesh::quad(
            middle + right.cross(up) * out,
            right * side,
            up * side,
        ));
    }
    pictures
}
