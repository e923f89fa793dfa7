//! Materials: factors, and the textures that vary them.

use glam::{Vec3, Vec4};
use texcoord::TextureTransform;
use texcoord::mapping::PlacedMapping;

/// Where a surface is on a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinates {
    /// A set of texture coordinates of its vertices; p is 0.
    Set(usize),
    /// A mapping of where it lies: index into [`super::Scene::mappings`], evaluated per pixel. Where it gives no
    /// coordinate the surface is as if it had no such map.
    Mapping(usize),
}

/// A mapping from where surfaces lie to texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceMapping {
    /// The mapping.
    pub placed: PlacedMapping,
    /// Whose space it looks at.
    pub space: MappingSpace,
}

/// The space that a mapping looks at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MappingSpace {
    /// That of the primitive that it is used on: the texture moves with it.
    #[default]
    Object,
    /// The world: the primitive moves through the texture.
    World,
}

/// A texture as a material refers to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureUse {
    /// Index into [`super::Scene::textures`].
    pub texture: usize,
    /// Where it is read.
    pub coordinates: Coordinates,
    /// Applied to (s,t).
    pub transform: TextureTransform,
}

/// A normal map and its strength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalTexture {
    /// The map: direction in RGB, linear.
    pub map: TextureUse,
    /// Multiplies x and y of the decoded direction.
    pub scale: f32,
}

/// An occlusion map and its strength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionTexture {
    /// The map: visibility of the surroundings in R, linear.
    pub map: TextureUse,
    /// 0 for no occlusion, 1 for all of it.
    pub strength: f32,
}

/// How alpha is read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// Visible where alpha is at least the cutoff.
    Mask {
        /// The least alpha that is visible.
        cutoff: f32,
    },
    /// Laid over what is behind it.
    Blend,
}

/// The equation a material answers to, with what only that equation needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MaterialModel {
    /// glTF 2.0's core model, with KHR_materials_ior and KHR_materials_specular.
    MetallicRoughness {
        /// Multiplies B of the map.
        metallic: f32,
        /// Multiplies G of the map.
        roughness: f32,
        /// Roughness in G, metallic in B, linear.
        map: Option<TextureUse>,
        /// Index of refraction.
        ior: f32,
        /// Multiplies A of the specular map.
        specular: f32,
        /// Specular strength in A, linear.
        specular_map: Option<TextureUse>,
        /// Linear; multiplies the specular colour map.
        specular_color: Vec3,
        /// Specular colour in RGB, sRGB.
        specular_color_map: Option<TextureUse>,
    },
    /// KHR_materials_pbrSpecularGlossiness; the base colour is its diffuse colour.
    SpecularGlossiness {
        /// Linear; multiplies RGB of the map.
        specular: Vec3,
        /// Multiplies A of the map.
        glossiness: f32,
        /// Specular colour in RGB (sRGB), glossiness in A (linear).
        map: Option<TextureUse>,
    },
    /// KHR_materials_unlit: the base colour is what is seen.
    Unlit,
}

/// A material of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Its name, or empty.
    pub name: String,
    /// The equation it answers to.
    pub model: MaterialModel,
    /// Linear; multiplies the base-colour map.
    pub base_color: Vec4,
    /// Base colour in RGB (sRGB), alpha in A (linear).
    pub base_color_map: Option<TextureUse>,
    /// Bends the normal.
    pub normal: Option<NormalTexture>,
    /// Dims light from the surroundings.
    pub occlusion: Option<OcclusionTexture>,
    /// Linear radiance, strength included; multiplies the emissive map.
    pub emissive: Vec3,
    /// Emitted colour in RGB, sRGB.
    pub emissive_map: Option<TextureUse>,
    /// How alpha is read.
    pub alpha_mode: AlphaMode,
    /// Whether the back side is drawn, with its normal turned.
    pub double_sided: bool,
}

impl Material {
    /// Moves the indices of all textures that it refers to up by `by`.
    pub(crate) fn move_textures(&mut self, by: usize) {
        self.uses_mut().for_each(|map| map.texture += by);
    }

    /// All textures that it refers to.
    pub(crate) fn uses_mut(&mut self) -> impl Iterator<Item = &mut TextureUse> {
        let mut all = vec![&mut self.base_color_map, &mut self.emissive_map];
        match &mut self.model {
            MaterialModel::MetallicRoughness {
                map,
                specular_map,
                specular_color_map,
                ..
            } => all.extend([map, specular_map, specular_color_map]),
            MaterialModel::SpecularGlossiness { map, .. } => all.push(map),
            MaterialModel::Unlit => {}
        }
        let normal = self.normal.as_mut().map(|normal| &mut normal.map);
        let occlusion = self.occlusion.as_mut().map(|occlusion| &mut occlusion.map);
        all.into_iter().flatten().chain(normal).chain(occlusion)
    }
}

impl Default for Material {
    /// glTF 2.0's default material: white, rough, metallic.
    fn default() -> Self {
        Self {
            name: String::new(),
            model: MaterialModel::MetallicRoughness {
                metallic: 1.0,
                roughness: 1.0,
                map: None,
                ior: 1.5,
                specular: 1.0,
                specular_map: None,
                specular_color: Vec3::ONE,
                specular_color_map: None,
            },
            base_color: Vec4::ONE,
            base_color_map: None,
            normal: None,
            occlusion: None,
            emissive: Vec3::ZERO,
            emissive_map: None,
            alpha_mode: AlphaMode::Opaque,
            double_sided: false,
        }
    }
}
