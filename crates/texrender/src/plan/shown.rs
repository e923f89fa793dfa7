//! Coordinates made visible instead of materials.

use glam::{UVec2, Vec3};
use texcoord::AffineTransform;

use super::Plan;
use super::kernel::{Coverage, Kernel, KernelBuilder, Lighting, LitKernel, Reflectance};
use crate::error::Error;
use crate::prepare::decode;
use crate::scene::{Coordinates, Material, MaterialModel, Scene, Texture, TextureUse};
use crate::settings::Show;

/// Size of a texture that a surface does not have, for what is told in texels.
const ASSUMED_SIZE: UVec2 = UVec2::splat(1024);

/// What is shown of a surface.
#[derive(Clone, Copy, Debug)]
pub struct Shown {
    /// What of its coordinates.
    pub show: Show,
    /// Which coordinates: those of its base-colour map, or else of another map, or else its set 0.
    pub coordinates: Option<Coordinates>,
    /// Applied to them.
    pub transform: Option<AffineTransform>,
    /// Index into [`Scene::images`] of the texture that they belong to.
    image: Option<usize>,
    /// Its size in texels; 1024×1024 without one.
    pub size: UVec2,
}

impl KernelBuilder<'_> {
    /// A kernel that shows the coordinates of its surface.
    pub(super) fn shown(&self, show: Show) -> Kernel {
        let primitive = self.primitive;
        let texture = uses(&self.material).find(|source| match source.coordinates {
            Coordinates::Set(set) => set < primitive.texcoords.len(),
            Coordinates::Mapping(_) => true,
        });
        let first_set = (!primitive.texcoords.is_empty()).then_some(Coordinates::Set(0));
        let transform = texture.map(|source| source.transform);
        let image = texture.and_then(|source| match self.scene.textures.get(source.texture) {
            Some(Texture::Image(texture)) => Some(texture.image),
            _ => None,
        });
        let lighting = match show {
            Show::Checker => Lighting::Lit(Box::new(LitKernel {
                reflectance: matte(),
                normal: None,
                occlusion: None,
            })),
            _ => Lighting::Unlit,
        };
        Kernel {
            shown: Some(Shown {
                show,
                coordinates: texture.map(|source| source.coordinates).or(first_set),
                transform: transform
                    .filter(|transform| !transform.is_identity())
                    .map(|transform| transform.affine()),
                image,
                size: ASSUMED_SIZE,
            }),
            coverage: Coverage::Opaque,
            lighting,
            ..self.bare()
        }
    }
}

fn matte() -> Reflectance {
    Reflectance::MetallicRoughness {
        metallic: 0.0,
        roughness: 1.0,
        map: None,
        ior: 1.5,
        specular: 0.0,
        specular_map: None,
        specular_color: Vec3::ONE,
        specular_color_map: None,
    }
}

/// The textures of a material, its base colour first.
fn uses(material: &Material) -> impl Iterator<Item = TextureUse> {
    let map = match material.model {
        MaterialModel::MetallicRoughness { map, .. }
        | MaterialModel::SpecularGlossiness { map, .. } => map,
        MaterialModel::Unlit => None,
    };
    let all = [
        material.base_color_map,
        material.normal.map(|normal| normal.map),
        map,
        material.emissive_map,
        material.occlusion.map(|occlusion| occlusion.map),
    ];
    all.into_iter().flatten()
}

/// Reads the sizes of textures whose coordinates are shown in texels.
pub(super) fn measure(scene: &Scene, plan: &mut Plan) -> Result<(), Error> {
    for shown in plan.kernels.iter_mut().filter_map(|k| k.shown.as_mut()) {
        if let Some(image) = shown.image {
            shown.size = decode::header(&scene.images[image])?.size;
        }
    }
    Ok(())
}
