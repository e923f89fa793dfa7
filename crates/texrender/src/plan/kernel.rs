//! The smallest kernel that serves a surface.

use glam::{Vec3, Vec4};
use raster::Cull;

use super::map::Map;
use super::shown::Shown;
use super::texture::TextureRole;
use super::{Plan, TangentNeed};
use crate::scene::{AlphaMode, Coordinates, Material, MaterialModel, Primitive, Scene, Topology};

/// How the surface of a primitive is shaded: its factors, and the maps that change them.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// Name of the material, or empty.
    pub material: String,
    /// Which of its samples are covered.
    pub coverage: Coverage,
    /// Which of its sides are drawn.
    pub sidedness: Sidedness,
    /// Whether normals are interpolated.
    pub curvature: Curvature,
    /// Whether vertex colours multiply the base colour.
    pub vertex_colors: bool,
    /// Linear; multiplies the map.
    pub base_color: Vec4,
    /// Colour, and alpha where coverage asks for it.
    pub base_color_map: Option<Map>,
    /// Linear radiance; multiplies the map.
    pub emissive: Vec3,
    /// Emitted colour.
    pub emissive_map: Option<Map>,
    /// What light does to it.
    pub lighting: Lighting,
    /// What is shown of its coordinates instead of all this.
    pub shown: Option<Shown>,
}

/// Which samples of a surface are covered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coverage {
    /// All.
    Opaque,
    /// Those with at least this alpha.
    Mask {
        /// The least alpha that is visible.
        cutoff: f32,
    },
    /// All, each by its alpha.
    Blend,
}

/// Which sides of a surface are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sidedness {
    /// The front.
    Single,
    /// Both; the back with its normal turned.
    Double,
}

impl Sidedness {
    /// What assembly leaves out.
    pub(crate) fn cull(self) -> Cull {
        match self {
            Self::Single => Cull::Back,
            Self::Double => Cull::None,
        }
    }
}

/// Whether normals are interpolated over a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curvature {
    /// Each triangle has its own.
    Flat,
    /// From vertex to vertex.
    Smooth,
}

/// What light does to a surface.
#[derive(Clone, Debug)]
pub enum Lighting {
    /// Nothing: the base colour is what is seen.
    Unlit,
    /// Reflects it.
    Lit(Box<LitKernel>),
}

/// The part of a kernel that only lit surfaces have.
#[derive(Clone, Debug)]
pub struct LitKernel {
    /// The equation and its maps.
    pub reflectance: Reflectance,
    /// Normal map, its scale, and where tangents come from.
    pub normal: Option<(Map, f32, TangentSource)>,
    /// Occlusion map and its strength.
    pub occlusion: Option<(Map, f32)>,
}

/// A reflectance model with the maps that vary it; factors and channels are those of
/// [`MaterialModel`].
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the fields are documented at MaterialModel")]
#[allow(
    clippy::large_enum_variant,
    reason = "one a material, and most materials are of the first kind"
)]
pub enum Reflectance {
    /// glTF 2.0's core model.
    MetallicRoughness {
        metallic: f32,
        roughness: f32,
        map: Option<Map>,
        ior: f32,
        specular: f32,
        specular_map: Option<Map>,
        specular_color: Vec3,
        specular_color_map: Option<Map>,
    },
    /// KHR_materials_pbrSpecularGlossiness.
    SpecularGlossiness {
        specular: Vec3,
        glossiness: f32,
        map: Option<Map>,
    },
}

/// Where the tangents of a normal map come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TangentSource {
    /// The file.
    File,
    /// Generated: index into [`Plan::tangents`].
    Generated(usize),
    /// The mapping that gives the map its coordinates, per pixel.
    Mapping,
}

impl Kernel {
    /// Whether light reaches the surface.
    #[must_use]
    pub fn is_lit(&self) -> bool {
        matches!(self.lighting, Lighting::Lit(_))
    }

    /// Whether what shading reads goes on from a triangle to its neighbours wherever they have their vertices in common:
    /// no normals that triangles have for themselves, and no coordinates that a mapping gives.
    #[must_use]
    pub(crate) fn is_continuous(&self) -> bool {
        let by_vertices = |map: &Map| matches!(map.coordinates, Coordinates::Set(_));
        (self.curvature == Curvature::Smooth || !self.is_lit())
            && self.shown.is_none()
            && self.maps().all(by_vertices)
    }

    /// All its maps.
    pub(crate) fn maps(&self) -> impl Iterator<Item = &Map> {
        let mut all = vec![self.base_color_map.as_ref(), self.emissive_map.as_ref()];
        if let Lighting::Lit(lit) = &self.lighting {
            all.push(lit.normal.as_ref().map(|(map, _, _)| map));
            all.push(lit.occlusion.as_ref().map(|(map, _)| map));
            match &lit.reflectance {
                Reflectance::MetallicRoughness {
                    map,
                    specular_map,
                    specular_color_map,
                    ..
                } => all.extend([
                    map.as_ref(),
                    specular_map.as_ref(),
                    specular_color_map.as_ref(),
                ]),
                Reflectance::SpecularGlossiness { map, .. } => all.push(map.as_ref()),
            }
        }
        all.into_iter().flatten()
    }
}

/// Turns the material of one primitive into a kernel, listing what it needs in the plan.
pub(super) struct KernelBuilder<'a> {
    pub(super) scene: &'a Scene,
    index: usize,
    pub(super) primitive: &'a Primitive,
    pub(super) material: Material,
    pub(super) plan: &'a mut Plan,
}

impl<'a> KernelBuilder<'a> {
    pub(super) fn new(scene: &'a Scene, index: usize, plan: &'a mut Plan) -> Self {
        let primitive = &scene.primitives[index];
        Self {
            scene,
            index,
            primitive,
            material: scene.material(primitive),
            plan,
        }
    }

