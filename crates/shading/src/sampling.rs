//! Fixed sample sets for the integrals of microfacet reflection.

use core::f32::consts::TAU;

use glam::{Vec2, Vec3};

/// The `i`-th of `n` Hammersley points in the unit square: `(i/n, radical inverse of i in base 2)`.
///
/// `i` in `0..n`, `n` ≥ 1. Both coordinates are in 0..1.
///
/// # Source
/// Hammersley 1960; Niederreiter 1992, "Random Number Generation and Quasi-Monte Carlo Methods", §3.1.
/// # Examples
/// ```
/// assert_eq!(shading::hammersley(1, 4), glam::Vec2::new(0.25, 0.5));
/// ```
#[must_use]
pub fn hammersley(i: u32, n: u32) -> Vec2 {
    // The top 24 bits are exact in f32, so the second coordinate never rounds up to 1.
    const SCALE: f32 = 1.0 / (1 << 24) as f32;
    Vec2::new(i as f32 / n as f32, (i.reverse_bits() >> 8) as f32 * SCALE)
}

/// A half vector drawn with density `D(h)·(n·h)`, about the normal +Z.
///
/// `xi` in the unit square; `alpha_ggx` in 0..=1. The result is a unit vector with z ≥ 0.
///
/// # Source
/// Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", eqs. 35 and 36.
/// # Examples
/// ```
/// use glam::{Vec2, Vec3};
/// assert_eq!(shading::sample_ggx_half_vector(Vec2::ZERO, 0.5), Vec3::Z);
/// ```
#[must_use]
pub fn sample_ggx_half_vector(xi: Vec2, alpha_ggx: f32) -> Vec3 {
    // tan²θ = α²·ξ / (1 − ξ), hence cos²θ = (1 − ξ) / ((1 − ξ) + α²·ξ).
    let a2 = alpha_ggx * alpha_ggx;
    let denominator = (1.0 - xi.x) + a2 * xi.x;
    let (cos, sin) = if denominator > 0.0 {
        (
            ((1.0 - xi.x) / denominator).sqrt(),
            (a2 * xi.x / denominator).sqrt(),
        )
    } else {
        (1.0, 0.0)
    };
    let phi = TAU * xi.y;
    Vec3::new(sin * libm::cosf(phi), sin * libm::sinf(phi), cos)
}
