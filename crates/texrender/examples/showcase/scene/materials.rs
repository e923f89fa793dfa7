//! Stone, wood, brick, metal, paper, glass and leaves.

use std::f32::consts::{PI, TAU};

use glam::{IVec2, UVec2, Vec2, Vec3, Vec4};

use super::noise::{cells, fbm, noise, random};
use super::paint::{band, grey, mix, normals, normals_of, rgb, rgba, sin_cos, step};

/// Floor tiles along a side of the texture; a chequer, so even.
pub(super) const FLOOR_TILES: i32 = 4;

/// A place on the floor.
struct Tile {
    /// Distance to the tile's border, in tiles.
    border: f32,
    /// Distance to the nearest corner in the sum of both directions, in tiles.
    corner: f32,
    dark: bool,
    id: IVec2,
}

fn tile(st: Vec2) -> Tile {
    let p = st * FLOOR_TILES as f32;
    let id = p.floor().as_ivec2();
    let f = p - p.floor();
    let edge = f.min(1.0 - f);
    Tile {
        border: edge.min_element(),
        corner: edge.x + edge.y,
        dark: (id.x + id.y) % 2 != 0,
        id,
    }
}

pub(super) fn floor_color(size: UVec2) -> Vec<u8> {
    rgb(size, |st| {
        let Tile {
            border,
            corner,
            dark,
            id,
        } = tile(st);
        let tone = random(id.x, id.y, 91) - 0.5;
        let warp = fbm(st, IVec2::splat(6), 4, 11) - 0.5;
        let vein = (fbm(st + 0.12 * warp, IVec2::splat(5), 4, 12 + u32::from(dark)) - 0.5).abs();
        let vein = 1.0 - step(0.0, 0.035, vein);
        let stone = if dark {
            mix(
                Vec3::new(0.20, 0.34, 0.37),
                Vec3::new(0.55, 0.68, 0.66),
                0.45 * vein,
            )
        } else {
            mix(
                Vec3::new(0.84, 0.78, 0.68),
                Vec3::new(0.62, 0.52, 0.42),
                0.5 * vein,
            )
        };
        let stone = stone * (1.0 + 0.12 * tone + 0.16 * warp);
        let inset = Vec3::new(0.66, 0.33, 0.20) * (1.0 + 0.3 * warp);
        let laid = mix(stone, inset, step(0.20, 0.195, corner));
        let joint = joint(border, corner);
        mix(
            laid,
            Vec3::new(0.40, 0.36, 0.31) * (1.0 + 0.4 * warp),
            joint,
        )
    })
}

pub(super) fn floor_surface(size: UVec2) -> Vec<u8> {
    rgb(size, |st| {
        let Tile {
            border,
            corner,
            dark,
            ..
        } = tile(st);
        let wear = fbm(st, IVec2::splat(5), 4, 51);
        let polish = if dark { 0.17 } else { 0.26 };
        let rough = polish + 0.3 * step(0.4, 0.75, wear);
        Vec3::new(1.0, rough + (0.85 - rough) * joint(border, corner), 0.0)
    })
}

pub(super) fn floor_normal(size: UVec2) -> Vec<u8> {
    normals(size, FLOOR_TILES as f32, |st| {
        let Tile {
            border, corner, id, ..
        } = tile(st);
        let inset = (corner - 0.198).abs() * 0.7;
        let edge = if corner < 0.198 {
            inset
        } else {
            border.min(inset)
        };
        let pillow = 0.022 * step(0.0, 0.045, edge);
        // No two tiles lie quite level.
        let f = st * FLOOR_TILES as f32 - id.as_vec2() - 0.5;
        let tilt = Vec2::new(random(id.x, id.y, 7), random(id.x, id.y, 8)) - 0.5;
        let lie = f.dot(tilt) * 0.012 * step(0.02, 0.05, border);
        pillow + lie + 0.004 * noise(st, IVec2::splat(16), 9)
    })
}

