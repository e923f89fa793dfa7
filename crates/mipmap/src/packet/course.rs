//! The taps of sixteen footprints.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16, mask32x16, u32x16};
use sampler::packet::{ONE, Share, Tap, fold, held};
use sampler::{AddressMode, Filter};

use super::PackedPyramid;
use super::layout::Placed;
use super::line::Line;
use super::plan::Plan;
use crate::sampler_state::SamplerState;

/// Where a packet's taps are: one place on one or two levels, or pairs of probes on either side of it.
pub(super) struct Course<S: Simd> {
    simd: S,
    modes: [AddressMode; 2],
    stride: u32,
    /// Whole textures and parts of them, as [`fold`] takes them.
    middle: [f32x16<S>; 2],
    /// The finer level and the next.
    placed: [Placed<S>; 2],
    /// How many of them are read.
    pub(super) levels: usize,
    fraction: f32x16<S>,
    split: Split<S>,
}

/// How a place on an axis is split into the first of two neighbouring texels and the weight of the second.
struct Split<S: Simd> {
    /// Always between the centres of two texels, [`ONE`] units apart.
    between_centres: bool,
    /// Lanes that read one texel of a level.
    nearest: mask32x16<S>,
    bordered: bool,
    /// Binary digits of a unit.
    bits: u32,
}

impl<S: Simd> Course<S> {
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        [s, t]: [f32x16<S>; 2],
        plan: &Plan<S>,
    ) -> Self {
        let split = Split::of(simd, texture, state, plan.minified);
        let (placed, levels) = plan.placed(simd, texture, state);
        Self {
            simd,
            modes: texture.modes(),
            stride: texture.sheet().stride(),
            middle: [held(simd, s), held(simd, t)],
            placed,
            levels,
            fraction: plan.fraction,
            split,
        }
    }

    /// Bilinear taps of the finest level, wherever they are.
    #[inline(always)]
    pub(super) fn of_the_finest(simd: S, texture: &PackedPyramid) -> Self {
        let zero = f32x16::splat(simd, 0.0);
        Self {
            simd,
            modes: texture.modes(),
            stride: texture.sheet().stride(),
            middle: [zero; 2],
            placed: texture.placed_everywhere(simd, texture.finest() as usize),
            levels: 1,
            fraction: zero,
            split: Split::of(simd, texture, &SamplerState::default(), zero.simd_lt(zero)),
        }
    }

    /// Sets [`Self::levels`] taps to those of the middle.
    #[inline(always)]
    pub(super) fn middle(&self, taps: &mut [Tap]) {
        let coarse = units(self.fraction);
        let one = u32x16::splat(self.simd, ONE);
        self.probe(self.middle, [one - coarse, coarse], taps);
    }

    /// Sets a tap to the nearest texel of one level, of a texture without a border.
    #[inline(always)]
    pub(super) fn nearest(&self, tap: &mut Tap) {
        let placed = &self.placed[0];
        let index = |place: f32x16<S>, size: f32x16<S>| {
            u32x16::truncate_from((place * size).min(size - 1.0)) >> self.split.bits
        };
        let column = index(fold(self.simd, self.modes[0], self.middle[0]), placed.width);
        let row = index(
            fold(self.simd, self.modes[1], self.middle[1]),
            placed.height,
        );
        // Counted from the ring.
        let offsets = placed.origin + (row + 1) * self.stride + (column + 1);
        tap.set_single(self.simd, offsets);
    }

    /// Sets twice as many to those of a pair of probes on either side of the middle; returns what each probe counts
    /// for.
    #[inline(always)]
    pub(super) fn pair(&self, line: &Line<S>, pair: u32, taps: &mut [Tap]) -> u32x16<S> {
        let (cells, weight) = line.pair(self.simd, pair);
        let all = units(weight);
        let coarse = if self.levels == 1 {
            u32x16::splat(self.simd, 0)
        } else {
            units(weight * self.fraction)
        };
        let (ds, dt) = (line.step_s * cells, line.step_t * cells);
        let [s, t] = self.middle;
        let (before, after) = taps.split_at_mut(self.levels);
        self.probe([s - ds, t - dt], [all - coarse, coarse], before);
        self.probe([s + ds, t + dt], [all - coarse, coarse], after);
        all
    }

    /// Sets the taps of a place on each level.
    #[inline(always)]
    pub(super) fn probe(&self, [s, t]: [f32x16<S>; 2], weights: [u32x16<S>; 2], taps: &mut [Tap]) {
        let s = fold(self.simd, self.modes[0], s);
        let t = fold(self.simd, self.modes[1], t);
        let levels = self.placed.iter().zip(weights);
        for (tap, (placed, weight)) in taps.iter_mut().zip(levels) {
            let (column, right) = self.split.texel(self.simd, s, placed.width);
            let (row, lower) = self.split.texel(self.simd, t, placed.height);
            let offsets = placed.origin + row * self.stride + column;
            let share = Share {
                right,
                lower,
                weight,
            };
            tap.set(offsets, &share);
        }
    }
}

/// Of 0..=1, in units of 1/[`ONE`].
#[inline(always)]
pub(super) fn units<S: Simd>(weight: f32x16<S>) -> u32x16<S> {
    u32x16::truncate_from(weight * ONE as f32 + 0.5)
}

impl<S: Simd> Split<S> {
    #[inline(always)]
    fn of(simd: S, texture: &PackedPyramid, state: &SamplerState, minified: mask32x16<S>) -> Self {
        let zero = f32x16::splat(simd, 0.0);
        let filters = [state.magnify, state.minify].map(|filter| filter == Filter::Nearest);
        let nearest = match filters {
            [false, false] => zero.simd_lt(zero),
            [true, true] => zero.simd_eq(zero),
            [true, false] => !minified,
            [false, true] => minified,
        };
        let bordered = texture.modes().contains(&AddressMode::ClampToBorder);
        let bits = texture.fraction_bits();
        Self {
            between_centres: filters == [false; 2] && !bordered && bits == ONE.ilog2(),
            nearest,
            bordered,
            bits,
        }
    }

    /// The first of two neighbouring texels on an axis of `size`, counted from the ring, and the weight of the second.
    #[inline(always)]
    fn texel(&self, simd: S, place: f32x16<S>, size: f32x16<S>) -> (u32x16<S>, u32x16<S>) {
        if self.between_centres {
            // Half a texel more than the place: the ring is one wide, a centre half of one from its border.
            let units = u32x16::truncate_from(place * size + (ONE / 2) as f32);
            return (units >> ONE.ilog2(), units & (ONE - 1));
        }
        let bits = self.bits;
        let one = f32x16::splat(simd, (1u32 << bits) as f32);
        let zero = f32x16::splat(simd, 0.0);
        let to_centre = self.nearest.select(zero, one * 0.5);
        // A whole texel more than the place, so that truncation is the floor.
        let mut units = place * size + (one - to_centre);
        if self.bordered {
            units = units.max(zero);
        }
        // At the far end, and beyond a border, the last texel's right edge.
        let far = i32x16::truncate_from(size) + ((1 << bits) - 1);
        let units = i32x16::truncate_from(units);
        let none = u32x16::splat(simd, 0);
        let mut beyond = none;
        if self.bordered {
            let whole = u32x16::splat(simd, ONE);
            beyond = units.simd_gt(far).select(whole, none);
        }
        let units = units.min(far);
        let fraction = units & ((1 << bits) - 1);
        let first: u32x16<S> = (units >> bits).bitcast();
        let second: u32x16<S> = (fraction << (ONE.ilog2() - bits)).bitcast();
        (first, self.nearest.select(beyond, second))
    }
}
