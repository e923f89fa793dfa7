//! Shadows laid on floor and table as dark glass: the renderer casts none yet.
//!
//! Light comes from the left, where the studio has its key. What stands is taken as discs or boxes at
//! a few heights; the higher one is, the farther its shadow lies and the softer its edge.

use glam::{UVec2, Vec2, Vec4};

use super::layout::{
    CRATE, PLANTER, SPHERES, TABLE_HEIGHT, TABLE_RADIUS, TEAPOT, TEAPOT_SCALE, TOPIARIES, turn_2d,
};
use super::occlusion::Footprint;
use super::paint::{rgba, step};

/// Half the side of the square on the floor that is shaded.
pub(super) const FLOOR_HALF: f32 = 7.0;
/// Where the shadow of a point goes for each unit of its height, (x, z).
const CAST: Vec2 = Vec2::new(0.70, 0.10);
/// Growth of half a shadow's edge with height.
const SOFTNESS: f32 = 0.24;
/// Slices of a standing thing.
const SLICES: u8 = 8;
/// Radii of the teapot from foot to rim, in its own units, and their height.
const BELLY: [f32; 6] = [1.5, 1.9, 2.0, 1.9, 1.7, 1.45];
const RIM: f32 = 2.4;

/// The floor about the origin; the picture spans [`FLOOR_HALF`].
pub(super) fn floor(size: UVec2) -> Vec<u8> {
    rgba(size, |st| {
        let p = (st * 2.0 - 1.0) * FLOOR_HALF;
        let mut dark =
            disc(p, Vec2::ZERO, TABLE_RADIUS, TABLE_HEIGHT).max(disc(p, Vec2::ZERO, 0.55, 0.04));
        dark = dark.max(block(p, &CRATE)).max(block(p, &PLANTER));
        for at in TOPIARIES {
            let crown = disc(p, at, 0.42, 1.1);
            dark = dark
                .max(crown)
                .max(disc(p, at, 0.28, 0.2))
                .max(disc(p, at, 0.25, 0.04));
        }
        let border = (st.min(1.0 - st).min_element() * 16.0).min(1.0);
        shade(0.66 * dark * border)
    })
}

/// The table's top; the picture spans its radius.
pub(super) fn table(size: UVec2) -> Vec<u8> {
    rgba(size, |st| {
        let p = (st * 2.0 - 1.0) * TABLE_RADIUS;
        let teapot = Vec2::new(TEAPOT.x, TEAPOT.z);
        let mut dark = 0.0f32;
        for (k, radius) in (0u8..).zip(BELLY) {
            let height = 0.03 + f32::from(k) / 5.0 * RIM * TEAPOT_SCALE;
            dark = dark.max(disc(p, teapot, 0.97 * radius * TEAPOT_SCALE, height));
        }
        for (at, radius) in SPHERES {
            for share in [0.15f32, 0.5, 1.0, 1.5] {
                let slice = radius * (share * (2.0 - share)).sqrt();
                dark = dark.max(disc(p, at, 0.92 * slice, radius * share));
            }
        }
        shade(0.66 * dark)
    })
}

fn shade(alpha: f32) -> Vec4 {
    Vec4::new(0.0, 0.0, 0.0, alpha)
}

/// Shadow of a level disc.
fn disc(p: Vec2, at: Vec2, radius: f32, height: f32) -> f32 {
    edge((p - at - CAST * height).length() - radius, height)
}

/// Shadow of a box on the floor.
fn block(p: Vec2, footprint: &Footprint) -> f32 {
    (0..=SLICES)
        .map(|k| {
            let height = footprint.height * f32::from(k) / f32::from(SLICES);
            let local = turn_2d(p - footprint.centre - CAST * height, -footprint.yaw);
            let outside = local.abs() - footprint.half;
            let distance = outside.max(Vec2::ZERO).length() + outside.max_element().min(0.0);
            edge(distance, height)
        })
        .fold(0.0, f32::max)
}

/// 1 within, 0 outside, over an edge that widens with height.
fn edge(distance: f32, height: f32) -> f32 {
    let half = 0.035 + SOFTNESS * height;
    step(half, -half, distance)
}
