//! Limits of a lane, spelled as comparisons: what `min` and `max` do with NaN differs between instruction sets.

use fearless_simd::{Select, Simd, SimdBase, f32x16};

/// Each lane clamped to 0..=1, with NaN as 0.
#[inline(always)]
#[must_use]
pub fn unit_or_zero<S: Simd>(x: f32x16<S>) -> f32x16<S> {
    at_most(at_least_zero(x), 1.0)
}

/// Each lane, or 0 where it is negative or NaN.
#[inline(always)]
#[must_use]
pub fn at_least_zero<S: Simd>(x: f32x16<S>) -> f32x16<S> {
    at_least(x, 0.0)
}

/// Each lane, or `least` where it is below that or NaN.
#[inline(always)]
pub(crate) fn at_least<S: Simd>(x: f32x16<S>, least: f32) -> f32x16<S> {
    let least = like(x, least);
    x.simd_gt(least).select(x, least)
}

/// Each lane, or `most` where it is above that or NaN.
#[inline(always)]
pub(crate) fn at_most<S: Simd>(x: f32x16<S>, most: f32) -> f32x16<S> {
    let most = like(x, most);
    x.simd_lt(most).select(x, most)
}

/// The greater of two lanes; the second where either is NaN.
#[inline(always)]
pub(crate) fn greater<S: Simd>(a: f32x16<S>, b: f32x16<S>) -> f32x16<S> {
    a.simd_gt(b).select(a, b)
}

/// A value in every lane of a packet of the same kind as `x`.
#[inline(always)]
pub(crate) fn like<S: Simd>(x: f32x16<S>, value: f32) -> f32x16<S> {
    use fearless_simd::ExtractToken;
    f32x16::splat(x.token(), value)
}
