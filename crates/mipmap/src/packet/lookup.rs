//! The texels that a plan names, weighted and summed.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16, u32x16};
use sampler::Filter;
use sampler::packet::{Share, Sums, unit};

use super::plan::Plan;
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
    let lookup = Lookup {
        simd,
        texture,
        texels,
        nearest: nearest_lanes(simd, state, plan.minified),
    };
    let zero = f32x16::splat(simd, 0.0);
    let one = f32x16::splat(simd, 1.0);
    let two_levels = plan.fraction.simd_gt(zero).any_true();
    let mut sums = A::zero(simd);
    // A line's probes stand on either side of the middle: pair 0 before and after it, pair 1, and so on.
    let probes = plan.line.map_or(1, |line| 2 * line.pairs);
    for probe in 0..probes {
        let (s, t, weight) = match &plan.line {
            None => (footprint.s, footprint.t, one),
            Some(line) => line.probe(simd, probe, footprint),
        };
        let place = lookup.place(s, t);
        let coarse = weight * plan.fraction;
        let mut reads = [(plan.fine, weight - coarse), (plan.fine + 1.0, coarse)];
        if two_levels {
            // Of weight 0 the level beside the last would be.
            let last = f32x16::splat(simd, (texture.levels() - 1) as f32);
            reads[1].0 = reads[1].0.min(last);
        }
        for (level, weight) in &reads[..1 + usize::from(two_levels)] {
            lookup.level(&mut sums, *level, place, *weight);
        }
    }
    sums.texels(simd, plan.line.map_or(one, |line| one / line.total))
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

struct Lookup<'a, S: Simd, T> {
    simd: S,
    texture: &'a PackedPyramid,
    texels: &'a [T],
    nearest: Option<mask32x16<S>>,
}

impl<S: Simd, T> Lookup<'_, S, T> {
    /// Where each lane stands in the texture.
    #[inline(always)]
    fn place(&self, s: f32x16<S>, t: f32x16<S>) -> [f32x16<S>; 2] {
        let [s_mode, t_mode] = self.texture.modes();
        [unit(self.simd, s_mode, s), unit(self.simd, t_mode, t)]
    }

    /// Adds one level's texels at each lane's place.
    #[inline(always)]
    fn level<A: Sums<S, Texel = T>>(
        &self,
        sums: &mut A,
        level: f32x16<S>,
        place: [f32x16<S>; 2],
        weight: f32x16<S>,
    ) {
        let placed = self.texture.placed(self.simd, level);
        let (column, right) = self.texel(place[0], placed.width);
        let (row, lower) = self.texel(place[1], placed.height);
        let share = Share { right, lower, weight };
        let stride = self.texture.sheet().stride();
        let offsets = offset(stride, placed.column + column, placed.row + row);
        sums.add(self.simd, self.texels, stride as usize, offsets, &share);
    }

    /// The first of two neighbouring texels on an axis of `size`, −1 to size − 1, and the weight of the second.
    #[inline(always)]
    fn texel(&self, place: f32x16<S>, size: f32x16<S>) -> (f32x16<S>, f32x16<S>) {
        let zero = f32x16::splat(self.simd, 0.0);
        let half = f32x16::splat(self.simd, 0.5);
        let to_centre = match self.nearest {
            Some(nearest) => nearest.select(zero, half),
            None => half,
        };
        let from_centre = (place * size - to_centre).max(f32x16::splat(self.simd, -1.0));
        let first = from_centre.floor().min(size - 1.0);
        let second = (from_centre - first).min(f32x16::splat(self.simd, 1.0));
        match self.nearest {
            Some(nearest) => (first, nearest.select(zero, second)),
            None => (first, second),
        }
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
    let (s, t) = (unit(simd, s_mode, footprint.s), unit(simd, t_mode, footprint.t));
    let column = (s * placed.width).floor().min(placed.width - 1.0);
    let row = (t * placed.height).floor().min(placed.height - 1.0);
    let stride = texture.sheet().stride();
    let offsets: [u32; 16] = offset(stride, placed.column + column, placed.row + row).to_array();
    let mut codes = [0; 16];
    for (code, offset) in codes.iter_mut().zip(offsets) {
        *code = texels[offset as usize];
    }
    Some(codes.simd_into(simd))
}
