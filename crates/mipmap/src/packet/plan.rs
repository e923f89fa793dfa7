//! Levels and probes of sixteen footprints: the packet twin of what [`crate::sample`] decides.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16};
use sampler::Filter;

use super::{PackedPyramid, PacketFootprint};
use crate::lod::{LodRule, packet_log2};
use crate::sample::{CUT_SHARPENING, MAX_ANISOTROPY, MipFilter, SamplerState};

/// What each lane reads.
#[derive(Clone, Copy)]
pub(super) struct Plan<S: Simd> {
    /// The finer level, a whole number, and the weight of the next.
    pub(super) fine: f32x16<S>,
    pub(super) fraction: f32x16<S>,
    /// Whether λ > 0.
    pub(super) minified: mask32x16<S>,
    /// The probes; none where every lane has one.
    pub(super) line: Option<Line<S>>,
}

/// A line of probes about each lane's middle.
#[derive(Clone, Copy)]
pub(super) struct Line<S: Simd> {
    /// From one probe to the next, in textures.
    pub(super) step_s: f32x16<S>,
    pub(super) step_t: f32x16<S>,
    /// Whole cells on each side; where the end's probe stands and what it counts for.
    pub(super) whole: f32x16<S>,
    pub(super) end_at: f32x16<S>,
    pub(super) end: f32x16<S>,
    /// Pairs of probes of the lane that has most.
    pub(super) pairs: u32,
}

/// The greatest distance of probes, in textures.
const FARTHEST_STEP: f32 = 1_048_576.0;

/// The footprint's ellipse in texels.
pub(super) struct Ellipse<S: Simd> {
    /// Square of the longer axis.
    pub(super) major_squared: f32x16<S>,
    /// Longer over shorter axis, 1 and more.
    pub(super) aspect: f32x16<S>,
    /// A vector along the longer axis, of any length.
    pub(super) along: [f32x16<S>; 2],
}

impl<S: Simd> Plan<S> {
    #[inline(always)]
    pub(super) fn of(
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        footprint: &PacketFootprint<S>,
    ) -> Self {
        let zero = f32x16::splat(simd, 0.0);
        let one = f32x16::splat(simd, 1.0);
        let max_anisotropy = f32::min(state.max_anisotropy.max(1.0), MAX_ANISOTROPY);
        let one_level = texture.levels() == 1 || state.mip == MipFilter::None;
        if one_level && state.magnify == state.minify && max_anisotropy == 1.0 {
            return Self {
                fine: zero,
                fraction: zero,
                minified: zero.simd_eq(one),
                line: None,
            };
        }

        let ellipse = Ellipse::of(simd, texture, state.lod_rule, footprint);
        let bounded = ellipse.major_squared.simd_le(f32x16::splat(simd, f32::MAX));
        // η, and what of the aspect it leaves.
        let eta = if max_anisotropy == 1.0 {
            one
        } else {
            let eta = followed(simd, &ellipse, max_anisotropy, state.magnify);
            bounded.select(eta, one)
        };
        let half = f32x16::splat(simd, 0.5);
        let mut lambda = packet_log2(simd, ellipse.major_squared) * half;
        if max_anisotropy > 1.0 {
            lambda -= packet_log2(simd, eta);
        }
        if state.lod_rule == LodRule::Exact {
            let cut = if max_anisotropy == 1.0 {
                ellipse.aspect
            } else {
                ellipse.aspect / eta
            };
            let cut = cut.min(f32x16::splat(simd, 2.0)).max(one);
            lambda -= packet_log2(simd, cut) * CUT_SHARPENING;
        }
        let lambda = bounded.select(lambda, f32x16::splat(simd, f32::INFINITY));
        let lambda = limited(simd, state, lambda);
        let (fine, fraction) = levels(simd, texture, state.mip, lambda);
        let line = if max_anisotropy > 1.0 && eta.simd_gt(one).any_true() {
            Some(Line::of(simd, texture, &ellipse, eta))
        } else {
            None
        };
        Self {
            fine,
            fraction,
            minified: lambda.simd_gt(zero),
            line,
        }
    }
}

impl<S: Simd> Ellipse<S> {
    #[inline(always)]
    pub(super) fn of(
        simd: S,
        texture: &PackedPyramid,
        rule: LodRule,
        footprint: &PacketFootprint<S>,
    ) -> Self {
        let [w, h] = [texture.size().x as f32, texture.size().y as f32];
        let (ax, ay) = (footprint.ds_dx * w, footprint.dt_dx * h);
        let (bx, by) = (footprint.ds_dy * w, footprint.dt_dy * h);
        let one = f32x16::splat(simd, 1.0);
        let least = f32x16::splat(simd, f32::MIN_POSITIVE);
        if rule == LodRule::MaxLength {
            let (aa, bb) = (ax * ax + ay * ay, bx * bx + by * by);
            let first = aa.simd_ge(bb);
            let major_squared = known_or_infinite(simd, aa, bb).max(least);
            let minor_squared = aa.min(bb).max(least);
            return Self {
                major_squared,
                aspect: (major_squared / minor_squared).max(one).sqrt(),
                along: [first.select(ax, bx), first.select(ay, by)],
            };
        }
        // The singular values: with the determinant, because a difference would cancel.
        let (xx, yy) = (ax * ax + bx * bx, ay * ay + by * by);
        let xy = ax * ay + bx * by;
        let half_difference = (xx - yy) * 0.5;
        let root = (half_difference * half_difference + xy * xy).sqrt();
        let major_squared = ((xx + yy) * 0.5 + root).max(least);
        let determinant = (ax * by - ay * bx).abs().max(least);
        let wide = half_difference.simd_ge(f32x16::splat(simd, 0.0));
        Self {
            major_squared: known_or_infinite(simd, major_squared, root),
            aspect: (major_squared / determinant).max(one),
            along: [
                wide.select(half_difference + root, xy),
                wide.select(xy, root - half_difference),
            ],
        }
    }
}

