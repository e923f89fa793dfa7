//! Perlin's noise at sixteen places at once.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16, u32x16};
use glam::DVec3;

use super::noise::{FACTORS, HIGH, Lattice, MIX, Noise, NoiseKind, TURNS};

/// Bound of [`Noise::value_packet`]'s error for places within ±2¹⁰, beside what f32 makes of the place.
pub const NOISE_PACKET_MAX_ERROR: f32 = 2e-6;

/// Farther than this a lattice point is no 32-bit number.
const FARTHEST: f32 = 1e9;

impl Noise {
    /// [`Noise::value`] at sixteen places, in f32.
    ///
    /// `stp`: up to ±10⁹ a component; beyond, and where one is not finite, 0. The definition of 2002 on a hashed
    /// lattice is what this is fast for; others take each lane by itself.
    ///
    /// # Accuracy
    /// Within [`NOISE_PACKET_MAX_ERROR`] of [`Noise::value`] at the same place, in ±2¹⁰; the same bits on every
    /// instruction set. Checked by `tests/properties/solid_noise.rs`.
    #[inline(always)]
    pub fn value_packet<S: Simd>(&self, simd: S, stp: [f32x16<S>; 3]) -> f32x16<S> {
        match (self.kind, self.lattice) {
            (NoiseKind::Perlin2002, Lattice::Hash { seed }) => hashed(simd, seed, stp),
            _ => self.lane_by_lane(simd, stp),
        }
    }

    #[inline(always)]
    fn lane_by_lane<S: Simd>(&self, simd: S, stp: [f32x16<S>; 3]) -> f32x16<S> {
        let mut values = [0.0; 16];
        for (lane, value) in values.iter_mut().enumerate() {
            let place = DVec3::new(
                stp[0][lane].into(),
                stp[1][lane].into(),
                stp[2][lane].into(),
            );
            *value = crate::transfer::round_to_f32(self.value(place));
        }
        values.simd_into(simd)
    }
}

/// Products of a coordinate's lattice points, the near one and the far one.
#[inline(always)]
fn products<S: Simd>(cell: i32x16<S>, factor: u32) -> [u32x16<S>; 2] {
    [folded(cell) * factor, folded(cell + 1) * factor]
}

/// A coordinate as the hash of 64-bit ones has it: with the high half that its sign extends to.
#[inline(always)]
fn folded<S: Simd>(cell: i32x16<S>) -> u32x16<S> {
    let high: u32x16<S> = (cell >> 31).bitcast();
    let low: u32x16<S> = cell.bitcast();
    low ^ (high * HIGH)
}

#[inline(always)]
fn turned<S: Simd>(products: [u32x16<S>; 2], by: u32) -> [u32x16<S>; 2] {
    let [near, far] = products;
    [
        (near << by) | (near >> (32 - by)),
        (far << by) | (far >> (32 - by)),
    ]
}

#[inline(always)]
fn hashed<S: Simd>(simd: S, seed: u32, stp: [f32x16<S>; 3]) -> f32x16<S> {
    let [x, y, z] = stp;
    let farthest = f32x16::splat(simd, FARTHEST);
    let inside = x.abs().simd_le(farthest) & y.abs().simd_le(farthest) & z.abs().simd_le(farthest);
    let zero = f32x16::splat(simd, 0.0);
    let (x, y, z) = (
        inside.select(x, zero),
        inside.select(y, zero),
        inside.select(z, zero),
    );
    let (floor_x, floor_y, floor_z) = (x.floor(), y.floor(), z.floor());
    let (x, y, z) = (x - floor_x, y - floor_y, z - floor_z);
    let xs = products(i32x16::truncate_from(floor_x), FACTORS[0]);
    let ys = turned(
        products(i32x16::truncate_from(floor_y), FACTORS[1]),
        TURNS[0],
    );
    let zs = turned(
        products(i32x16::truncate_from(floor_z), FACTORS[2]),
        TURNS[1],
    );
    let seed = seed.wrapping_mul(FACTORS[3]);
    let (fade_x, fade_y, fade_z) = (quintic(x), quintic(y), quintic(z));

    let mut planes = [zero; 2];
    for (k, plane) in planes.iter_mut().enumerate() {
        let z = z - k as f32;
        let mut lines = [zero; 2];
        for (j, line) in lines.iter_mut().enumerate() {
            let y = y - j as f32;
            let rest = ys[j] ^ zs[k] ^ seed;
            let near = linear(mixed(xs[0] ^ rest), x, y, z);
            let far = linear(mixed(xs[1] ^ rest), x - 1.0, y, z);
            *line = near + (far - near) * fade_x;
        }
        *plane = lines[0] + (lines[1] - lines[0]) * fade_y;
    }
    let value = planes[0] + (planes[1] - planes[0]) * fade_z;
    inside.select(value, zero)
}

/// The four bits that choose an edge of the cube.
#[inline(always)]
fn mixed<S: Simd>(h: u32x16<S>) -> u32x16<S> {
    let h = (h ^ (h >> 16)) * MIX[0];
    let h = (h ^ (h >> 13)) * MIX[1];
    ((h ^ (h >> 16)) >> 24) & 15
}

/// g·(x, y, z) for the edge `h`: two of the coordinates, signed by its low bits.
#[inline(always)]
fn linear<S: Simd>(h: u32x16<S>, x: f32x16<S>, y: f32x16<S>, z: f32x16<S>) -> f32x16<S> {
    let simd = h.token();
    let first = h.simd_lt(u32x16::splat(simd, 8)).select(x, y);
    // 12 and 14 are (±1, 1, 0) once more.
    let again = (h & 13).simd_eq(u32x16::splat(simd, 12));
    let second = h
        .simd_lt(u32x16::splat(simd, 4))
        .select(y, again.select(x, z));
    let first: u32x16<S> = first.bitcast();
    let second: u32x16<S> = second.bitcast();
    let first: f32x16<S> = (first ^ (h << 31)).bitcast();
    let second: f32x16<S> = (second ^ ((h & 2) << 30)).bitcast();
    first + second
}

#[inline(always)]
fn quintic<S: Simd>(x: f32x16<S>) -> f32x16<S> {
    x * x * x * (x * (x * 6.0 - 15.0) + 10.0)
}
