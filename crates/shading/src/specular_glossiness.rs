//! The parameters of the archived specular-glossiness model.

use glam::Vec3;

use crate::{Fresnel, Surface};

/// KHR_materials_pbrSpecularGlossiness parameters at one point, textures already multiplied in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpecularGlossiness {
    /// Linear diffuse colour, each channel in 0..=1.
    pub diffuse: Vec3,
    /// Linear specular colour, the `f0` of the layer, each channel in 0..=1.
    pub specular: Vec3,
    /// 1 for smooth, 0 for rough.
    pub glossiness: f32,
}

impl Surface {
    /// The surface of the specular-glossiness model.
    ///
    /// `c_diff = diffuse·(1 − max(specular))`, `f0 = specular`, `α = (1 − glossiness)²`.
    ///
    /// # Source
    /// KHR_materials_pbrSpecularGlossiness, "Specular-Glossiness".
    #[must_use]
    pub fn from_specular_glossiness(material: &SpecularGlossiness) -> Self {
        let layer = Fresnel {
            f0: material.specular,
            f90: Vec3::ONE,
        };
        Self {
            diffuse_albedo: material.diffuse * (1.0 - material.specular.max_element()),
            base_fresnel: layer,
            specular_fresnel: layer,
            roughness: (1.0 - material.glossiness).clamp(0.0, 1.0),
        }
    }
}
