//! F: how much light a facet mirrors, by angle.

use glam::Vec3;

/// Schlick's Fresnel curve between normal incidence and grazing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fresnel {
    /// Reflectance at normal incidence, linear, each channel in 0..=1.
    pub f0: Vec3,
    /// Reflectance at grazing incidence, linear, each channel in 0..=1.
    pub f90: Vec3,
}

impl Fresnel {
    /// Reflectance where the viewer meets the half vector at cosine `v_dot_h`.
    ///
    /// `f0 + (f90 − f0)·(1 − v·h)⁵`. The cosine is clamped to 0..=1; NaN counts as 0 (grazing).
    ///
    /// # Accuracy
    /// 1e-6 absolute against f64, for coefficients in 0..=1.
    /// # Source
    /// Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", eq. 15;
    /// glTF 2.0, Appendix B.3.4; `f90` from KHR_materials_specular.
    /// # Examples
    /// ```
    /// # use glam::Vec3; use shading::Fresnel;
    /// let glass = Fresnel { f0: Vec3::splat(0.04), f90: Vec3::ONE };
    /// assert_eq!(glass.at(1.0).x, 0.04);
    /// assert_eq!(glass.at(0.0).x, 1.0);
    /// ```
    #[must_use]
    pub fn at(self, v_dot_h: f32) -> Vec3 {
        let m = 1.0 - unit_or_zero(v_dot_h);
        let m2 = m * m;
        let grazing = m2 * m2 * m;
        self.f0 * (1.0 - grazing) + self.f90 * grazing
    }

    /// The curve `(1 − t)·self + t·other`; exact, because Schlick's curve is linear in `f0`, `f90`.
    #[must_use]
    pub fn lerp(self, other: Self, t: f32) -> Self {
        Self {
            f0: self.f0 * (1.0 - t) + other.f0 * t,
            f90: self.f90 * (1.0 - t) + other.f90 * t,
        }
    }
}

/// `x` clamped to 0..=1, with NaN as 0.
pub(crate) fn unit_or_zero(x: f32) -> f32 {
    if x > 0.0 { x.min(1.0) } else { 0.0 }
}

/// Reflectance at normal incidence of a dielectric with index of refraction `ior` in air.
///
/// `((ior − 1)/(ior + 1))²`. An `ior` of 0 means, as KHR_materials_ior has it, a reflectance of 1.
///
/// # Source
/// glTF 2.0, Appendix B.3.4; KHR_materials_ior.
/// # Examples
/// ```
/// assert!((shading::dielectric_f0(1.5) - 0.04).abs() < 1e-8);
/// ```
#[must_use]
pub fn dielectric_f0(ior: f32) -> f32 {
    let r = (ior - 1.0) / (ior + 1.0);
    r * r
}
