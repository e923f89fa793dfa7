use glam::{DVec2, DVec4, UVec2, Vec4};
use sampler::{AddressMode, Addressing, Filter, FixedMean, Precision, Texels};

use crate::footprint::{AxisLengths, Footprint};
use crate::lod::{LodRule, quick_log2};
use crate::probes::{ProbeWeights, Probes};
use crate::pyramid::Pyramid;
use crate::stochastic::picks_first;

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
    /// trilinear filtering; less reads one level alone where λ is near a whole number, a quarter of the lookups for
    /// ¾, at little error beside that of the levels themselves. Below [`LEAST_MIP_BAND`] counts as that, above 1 and
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
    fn limited(&self, lambda: f32) -> f32 {
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
    fn keeps_magnification(&self) -> bool {
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

/// The colour under `footprint`.
///
/// With major and minor the footprint's axes in texels ([`crate::footprint_axes`]):
///
/// ```text
/// a = major/minor if that is 1.6 or more, else max(1.5·major/minor − 0.8, 1)
/// η = min(a, max_anisotropy, max(2·major, 1))
/// λ = log₂(major/η) − 0.4·min(log₂(major/minor/η), 1) + bias, within its range
/// ```
///
/// The footprint is covered by a line of probes a distance major/η apart along the major axis, weighted as
/// [`ProbeWeights`] says (by default as a box of length `major`); every probe filters at λ. For η = 1 that is one
/// probe, as for footprints up to 1.2 times as long as wide, where more would cost and err more. The last term of η keeps probes at least half a texel apart (a texel, where magnification is
/// [`Filter::Nearest`], so that no edge of a texel is softened). Where max_anisotropy cuts the aspect, λ rises; by
/// [`LodRule::Exact`] up to 0.4 less than the longer side asks for: a square as wide as a long footprint is too wide
/// across it. [`LodRule::MaxLength`] has no such term: it is the textbook's. The result is continuous in every input
/// wherever magnify, minify and mip are linear.
///
/// Target pixel kernel: of one lookup of level 0, the point; of one probe, a square along the texture's axes, as wide
/// as the footprint is long; of a line of probes, the rectangle that the footprint's two axes span, or by
/// [`ProbeWeights::Gaussian`] the Gaussian of σ = ½ pixel through the footprint.
///
/// Where λ reaches a last level of one texel that is not bordered, that texel is fetched once, whatever η.
///
/// Defined for every input: st as [`sampler::sample`]; a derivative that is infinite or NaN selects the coarsest
/// level.
///
/// # Accuracy
/// Within 1e-5 of the range of texels read of the f64 form of the same kernel; `tests/properties/anisotropic.rs`. By
/// [`Precision::Fixed`] within [`sampler::BILINEAR_FIXED_MAX_ERROR`] + 2e-5 of that; `tests/properties/filtering.rs`.
/// # Source
/// Vulkan 1.3, "Scale Factor Operation", "Image Level(s) Selection", "Texel Anisotropic Filtering" (η and λ; its
/// N = ⌈η⌉ equal probes jump with N, hence the weights here); McCormack et al. 1999, "Feline" (the probe line).
/// # Examples
/// ```
/// use glam::{DVec2, UVec2, Vec2};
/// use mipmap::{Content, Footprint, Pyramid, SamplerState, sample};
/// use sampler::{Texels, Texture, Transfer};
/// let halves = Texture::new(UVec2::new(2, 1), 1, Transfer::Linear, Texels::F32(vec![0.0, 1.0]))?;
/// let pyramid = Pyramid::build(halves, Content::Colour)?;
/// // A pixel that sees the texture ten times over sees its mean.
/// let far = Footprint { st: DVec2::ZERO, dst_dx: Vec2::X * 10.0, dst_dy: Vec2::Y * 10.0 };
/// assert_eq!(sample(&pyramid, &SamplerState::default(), &far).x, 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sample(pyramid: &Pyramid, state: &SamplerState, footprint: &Footprint) -> Vec4 {
    sample_with_lod(pyramid, state, footprint).0
}

/// As [`sample`], with the level of detail used: λ clamped to the stored levels, a whole number where one level was
/// chosen, 0 where level 0 answered.
pub fn sample_with_lod(
    pyramid: &Pyramid,
    state: &SamplerState,
    footprint: &Footprint,
) -> (Vec4, f32) {
    let plan = Plan::of(pyramid, state, footprint);
    if state.precision == Precision::Fixed
        && plan.filter == Filter::Bilinear
        && let Some(colour) = in_integers(pyramid, state, &plan, footprint.st)
    {
        return (colour, plan.levels.lod());
    }
    let at = |st: DVec2| {
        plan.levels
            .blend(|level| lookup(pyramid, state, plan.filter, level, st))
    };
    let colour = match plan.probes {
        None => at(footprint.st),
        Some(probes) => probes.map_sum(|offset| at(footprint.st + offset)),
    };
    (colour.as_vec4(), plan.levels.lod())
}

/// What a lookup reads: which levels, with which filter, at which probes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plan {
    pub(crate) levels: Levels,
    pub(crate) filter: Filter,
    /// None for one probe in the middle.
    pub(crate) probes: Option<Probes>,
}

