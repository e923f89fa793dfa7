//! Lines of probes along the longer axes of sixteen footprints: the packet twin of [`crate::probes`].

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};

use super::PackedPyramid;
use super::gaussian::gaussian;
use super::plan::{Ellipse, twice};
use crate::lod::round_to_f32;
use crate::probes::{CUT, CUT_VARIANCE, EDGE, ProbeWeights};

/// A line of probes about each lane's middle: pairs, one probe on either side.
#[derive(Clone, Copy)]
pub(super) struct Line<S: Simd> {
    /// From one probe to the next, in textures.
    pub(super) step_s: f32x16<S>,
    pub(super) step_t: f32x16<S>,
    kind: ProbeWeights,
    weights: Weights<S>,
    /// Pairs of probes of the lane that has most.
    pub(super) pairs: u32,
    /// How many of them, the inner ones, count for 1 in every lane, and stand half a step further than their number.
    pub(super) common: u32,
}

/// How the probes are weighted.
#[derive(Clone, Copy)]
struct Weights<S: Simd> {
    /// Equal ones: whole cells on each side; where the end's probe stands and what it counts for.
    whole: f32x16<S>,
    end_at: f32x16<S>,
    end: f32x16<S>,
    /// Gaussian ones: 1/(16 s'²).
    falloff: f32x16<S>,
}

/// The longest axis that probes follow, in textures along the shorter side.
const LONGEST_AXIS: f32 = 1_048_576.0;

/// The least variance of a line that is divided by: it has the probe in its middle alone.
const LEAST_VARIANCE: f32 = 1e-6;

impl<S: Simd> Line<S> {
    #[inline(always)]
    pub(super) fn of(
        simd: S,
        texture: &PackedPyramid,
        (ellipse, eta): (&Ellipse<S>, f32x16<S>),
        kind: ProbeWeights,
    ) -> Self {
        let zero = f32x16::splat(simd, 0.0);
        let one = f32x16::splat(simd, 1.0);
        // The longer axis over η, from texels to textures; beyond so many the coarsest level answers, wherever a probe
        // stands.
        let [x, y] = ellipse.along;
        let squared = x * x + y * y;
        let most = f32x16::splat(simd, f32::MAX);
        let [w, h] = [texture.size().x as f32, texture.size().y as f32];
        let longest = LONGEST_AXIS * w.min(h);
        let longest = f32x16::splat(simd, longest * longest);
        let some =
            squared.simd_gt(zero) & squared.simd_le(most) & ellipse.major_squared.simd_le(longest);
        let length = (ellipse.major_squared / (some.select(squared, one) * eta * eta)).sqrt();
        let (step_s, step_t) = (x * length * (1.0 / w), y * length * (1.0 / h));
        let (weights, pairs) = Weights::of(simd, eta, kind);
        let common = match kind {
            ProbeWeights::Equal => weights.whole.reduce_min(),
            ProbeWeights::Gaussian => 0.0,
        };
        Self {
            step_s: some.select(step_s, zero),
            step_t: some.select(step_t, zero),
            kind,
            weights,
            pairs: whole_number(pairs),
            common: whole_number(common),
        }
    }

    /// As [`Plan::of_pixels`](super::plan::Plan::of_pixels): the lanes that have most pairs still say how many there are.
    #[inline(always)]
    pub(super) fn of_pixels(&self, half: usize) -> Self {
        let weights = &self.weights;
        Self {
            step_s: twice(self.step_s, half),
            step_t: twice(self.step_t, half),
            weights: Weights {
                whole: twice(weights.whole, half),
                end_at: twice(weights.end_at, half),
                end: twice(weights.end, half),
                falloff: twice(weights.falloff, half),
            },
            ..*self
        }
    }

    /// Where the probes of pair `k` stand, in steps from the middle, and what each counts for, 0..=1.
    #[inline(always)]
    pub(super) fn pair(&self, simd: S, k: u32) -> (f32x16<S>, f32x16<S>) {
        let zero = f32x16::splat(simd, 0.0);
        let one = f32x16::splat(simd, 1.0);
        let middle = k == 0;
        let k = f32x16::splat(simd, k as f32);
        let weights = &self.weights;
        match self.kind {
            ProbeWeights::Equal => {
                let (inner, outer) = (k.simd_lt(weights.whole), k.simd_gt(weights.whole));
                let weight = inner.select(one, outer.select(zero, weights.end));
                (inner.select(k + 0.5, weights.end_at), weight)
            }
            ProbeWeights::Gaussian => {
                // The middle is a pair of halves.
                let share = if middle { 0.5 } else { 1.0 };
                let cut = f32x16::splat(simd, round_to_f32(CUT * CUT / 16.0));
                let weight =
                    gaussian(simd, (k * k * weights.falloff).min(cut)) - round_to_f32(EDGE);
                (k, weight.max(zero) * share)
            }
        }
    }
}

impl<S: Simd> Weights<S> {
    /// With the pairs of the lane that has most.
    #[inline(always)]
    fn of(simd: S, eta: f32x16<S>, kind: ProbeWeights) -> (Self, f32) {
        let zero = f32x16::splat(simd, 0.0);
        let one = f32x16::splat(simd, 1.0);
        match kind {
            ProbeWeights::Equal => {
                let half = eta * 0.5;
                let whole = half.floor();
                let rest = half - whole;
                let parting = eta.simd_le(f32x16::splat(simd, 2.0));
                let equal = Self {
                    whole: parting.select(zero, whole),
                    end_at: parting.select((eta - one) * 0.5, whole + rest * 0.5),
                    end: parting.select(one, rest),
                    falloff: zero,
                };
                (equal, parting.select(one, half.ceil()).reduce_max())
            }
            ProbeWeights::Gaussian => {
                let variance = (eta * eta - one) * round_to_f32(0.25 / CUT_VARIANCE);
                let variance = variance.max(f32x16::splat(simd, LEAST_VARIANCE));
                let side = (variance.sqrt() * round_to_f32(CUT)).floor();
                let falloff = f32x16::splat(simd, 1.0 / 16.0) / variance;
                let gaussian = Self {
                    whole: zero,
                    end_at: zero,
                    end: zero,
                    falloff,
                };
                (gaussian, side.reduce_max() + 1.0)
            }
        }
    }
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number from 1 to a few times MAX_ANISOTROPY"
)]
fn whole_number(x: f32) -> u32 {
    x as u32
}
