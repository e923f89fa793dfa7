//! Levels and probes of sixteen footprints: the packet twin of what [`crate::sample`] decides.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16};
use sampler::Filter;

use super::line::Line;
use super::{PackedPyramid, PacketFootprint};
use crate::lod::{LodRule, packet_log2};
use crate::sample::{CUT_SHARPENING, MAX_ANISOTROPY, MipFilter, SamplerState};

/// The greatest aspect that a state lets probes follow.
#[inline(always)]
pub(super) fn greatest_anisotropy(state: &SamplerState) -> f32 {
    f32::min(state.max_anisotropy.max(1.0), MAX_ANISOTROPY)
}

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
    /// `most`: the greatest aspect that each lane follows, 1 and more, but never more than the state does.
    #[inline(always)]
    pub(super) fn of(
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
        most: f32x16<S>,
        footprint: &PacketFootprint<S>,
    ) -> Self {
        let zero = f32x16::splat(simd, 0.0);
        let one = f32x16::splat(simd, 1.0);
        let max_anisotropy = greatest_anisotropy(state);
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
            let eta = followed(simd, &ellipse, most, state.magnify);
            bounded.select(eta, one)
        };
        // Where η is all of the longer axis, λ is 0 exactly, and neither side of it.
        let mut lambda = if max_anisotropy > 1.0 {
            packet_log2(simd, ellipse.major_squared.sqrt() / eta)
        } else {
            packet_log2(simd, ellipse.major_squared) * 0.5
        };
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
            Some(Line::of(simd, texture, &ellipse, eta, state.probe_weights))
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
    max_anisotropy: f32x16<S>,
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
    needed.min(max_anisotropy).min(most.max(one))
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
