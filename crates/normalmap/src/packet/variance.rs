//! Variances of slopes at sixteen points.

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, f32x16};
use shading::packet::{Vec3x16, at_least_zero};

use crate::variance::{MAX_CURVATURE_VARIANCE, QUANTISATION};

/// [`crate::filtered_variance`] at sixteen points.
#[inline(always)]
#[must_use]
pub fn filtered_variance<S: Simd>(simd: S, direction: Vec3x16<S>, scale: f32) -> f32x16<S> {
    let one = f32x16::splat(simd, 1.0);
    let spread = one / direction.length() - one - f32x16::splat(simd, QUANTISATION);
    let variance = at_least_zero(spread) * scale * scale;
    // Infinite and NaN count as the greatest.
    variance.simd_lt(one).select(variance, one)
}

/// [`crate::curvature_variance`] at sixteen points.
#[inline(always)]
#[must_use]
pub fn curvature_variance<S: Simd>(simd: S, dn_dx: Vec3x16<S>, dn_dy: Vec3x16<S>) -> f32x16<S> {
    let (x, y) = (dn_dx.length_squared(), dn_dy.length_squared());
    let greatest = f32x16::splat(simd, MAX_CURVATURE_VARIANCE);
    let variance = x.simd_gt(y).select(x, y) / 12.0;
    let sound = x.is_finite() & y.is_finite() & variance.simd_lt(greatest);
    sound.select(variance, greatest)
}