impl Plan {
    #[inline]
    pub(crate) fn of(pyramid: &Pyramid, state: &SamplerState, footprint: &Footprint) -> Self {
        let magnified = Self {
            levels: Levels::one(0),
            filter: state.magnify,
            probes: None,
        };
        // `max` turns NaN into 1, which `clamp` would keep.
        let max_anisotropy = f32::min(state.max_anisotropy.max(1.0), MAX_ANISOTROPY);
        let one_level = pyramid.levels() == 1 || state.mip == MipFilter::None;
        if one_level && state.magnify == state.minify && max_anisotropy == 1.0 {
            return magnified;
        }

        // A texel, or half a one, covers the pixel: η = 1 and λ ≤ 0, whatever the axes.
        let one_probe = if max_anisotropy == 1.0 {
            1.0
        } else {
            one_probe_until(state.magnify)
        };
        if state.keeps_magnification() && footprint.is_within(one_probe, pyramid.size()) {
            return magnified;
        }

        // Which levels, and how many probes.
        let axes = AxisLengths::by_rule(
            pyramid.size(),
            footprint.dst_dx,
            footprint.dst_dy,
            state.lod_rule,
        );
        let aspect = axes.anisotropy();
        let eta = followed_anisotropy(axes.major, aspect, max_anisotropy, state.magnify);
        let log2 = |x| match state.precision {
            Precision::Exact => libm::log2f(x),
            Precision::Fixed => quick_log2(x),
        };
        // The levels wait for these quotients, and one by 1 changes nothing.
        let over_eta = |length: f32| if eta == 1.0 { length } else { length / eta };
        let sharpening = match state.lod_rule {
            LodRule::Exact => CUT_SHARPENING * cut_octaves(over_eta(aspect), log2),
            LodRule::MaxLength => 0.0,
        };
        let lambda = state.limited(log2(over_eta(axes.major)) - sharpening);
        let filter = if lambda > 0.0 {
            state.minify
        } else {
            state.magnify
        };
        let levels = Levels::at(lambda, pyramid.levels(), state);

        // A level of one texel gives that texel wherever a probe stands.
        let bordered = state.address.modes.contains(&AddressMode::ClampToBorder);
        let uniform =
            levels.fraction == 0.0 && !bordered && pyramid.level(levels.fine).size() == UVec2::ONE;
        if uniform {
            return Self {
                levels,
                filter: Filter::Nearest,
                probes: None,
            };
        }
        let probes = (eta != 1.0)
            .then(|| Probes::along(axes.direction().as_dvec2(), eta, state.probe_weights));
        Self {
            levels,
            filter,
            probes,
        }
    }
}

