//! Sixteen points of surfaces, ready to be lit.

use core::f32::consts::{FRAC_1_PI, PI};

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, f32x16};

use super::select::{at_least, at_most, unit_or_zero};
use super::vector::one;
use super::{Incident, Vec3x16};
use crate::MIN_ALPHA_GGX;
use crate::surface::MIN_N_DOT_V;

/// Schlick's curve between normal incidence and grazing, at sixteen points: see [`crate::Fresnel`].
#[derive(Clone, Copy, Debug)]
pub struct Fresnel<S: Simd> {
    /// Reflectance at normal incidence.
    pub f0: Vec3x16<S>,
    /// Reflectance at grazing incidence, the same for all channels.
    pub f90: f32x16<S>,
}

impl<S: Simd> Fresnel<S> {
    /// [`crate::Fresnel::at`].
    #[inline(always)]
    #[must_use]
    pub fn at(self, v_dot_h: f32x16<S>) -> Vec3x16<S> {
        let m = one(v_dot_h) - unit_or_zero(v_dot_h);
        let m2 = m * m;
        let grazing = m2 * m2 * m;
        self.f0 * (one(m) - grazing) + Vec3x16::grey(self.f90 * grazing)
    }
}

/// [`crate::MetallicRoughness`] at sixteen points, but for the index of refraction: a packet has one.
#[derive(Clone, Copy, Debug)]
#[expect(
    missing_docs,
    reason = "the fields are documented at the scalar struct"
)]
pub struct MetallicRoughness<S: Simd> {
    pub base_color: Vec3x16<S>,
    pub metallic: f32x16<S>,
    pub roughness: f32x16<S>,
    pub specular: f32x16<S>,
    pub specular_color: Vec3x16<S>,
}

/// [`crate::SpecularGlossiness`] at sixteen points.
#[derive(Clone, Copy, Debug)]
#[expect(
    missing_docs,
    reason = "the fields are documented at the scalar struct"
)]
pub struct SpecularGlossiness<S: Simd> {
    pub diffuse: Vec3x16<S>,
    pub specular: Vec3x16<S>,
    pub glossiness: f32x16<S>,
}

/// [`crate::Surface`] at sixteen points.
#[derive(Clone, Copy, Debug)]
#[expect(
    missing_docs,
    reason = "the fields are documented at the scalar struct"
)]
pub struct Surface<S: Simd> {
    pub diffuse_albedo: Vec3x16<S>,
    pub base_fresnel: Fresnel<S>,
    pub specular_fresnel: Fresnel<S>,
    pub roughness: f32x16<S>,
}

impl<S: Simd> Surface<S> {
    /// [`crate::Surface::from_metallic_roughness`]; `dielectric_f0`: of the index of refraction, by
    /// [`crate::dielectric_f0`].
    #[inline(always)]
    #[must_use]
    pub fn from_metallic_roughness(material: &MetallicRoughness<S>, dielectric_f0: f32) -> Self {
        let metallic = unit_or_zero(material.metallic);
        let past_metallic = one(metallic) - metallic;
        let f0 = (material.specular_color * dielectric_f0).map(
            #[inline(always)]
            |x| at_most(x, 1.0),
        );
        let dielectric = Fresnel {
            f0: f0 * material.specular,
            f90: material.specular,
        };
        Self {
            diffuse_albedo: material.base_color * past_metallic,
            base_fresnel: dielectric,
            specular_fresnel: Fresnel {
                f0: dielectric.f0 * past_metallic + material.base_color * metallic,
                f90: dielectric.f90 * past_metallic + metallic,
            },
            roughness: unit_or_zero(material.roughness),
        }
    }

    /// [`crate::Surface::from_specular_glossiness`].
    #[inline(always)]
    #[must_use]
    pub fn from_specular_glossiness(material: &SpecularGlossiness<S>) -> Self {
        let white = one(material.glossiness);
        let layer = Fresnel {
            f0: material.specular,
            f90: white,
        };
        Self {
            diffuse_albedo: material.diffuse * (white - material.specular.max_element()),
            base_fresnel: layer,
            specular_fresnel: layer,
            roughness: unit_or_zero(white - material.glossiness),
        }
    }

