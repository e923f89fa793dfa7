//! The parameters of glTF's metallic-roughness model.

use glam::Vec3;

use crate::{Fresnel, Surface, dielectric_f0};

/// glTF's metallic-roughness parameters at one point, textures already multiplied in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MetallicRoughness {
    /// Linear base colour, each channel in 0..=1.
    pub base_color: Vec3,
    /// 0 for a dielectric, 1 for a metal.
    pub metallic: f32,
    /// Perceptual roughness, 0..=1.
    pub roughness: f32,
    /// Index of refraction (KHR_materials_ior): 0, or ≥ 1.
    pub ior: f32,
    /// Strength of the dielectric's highlight (KHR_materials_specular), 0..=1.
    pub specular: f32,
    /// Tint of the dielectric's `f0` (KHR_materials_specular), each channel ≥ 0.
    pub specular_color: Vec3,
}

impl Default for MetallicRoughness {
    /// White, rough, metallic: the defaults of glTF 2.0.
    fn default() -> Self {
        Self {
            base_color: Vec3::ONE,
            metallic: 1.0,
            roughness: 1.0,
            ior: 1.5,
            specular: 1.0,
            specular_color: Vec3::ONE,
        }
    }
}

impl Surface {
    /// The surface of glTF's metallic-roughness model.
    ///
    /// A mix by `metallic` of a dielectric (diffuse `base_color` under a layer with `f0` from
    /// `ior`, `specular` and `specular_color`) and a metal (`f0 = base_color`). The mix is exact:
    /// both specular lobes share D and V, and F is linear in its ends.
    ///
    /// # Source
    /// glTF 2.0, Appendix B.2; KHR_materials_specular, "Implementation"; KHR_materials_ior.
    #[must_use]
    pub fn from_metallic_roughness(material: &MetallicRoughness) -> Self {
        let metallic = material.metallic.clamp(0.0, 1.0);
        let f0 = (material.specular_color * dielectric_f0(material.ior)).min(Vec3::ONE);
        let dielectric = Fresnel {
            f0: f0 * material.specular,
            f90: Vec3::splat(material.specular),
        };
        let metal = Fresnel {
            f0: material.base_color,
            f90: Vec3::ONE,
        };
        Self {
            diffuse_albedo: material.base_color * (1.0 - metallic),
            base_fresnel: dielectric,
            specular_fresnel: dielectric.lerp(metal, metallic),
            roughness: material.roughness.clamp(0.0, 1.0),
        }
    }
}