/// η: the aspect that probes follow.
#[inline]
fn followed_anisotropy(major: f32, aspect: f32, max_anisotropy: f32, magnify: Filter) -> f32 {
    if max_anisotropy == 1.0 {
        return 1.0;
    }
    let most = match magnify {
        Filter::Nearest => major,
        Filter::Bilinear | Filter::Bicubic(_) => 2.0 * major,
    };
    // Nearly round: one probe errs less than two.
    let needed = if aspect < 1.6 {
        (1.5 * aspect - 0.8).max(1.0)
    } else {
        aspect
    };
    needed.min(max_anisotropy).min(most.max(1.0))
}

/// The major axis, in texels, up to which [`followed_anisotropy`] is 1 whatever the aspect.
fn one_probe_until(magnify: Filter) -> f32 {
    match magnify {
        Filter::Nearest => 1.0,
        Filter::Bilinear | Filter::Bicubic(_) => 0.5,
    }
}

/// The greatest part of a level by which λ is lowered where an aspect is cut.
///
/// A cut footprint is filtered by squares as wide as it is long over η: too wide across it, while a level finer would
/// alias along it. Of all values, 0.4 has nearly the least RMSE against a box pixel on the planes of
/// `texrender frontier`, for 1 to 16 probes and for every texture there; the error is flat from 0.3 to 0.6.
pub(crate) const CUT_SHARPENING: f32 = 0.4;

/// The octaves of aspect that are cut, up to one: λ is lowered in proportion.
#[inline]
fn cut_octaves(cut: f32, log2: impl Fn(f32) -> f32) -> f32 {
    // An octave and more is one, and none is none: no logarithm for either.
    if cut >= 2.0 {
        1.0
    } else if cut <= 1.0 {
        0.0
    } else {
        log2(cut).clamp(0.0, 1.0)
    }
}

/// As the plan says, with nothing but 8-bit texels; `None` where a level or a place calls for floating point.
#[inline]
fn in_integers(pyramid: &Pyramid, state: &SamplerState, plan: &Plan, st: DVec2) -> Option<Vec4> {
    let in_range = matches!(pyramid.level(0).texels(), Texels::U8(_))
        && !state.address.modes.contains(&AddressMode::ClampToBorder);
    if !in_range {
        return None;
    }
    let levels = plan.levels;
    if let Some(probes) = plan.probes {
        return line_in_integers(pyramid, state, levels, probes, st);
    }
    let at = |level| sampler::bilinear_fixed(pyramid.level(level), state.address, st);
    let fine = at(levels.fine);
    if levels.fraction == 0.0 {
        return Some(fine);
    }
    Some(fine + (at(levels.fine + 1) - fine) * levels.fraction)
}

/// The whole line of probes in integers; `None` where a level or a place calls for floating point.
fn line_in_integers(
    pyramid: &Pyramid,
    state: &SamplerState,
    levels: Levels,
    probes: Probes,
    st: DVec2,
) -> Option<Vec4> {
    let mean = |level| FixedMean::of(pyramid.level(level), state.address.modes);
    let Levels { fine, fraction } = levels;
    if fraction == 0.0 {
        let mut means = [mean(fine)?];
        probes.add_to(&mut means, st)?;
        return Some(means[0].mean());
    }
    let mut means = [mean(fine)?, mean(fine + 1)?];
    probes.add_to(&mut means, st)?;
    let [fine, coarse] = [means[0].mean(), means[1].mean()];
    Some(fine + (coarse - fine) * fraction)
}

#[inline]
fn lookup(pyramid: &Pyramid, state: &SamplerState, filter: Filter, level: u32, st: DVec2) -> Vec4 {
    sampler::sample(
        pyramid.level(level),
        state.address,
        filter,
        state.precision,
        st,
    )
}

/// One stored level, or two neighbours and the weight of the coarser.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Levels {
    fine: u32,
    fraction: f32,
}

impl Levels {
    fn one(level: u32) -> Self {
        Self {
            fine: level,
            fraction: 0.0,
        }
    }

