//! The teapot's glaze: cobalt brushed on white, bands of gold.
//!
//! x runs round the vessel, 0..`AROUND` a tile and two tiles a turn; y climbs the profile, 0..`HEIGHT`.

use std::f32::consts::{PI, TAU};

use glam::{IVec2, UVec2, Vec2, Vec3};

use super::noise::{fbm, noise};
use super::paint::{band, mix, rgb, sin_cos, step};

/// Lengths of the tile in units of Newell's teapot.
const AROUND: f32 = TAU;
pub(super) const HEIGHT: f32 = 5.35;
/// Heights on the profile where one ring of patches meets the next.
pub(super) const RINGS: [f32; 7] = [0.0, 0.4, 1.35, 2.95, 3.25, 4.45, 5.35];

const WHITE: Vec3 = Vec3::new(0.945, 0.93, 0.885);
const WASH: Vec3 = Vec3::new(0.36, 0.53, 0.82);
const COBALT: Vec3 = Vec3::new(0.06, 0.13, 0.45);
const CORAL: Vec3 = Vec3::new(0.87, 0.36, 0.22);
const GOLD: Vec3 = Vec3::new(0.95, 0.72, 0.36);

/// What the brush left at a place, each 0..1.
#[derive(Clone, Copy, Default)]
struct Paint {
    cobalt: f32,
    coral: f32,
    gold: f32,
}

impl Paint {
    fn cobalt(&mut self, density: f32) {
        self.cobalt = self.cobalt.max(density);
    }
}

/// Base colour of the vessel.
pub(super) fn vessel_color(size: UVec2) -> Vec<u8> {
    rgb(size, |st| color(st, vessel(st)))
}

/// Occlusion, roughness, metal of the vessel.
pub(super) fn vessel_surface(size: UVec2) -> Vec<u8> {
    rgb(size, |st| {
        let y = (1.0 - st.y) * HEIGHT;
        // Under the belly, in the groove of the lid, under the knob.
        let shade = 1.0
            - 0.75 * step(1.25, 0.35, y)
            - 0.45 * band(y, 3.27, 0.03, 0.12)
            - 0.25 * band(y, 4.45, 0.03, 0.2);
        surface(st, vessel(st), shade)
    })
}

/// Base colour of spout and handle: s round the limb, t along it from the body.
pub(super) fn limb_color(size: UVec2) -> Vec<u8> {
    rgb(size, |st| color(st, limb(st)))
}

/// Occlusion, roughness, metal of spout and handle.
pub(super) fn limb_surface(size: UVec2) -> Vec<u8> {
    rgb(size, |st| {
        surface(st, limb(st), 1.0 - 0.45 * step(0.3, 0.0, st.y))
    })
}

fn color(st: Vec2, paint: Paint) -> Vec3 {
    let pooled = fbm(st, IVec2::splat(12), 3, 5);
    let glaze = WHITE * (0.985 + 0.03 * noise(st, IVec2::splat(6), 3));
    // The brush leaves more where the glaze pools.
    let density = (paint.cobalt * (0.72 + 0.56 * pooled)).clamp(0.0, 1.0);
    let washed = mix(glaze, WASH, step(0.0, 0.45, density));
    let painted = mix(washed, COBALT, step(0.3, 0.95, density));
    let blushed = mix(painted, CORAL, paint.coral * (0.75 + 0.4 * pooled).min(1.0));
    mix(blushed, GOLD * (0.93 + 0.1 * pooled), paint.gold)
}

fn surface(st: Vec2, paint: Paint, shade: f32) -> Vec3 {
    let wear = fbm(st, IVec2::splat(9), 4, 21);
    let glaze = 0.10 + 0.13 * wear + 0.12 * paint.cobalt;
    let gold = 0.16 + 0.22 * wear;
    Vec3::new(shade, glaze + (gold - glaze) * paint.gold, paint.gold)
}

fn vessel(st: Vec2) -> Paint {
    let wobble = 0.035 * (fbm(st, IVec2::splat(10), 2, 31) - 0.5);
    let x = st.x * AROUND + wobble;
    let y = (1.0 - st.y) * HEIGHT + wobble;
    let mut paint = Paint::default();
    for (height, half) in [
        (1.2, 0.022),
        (1.27, 0.009),
        (2.42, 0.01),
        (2.48, 0.02),
        (2.76, 0.02),
        (3.42, 0.02),
    ] {
        paint.cobalt(0.95 * band(y, height, half, 0.02));
    }
    paint.cobalt(petals(x, (y - 0.62) / 0.5, 14.0));
    paint.cobalt(petals(x, (y - 3.5) / 0.62, 10.0));
    paint.cobalt(lattice(x, y));
    vine(x, y, &mut paint);
    // Gold: foot, shoulder, the whole rim, a line on the lid, the knob.
    let straight = (1.0 - st.y) * HEIGHT;
    for (height, half) in [(0.5, 0.06), (2.84, 0.03), (3.1, 0.16), (4.95, 0.52)] {
        let gold = band(straight, height, half, 0.015);
        paint.gold = paint.gold.max(gold);
    }
    paint.cobalt *= 1.0 - paint.gold;
    paint.coral *= 1.0 - paint.gold;
    paint
}

/// A row of `count` lotus petals a tile; `y` is 0 at their foot and 1 at their tip.
fn petals(x: f32, y: f32, count: f32) -> f32 {
    if !(0.0..1.08).contains(&y) {
        return 0.0;
    }
    let across = (x / AROUND * count).rem_euclid(1.0) * 2.0 - 1.0;
    // Half width of a petal at a height: full at the foot, an ogive toward the tip.
    let width = 0.94 * (1.0 - y * y).max(0.0).sqrt();
    let inside = width - across.abs();
    let outline = band(inside, 0.05, 0.05, 0.06);
    let heart = step(0.25, 0.7, inside) * (0.75 - 0.6 * y);
    let vein = band(across, 0.0, 0.03, 0.05) * step(0.75, 0.5, y);
    (outline * 0.95).max(heart).max(vein * 0.9) * step(1.06, 0.98, y)
}

