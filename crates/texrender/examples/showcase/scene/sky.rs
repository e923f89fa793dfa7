//! The view from the terrace: a morning sky over mountains in mist.

use glam::{IVec2, UVec2, Vec2, Vec3};

use super::noise::{fbm, noise};
use super::paint::{mix, rgb, step};

/// Share of the picture below the horizon.
pub(super) const GROUND: f32 = 0.06;

const ZENITH: Vec3 = Vec3::new(0.36, 0.60, 0.84);
const MIDDLE: Vec3 = Vec3::new(0.66, 0.82, 0.92);
pub(super) const HORIZON: Vec3 = Vec3::new(0.99, 0.88, 0.74);
const SUN: Vec2 = Vec2::new(0.685, 0.21);

/// s round the horizon, t from the top of the sky down.
pub(super) fn sky(size: UVec2) -> Vec<u8> {
    rgb(size, |st| {
        let height = (1.0 - st.y - GROUND) / (1.0 - GROUND);
        let mut color = air(st, height);
        for (k, ridge) in RIDGES.iter().enumerate() {
            let far = k as f32 / (RIDGES.len() - 1) as f32;
            let top = ridge_height(st.x, ridge);
            let rock = mix(Vec3::new(0.60, 0.70, 0.84), Vec3::new(0.25, 0.42, 0.48), far);
            let lit = mix(rock, HORIZON, 0.35 * glow(st, 0.5));
            // Mist lies in the valleys.
            let misty = mix(HORIZON * 0.98, lit, step(-0.02, 0.9, height / ridge.top));
            color = mix(color, misty, step(-0.0012, 0.0012, top - height));
        }
        color
    })
}

struct Ridge {
    top: f32,
    rough: f32,
    cells: i32,
    seed: u32,
}

const RIDGES: [Ridge; 4] = [
    Ridge { top: 0.40, rough: 0.24, cells: 5, seed: 201 },
    Ridge { top: 0.29, rough: 0.18, cells: 6, seed: 219 },
    Ridge { top: 0.20, rough: 0.13, cells: 8, seed: 233 },
    Ridge { top: 0.12, rough: 0.07, cells: 11, seed: 247 },
];

fn ridge_height(s: f32, ridge: &Ridge) -> f32 {
    let at = |s: f32| fbm(Vec2::new(s, 0.0), IVec2::new(ridge.cells, 1), 6, ridge.seed);
    // Creases make peaks of the noise's hills.
    let crease = 1.0 - 2.0 * (at(s) - 0.5).abs() * 1.6;
    ridge.top - ridge.rough + ridge.rough * crease
}

fn air(st: Vec2, height: f32) -> Vec3 {
    let low = mix(HORIZON, MIDDLE, step(0.05, 0.5, height));
    let clear = mix(low, ZENITH, step(0.35, 1.0, height));
    let warm = mix(clear, Vec3::new(1.0, 0.95, 0.82), 0.75 * glow(st, 0.28));
    // Long thin clouds, lit from below.
    let stretched = fbm(st, IVec2::new(4, 14), 5, 261);
    let cover = step(0.52, 0.74, stretched) * step(0.2, 0.45, height);
    let edge = noise(st, IVec2::new(6, 30), 267);
    mix(warm, Vec3::new(1.0, 0.965, 0.92), cover * (0.55 + 0.25 * edge))
}

/// 1 in the sun, falling to 0 at `reach`.
fn glow(st: Vec2, reach: f32) -> f32 {
    let d = ((st - Vec2::new(SUN.x, 1.0 - GROUND - SUN.y)) * Vec2::new(1.0, 0.4)).length();
    let fall = step(reach, 0.0, d);
    fall * fall
}
