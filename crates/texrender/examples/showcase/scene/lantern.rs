//! A paper lantern on an iron hook.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Mat3, UVec2, Vec2, Vec3};
use serde_json::json;

use super::glb::{Document, Magnify, Wrap};
use super::layout::{LANTERN, LANTERN_POST};
use super::materials;
use super::mesh::Mesh;
use super::paint::sin_cos;

/// Where the post begins to bend.
const TOP: f32 = 2.42;

pub(super) fn add(document: &mut Document, iron: usize) {
    let paper = materials::lantern(UVec2::splat(512));
    let paper = document.texture("lantern", &paper, [Wrap::Repeat; 2], Magnify::Linear);
    let shell = document.material(
        "paper lantern",
        json!({
            "pbrMetallicRoughness": {
                "baseColorTexture": { "index": paper }, "baseColorFactor": [0.55, 0.42, 0.30, 1.0],
                "metallicFactor": 0, "roughnessFactor": 0.8,
            },
            "emissiveTexture": { "index": paper },
            "emissiveFactor": [1.0, 0.62, 0.30],
            "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 1.8 } },
        }),
    );
    let post_mesh = document.mesh("post", &[(&post(), iron)]);
    document.node("post", json!({ "mesh": post_mesh }));
    let mut globe = Mesh::sphere(Vec3::ZERO, 1.0, 64, 32);
    globe.tangents.clear();
    let mesh = document.mesh("lantern", &[(&globe, shell)]);
    document.node(
        "lantern",
        json!({ "mesh": mesh, "translation": LANTERN.to_array(), "scale": [0.31, 0.25, 0.31] }),
    );
    let mesh = document.mesh("caps", &[(&caps(), iron)]);
    document.node(
        "caps",
        json!({ "mesh": mesh, "translation": LANTERN.to_array() }),
    );
}

/// Foot, post, hook, chain and a scroll in the bend.
fn post() -> Mesh {
    // A post that bends into a hook over the lantern.
    let reach = 0.5 * (LANTERN_POST.x - LANTERN.x);
    let mut path: Vec<Vec3> = (0..6)
        .map(|k| LANTERN_POST + Vec3::Y * (TOP * k as f32 / 5.0))
        .collect();
    for k in 1..=20 {
        let (sin, cos) = sin_cos(PI * k as f32 / 20.0);
        path.push(LANTERN_POST + Vec3::new(reach * (cos - 1.0), TOP + 0.30 * sin, 0.0));
    }
    let mut post = Mesh::tube(&path, 0.022, 12);
    let chain = [
        Vec3::new(LANTERN.x, TOP, LANTERN.z),
        Vec3::new(LANTERN.x, LANTERN.y + 0.26, LANTERN.z),
    ];
    post.add(&Mesh::tube(&chain, 0.008, 8));
    // A scroll in the bend.
    let scroll: Vec<Vec3> = (0..40)
        .map(|k| {
            let t = k as f32 / 39.0;
            let (sin, cos) = sin_cos(-FRAC_PI_2 + 2.6 * PI * t);
            let r = 0.17 * (1.0 - 0.75 * t);
            LANTERN_POST + Vec3::new(-0.02 - 0.17 + r * cos, TOP - 0.12 + r * sin, 0.0)
        })
        .collect();
    post.add(&Mesh::tube(&scroll, 0.012, 8));
    let foot = Mesh::turned(
        &[
            &[[0.22, 0.0], [0.22, 0.03]],
            &[
                [0.22, 0.03],
                [0.19, 0.045],
                [0.07, 0.07],
                [0.03, 0.13],
                [0.022, 0.2],
            ],
        ],
        32,
        Vec2::ONE,
    );
    post.add(&foot.placed(Mat3::IDENTITY, LANTERN_POST));
    post
}

/// The rings of wood that the paper is stretched between.
fn caps() -> Mesh {
    let mut caps = Mesh::turned(
        &[
            &[[0.10, 0.225], [0.12, 0.225], [0.12, 0.26]],
            &[[0.12, 0.26], [0.02, 0.285]],
        ],
        32,
        Vec2::ONE,
    );
    caps.add(&Mesh::turned(
        &[
            &[[0.0, -0.27], [0.10, -0.27]],
            &[[0.10, -0.27], [0.10, -0.225]],
        ],
        32,
        Vec2::ONE,
    ));
    caps
}
