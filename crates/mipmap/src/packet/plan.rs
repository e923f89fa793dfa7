//! Levels and probes of sixteen footprints: the packet twin of what [`crate::sample`] decides.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16};
use sampler::Filter;

use super::layout::Placed;
use super::line::Line;
use super::{PackedPyramid, PacketFootprint};
use crate::lod::{LodRule, packet_log2};
use crate::sample::CUT_SHARPENING;
use crate::sampler_state::{MAX_ANISOTROPY, MipFilter, SamplerState};

/// The greatest aspect that a state lets probes follow.
#[inline(always)]
pub(super) fn greatest_anisotropy(state: &SamplerState) -> f32 {
    f32::min(state.max_anisotropy.max(1.0), MAX_ANISOTROPY)
}

/// Whether every lane reads the finest level alone, whatever its footprint.
#[inline(always)]
pub(super) fn has_one_level(texture: &PackedPyramid, state: &SamplerState) -> bool {
    texture.levels() == 1 || state.mip == MipFilter::None
}

/// Whether footprints of any size are read alike: one tap of the finest level.
#[inline(always)]
pub(super) fn has_one_plan(texture: &PackedPyramid, state: &SamplerState) -> bool {
    has_one_level(texture, state)
        && state.magnify == state.minify
        && greatest_anisotropy(state) == 1.0
}

/// What each lane reads.
#[derive(Clone, Copy)]
pub(super) struct Plan<S: Simd> {
    /// The finer level, a whole number, and the weight of the next.
    pub(super) fine: f32x16<S>,
    pub(super) fraction: f32x16<S>,
    /// Whether λ > 0.
    pub(super) minified: mask32x16<S>,
    /// None where every lane has one probe.
    pub(super) line: Option<Line<S>>,
}

/// The footprint's ellipse in texels.
#[derive(Clone, Copy)]
pub(super) struct Ellipse<S: Simd> {
    /// Lanes whose footprint is finite.
    pub(super) bounded: mask32x16<S>,
    /// Square of the longer axis.
    pub(super) major_squared: f32x16<S>,
    /// The axes' product; by [`LodRule::MaxLength`] the square of the shorter vector.
    determinant: f32x16<S>,
    /// A vector along the longer axis, of any length.
    pub(super) along: [f32x16<S>; 2],
}

impl<S: Simd> Plan<S> {
    /// The plan of all footprints of a texture that [`has_one_plan`].
    #[inline(always)]
    pub(super) fn fixed(simd: S, texture: &PackedPyramid) -> Self {
        let zero = f32x16::splat(simd, 0.0);
        Self {
            fine: f32x16::splat(simd, texture.stored()[0]),
            fraction: zero,
            minified: zero.simd_lt(zero),
            line: None,
        }
    }

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
        let ellipse = Ellipse::of(simd, texture, state.lod_rule, footprint);
        let mut lambda = packet_log2(simd, ellipse.major_squared) * 0.5;
        let mut eta = one;
        if max_anisotropy == 1.0 {
            if state.lod_rule == LodRule::Exact {
                lambda -= sharpened(simd, ellipse.aspect(state.lod_rule), one);
            }
        } else {
            let aspect = ellipse.aspect(state.lod_rule);
            eta = followed(simd, ellipse.major_squared, aspect, most, state.magnify);
            eta = ellipse.bounded.select(eta, one);
            if state.magnify == state.minify {
                lambda -= packet_log2(simd, eta);
            } else {
                // Where η is all of the longer axis, λ is 0 exactly, and neither side of it.
                lambda = packet_log2(simd, ellipse.major_squared.sqrt() / eta);
            }
            if state.lod_rule == LodRule::Exact {
                lambda -= sharpened(simd, aspect, eta);
            }
        }
        let lambda = ellipse
            .bounded
            .select(lambda, f32x16::splat(simd, f32::INFINITY));
        let lambda = limited(simd, state, lambda);
        let (fine, fraction) = levels(simd, texture, state, lambda);
        let several = max_anisotropy > 1.0 && eta.simd_gt(one).any_true();
        Self {
            fine,
            fraction,
            minified: lambda.simd_gt(zero),
            line: several.then(
                #[inline(always)]
                || Line::of(simd, texture, (&ellipse, eta), state.probe_weights),
            ),
        }
    }

    /// Where the finer level and the next lie, and how many of them are read.
    #[inline(always)]
    pub(super) fn placed(
        &self,
        simd: S,
        texture: &PackedPyramid,
        state: &SamplerState,
    ) -> ([Placed<S>; 2], usize) {
        if has_one_level(texture, state) {
            return (
                texture.placed_everywhere(simd, texture.finest() as usize),
                1,
            );
        }
        let blended = self.fraction.simd_gt(0.0).any_true();
        (texture.placed(simd, self.fine), 1 + usize::from(blended))
    }

    /// Of a plan of 16 quads of 2×2 pixels in a row, that of 16 pixels above or below each other: of the first eight quads
    /// (`half` 0) or the last.
    #[inline(always)]
    pub(super) fn of_pixels(&self, half: usize) -> Self {
        let simd = self.fine.simd;
        let (zero, one) = (f32x16::splat(simd, 0.0), f32x16::splat(simd, 1.0));
        let minified = twice(self.minified.select(one, zero), half);
        Self {
            fine: twice(self.fine, half),
            fraction: twice(self.fraction, half),
            minified: minified.simd_gt(zero),
            line: self.line.as_ref().map(
                #[inline(always)]
                |line| line.of_pixels(half),
            ),
        }
    }
}

