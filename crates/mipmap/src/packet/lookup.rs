//! The texels that a plan names, weighted and summed.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16, u32x16};
use sampler::Filter;
use sampler::packet::{Share, Sums, unit};

use super::plan::{Line, Plan};
use super::{PackedPyramid, PacketFootprint};
use crate::sample::{MipFilter, SamplerState};

/// The filtered colours, interleaved RGBA.
#[inline(always)]
pub(super) fn filtered<S: Simd, A: Sums<S>>(
    simd: S,
    texture: &PackedPyramid,
    texels: &[A::Texel],
    state: &SamplerState,
    footprint: &PacketFootprint<S>,
) -> [f32x16<S>; 4] {
    let plan = Plan::of(simd, texture, state, footprint);
    let nearest = nearest_lanes(simd, state, plan.minified);
    let one = f32x16::splat(simd, 1.0);
    let mut sums = A::zero(simd);
    let mut lookup = Lookup {
        simd,
        texture,
        texels,
        sums: &mut sums,
        nearest,
    };
    match plan.line {
        None => {
            lookup.levels(&plan, footprint.s, footprint.t, one);
            sums.texels(simd, one)
        }
        Some(line) => {
            lookup.line(&plan, &line, footprint);
            sums.texels(simd, one / line.total)
        }
    }
}

/// Lanes that read one texel of a level; none where no filter does.
#[inline(always)]
fn nearest_lanes<S: Simd>(
    simd: S,
    state: &SamplerState,
    minified: mask32x16<S>,
) -> Option<mask32x16<S>> {
    let zero = f32x16::splat(simd, 0.0);
    match [state.magnify, state.minify].map(|filter| filter == Filter::Nearest) {
        [false, false] => None,
        [true, true] => Some(zero.simd_eq(zero)),
        [true, false] => Some(!minified),
        [false, true] => Some(minified),
    }
}

struct Lookup<'a, S: Simd, A: Sums<S>> {
    simd: S,
    texture: &'a PackedPyramid,
    texels: &'a [A::Texel],
    sums: &'a mut A,
    nearest: Option<mask32x16<S>>,
}

impl<S: Simd, A: Sums<S>> Lookup<'_, S, A> {
    /// A line of probes, pair by pair from the middle.
    #[inline(always)]
    fn line(&mut self, plan: &Plan<S>, line: &Line<S>, footprint: &PacketFootprint<S>) {
        for k in 0..line.pairs {
            let (cells, weight) = line.pair(self.simd, k);
            let (s, t) = (line.step_s * cells, line.step_t * cells);
            self.levels(plan, footprint.s - s, footprint.t - t, weight);
            self.levels(plan, footprint.s + s, footprint.t + t, weight);
        }
    }

    /// One probe of each lane: its two levels.
    #[inline(always)]
    fn levels(&mut self, plan: &Plan<S>, s: f32x16<S>, t: f32x16<S>, weight: f32x16<S>) {
        let [s_mode, t_mode] = self.texture.modes();
        let place = [unit(self.simd, s_mode, s), unit(self.simd, t_mode, t)];
        let zero = f32x16::splat(self.simd, 0.0);
        let coarser = plan.fraction.simd_gt(zero);
        if !coarser.any_true() {
            return self.level(plan.fine, place, weight);
        }
        let coarse = weight * plan.fraction;
        self.level(plan.fine, place, weight - coarse);
        let next = coarser.select(plan.fine + 1.0, plan.fine);
        self.level(next, place, coarse);
    }

    #[inline(always)]
    fn level(&mut self, level: f32x16<S>, place: [f32x16<S>; 2], weight: f32x16<S>) {
        let placed = self.texture.placed(self.simd, level);
        let (column, right) = self.texel(place[0], placed.width);
        let (row, lower) = self.texel(place[1], placed.height);
        let share = Share {
            right,
            lower,
            weight,
        };
        let stride = self.texture.sheet().stride();
        let offsets = offset(stride, placed.column + column, placed.row + row);
        self.sums
            .add(self.simd, self.texels, stride as usize, offsets, &share);
    }

    /// The first of two neighbouring texels on an axis of `size`, −1 to size − 1, and the weight of the second.
    #[inline(always)]
    fn texel(&self, place: f32x16<S>, size: f32x16<S>) -> (f32x16<S>, f32x16<S>) {
        let zero = f32x16::splat(self.simd, 0.0);
        let position = place * size;
        let minus_one = f32x16::splat(self.simd, -1.0);
        let last = |first: f32x16<S>| first.min(size - 1.0);
        let Some(nearest) = self.nearest else {
            let from_centre = (position - 0.5).max(minus_one);
            let first = last(from_centre.floor());
            return (
                first,
                (from_centre - first).min(f32x16::splat(self.simd, 1.0)),
            );
        };
        let from_centre =
            (position - nearest.select(zero, f32x16::splat(self.simd, 0.5))).max(minus_one);
        let first = last(from_centre.floor());
        (
            first,
            nearest.select(
                zero,
                (from_centre - first).min(f32x16::splat(self.simd, 1.0)),
            ),
        )
    }
}

#[inline(always)]
fn offset<S: Simd>(stride: u32, column: f32x16<S>, row: f32x16<S>) -> u32x16<S> {
    u32x16::truncate_from(row) * stride + u32x16::truncate_from(column)
}

/// 8-bit texels as they are, where each lane reads just one.
#[inline(always)]
pub(super) fn picked<S: Simd>(
    simd: S,
    texture: &PackedPyramid,
    texels: &[u32],
    state: &SamplerState,
    footprint: &PacketFootprint<S>,
) -> Option<u32x16<S>> {
    let one = state.magnify == Filter::Nearest
        && state.minify == Filter::Nearest
        && (state.mip != MipFilter::Linear || texture.levels() == 1)
        && state.max_anisotropy.max(1.0) == 1.0;
    if !one {
        return None;
    }
    let plan = Plan::of(simd, texture, state, footprint);
    let placed = texture.placed(simd, plan.fine);
    let [s_mode, t_mode] = texture.modes();
    let texel = |place: f32x16<S>, size: f32x16<S>| (place * size).floor().min(size - 1.0);
    let column = texel(unit(simd, s_mode, footprint.s), placed.width);
    let row = texel(unit(simd, t_mode, footprint.t), placed.height);
    let stride = texture.sheet().stride();
    let offsets: [u32; 16] = offset(stride, placed.column + column, placed.row + row).to_array();
    Some(
        offsets
            .map(|offset| texels[offset as usize])
            .simd_into(simd),
    )
}
