//! A heavy scene: a wall of balls, each of a material of its own, for timing. 199,680 triangles and 36 textures.

use glam::{IVec2, UVec2, Vec2, Vec3};
use serde_json::json;

use super::glb::{Document, Magnify, Wrap};
use super::mesh::Mesh;
use super::noise::{cells, fbm, random};
use super::paint::{mix, normals, rgb, step};

/// Balls in a row and in a column.
const BALLS: [u32; 2] = [4, 3];
/// Facets round a ball and from pole to pole: 16,640 triangles.
const FACETS: [u32; 2] = [128, 65];

/// `side`: of a texture, in texels.
pub(super) fn add(document: &mut Document, side: u32) {
    for number in 0..BALLS[0] * BALLS[1] {
        let place = Vec2::new((number % BALLS[0]) as f32, (number / BALLS[0]) as f32);
        let middle = (Vec2::new(BALLS[0] as f32, BALLS[1] as f32) - 1.0) * 0.5;
        let centre = ((place - middle) * 2.3).extend(0.0);
        let material = material(document, number, side);
        let ball = Mesh::sphere(Vec3::ZERO, 1.0, FACETS[0], FACETS[1]);
        let name = format!("ball {number}");
        let mesh = document.mesh(&name, &[(&ball, material)]);
        document.node(
            &name,
            json!({ "mesh": mesh, "translation": centre.to_array() }),
        );
    }
}

/// Glazed cells in mortar: another palette, size and gloss for each number.
fn material(document: &mut Document, number: u32, side: u32) -> usize {
    let seed = 100 + 10 * number;
    let size = UVec2::splat(side);
    let count = IVec2::splat(6 + 2 * (number % 5).cast_signed()) * IVec2::new(2, 1);
    let of = |k: i32| random(k, number.cast_signed(), seed);
    let (warm, cool) = (
        Vec3::new(0.35 + 0.6 * of(0), 0.25 + 0.4 * of(1), 0.15 + 0.3 * of(2)),
        Vec3::new(0.1 + 0.3 * of(3), 0.2 + 0.4 * of(4), 0.35 + 0.5 * of(5)),
    );
    let mortar = |st: Vec2| step(0.02, 0.07, cells(st, count, seed).border);
    let color = rgb(size, |st| {
        let glaze = mix(warm, cool, cells(st, count, seed).id);
        let grain = 0.8 + 0.4 * fbm(st, count * 2, 4, seed + 1);
        mix(Vec3::splat(0.32), glaze * grain, mortar(st))
    });
    let height = |st: Vec2| 0.008 * mortar(st) + 0.002 * fbm(st, count * 3, 3, seed + 2);
    let normal = normals(size, 1.0, height);
    let metal = if number.is_multiple_of(3) { 1.0 } else { 0.0 };
    let surface = rgb(size, |st| {
        let glaze = mortar(st);
        let rough = 0.75 - (0.35 + 0.3 * of(6)) * glaze + 0.15 * fbm(st, count, 3, seed + 3);
        Vec3::new(0.6 + 0.4 * glaze, rough, metal * glaze)
    });
    let mut texture = |name: &str, png: &[u8]| {
        let name = format!("{name} of ball {number}");
        document.texture(&name, png, [Wrap::Repeat; 2], Magnify::Linear)
    };
    let (color, normal, surface) = (
        texture("colour", &color),
        texture("normals", &normal),
        texture("surface", &surface),
    );
    document.material(
        &format!("glaze {number}"),
        json!({
            "pbrMetallicRoughness": {
                "baseColorTexture": { "index": color },
                "metallicRoughnessTexture": { "index": surface },
            },
            "normalTexture": { "index": normal },
            "occlusionTexture": { "index": surface },
        }),
    )
}
