use sampler::{Addressing, Filter, Precision};

use crate::lod::LodRule;
use crate::probes::ProbeWeights;

/// The greatest anisotropy that a lookup follows, whatever its state asks for.
pub const MAX_ANISOTROPY: f32 = 64.0;

/// The least [`SamplerState::mip_band`].
pub const LEAST_MIP_BAND: f32 = 1.0 / 64.0;

/// How the levels of a pyramid are used when a texture is minified.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum MipFilter {
    /// Level 0 only.
    None,
    /// The level nearest to λ: ⌈λ + ½⌉ − 1.
    Nearest,
    /// The two levels around λ, weighted linearly; with [`Filter::Bilinear`], trilinear filtering.
    #[default]
    #[doc(alias = "trilinear")]
    Linear,
}

/// How a pyramid is read. The default is the best this crate offers: trilinear, 16 times anisotropic, repeating.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SamplerState {
    /// Address modes of s and of t, and the border's colour.
    pub address: Addressing<2>,
    /// How exactly 8-bit texels are filtered within a level.
    pub precision: Precision,
    /// Filter where a texel covers a pixel or more (λ ≤ 0).
    pub magnify: Filter,
    /// Filter within a level where a pixel covers more than a texel (λ > 0).
    pub minify: Filter,
    /// How levels are chosen where λ > 0.
    pub mip: MipFilter,
    /// The part of a level's range over which [`MipFilter::Linear`] blends it with the next, about the middle: 1 is
    /// trilinear filtering; less reads one level alone where λ is near a whole number, at ¾ over a quarter of all λ, at
    /// little error beside that of the levels themselves. Below [`LEAST_MIP_BAND`] counts as that, above 1 and
    /// NaN as 1.
    pub mip_band: f32,
    /// Which lengths of the footprint count as its axes.
    pub lod_rule: LodRule,
    /// Added to λ: negative is sharper. NaN counts as 0.
    pub lod_bias: f32,
    /// Least and greatest λ, after the bias. The least wins over a smaller greatest; NaN is no limit.
    pub lod_range: [f32; 2],
    /// Greatest aspect of a footprint that is followed by a line of probes; 1 turns it off. Less than 1 and NaN
    /// count as 1, more than [`MAX_ANISOTROPY`] as that.
    pub max_anisotropy: f32,
    /// How the probes of that line are weighted, and so the pixel kernel it stands for.
    pub probe_weights: ProbeWeights,
}

impl SamplerState {
    /// λ with bias and limits. Negative λ counts until the bias is added; NaN never passes.
    #[inline]
    pub(crate) fn limited(&self, lambda: f32) -> f32 {
        let biased = if self.lod_bias.is_nan() {
            lambda
        } else {
            lambda + self.lod_bias
        };
        // `min` and `max` ignore NaN; ∞ − ∞ is the coarsest level.
        let biased = if biased.is_nan() {
            f32::INFINITY
        } else {
            biased
        };
        biased.min(self.lod_range[1]).max(self.lod_range[0])
    }

    /// 1 over the band in which levels are blended: 1 and more.
    #[inline]
    pub(crate) fn blend_slope(&self) -> f32 {
        // `min` turns NaN into 1.
        1.0 / f32::min(self.mip_band, 1.0).max(LEAST_MIP_BAND)
    }

    /// Whether λ ≤ 0 before bias and limits is λ ≤ 0 after them.
    #[inline]
    pub(crate) fn keeps_magnification(&self) -> bool {
        !(self.lod_bias > 0.0 || self.lod_range[0] > 0.0)
    }
}

impl Default for SamplerState {
    fn default() -> Self {
        Self {
            address: Addressing::default(),
            precision: Precision::Exact,
            magnify: Filter::Bilinear,
            minify: Filter::Bilinear,
            mip: MipFilter::Linear,
            mip_band: 1.0,
            lod_rule: LodRule::Exact,
            lod_bias: 0.0,
            lod_range: [f32::NEG_INFINITY, f32::INFINITY],
            max_anisotropy: 16.0,
            probe_weights: ProbeWeights::Equal,
        }
    }
}
