//! Light that leaves evenly in all directions.

use core::f32::consts::FRAC_1_PI;

use glam::Vec3;

/// Lambertian reflectance distribution: `albedo / π`, per steradian.
///
/// `albedo`: linear reflectance, each channel in 0..=1. The cosine of the incident direction is
/// not included. Non-finite channels are passed on.
///
/// # Accuracy
/// One rounding: within 0.5 ulp of `albedo · FRAC_1_PI`.
/// # Source
/// Lambert 1760; glTF 2.0, Appendix B.3.3, "Diffuse BRDF".
/// # Examples
/// ```
/// # use glam::Vec3;
/// let f = shading::lambert(Vec3::ONE);
/// assert!((f.x - 0.318_309_9).abs() < 1e-7);
/// ```
#[must_use]
pub fn lambert(albedo: Vec3) -> Vec3 {
    albedo * FRAC_1_PI
}