fn joint(border: f32, corner: f32) -> f32 {
    let inset = band(corner, 0.198, 0.012, 0.012);
    let between = step(0.018, 0.01, border) * step(0.194, 0.2, corner);
    between.max(inset)
}

/// Boards, their grain along s.
pub(super) fn wood_color(size: UVec2) -> Vec<u8> {
    rgb(size, |st| {
        let (board, seam) = board(st);
        let shift = random(board, 0, 3);
        let bend = fbm(
            st + Vec2::new(shift, 0.0),
            IVec2::new(2, 8),
            3,
            61 + board.cast_unsigned(),
        );
        let rings = sin_cos((st.y * 9.0 + bend * 2.6) * TAU).0 * 0.5 + 0.5;
        let fibre = noise(st, IVec2::new(10, 180), 62);
        let dark = 0.55 * rings * rings + 0.35 * fibre;
        let tone = 0.86 + 0.28 * random(board, 1, 3);
        mix(
            Vec3::new(0.66, 0.43, 0.25),
            Vec3::new(0.36, 0.19, 0.10),
            dark,
        ) * tone
            * (1.0 - 0.7 * seam)
    })
}

pub(super) fn wood_normal(size: UVec2) -> Vec<u8> {
    normals(size, 1.0, |st| {
        let (_, seam) = board(st);
        0.0007 * noise(st, IVec2::new(10, 160), 62) - 0.003 * seam
    })
}

fn board(st: Vec2) -> (i32, f32) {
    let p = st.y * 4.0;
    let f = p - p.floor();
    (p.floor() as i32, step(0.03, 0.012, f.min(1.0 - f)))
}

/// A place on the wall: distance to the mortar in units of the tile, and the brick.
fn brick(st: Vec2) -> (f32, IVec2) {
    let row = (st.y * 6.0).floor();
    let shift = if row.rem_euclid(2.0) < 0.5 { 0.0 } else { 0.5 };
    let p = Vec2::new(st.x * 3.0 + shift, st.y * 6.0);
    let f = p - p.floor();
    let edge = f.min(1.0 - f) / Vec2::new(3.0, 6.0);
    let id = IVec2::new(p.x.floor() as i32 % 3, row as i32);
    (edge.min_element(), id)
}

pub(super) fn brick_color(size: UVec2) -> Vec<u8> {
    rgb(size, |st| {
        let (edge, id) = brick(st);
        let grain = fbm(st, IVec2::splat(10), 4, 71);
        let tone = random(id.x, id.y, 72);
        let clay = mix(
            Vec3::new(0.56, 0.27, 0.20),
            Vec3::new(0.74, 0.44, 0.32),
            tone,
        );
        let clay = clay * (0.72 + 0.56 * grain);
        let mortar = Vec3::new(0.70, 0.66, 0.60) * (0.75 + 0.5 * grain);
        mix(
            mortar,
            clay,
            step(0.008, 0.016, edge + 0.008 * (grain - 0.5)),
        )
    })
}

pub(super) fn brick_normal(size: UVec2) -> Vec<u8> {
    normals(size, 1.0, |st| {
        let (edge, _) = brick(st);
        let grain = fbm(st, IVec2::splat(10), 4, 71);
        0.012 * step(0.004, 0.026, edge + 0.008 * (grain - 0.5)) + 0.012 * grain
    })
}

/// Dents of a hammer.
pub(super) fn hammered_normal(size: UVec2) -> Vec<u8> {
    normals(size, 1.0, |st| {
        let dent = cells(st, IVec2::splat(11), 81);
        0.018 * dent.nearest * dent.nearest
    })
}

/// Occlusion, roughness and metal of hammered copper: duller where it is tarnished.
pub(super) fn copper_surface(size: UVec2) -> Vec<u8> {
    rgb(size, |st| {
        let tarnish = step(0.45, 0.7, fbm(st, IVec2::splat(5), 4, 82));
        Vec3::new(1.0, 0.27 + 0.3 * tarnish, 1.0)
    })
}

