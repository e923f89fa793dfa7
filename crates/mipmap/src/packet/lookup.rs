//! The texels that a plan names, weighted and summed.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16, mask32x16, u32x16};
use sampler::packet::{BlockSums, ONE, Share, Sums, codes, fold, held, unit};
use sampler::{AddressMode, Filter};

use super::bicubic::Kernels;
use super::layout::Placed;
use super::plan::Plan;
use super::{PackedPyramid, PacketFootprint};
use crate::sample::{MipFilter, SamplerState};

/// What becomes of a packet's sums.
pub(super) trait Finish<S: Simd> {
    type Output;
    /// `total`: what the lookups counted for; `None` for 1.
    fn finish<A: Sums<S>>(simd: S, sums: A, total: Option<f32x16<S>>) -> Self::Output;
}

/// Interleaved RGBA.
pub(super) struct Colours;

/// 8-bit codes of RGBA.
pub(super) struct Codes;

impl<S: Simd> Finish<S> for Colours {
    type Output = [f32x16<S>; 4];

    #[inline(always)]
    fn finish<A: Sums<S>>(simd: S, sums: A, total: Option<f32x16<S>>) -> [f32x16<S>; 4] {
        let one = f32x16::splat(simd, 1.0);
        let scale = match total {
            None => one,
            Some(total) => one / total,
        };
        sums.texels(simd, scale)
    }
}

impl<S: Simd> Finish<S> for Codes {
    type Output = u32x16<S>;

    #[inline(always)]
    fn finish<A: Sums<S>>(simd: S, sums: A, total: Option<f32x16<S>>) -> u32x16<S> {
        match total {
            None => sums.codes(simd),
            Some(_) => codes(simd, Colours::finish(simd, sums, total)),
        }
    }
}

/// The filtered colours. `most`: as [`Plan::of`] takes it.
#[inline(always)]
pub(super) fn filtered<S: Simd, A: BlockSums<S>, F: Finish<S>>(
    simd: S,
    texture: &PackedPyramid,
    texels: &[A::Texel],
    state: &SamplerState,
    most: f32x16<S>,
    footprint: &PacketFootprint<S>,
) -> F::Output {
    let plan = Plan::of(simd, texture, state, most, footprint);
    if let Some(kernels) = Kernels::of(simd, state, plan.minified) {
        return simd.vectorize(
            #[inline(always)]
            || kernels.filtered::<A, F>(simd, texture, texels, &plan, footprint),
        );
    }
    let lookup = Lookup {
        simd,
        texture,
        texels,
        nearest: nearest_lanes(simd, state, plan.minified),
        bordered: texture.modes().contains(&AddressMode::ClampToBorder),
    };
    let zero = f32x16::splat(simd, 0.0);
    // Beside the last level there is none; its weight is 0.
    let last = f32x16::splat(simd, (texture.levels() - 1) as f32);
    let levels = 1 + usize::from(plan.fraction.simd_gt(zero).any_true());
    let fine = texture.placed(simd, plan.fine);
    let mut placed = [fine; 2];
    if levels == 2 {
        placed[1] = texture.placed(simd, (plan.fine + 1.0).min(last));
    }
    let mut sums = A::zero(simd);
    let one_units = u32x16::splat(simd, ONE);
    let coarse = u32x16::truncate_from(plan.fraction * ONE as f32 + 0.5);
    let (s, t) = (held(simd, footprint.s), held(simd, footprint.t));
    let Some(line) = &plan.line else {
        let place = lookup.place(s, t);
        lookup.level(&mut sums, &placed[0], place, one_units - coarse);
        if levels == 2 {
            lookup.level(&mut sums, &placed[1], place, coarse);
        }
        return F::finish(simd, sums, None);
    };
    let mut all_weights = u32x16::splat(simd, 0);
    for k in 0..line.pairs {
        let (cells, weight) = line.pair(simd, k);
        let all = u32x16::truncate_from(weight * ONE as f32 + 0.5);
        let coarse = u32x16::truncate_from(weight * plan.fraction * ONE as f32 + 0.5);
        all_weights += all + all;
        let (ds, dt) = (line.step_s * cells, line.step_t * cells);
        for (s, t) in [(s - ds, t - dt), (s + ds, t + dt)] {
            let place = lookup.place(s, t);
            lookup.level(&mut sums, &placed[0], place, all - coarse);
            if levels == 2 {
                lookup.level(&mut sums, &placed[1], place, coarse);
            }
        }
    }
    let total = Some(f32x16::float_from(all_weights) * (1.0 / ONE as f32));
    F::finish(simd, sums, total)
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

pub(super) struct Lookup<'a, S: Simd, T> {
    simd: S,
    texture: &'a PackedPyramid,
    texels: &'a [T],
    nearest: Option<mask32x16<S>>,
    bordered: bool,
}

