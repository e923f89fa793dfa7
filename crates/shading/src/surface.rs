//! A point of a surface, ready to be lit.

use glam::{Vec2, Vec3};

use crate::distribution::ggx_lobe;
use crate::{Fresnel, Incident, MIN_ALPHA_GGX, lambert, smith_ggx_correlated};

/// Cosine below which the viewer counts as grazing; keeps V finite under bent shading normals.
pub(crate) const MIN_N_DOT_V: f32 = 1e-4;

/// What a surface does with light: a diffuse base under a microfacet layer.
///
/// Made from the parameters that an author gives: [`Surface::from_metallic_roughness`],
/// [`Surface::from_specular_glossiness`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Albedo of the diffuse base, linear, each channel in 0..=1.
    pub diffuse_albedo: Vec3,
    /// The curve that takes light from the diffuse base: what it reflects never enters.
    pub base_fresnel: Fresnel,
    /// The curve of the microfacet layer.
    pub specular_fresnel: Fresnel,
    /// Perceptual roughness, 0..=1.
    pub roughness: f32,
}

impl Surface {
    /// The square of the roughness: width of the GGX lobe.
    #[must_use]
    pub fn alpha_ggx(&self) -> f32 {
        self.roughness * self.roughness
    }

    /// The surface whose normals spread by a variance of slopes: `α'² = α² + 2σ²`, at most 1.
    ///
    /// What a pixel cannot resolve of a bumpy or curved surface makes its highlight wider and dimmer
    /// instead of letting it sparkle. `variance` ≥ 0; NaN counts as 0.
    ///
    /// # Source
    /// Kaplanyan et al. 2016, "Filtering Distributions of Normals for Shading Antialiasing": the
    /// convolution of two Gaussian slope distributions adds their variances, and α² = 2σ².
    /// # Examples
    /// ```
    /// use shading::{MetallicRoughness, Surface};
    /// let mirror = MetallicRoughness { roughness: 0.0, ..Default::default() };
    /// let spread = Surface::from_metallic_roughness(&mirror).widened(0.02);
    /// assert!((spread.alpha_ggx() - 0.2).abs() < 1e-6);
    /// ```
    #[must_use]
    pub fn widened(self, variance: f32) -> Self {
        if variance > 0.0 {
            let alpha = self.alpha_ggx();
            let widened = (alpha * alpha + 2.0 * variance).min(1.0);
            Self {
                roughness: widened.sqrt().sqrt(),
                ..self
            }
        } else {
            self
        }
    }

    /// Reflectance distribution `f(l, v)`, per steradian, without the cosine of the light.
    ///
    /// `normal`, `view`, `light`: unit, away from the surface. Zero where the light is at or below
    /// the horizon. A viewer below the horizon of a bent normal counts as grazing. `alpha_ggx` is
    /// held at [`MIN_ALPHA_GGX`] or above.
    ///
    /// # Accuracy
    /// 1e-4 relative against f64. The sine of the half vector comes from a cross product, so that
    /// the bound holds at the peak of the narrowest lobe.
    /// # Source
    /// glTF 2.0, Appendix B.2 and B.3 ("Implementation"), the dielectric and the metal mixed as
    /// there; `f90` as KHR_materials_specular.
    #[must_use]
    pub fn brdf(&self, normal: Vec3, view: Vec3, light: Vec3) -> Vec3 {
        let n_dot_l = normal.dot(light);
        let sum = light + view;
        let sum_length = sum.length();
        if n_dot_l <= 0.0 || sum_length <= 0.0 {
            return Vec3::ZERO;
        }
        let n_dot_v = normal.dot(view).max(MIN_N_DOT_V);
        let half = sum / sum_length;
        // v·h = l·h = |l + v|/2 for unit vectors: the same number for both, so f is reciprocal.
        let v_dot_h = 0.5 * sum_length;
        let n_dot_h = normal.dot(half);
        let alpha = self.alpha_ggx().max(MIN_ALPHA_GGX);

        // Microfacet layer: F·D·V.
        let distribution = if n_dot_h > 0.0 {
            ggx_lobe(
                n_dot_h * n_dot_h,
                normal.cross(half).length_squared(),
                alpha,
            )
        } else {
            0.0
        };
        let visibility = smith_ggx_correlated(n_dot_l, n_dot_v, alpha);
        let specular = self.specular_fresnel.at(v_dot_h) * (distribution * visibility);

        // Diffuse base: what the layer above it lets through.
        let entered = 1.0 - self.base_fresnel.at(v_dot_h).max_element();
        lambert(self.diffuse_albedo) * entered + specular
    }

    /// Radiance toward the viewer from one incident light: `f(l, v)·E·(n·l)`.
    ///
    /// `normal`, `view`: unit, away from the surface. Zero where the light is below the horizon.
    #[must_use]
    pub fn reflected(&self, normal: Vec3, view: Vec3, incident: &Incident) -> Vec3 {
        let n_dot_l = normal.dot(incident.direction);
        if n_dot_l > 0.0 {
            self.brdf(normal, view, incident.direction) * incident.illuminance * n_dot_l
        } else {
            Vec3::ZERO
        }
    }

    /// Radiance toward the viewer from the environment, by the split sum.
    ///
    /// `reflectance`: [`crate::ReflectanceTable::lookup`] at this viewing angle and roughness.
    /// `irradiance`: of the hemisphere about the normal. `radiance`: the environment about the
    /// mirror direction, already blurred to this roughness. Light that single scattering loses
    /// inside the microfacets returns as diffuse light, so that a white metal under constant light
    /// reflects all of it.
    ///
    /// # Source
    /// Karis 2013, "Real Shading in Unreal Engine 4" (split sum); Fdez-Agüera 2019, "A
    /// Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting", eqs. 11 to 21.
    #[must_use]
    pub fn indirect(&self, reflectance: Vec2, irradiance: Vec3, radiance: Vec3) -> Vec3 {
        let (single, multiple) = scattered(self.specular_fresnel, reflectance);
        let (base_single, base_multiple) = scattered(self.base_fresnel, reflectance);
        let entered = 1.0 - (base_single + base_multiple).max_element();
        let diffuse = lambert(irradiance);
        single * radiance + (multiple + self.diffuse_albedo * entered) * diffuse
    }
}

/// Share of constant light that leaves a layer after one and after more reflections.
fn scattered(fresnel: Fresnel, reflectance: Vec2) -> (Vec3, Vec3) {
    // Mean of Schlick's curve over the hemisphere, cosine-weighted: f0 + (f90 − f0)/21.
    let mean = fresnel.f0 + (fresnel.f90 - fresnel.f0) / 21.0;
    let lost = 1.0 - (reflectance.x + reflectance.y);
    let single = fresnel.f0 * reflectance.x + fresnel.f90 * reflectance.y;
    let multiple = single * mean * lost / (Vec3::ONE - mean * lost);
    (single, multiple)
}