    /// [`crate::Surface::widened`].
    #[inline(always)]
    #[must_use]
    pub fn widened(self, variance: f32x16<S>) -> Self {
        let alpha = self.roughness * self.roughness;
        let widened = at_most(alpha * alpha + variance * 2.0, 1.0);
        let spread = variance.simd_gt(0.0);
        Self {
            roughness: spread.select(widened.sqrt().sqrt(), self.roughness),
            ..self
        }
    }

    /// [`crate::Surface::reflected`].
    #[inline(always)]
    #[must_use]
    pub fn reflected(
        &self,
        normal: Vec3x16<S>,
        view: Vec3x16<S>,
        incident: &Incident<S>,
    ) -> Vec3x16<S> {
        let n_dot_l = normal.dot(incident.direction);
        let sum = incident.direction + view;
        let sum_length = sum.length();
        let lit = n_dot_l.simd_gt(0.0) & sum_length.simd_gt(0.0);

        let n_dot_v = at_least(normal.dot(view), MIN_N_DOT_V);
        let half = sum * (one(sum_length) / sum_length);
        let v_dot_h = sum_length * 0.5;
        let n_dot_h = normal.dot(half);
        let alpha = at_least(self.roughness * self.roughness, MIN_ALPHA_GGX);

        // Microfacet layer: F·D·V.
        let a2 = alpha * alpha;
        let bracket = a2 * (n_dot_h * n_dot_h) + normal.cross(half).length_squared();
        let zero = one(alpha) * 0.0;
        let faces = n_dot_h.simd_gt(0.0);
        let distribution = faces.select(a2 / (bracket * bracket * PI), zero);
        let sum = n_dot_l * masked(a2, n_dot_v) + n_dot_v * masked(a2, n_dot_l);
        let visibility = one(alpha) * 0.5 / sum;
        let specular = self.specular_fresnel.at(v_dot_h) * (distribution * visibility);

        // Diffuse base: what the layer above it lets through.
        let entered = one(alpha) - self.base_fresnel.at(v_dot_h).max_element();
        let f = self.diffuse_albedo * FRAC_1_PI * entered + specular;
        (f * incident.illuminance * n_dot_l).select(lit, Vec3x16::grey(zero))
    }

    /// [`crate::Surface::indirect`]; `reflectance`: as [`super::reflectance`] gives it.
    #[inline(always)]
    #[must_use]
    pub fn indirect(
        &self,
        reflectance: [f32x16<S>; 2],
        irradiance: Vec3x16<S>,
        radiance: Vec3x16<S>,
    ) -> Vec3x16<S> {
        let (single, multiple) = scattered(self.specular_fresnel, reflectance);
        let (base_single, base_multiple) = scattered(self.base_fresnel, reflectance);
        let entered = one(self.roughness) - (base_single + base_multiple).max_element();
        let diffuse = irradiance * FRAC_1_PI;
        single * radiance + (multiple + self.diffuse_albedo * entered) * diffuse
    }
}

/// √(α² + (1 − α²)·cos²).
#[inline(always)]
fn masked<S: Simd>(a2: f32x16<S>, cos: f32x16<S>) -> f32x16<S> {
    (a2 + (one(a2) - a2) * cos * cos).sqrt()
}

/// Share of constant light that leaves a layer after one and after more reflections.
#[inline(always)]
fn scattered<S: Simd>(
    fresnel: Fresnel<S>,
    reflectance: [f32x16<S>; 2],
) -> (Vec3x16<S>, Vec3x16<S>) {
    let [scale, bias] = reflectance;
    let lost = Vec3x16::grey(one(scale) - (scale + bias));
    let white = Vec3x16::grey(one(scale));
    let (f0, f90) = (fresnel.f0, Vec3x16::grey(fresnel.f90));
    let mean = f0 + (f90 - f0) * (1.0 / 21.0);
    let single = f0 * scale + f90 * bias;
    (single, single * mean * lost / (white - mean * lost))
}