impl<'a, S: Simd, T> Lookup<'a, S, T> {
    /// Of 2×2 texels in every lane.
    #[inline(always)]
    pub(super) fn bilinear(simd: S, texture: &'a PackedPyramid, texels: &'a [T]) -> Self {
        Self {
            simd,
            texture,
            texels,
            nearest: None,
            bordered: texture.modes().contains(&AddressMode::ClampToBorder),
        }
    }

    /// Where each lane stands in the texture; coordinates as [`fold`] takes them.
    #[inline(always)]
    pub(super) fn place(&self, s: f32x16<S>, t: f32x16<S>) -> [f32x16<S>; 2] {
        let [s_mode, t_mode] = self.texture.modes();
        [fold(self.simd, s_mode, s), fold(self.simd, t_mode, t)]
    }

    /// Adds one level's texels at each lane's place.
    #[inline(always)]
    pub(super) fn level<A: Sums<S, Texel = T>>(
        &self,
        sums: &mut A,
        placed: &Placed<S>,
        place: [f32x16<S>; 2],
        weight: u32x16<S>,
    ) {
        let (column, right) = self.texel(place[0], placed.width);
        let (row, lower) = self.texel(place[1], placed.height);
        let share = Share {
            right,
            lower,
            weight,
        };
        let stride = self.texture.sheet().stride();
        let offsets = (placed.row + row) * stride + (placed.column + column);
        sums.add(self.simd, self.texels, stride as usize, offsets, &share);
    }

    /// The first of two neighbouring texels on an axis of `size`, −1 to size − 1, and the weight of the second.
    #[inline(always)]
    fn texel(&self, place: f32x16<S>, size: f32x16<S>) -> (u32x16<S>, u32x16<S>) {
        let bits = self.texture.fraction_bits();
        let one = f32x16::splat(self.simd, (1u32 << bits) as f32);
        let half = one * 0.5;
        let to_centre = match self.nearest {
            Some(nearest) => nearest.select(f32x16::splat(self.simd, 0.0), half),
            None => half,
        };
        // A whole texel more than the place, so that truncation is the floor.
        let mut units = place * size + (one - to_centre);
        if self.bordered {
            units = units.max(f32x16::splat(self.simd, 0.0));
        }
        let mut units = i32x16::truncate_from(units);
        let last = i32x16::truncate_from(size) + ((1 << bits) - 1);
        let none = u32x16::splat(self.simd, 0);
        let mut beyond = none;
        if self.bordered || self.nearest.is_some() {
            // At the far end, and beyond a border, the last texel's right edge.
            if self.bordered {
                let whole = u32x16::splat(self.simd, ONE);
                beyond = units.simd_gt(last).select(whole, none);
            }
            units = units.min(last);
        }
        let fraction = units & ((1 << bits) - 1);
        let first: u32x16<S> = ((units >> bits) - 1).bitcast();
        let second: u32x16<S> = (fraction << (ONE.ilog2() - bits)).bitcast();
        match self.nearest {
            Some(nearest) => (first, nearest.select(beyond, second)),
            None => (first, second),
        }
    }
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
    let most = f32x16::splat(simd, 1.0);
    let plan = Plan::of(simd, texture, state, most, footprint);
    let placed = texture.placed(simd, plan.fine);
    let [s_mode, t_mode] = texture.modes();
    let (s, t) = (
        unit(simd, s_mode, footprint.s),
        unit(simd, t_mode, footprint.t),
    );
    let bits = texture.fraction_bits();
    let column = u32x16::truncate_from((s * placed.width).min(placed.width - 1.0)) >> bits;
    let row = u32x16::truncate_from((t * placed.height).min(placed.height - 1.0)) >> bits;
    let stride = texture.sheet().stride();
    let offsets = (placed.row + row) * stride + (placed.column + column);
    let offsets: [u32; 16] = offsets.to_array();
    let mut codes = [0; 16];
    for (code, offset) in codes.iter_mut().zip(offsets) {
        *code = texels[offset as usize];
    }
    Some(codes.simd_into(simd))
}
