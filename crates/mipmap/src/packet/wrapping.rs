//! The taps of sixteen footprints of a texture that repeats and whose sides are powers of two, in whole numbers.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16, u32x16};
use sampler::packet::{ONE, Tap, Wrapped, fold};
use sampler::{AddressMode, Filter};

use super::PackedPyramid;
use super::course::units;
use super::layout::Placed;
use super::line::Line;
use crate::sampler_state::SamplerState;

/// Where the taps of a packet are on one level.
#[derive(Clone, Copy)]
pub(super) struct Layer<S: Simd> {
    wrapped: Wrapped<S>,
    /// Of the width and height: 2⁻¹⁶ texels.
    units: [f32x16<S>; 2],
    /// The middle, as [`Wrapped`] takes it.
    middle: [u32x16<S>; 2],
}

/// Whether the taps of lookups by `state` are bilinear, of a texture that repeats and whose sides are powers of two.
#[inline(always)]
pub(super) fn wraps(texture: &PackedPyramid, state: &SamplerState) -> bool {
    let bilinear = state.magnify != Filter::Nearest && state.minify != Filter::Nearest;
    bilinear && texture.wraps()
}

/// Units of a [`Wrapped`] in a unit of [`Placed`].
const UNITS: f32 = 65_536.0 / ONE as f32;

/// Half a texel, as the ring lies, and what makes up for products that are rounded down.
const START: [u32; 2] = [32_768 + 3, 32_768 + 2];

impl<S: Simd> Layer<S> {
    #[inline(always)]
    pub(super) fn of(simd: S, placed: &Placed<S>, middle: [f32x16<S>; 2], stride: u32) -> Self {
        let (columns, rows) = (placed.width * UNITS, placed.height * UNITS);
        let sides = [whole(columns) >> 16, whole(rows) >> 16];
        let s = fold(simd, AddressMode::Repeat, middle[0]);
        let t = fold(simd, AddressMode::Repeat, middle[1]);
        Self {
            wrapped: Wrapped::new(simd, placed.origin, sides, stride),
            units: [columns, rows],
            middle: [whole(s * columns) + START[0], whole(t * rows) + START[1]],
        }
    }

    /// A way in textures, but for whole ones, to the nearest unit.
    #[inline(always)]
    fn way(&self, s: f32x16<S>, t: f32x16<S>) -> [u32x16<S>; 2] {
        [part(s, self.units[0]), part(t, self.units[1])]
    }
}

/// What is beyond the nearest whole number, so that short ways keep their digits, times `units`.
#[inline(always)]
fn part<S: Simd>(way: f32x16<S>, units: f32x16<S>) -> u32x16<S> {
    whole(((way - way.round_ties_even()) * units).round_ties_even())
}

/// Sets a tap a level to that of the middle; `fraction` is the next level's share.
#[inline(always)]
pub(super) fn middle<S: Simd, const LEVELS: usize>(
    layers: &[Layer<S>; LEVELS],
    fraction: f32x16<S>,
    taps: &mut [Tap],
) {
    let all = u32x16::splat(fraction.simd, ONE);
    let weights = shares::<S, LEVELS>(all, fraction);
    let taps = &mut taps[..LEVELS];
    for level in 0..LEVELS {
        let layer = &layers[level];
        taps[level].set_wrapped(&layer.wrapped, layer.middle, weights[level]);
    }
}

/// Sets taps to those of a line of probes, a pair after the other, each on all layers; returns what one probe of each
/// pair counts for in all.
#[inline(always)]
pub(super) fn probes<S: Simd, const LEVELS: usize>(
    layers: &[Layer<S>; LEVELS],
    fraction: f32x16<S>,
    line: &Line<S>,
    taps: &mut [Tap],
) -> u32x16<S> {
    let simd = fraction.simd;
    let mut pairs = taps.chunks_exact_mut(2 * LEVELS);
    let all = u32x16::splat(simd, ONE);
    let weights = shares::<S, LEVELS>(all, fraction);
    let (half_s, half_t) = (line.step_s * 0.5, line.step_t * 0.5);
    let mut ways = [layers[0].way(half_s, half_t); LEVELS];
    for level in 1..LEVELS {
        ways[level] = layers[level].way(half_s, half_t);
    }
    let mut steps = ways;
    for [s, t] in &mut steps {
        *s += *s;
        *t += *t;
    }
    for taps in pairs.by_ref().take(line.common as usize) {
        pair(layers, &ways, weights, taps);
        for (way, step) in ways.iter_mut().zip(&steps) {
            way[0] += step[0];
            way[1] += step[1];
        }
    }
    let mut total = u32x16::splat(simd, ONE * line.common);
    for (k, taps) in (line.common..).zip(pairs) {
        let (cells, weight) = line.pair(simd, k);
        let (s, t) = (line.step_s * cells, line.step_t * cells);
        for (way, layer) in ways.iter_mut().zip(layers) {
            *way = layer.way(s, t);
        }
        let all = units(weight);
        pair(
            layers,
            &ways,
            shares::<S, LEVELS>(all, weight * fraction),
            taps,
        );
        total += all;
    }
    total
}

/// The probes on either side.
#[inline(always)]
fn pair<S: Simd, const LEVELS: usize>(
    layers: &[Layer<S>; LEVELS],
    ways: &[[u32x16<S>; 2]; LEVELS],
    weights: [u32x16<S>; 2],
    taps: &mut [Tap],
) {
    let (before, after) = taps.split_at_mut(LEVELS);
    for level in 0..LEVELS {
        let (layer, [ds, dt]) = (&layers[level], ways[level]);
        let ([s, t], weight) = (layer.middle, weights[level]);
        before[level].set_wrapped(&layer.wrapped, [s - ds, t - dt], weight);
        after[level].set_wrapped(&layer.wrapped, [s + ds, t + dt], weight);
    }
}

/// Weights of the finer and the coarser level, which add up to `all`.
#[inline(always)]
fn shares<S: Simd, const LEVELS: usize>(all: u32x16<S>, coarser: f32x16<S>) -> [u32x16<S>; 2] {
    if LEVELS == 1 {
        return [all; 2];
    }
    let coarser = units(coarser);
    [all - coarser, coarser]
}

/// Of a whole number within ±2³¹: two's complement.
#[inline(always)]
fn whole<S: Simd>(number: f32x16<S>) -> u32x16<S> {
    i32x16::truncate_from(number).bitcast()
}