    /// λ may be infinite, not NaN. `count` ≥ 1.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "0 ≤ lod < count, and truncation is the floor of it"
    )]
    fn at(lambda: f32, count: u32, state: &SamplerState) -> Self {
        let lod = lambda.max(0.0).min((count - 1) as f32);
        match state.mip {
            MipFilter::None => Self::one(0),
            MipFilter::Nearest => {
                // ⌈x⌉ − 1 for x = λ + ½ > 0: the floor, less one on the integers.
                let above = lod + 0.5;
                let floor = above as u32;
                Self::one(floor - u32::from(floor as f32 == above))
            }
            MipFilter::Linear => {
                let fine = lod as u32;
                let slope = state.blend_slope();
                let fraction = (lod - fine as f32 - 0.5) * slope + 0.5;
                if slope == 1.0 {
                    Self {
                        fine,
                        fraction: lod - fine as f32,
                    }
                } else if fraction >= 1.0 {
                    Self::one(fine + 1)
                } else {
                    Self {
                        fine,
                        fraction: fraction.max(0.0),
                    }
                }
            }
        }
    }

    /// One of the levels, by its weight.
    pub(crate) fn pick(self, random: &mut f64) -> u32 {
        if self.fraction == 0.0 || !picks_first(random, f64::from(self.fraction)) {
            self.fine
        } else {
            self.fine + 1
        }
    }

    fn lod(self) -> f32 {
        self.fine as f32 + self.fraction
    }

    /// Blends two levels in f64, where a constant stays exact; a level of weight 0 is not read.
    #[inline(always)]
    fn blend(self, level: impl Fn(u32) -> Vec4) -> DVec4 {
        let fine = level(self.fine).as_dvec4();
        if self.fraction == 0.0 {
            return fine;
        }
        let coarse = level(self.fine + 1).as_dvec4();
        fine + (coarse - fine) * f64::from(self.fraction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_level_changes_after_the_half() {
        let level = |lambda| {
            let state = SamplerState {
                mip: MipFilter::Nearest,
                ..SamplerState::default()
            };
            Levels::at(lambda, 5, &state).fine
        };
        assert_eq!(
            [0.0, 0.5, 0.51, 1.5, 1.6, 9.0, -3.0].map(level),
            [0, 0, 1, 1, 2, 4, 0]
        );
    }

    #[test]
    fn odd_lambda_is_clamped_to_the_levels() {
        let linear = |lambda| Levels::at(lambda, 5, &SamplerState::default());
        assert_eq!(
            linear(f32::INFINITY),
            Levels {
                fine: 4,
                fraction: 0.0
            }
        );
        assert_eq!(
            linear(f32::NEG_INFINITY),
            Levels {
                fine: 0,
                fraction: 0.0
            }
        );
        assert_eq!(
            linear(2.25),
            Levels {
                fine: 2,
                fraction: 0.25
            }
        );
    }

    #[test]
    fn outside_the_band_one_level_answers() {
        let state = SamplerState {
            mip_band: 0.5,
            ..SamplerState::default()
        };
        let lod = |lambda| Levels::at(lambda, 5, &state).lod();
        let lambdas = [0.0, 1.0, 1.25, 1.375, 1.5, 1.75, 1.9, 3.9, 4.0];
        assert_eq!(
            lambdas.map(lod),
            [0.0, 1.0, 1.0, 1.25, 1.5, 2.0, 2.0, 4.0, 4.0]
        );
        // What is no band is trilinear filtering, or nearly a step.
        let odd = |mip_band| {
            let state = SamplerState { mip_band, ..state };
            [1.3, 1.6].map(|lambda| Levels::at(lambda, 5, &state).lod())
        };
        assert_eq!(odd(f32::NAN), [1.3, 1.6]);
        assert_eq!(odd(9.0), [1.3, 1.6]);
        assert_eq!(odd(-1.0), [1.0, 2.0]);
    }
}
