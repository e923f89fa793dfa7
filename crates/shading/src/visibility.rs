//! V: how many microfacets are seen by both the light and the viewer.

/// Height-correlated Smith visibility for GGX: `G / (4·(n·l)·(n·v))`.
///
/// `0.5 / (n·l·√(α² + (1−α²)(n·v)²) + n·v·√(α² + (1−α²)(n·l)²))`. Cosines in 0..=1;
/// `alpha_ggx` in 0..=1. Where both cosines are 0 the result is 0; NaN gives 0.
///
/// # Accuracy
/// 1e-5 relative against f64 for cosines ≥ 1e-4.
/// # Source
/// Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", eq. 99;
/// glTF 2.0, Appendix B.3.2.
/// # Examples
/// ```
/// // Head-on, nothing is hidden: G = 1.
/// assert!((shading::smith_ggx_correlated(1.0, 1.0, 0.5) - 0.25).abs() < 1e-6);
/// ```
#[must_use]
pub fn smith_ggx_correlated(n_dot_l: f32, n_dot_v: f32, alpha_ggx: f32) -> f32 {
    let a2 = alpha_ggx * alpha_ggx;
    let masked = |cos: f32| (a2 + (1.0 - a2) * cos * cos).sqrt();
    let sum = n_dot_l * masked(n_dot_v) + n_dot_v * masked(n_dot_l);
    if sum > 0.0 { 0.5 / sum } else { 0.0 }
}