/// A band of crossed lines under the shoulder.
fn lattice(x: f32, y: f32) -> f32 {
    let inside = band(y, 2.62, 0.12, 0.02);
    let cell = |d: f32| (d * 4.456).rem_euclid(1.0) - 0.5;
    let (a, b) = (cell(x + y - 2.62), cell(x - y + 2.62));
    let lines = band(a, 0.0, 0.05, 0.06).max(band(b, 0.0, 0.05, 0.06));
    let dot = 1.0 - step(0.16, 0.22, Vec2::new(a.abs() - 0.5, b.abs() - 0.5).length());
    inside * (0.7 * lines).max(dot)
}

/// A stem that waves round the belly, with a flower in every bend and leaves between.
fn vine(x: f32, y: f32, paint: &mut Paint) {
    if !(1.25..2.45).contains(&y) {
        return;
    }
    let phase = x / AROUND * 2.0 * TAU;
    let (sin, cos) = sin_cos(phase);
    let stem = 1.85 - 0.27 * sin;
    let slope = -0.27 * cos * 2.0;
    paint.cobalt(0.8 * band((y - stem) / (1.0 + slope * slope).sqrt(), 0.0, 0.022, 0.025));
    // Bends are a quarter turn of the phase from the crossings: flowers sit inside them.
    for k in -1i32..5 {
        let bend = (k as f32 + 0.5) * 0.25 * AROUND;
        let up = if k.rem_euclid(2) == 0 { 1.0 } else { -1.0 };
        let flower = Vec2::new(x - bend, y - (1.85 + 0.17 * up));
        blossom(flower, k as f32, paint);
        for (dx, dy, angle, length) in [
            (0.62, -0.2, -0.5, 0.34),
            (-0.62, -0.2, PI + 0.5, 0.34),
            (0.78, 0.26, 0.75, 0.28),
            (-0.78, 0.26, PI - 0.75, 0.28),
        ] {
            let from = Vec2::new(x - bend - dx, y - 1.85 - dy * up);
            leaf(from, angle * up, length, paint);
        }
    }
}

/// A flower of eight petals about the origin.
fn blossom(p: Vec2, turn: f32, paint: &mut Paint) {
    let radius = p.length();
    if radius > 0.5 {
        return;
    }
    let angle = libm::atan2f(p.y, p.x) + 0.4 * turn;
    let (_, lobe) = sin_cos(8.0 * angle);
    let outer = 0.37 + 0.05 * lobe;
    let (_, inner_lobe) = sin_cos(5.0 * angle + 1.0);
    let inner = 0.21 + 0.03 * inner_lobe;
    let petal = step(outer, outer - 0.02, radius);
    let edge = band(radius, outer - 0.02, 0.018, 0.025);
    let streak = 0.5 + 0.5 * sin_cos(32.0 * angle).0;
    paint.cobalt *= 1.0 - petal;
    let wash = petal * (0.22 + 0.45 * step(0.2, 0.36, radius) * streak);
    paint.cobalt(wash.max(edge));
    let heart = step(inner, inner - 0.02, radius);
    paint.cobalt *= 1.0 - heart;
    paint.cobalt(band(radius, inner, 0.014, 0.02));
    paint.coral = paint
        .coral
        .max(heart * (0.55 + 0.45 * step(0.02, 0.2, radius)));
    paint.gold = paint.gold.max(step(0.085, 0.07, radius));
}

/// A leaf with its foot at the origin.
fn leaf(p: Vec2, angle: f32, length: f32, paint: &mut Paint) {
    let (sin, cos) = sin_cos(angle);
    let along = (p.x * cos + p.y * sin) / length;
    if !(0.0..1.0).contains(&along) {
        return;
    }
    let across = (p.y * cos - p.x * sin) / length;
    let width = 0.9 * along.sqrt() * (1.0 - along);
    let inside = width - across.abs();
    let vein = band(across, 0.0, 0.02, 0.03);
    let half = if across > 0.0 { 0.85 } else { 0.5 };
    paint.cobalt(step(0.0, 0.05, inside) * (half - 0.35 * vein));
}

fn limb(st: Vec2) -> Paint {
    let wobble = 0.02 * (fbm(st, IVec2::splat(8), 2, 41) - 0.5);
    let along = st.y + wobble;
    let mut paint = Paint::default();
    for (height, half) in [(0.1, 0.008), (0.13, 0.014), (0.8, 0.014), (0.83, 0.006)] {
        paint.cobalt(0.95 * band(along, height, half, 0.01));
    }
    // Two sprays of paired leaves, one on either flank.
    let flank = (st.x * 2.0).rem_euclid(1.0) * 2.0 - 1.0;
    if (0.16..0.78).contains(&along) {
        paint.cobalt(0.85 * band(flank, 0.0, 0.035, 0.04));
        let beat = (along * 14.0 - flank.abs() * 1.4).rem_euclid(1.0);
        let leaf = band(beat, 0.5, 0.34 * (1.0 - flank.abs() / 0.7).max(0.0), 0.12);
        paint.cobalt(0.75 * leaf * step(0.7, 0.6, flank.abs()));
    }
    paint.gold = step(0.885, 0.89, st.y).max(step(0.045, 0.04, st.y));
    paint.cobalt *= 1.0 - paint.gold;
    paint
}
