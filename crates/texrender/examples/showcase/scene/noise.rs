//! Noise that tiles, from hashed integers: no tables, no state, the same bits everywhere.

use glam::{IVec2, Vec2};

/// A well mixed word of a lattice point.
pub(super) fn hash(x: i32, y: i32, seed: u32) -> u32 {
    let mut h = x.cast_unsigned().wrapping_mul(0x8da6_b343)
        ^ y.cast_unsigned().wrapping_mul(0xd816_3841)
        ^ seed.wrapping_mul(0xcb1a_b31f);
    h = (h ^ (h >> 16)).wrapping_mul(0x7feb_352d);
    h = (h ^ (h >> 15)).wrapping_mul(0x846c_a68b);
    h ^ (h >> 16)
}

/// A number in 0..1 of a lattice point.
pub(super) fn random(x: i32, y: i32, seed: u32) -> f32 {
    (hash(x, y, seed) >> 8) as f32 / 16_777_216.0
}

/// Value noise in 0..1 over `st`, with `cells` lattice cells a tile.
pub(super) fn noise(st: Vec2, cells: IVec2, seed: u32) -> f32 {
    let p = st * cells.as_vec2();
    let cell = p.floor();
    let f = p - cell;
    let w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let at = |dx, dy| {
        let ij = (cell.as_ivec2() + IVec2::new(dx, dy)).rem_euclid(cells);
        random(ij.x, ij.y, seed)
    };
    let top = at(0, 0) + (at(1, 0) - at(0, 0)) * w.x;
    let bottom = at(0, 1) + (at(1, 1) - at(0, 1)) * w.x;
    top + (bottom - top) * w.y
}

/// Octaves of noise, each twice as fine and half as strong; 0..1 about 0.5.
pub(super) fn fbm(st: Vec2, cells: IVec2, octaves: u32, seed: u32) -> f32 {
    let (mut sum, mut weight, mut total) = (0.0, 1.0, 0.0);
    for octave in 0..octaves {
        sum += weight * noise(st, cells * (1 << octave), seed + octave);
        total += weight;
        weight *= 0.5;
    }
    sum / total
}

/// The scattered points nearest to a place.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    /// Distance to the nearest point, in cells.
    pub nearest: f32,
    /// Distance to the border with the next point's region, in cells, roughly.
    pub border: f32,
    /// A number in 0..1 of the nearest point.
    pub id: f32,
}

/// Worley's cells over `st`, one point a lattice cell.
pub(super) fn cells(st: Vec2, cells: IVec2, seed: u32) -> Cell {
    let p = st * cells.as_vec2();
    let home = p.floor().as_ivec2();
    let (mut first, mut second, mut id) = (f32::MAX, f32::MAX, 0.0);
    for dy in -1..=1 {
        for dx in -1..=1 {
            let ij = home + IVec2::new(dx, dy);
            let lattice = ij.rem_euclid(cells);
            let jitter = Vec2::new(
                random(lattice.x, lattice.y, seed),
                random(lattice.x, lattice.y, seed ^ 0x5bd1),
            );
            let distance = (ij.as_vec2() + 0.1 + 0.8 * jitter - p).length();
            if distance < first {
                second = first;
                first = distance;
                id = random(lattice.x, lattice.y, seed ^ 0x77);
            } else {
                second = second.min(distance);
            }
        }
    }
    Cell {
        nearest: first,
        border: 0.5 * (second - first),
        id,
    }
}