/// Scratches: straight strokes over a tile, each a shallow groove.
pub(super) fn scratched_normal(size: UVec2) -> Vec<u8> {
    let mut field = vec![0.0f32; (size.x * size.y) as usize];
    for stroke in 0..260 {
        let r = |seed| random(stroke, 0, seed);
        let (sin, cos) = sin_cos(PI * (0.15 + 0.3 * r(1)) + if r(2) > 0.8 { 1.3 } else { 0.0 });
        let from = Vec2::new(r(3), r(4)) * size.as_vec2();
        let length = (30.0 + 170.0 * r(5) * r(6)) as u32;
        let depth = 0.0016 * (0.25 + r(7));
        for k in 0..length {
            let taper = 1.0 - (2.0 * k as f32 / length as f32 - 1.0).abs();
            let at = (from + Vec2::new(cos, sin) * k as f32).floor().as_ivec2();
            let ij = at.rem_euclid(size.as_ivec2()).as_uvec2();
            let texel = &mut field[(ij.y * size.x + ij.x) as usize];
            *texel = texel.min(-depth * taper);
        }
    }
    normals_of(size, 1.0, &field)
}

/// A leaf of ivy in the square, its stalk at the bottom; alpha is its shape.
pub(super) fn leaf(size: UVec2) -> Vec<u8> {
    rgba(size, |st| {
        let p = Vec2::new(st.x - 0.5, 0.62 - st.y);
        let angle = libm::atan2f(p.x, p.y);
        let lobes = sin_cos(5.0 * angle).1;
        let reach = 0.36 + 0.075 * lobes + 0.10 * step(0.9, 0.0, angle.abs())
            - 0.16 * step(2.6, PI, angle.abs());
        let shape = reach - p.length();
        let stalk = band(p.x, 0.0, 0.016, 0.01) * step(0.05, 0.0, p.y);
        // Veins run to the tips of the lobes.
        let spoke = (angle / (TAU / 5.0)).round() * (TAU / 5.0);
        let vein = p.length() * sin_cos(angle - spoke).0.abs();
        let pale = step(0.014, 0.004, vein).max(stalk);
        let mottled = fbm(st, IVec2::splat(6), 3, 101);
        let green = mix(
            Vec3::new(0.13, 0.32, 0.12),
            Vec3::new(0.40, 0.58, 0.20),
            mottled,
        );
        let rim = mix(
            green,
            Vec3::new(0.62, 0.66, 0.28),
            step(0.07, 0.0, shape) * 0.5,
        );
        let color = mix(rim, Vec3::new(0.74, 0.82, 0.50), 0.6 * pale);
        color.extend(step(-0.006, 0.006, shape).max(stalk))
    })
}

/// Clipped foliage: many small leaves.
pub(super) fn foliage(size: UVec2) -> Vec<u8> {
    rgb(size, |st| {
        let leaf = cells(st, IVec2::splat(14), 111);
        let light = (1.0 - leaf.nearest).clamp(0.0, 1.0) * (0.6 + 0.5 * leaf.id);
        mix(
            Vec3::new(0.06, 0.14, 0.07),
            Vec3::new(0.36, 0.52, 0.20),
            light,
        )
    })
}

pub(super) fn foliage_normal(size: UVec2) -> Vec<u8> {
    normals(size, 1.0, |st| {
        -0.06 * cells(st, IVec2::splat(14), 111).nearest
    })
}

/// An iron trellis of lozenges; alpha is the bars.
pub(super) fn trellis(size: UVec2) -> Vec<u8> {
    rgba(size, |st| {
        let bar = |d: f32| band((d * 1.0).rem_euclid(1.0), 0.5, 0.055, 0.02);
        let p = st * 2.0;
        let over = bar(p.x + p.y);
        let under = bar(p.x - p.y);
        let rivet = over * under;
        let rust = fbm(st, IVec2::splat(8), 3, 121);
        let color = mix(
            Vec3::new(0.80, 0.78, 0.72),
            Vec3::new(0.62, 0.56, 0.48),
            rust,
        ) * (0.8 + 0.2 * over + 0.1 * rivet);
        color.extend(over.max(under))
    })
}

