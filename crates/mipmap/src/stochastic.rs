use glam::{DVec2, UVec2, Vec4};

use crate::footprint::Footprint;
use crate::pyramid::Pyramid;
use crate::sample::Plan;
use crate::sampler_state::SamplerState;

/// One texel under `footprint`, picked so that the mean over many is [`crate::sample`]'s result.
///
/// A probe of the footprint's line, one of the two levels and one texel of the filter are each picked with a
/// probability in proportion to its weight. To be averaged: over samples of a pixel, over frames, or after shading,
/// where the mean is even more right than filtered texels for what is not linear in them.
///
/// `random`: two numbers in \[0, 1), of any sequence: independent, stratified, or [`blue_noise`]'s. What is left of
/// each after one pick serves the next.
///
/// Target pixel kernel, and defined results for odd input: as [`crate::sample`].
///
/// # Accuracy
/// Unbiased; the error of a mean of n falls as 1/√n or faster. Checked by `tests/properties/stochastic.rs`.
/// # Source
/// Fajardo et al. 2023, "Stochastic Texture Filtering"; Pharr et al. 2024, "Filtering After Shading with Stochastic
/// Texture Filtering".
/// # Examples
/// ```
/// use glam::{DVec2, UVec2, Vec2};
/// use mipmap::{Content, Footprint, Pyramid, SamplerState, blue_noise, stochastic};
/// use sampler::{Texels, Texture, Transfer};
/// let halves = Texture::new(UVec2::new(2, 1), 1, Transfer::Linear, Texels::F32(vec![0.0, 1.0]))?;
/// let pyramid = Pyramid::build(halves, Content::Colour)?;
/// let footprint = Footprint { st: DVec2::splat(0.5), dst_dx: Vec2::X * 0.1, dst_dy: Vec2::Y * 0.1 };
/// let state = SamplerState::default();
/// let texels = (0..1000).map(|k| stochastic(&pyramid, &state, &footprint, blue_noise(UVec2::ZERO, k, 0)).x);
/// let mean = texels.sum::<f32>() / 1000.0;
/// assert!((mean - 0.5).abs() < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn stochastic(
    pyramid: &Pyramid,
    state: &SamplerState,
    footprint: &Footprint,
    random: DVec2,
) -> Vec4 {
    // NaN becomes 0.
    let mut random = random.max(DVec2::ZERO).min(DVec2::splat(BELOW_ONE));
    let plan = Plan::of(pyramid, state, footprint);
    let offset = plan
        .probes
        .map_or(DVec2::ZERO, |probes| probes.pick(&mut random.x));
    let level = plan.levels.pick(&mut random.y);
    let texture = pyramid.level(level);
    sampler::pick(
        texture,
        state.address,
        plan.filter,
        footprint.st + offset,
        random,
    )
}

/// The last f64 below 1.
const BELOW_ONE: f64 = 1.0 - 0.5 * f64::EPSILON;

/// Picks the first of two outcomes with probability `share`, and spreads `random` over \[0, 1) again.
pub(crate) fn picks_first(random: &mut f64, share: f64) -> bool {
    let first = *random < share;
    let left = if first {
        *random / share
    } else {
        (*random - share) / (1.0 - share)
    };
    *random = left.clamp(0.0, BELOW_ONE);
    first
}

/// Two numbers in \[0, 1) for a sample of a pixel, which differ most between neighbours.
///
/// Over the pixels of a picture they are a low-discrepancy lattice, whose error is of high frequency, as that of blue
/// noise; over the samples `index` of one pixel they are an additive recurrence; `seed` shifts all alike.
///
/// # Source
/// Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences" (R₂ over the plane and its dithering mask).
/// # Examples
/// ```
/// use glam::UVec2;
/// let random = mipmap::blue_noise(UVec2::new(3, 4), 0, 7);
/// assert!(random.min_element() >= 0.0 && random.max_element() < 1.0);
/// ```
pub fn blue_noise(pixel: UVec2, index: u32, seed: u32) -> DVec2 {
    // 1/p, 1/p² of the root of p³ = p + 1, and the next powers for the second number and for the samples.
    const R: [f64; 4] = [
        0.754_877_666_246_692_8,
        0.569_840_290_998_053_3,
        0.430_159_709_001_946_7,
        0.324_717_957_244_746_1,
    ];
    let [x, y, k] = [pixel.x, pixel.y, index].map(f64::from);
    let shift = f64::from(seed.wrapping_mul(0x9e37_79b9)) / 4_294_967_296.0;
    let first = 0.5 + shift + x * R[0] + y * R[1] + k * R[0];
    let second = 0.5 + shift + x * R[2] + y * R[3] + k * R[1];
    let fraction = |value: f64| (value - value.floor()).min(BELOW_ONE);
    DVec2::new(fraction(first), fraction(second))
}
