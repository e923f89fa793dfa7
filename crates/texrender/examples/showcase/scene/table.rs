//! A round table of turned wood.

use std::f32::consts::FRAC_PI_2;

use glam::{UVec2, Vec2};
use serde_json::json;

use super::glb::{Document, Magnify, Wrap};
use super::layout::{TABLE_HEIGHT, TABLE_RADIUS};
use super::mesh::Mesh;
use super::{materials, occlusion, shadow};

/// Materials of the table.
struct Wood {
    top: usize,
    edge: usize,
    turned: usize,
    shadow: usize,
}

pub(super) fn add(document: &mut Document) {
    let wood = wood(document);
    let (r, h) = (TABLE_RADIUS, TABLE_HEIGHT);
    let mut board = Mesh::turned(&[&[[r - 0.025, h], [0.6 * r, h], [0.0, h]]], 96, Vec2::ONE);
    for (uv, p) in board.uv.iter_mut().zip(&board.positions) {
        *uv = Vec2::new(p.x, p.z) / 1.5 + 0.37;
    }
    let board = board.with_plan(r);
    let mut veil = Mesh::turned(
        &[&[[r - 0.025, h + 0.002], [0.0, h + 0.002]]],
        96,
        Vec2::ONE,
    )
    .with_plan(r);
    veil.uv = std::mem::take(&mut veil.uv1);
    let parts = [
        (&board, wood.top),
        (&rim(r, h), wood.edge),
        (&foot(h), wood.turned),
        (&veil, wood.shadow),
    ];
    let mesh = document.mesh("table", &parts);
    document.node("table", json!({ "mesh": mesh }));
}

fn wood(document: &mut Document) -> Wood {
    let mirror = [Wrap::Mirror; 2];
    let size = UVec2::splat(512);
    let color = document.texture(
        "wood colour",
        &materials::wood_color(size),
        mirror,
        Magnify::Linear,
    );
    let normal = document.texture(
        "wood normal",
        &materials::wood_normal(size),
        mirror,
        Magnify::Linear,
    );
    let shade = occlusion::table(size / 2);
    let shade = document.texture("table occlusion", &shade, [Wrap::Clamp; 2], Magnify::Linear);
    let top = document.material(
        "table top",
        json!({
            "pbrMetallicRoughness": {
                "baseColorTexture": { "index": color }, "metallicFactor": 0, "roughnessFactor": 0.38,
            },
            "normalTexture": { "index": normal },
            "occlusionTexture": { "index": shade, "texCoord": 1 },
        }),
    );
    let edge = document.material(
        "table edge",
        json!({
            "pbrMetallicRoughness": {
                "baseColorTexture": { "index": color }, "metallicFactor": 0, "roughnessFactor": 0.38,
            },
            "normalTexture": { "index": normal },
        }),
    );
    // Once round the foot is the width of one board, grain upright.
    let upright = |texture: usize| {
        json!({ "index": texture, "extensions": { "KHR_texture_transform": {
            "scale": [0.2, 1.0], "rotation": FRAC_PI_2, "offset": [0.0, 0.23],
        } } })
    };
    let turned = document.material(
        "turned wood",
        json!({
            "pbrMetallicRoughness": {
                "baseColorTexture": upright(color), "metallicFactor": 0, "roughnessFactor": 0.4,
                "baseColorFactor": [0.8, 0.76, 0.74, 1.0],
            },
            "normalTexture": upright(normal),
        }),
    );
    let shadow = document.shadow("table shadow", &shadow::table(size / 2));
    Wood {
        top,
        edge,
        turned,
        shadow,
    }
}

/// The moulding of a board of radius `r` at height `h`.
fn rim(r: f32, h: f32) -> Mesh {
    Mesh::turned(
        &[
            &[[0.3, h - 0.085], [r - 0.06, h - 0.085]],
            &[
                [r - 0.06, h - 0.085],
                [r - 0.02, h - 0.07],
                [r - 0.02, h - 0.055],
            ],
            &[
                [r - 0.02, h - 0.055],
                [r + 0.012, h - 0.04],
                [r + 0.016, h - 0.02],
                [r, h - 0.006],
                [r - 0.025, h],
            ],
        ],
        96,
        Vec2::new(0.16, 1.0),
    )
}

/// The foot under a board at height `h`.
fn foot(h: f32) -> Mesh {
    Mesh::turned(
        &[
            &[[0.55, 0.0], [0.56, 0.03], [0.53, 0.07]],
            &[
                [0.53, 0.07],
                [0.40, 0.085],
                [0.26, 0.14],
                [0.18, 0.22],
                [0.15, 0.30],
            ],
            &[[0.15, 0.30], [0.19, 0.325], [0.19, 0.355], [0.15, 0.38]],
            &[
                [0.15, 0.38],
                [0.21, 0.44],
                [0.225, 0.51],
                [0.18, 0.60],
                [0.13, 0.66],
                [0.14, 0.70],
            ],
            &[[0.14, 0.70], [0.28, 0.73], [0.40, h - 0.085]],
        ],
        48,
        Vec2::ONE,
    )
}