/// Stained glass: panes of `palette` at alpha 0.5 between leads at alpha 1.
pub(super) fn glass(size: UVec2, palette: [Vec3; 4], seed: u32) -> Vec<u8> {
    rgba(size, |st| {
        let bend = 0.02 * (fbm(st, IVec2::splat(4), 2, seed) - 0.5);
        let pane = cells(st + bend, IVec2::new(4, 6), seed);
        let frame = st.min(1.0 - st).min_element();
        let lead = step(0.05, 0.035, pane.border).max(step(0.028, 0.022, frame));
        let color = palette[((pane.id * 4.0) as usize).min(3)];
        let streak = 0.85 + 0.3 * fbm(st, IVec2::new(12, 3), 2, seed + 9);
        let glass = (color * streak).extend(0.46 + 0.2 * pane.nearest.min(1.0));
        glass + (Vec4::new(0.09, 0.085, 0.08, 1.0) - glass) * lead
    })
}

/// Paper of a lantern, lit from within: hoops of bamboo, a branch in blossom. (s, t) over the sphere.
pub(super) fn lantern(size: UVec2) -> Vec<u8> {
    rgb(size, |st| {
        let hoop = (st.y * 13.0).rem_euclid(1.0);
        let shade = 1.0 - 0.38 * step(0.14, 0.04, hoop.min(1.0 - hoop));
        let glow = 0.62 + 0.38 * band(st.y, 0.55, 0.16, 0.5);
        let fibre = 0.9 + 0.2 * fbm(st, IVec2::new(10, 10), 4, 131);
        let paper = Vec3::new(1.0, 0.80, 0.50) * (glow * shade * fibre);
        let (branch, flower) = blossom_branch(st);
        let inked = mix(paper, Vec3::new(0.22, 0.07, 0.03), branch);
        let bloom = mix(inked, Vec3::new(0.93, 0.20, 0.10) * glow, flower);
        let cap = step(0.115, 0.105, st.y.min(1.0 - st.y));
        mix(bloom, Vec3::new(0.02, 0.015, 0.01), cap)
    })
}

/// Ink and blossom on the lantern: two branches a turn.
fn blossom_branch(st: Vec2) -> (f32, f32) {
    let p = Vec2::new((st.x * 2.0 + 0.45).rem_euclid(1.0), st.y);
    let path = |x: f32| 0.74 - 0.42 * x + 0.035 * sin_cos(11.0 * x).0;
    let width = 0.016 * (1.05 - p.x);
    let mut ink = band(p.y, path(p.x), width, 0.006) * step(0.08, 0.1, p.x) * step(0.9, 0.86, p.x);
    let mut flower = 0.0f32;
    for k in 0..9 {
        let x = 0.16 + 0.08 * k as f32;
        let side = if k % 2 == 0 { 1.0 } else { -1.0 };
        let reach = 0.05 + 0.05 * random(k, 1, 132);
        let centre = Vec2::new(x + 0.03, path(x) + side * reach);
        let d = (p - centre) * Vec2::new(1.57, 1.0);
        let lobes = sin_cos(5.0 * libm::atan2f(d.y, d.x) + k as f32).1;
        let size = 0.03 + 0.018 * random(k, 2, 132);
        flower = flower.max(step(0.0, 0.006, size * (0.8 + 0.2 * lobes) - d.length()));
        flower *= 1.0 - 0.7 * step(0.009, 0.006, d.length());
        let twig = band(
            p.x,
            x + 0.03 * (p.y - path(x)) / (side * reach),
            0.006,
            0.006,
        );
        let between = (p.y - path(x)) * side;
        ink = ink.max(twig * step(0.0, 0.004, between) * step(reach, reach - 0.01, between));
    }
    (ink, flower)
}

/// Shade on something that stands on something: dark below, light above.
pub(super) fn grounded(size: UVec2) -> Vec<u8> {
    grey(size, |st| 1.0 - 0.85 * step(0.5, 1.0, st.y))
}