/// The greater; ∞ where either is NaN.
#[inline(always)]
fn known_or_infinite<S: Simd>(simd: S, a: f32x16<S>, b: f32x16<S>) -> f32x16<S> {
    let known = a.simd_eq(a) & b.simd_eq(b);
    known.select(a.max(b), f32x16::splat(simd, f32::INFINITY))
}

/// η: the aspect that probes follow.
#[inline(always)]
fn followed<S: Simd>(
    simd: S,
    ellipse: &Ellipse<S>,
    max_anisotropy: f32,
    magnify: Filter,
) -> f32x16<S> {
    let one = f32x16::splat(simd, 1.0);
    let major = ellipse.major_squared.sqrt();
    let most = match magnify {
        Filter::Nearest => major,
        Filter::Bilinear | Filter::Bicubic(_) => major * 2.0,
    };
    let aspect = ellipse.aspect;
    let nearly_round = aspect.simd_lt(f32x16::splat(simd, 1.6));
    let needed = nearly_round.select((aspect * 1.5 - 0.8).max(one), aspect);
    needed
        .min(f32x16::splat(simd, max_anisotropy))
        .min(most.max(one))
}

/// λ with bias and limits; NaN never passes.
#[inline(always)]
fn limited<S: Simd>(simd: S, state: &SamplerState, lambda: f32x16<S>) -> f32x16<S> {
    let infinite = f32x16::splat(simd, f32::INFINITY);
    let bias = if state.lod_bias.is_nan() {
        0.0
    } else {
        state.lod_bias
    };
    let biased = lambda + bias;
    let biased = biased.simd_eq(biased).select(biased, infinite);
    let [least, greatest] = state.lod_range;
    let below = if greatest.is_nan() {
        biased
    } else {
        biased.min(f32x16::splat(simd, greatest))
    };
    if least.is_nan() {
        below
    } else {
        below.max(f32x16::splat(simd, least))
    }
}

#[inline(always)]
fn levels<S: Simd>(
    simd: S,
    texture: &PackedPyramid,
    mip: MipFilter,
    lambda: f32x16<S>,
) -> (f32x16<S>, f32x16<S>) {
    let zero = f32x16::splat(simd, 0.0);
    let last = f32x16::splat(simd, (texture.levels() - 1) as f32);
    let lod = lambda.max(zero).min(last);
    match mip {
        MipFilter::None => (zero, zero),
        MipFilter::Nearest => (((lod + 0.5).ceil() - 1.0).max(zero), zero),
        MipFilter::Linear => {
            let fine = lod.floor();
            (fine, lod - fine)
        }
    }
}

impl<S: Simd> Line<S> {
    #[inline(always)]
    fn of(simd: S, texture: &PackedPyramid, ellipse: &Ellipse<S>, eta: f32x16<S>) -> Self {
        let zero = f32x16::splat(simd, 0.0);
        let one = f32x16::splat(simd, 1.0);
        let two = f32x16::splat(simd, 2.0);
        // The longer axis over η, from texels to textures.
        let [x, y] = ellipse.along;
        let squared = x * x + y * y;
        let some = squared.simd_gt(zero) & squared.simd_le(f32x16::splat(simd, f32::MAX));
        let length = (ellipse.major_squared / some.select(squared, one)).sqrt() / eta;
        let [w, h] = [texture.size().x as f32, texture.size().y as f32];
        let (step_s, step_t) = (x * length * (1.0 / w), y * length * (1.0 / h));
        // Beyond so many textures the coarsest level answers, wherever a probe stands.
        let farthest = f32x16::splat(simd, FARTHEST_STEP);
        let some = some & step_s.abs().simd_le(farthest) & step_t.abs().simd_le(farthest);
        let (step_s, step_t) = (some.select(step_s, zero), some.select(step_t, zero));
        let half = eta * 0.5;
        let whole = half.floor();
        let rest = half - whole;
        let parting = eta.simd_le(two);
        let pairs = (parting.select(one, half.ceil())).reduce_max();
        Self {
            step_s,
            step_t,
            whole: parting.select(zero, whole),
            end_at: parting.select((eta - one) * 0.5, whole + rest * 0.5),
            end: parting.select(one, rest),
            pairs: whole_number(pairs),
        }
    }
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number from 1 to MAX_ANISOTROPY"
)]
fn whole_number(x: f32) -> u32 {
    x as u32
}
