use glam::{DVec2, UVec2, Vec4};
use sampler::{AddressMode, Filter, FixedMean, Precision, Texels};

use crate::blend::Levels;
use crate::footprint::{AxisLengths, Footprint};
use crate::lod::{LodRule, quick_log2};
use crate::probes::Probes;
use crate::pyramid::Pyramid;
use crate::sampler_state::{MAX_ANISOTROPY, MipFilter, SamplerState};

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
/// [`crate::ProbeWeights`] says (by default as a box of length `major`); every probe filters at λ. For η = 1 that is one
/// probe, as for footprints up to 1.2 times as long as wide, where more would cost and err more. The last term of η keeps probes at least half a texel apart (a texel, where magnification is
/// [`Filter::Nearest`], so that no edge of a texel is softened). Where max_anisotropy cuts the aspect, λ rises; by
/// [`LodRule::Exact`] up to 0.4 less than the longer side asks for: a square as wide as a long footprint is too wide
/// across it. [`LodRule::MaxLength`] has no such term: it is the textbook's. The result is continuous in every input
/// wherever magnify, minify and mip are linear.
///
/// Target pixel kernel: of one lookup of level 0, the point; of one probe, a square along the texture's axes, as wide
/// as the footprint is long; of a line of probes, the rectangle that the footprint's two axes span, or by
/// [`crate::ProbeWeights::Gaussian`] the Gaussian of σ = ½ pixel through the footprint.
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
/// chosen, 0 where level 0 answered (the finest, if that is not stored).
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
            levels: Levels::one(pyramid.finest()),
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
        let stored = [pyramid.finest(), pyramid.levels() - 1];
        let levels = Levels::at(lambda, stored, state);

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