/// The first eight lanes (`half` 0) or the last, each twice.
#[inline(always)]
pub(super) fn twice<S: Simd>(lanes: f32x16<S>, half: usize) -> f32x16<S> {
    if half == 0 {
        lanes.zip_low(lanes)
    } else {
        lanes.zip_high(lanes)
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
        let least = f32x16::splat(simd, f32::MIN_POSITIVE);
        let most = f32x16::splat(simd, f32::MAX);
        if rule == LodRule::MaxLength {
            let (aa, bb) = (ax * ax + ay * ay, bx * bx + by * by);
            let first = aa.simd_ge(bb);
            return Self {
                bounded: aa.simd_le(most) & bb.simd_le(most),
                major_squared: aa.max(bb).max(least),
                determinant: aa.min(bb).max(least),
                along: [first.select(ax, bx), first.select(ay, by)],
            };
        }
        // The singular values: with the determinant, because a difference would cancel.
        let (xx, yy) = (ax * ax + bx * bx, ay * ay + by * by);
        let xy = ax * ay + bx * by;
        let half_difference = (xx - yy) * 0.5;
        let root = (half_difference * half_difference + xy * xy).sqrt();
        let major_squared = (xx + yy) * 0.5 + root;
        let wide = half_difference.simd_ge(0.0);
        Self {
            bounded: major_squared.simd_le(most),
            major_squared: major_squared.max(least),
            determinant: (ax * by - ay * bx).abs().max(least),
            along: [
                wide.select(half_difference + root, xy),
                wide.select(xy, root - half_difference),
            ],
        }
    }

    /// The longer over the shorter axis, 1 and more.
    #[inline(always)]
    pub(super) fn aspect(&self, rule: LodRule) -> f32x16<S> {
        let ratio = (self.major_squared / self.determinant).max(1.0);
        match rule {
            LodRule::Exact => ratio,
            LodRule::MaxLength => ratio.sqrt(),
        }
    }
}

/// By how much λ is less where of an aspect η is left: no logarithm where that is all of it, or half and less.
#[inline(always)]
fn sharpened<S: Simd>(simd: S, aspect: f32x16<S>, eta: f32x16<S>) -> f32x16<S> {
    let (zero, one) = (f32x16::splat(simd, 0.0), f32x16::splat(simd, 1.0));
    let halved = aspect.simd_ge(eta + eta);
    let cut = aspect.simd_gt(eta) & !halved;
    let mut octaves = halved.select(one, zero);
    if cut.any_true() {
        octaves = cut.select(packet_log2(simd, aspect / eta), octaves);
    }
    octaves * CUT_SHARPENING
}

/// η: the aspect that probes follow.
#[inline(always)]
fn followed<S: Simd>(
    simd: S,
    major_squared: f32x16<S>,
    aspect: f32x16<S>,
    max_anisotropy: f32x16<S>,
    magnify: Filter,
) -> f32x16<S> {
    let one = f32x16::splat(simd, 1.0);
    let nearly_round = aspect.simd_lt(f32x16::splat(simd, 1.6));
    let needed = nearly_round.select((aspect * 1.5 - 0.8).max(one), aspect);
    let eta = needed.min(max_anisotropy);
    // The longer axis in what a probe covers at least, so that none is nearer to the next. Its root is seldom needed.
    let probes_a_texel = match magnify {
        Filter::Nearest => 1.0,
        Filter::Bilinear | Filter::Bicubic(_) => 2.0,
    };
    let most_squared = major_squared * (probes_a_texel * probes_a_texel);
    let too_many = most_squared.simd_lt(eta * eta);
    if too_many.any_true() {
        too_many.select(eta.min(most_squared.sqrt().max(one)), eta)
    } else {
        eta
    }
}

/// λ with bias and limits; NaN never passes.
#[inline(always)]
fn limited<S: Simd>(simd: S, state: &SamplerState, lambda: f32x16<S>) -> f32x16<S> {
    let mut lod = lambda;
    if !state.lod_bias.is_nan() && state.lod_bias != 0.0 {
        let biased = lambda + state.lod_bias;
        let infinite = f32x16::splat(simd, f32::INFINITY);
        lod = biased.simd_eq(biased).select(biased, infinite);
    }
    let [least, greatest] = state.lod_range;
    if greatest < f32::INFINITY {
        lod = lod.min(f32x16::splat(simd, greatest));
    }
    if least > f32::NEG_INFINITY {
        lod = lod.max(f32x16::splat(simd, least));
    }
    lod
}

#[inline(always)]
fn levels<S: Simd>(
    simd: S,
    texture: &PackedPyramid,
    state: &SamplerState,
    lambda: f32x16<S>,
) -> (f32x16<S>, f32x16<S>) {
    let zero = f32x16::splat(simd, 0.0);
    let [finest, last] = texture.stored();
    let (finest, last) = (f32x16::splat(simd, finest), f32x16::splat(simd, last));
    let lod = lambda.max(finest).min(last);
    match state.mip {
        MipFilter::None => (finest, zero),
        MipFilter::Nearest => (((lod + 0.5).ceil() - 1.0).max(finest), zero),
        MipFilter::Linear => {
            let fine = lod.floor();
            let fraction = lod - fine;
            let slope = state.blend_slope();
            if slope == 1.0 {
                return (fine, fraction);
            }
            let one = f32x16::splat(simd, 1.0);
            let banded = ((fraction - 0.5) * slope + 0.5).max(zero);
            let next = banded.simd_ge(one);
            (next.select(fine + 1.0, fine), next.select(zero, banded))
        }
    }
}