    /// What its primitive alone decides: white, without light, maps or holes.
    pub(super) fn bare(&self) -> Kernel {
        Kernel {
            material: self.material.name.clone(),
            coverage: Coverage::Opaque,
            sidedness: if self.material.double_sided {
                Sidedness::Double
            } else {
                Sidedness::Single
            },
            curvature: match self.primitive.normals {
                Some(_) => Curvature::Smooth,
                None => Curvature::Flat,
            },
            vertex_colors: false,
            base_color: Vec4::ONE,
            base_color_map: None,
            emissive: Vec3::ZERO,
            emissive_map: None,
            lighting: Lighting::Unlit,
            shown: None,
        }
    }

    pub(super) fn build(mut self) -> Kernel {
        if let Some(show) = self.plan.settings.show {
            return self.shown(show);
        }
        let coverage = match self.material.alpha_mode {
            AlphaMode::Opaque => Coverage::Opaque,
            AlphaMode::Mask { cutoff } => Coverage::Mask { cutoff },
            AlphaMode::Blend => Coverage::Blend,
        };
        let color_role = color_role(coverage, self.material.base_color.w);
        let emissive = self.material.emissive;
        // A factor of zero hides its map; alpha still needs the map of a black surface.
        let base_color = self.material.base_color;
        let shows_color = base_color.truncate() != Vec3::ZERO || coverage != Coverage::Opaque;
        Kernel {
            coverage,
            vertex_colors: self.primitive.colors.is_some(),
            base_color,
            base_color_map: self.map(
                self.material.base_color_map.filter(|_| shows_color),
                color_role,
                "base colour",
            ),
            lighting: self.lighting(),
            emissive,
            emissive_map: self.map(
                self.material
                    .emissive_map
                    .filter(|_| emissive != Vec3::ZERO),
                TextureRole::Colour,
                "emission",
            ),
            ..self.bare()
        }
    }

    fn lighting(&mut self) -> Lighting {
        // glTF 2.0, section 3.7.2.1: points and lines without normals are not lit.
        let bare =
            self.primitive.topology != Topology::Triangles && self.primitive.normals.is_none();
        match self.reflectance() {
            Some(reflectance) if !bare => Lighting::Lit(Box::new(LitKernel {
                reflectance,
                normal: self.normal(),
                occlusion: self.occlusion(),
            })),
            _ => Lighting::Unlit,
        }
    }

    /// `None` for an unlit material.
    fn reflectance(&mut self) -> Option<Reflectance> {
        match self.material.model {
            MaterialModel::Unlit => None,
            MaterialModel::MetallicRoughness {
                metallic,
                roughness,
                map,
                ior,
                specular,
                specular_map,
                specular_color,
                specular_color_map,
            } => {
                let varies = metallic != 0.0 || roughness != 0.0;
                let layered = specular != 0.0;
                Some(Reflectance::MetallicRoughness {
                    metallic,
                    roughness,
                    map: self.map(
                        map.filter(|_| varies),
                        TextureRole::MetallicRoughness,
                        "metallic and roughness",
                    ),
                    ior,
                    specular,
                    specular_map: self.map(
                        specular_map.filter(|_| layered),
                        TextureRole::Data,
                        "specular",
                    ),
                    specular_color,
                    specular_color_map: self.map(
                        specular_color_map.filter(|_| layered),
                        TextureRole::Colour,
                        "specular colour",
                    ),
                })
            }
            MaterialModel::SpecularGlossiness {
                specular,
                glossiness,
                map,
            } => Some(Reflectance::SpecularGlossiness {
                specular,
                glossiness,
                map: self.map(map, TextureRole::ColourAndData, "specular and glossiness"),
            }),
        }
    }

    fn normal(&mut self) -> Option<(Map, f32, TangentSource)> {
        let normal = self.material.normal?;
        if self.primitive.topology != Topology::Triangles {
            return None;
        }
        let bends = normal.scale != 0.0;
        let map = self.map(
            Some(normal.map).filter(|_| bends),
            TextureRole::Normal,
            "normal",
        )?;
        let source = match normal.map.coordinates {
            Coordinates::Mapping(_) => TangentSource::Mapping,
            Coordinates::Set(_) if self.primitive.tangents.is_some() => TangentSource::File,
            Coordinates::Set(texcoord) => {
                self.plan.tangents.push(TangentNeed {
                    primitive: self.index,
                    texcoord,
                    transform: normal.map.transform,
                });
                TangentSource::Generated(self.plan.tangents.len() - 1)
            }
        };
        Some((map, normal.scale, source))
    }

    fn occlusion(&mut self) -> Option<(Map, f32)> {
        let occlusion = self.material.occlusion?;
        // Occlusion dims the surroundings' light; without surroundings there is nothing to dim.
        let dims = occlusion.strength != 0.0
            && self.plan.settings.environment != crate::settings::EnvironmentSource::None;
        let map = self.map(
            Some(occlusion.map).filter(|_| dims),
            TextureRole::Data,
            "occlusion",
        )?;
        Some((map, occlusion.strength))
    }
}

/// What base colour means under a coverage. `factor`: what its alpha is multiplied by before the test.
fn color_role(coverage: Coverage, factor: f32) -> TextureRole {
    match coverage {
        Coverage::Opaque => TextureRole::Colour,
        // A cutoff that no texel reaches keeps no share.
        Coverage::Mask { cutoff } if (0.0..=1.0).contains(&(cutoff / factor)) => {
            TextureRole::AlphaTested {
                cutoff: cutoff / factor,
            }
        }
        Coverage::Mask { .. } | Coverage::Blend => TextureRole::ColourWithAlpha,
    }
}
