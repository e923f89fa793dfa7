//! D: how many microfacets face a direction.

use core::f32::consts::PI;

/// Smallest `alpha_ggx` that direct lighting uses: a smoother surface would show a punctual light
/// as a point too bright for its pixel. It is a perceptual roughness of 0.032.
pub const MIN_ALPHA_GGX: f32 = 1e-3;

/// GGX (Trowbridge–Reitz) microfacet distribution D(h), per steradian.
///
/// `α² / (π·((n·h)²·(α² − 1) + 1)²)`, with the bracket written as `α²·cos² + sin²` so that nothing
/// cancels near the peak. `n_dot_h` in 0..=1 (below 0 there are no facets: the result is 0),
/// `alpha_ggx` > 0. NaN gives 0.
///
/// # Accuracy
/// 1e-5 relative for the cosine given; a cosine rounded to f32 carries its own error of about
/// `1.2e-7/α²` near the peak, which [`crate::Surface::brdf`] avoids by taking the sine from a cross product.
/// # Source
/// Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", eq. 33;
/// glTF 2.0, Appendix B.3.2.
/// # Examples
/// ```
/// // Fully rough: every direction alike.
/// assert!((shading::ggx_distribution(0.3, 1.0) - 1.0 / core::f32::consts::PI).abs() < 1e-6);
/// ```
#[must_use]
pub fn ggx_distribution(n_dot_h: f32, alpha_ggx: f32) -> f32 {
    if n_dot_h > 0.0 {
        ggx_lobe(
            n_dot_h * n_dot_h,
            ((1.0 - n_dot_h) * (1.0 + n_dot_h)).max(0.0),
            alpha_ggx,
        )
    } else {
        0.0
    }
}

/// D from the squared cosine and squared sine of the half vector's angle to the normal.
pub(crate) fn ggx_lobe(cos2: f32, sin2: f32, alpha_ggx: f32) -> f32 {
    let a2 = alpha_ggx * alpha_ggx;
    let bracket = a2 * cos2 + sin2;
    a2 / (PI * bracket * bracket)
}
