//! What the author wrote: geometry, materials, undecoded images, cameras and lights.
//!
//! A [`Scene`] holds everything the file's scene shows and nothing that a picture adds. Skins, morph
//! targets and animation are already applied (see [`crate::load::LoadOptions::time`]); images are
//! still the bytes of their files.

mod camera;
mod geometry;
mod image;
mod material;
mod texture;

use std::path::PathBuf;

use glam::DMat4;
use shading::PunctualLight;

pub use camera::{Camera, Projection};
pub(crate) use geometry::cofactors;
pub use geometry::{Bounds, Primitive, Topology};
pub use image::{ImageData, ImageSource};
pub use material::{
    AlphaMode, Coordinates, MappingSpace, Material, MaterialModel, NormalTexture, OcclusionTexture,
    SurfaceMapping, TextureUse,
};
pub use texture::{ImageTexture, SolidPattern, SolidTexture, Texture, VolumeTexture};

/// A scene as its author wrote it.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The file it came from; empty for a scene made in code.
    pub path: PathBuf,
    /// Pieces of geometry, each with one material.
    pub primitives: Vec<Primitive>,
    /// Where the pieces stand; drawn in this order.
    pub instances: Vec<Instance>,
    /// Materials; the last resort for a primitive without one is [`Material::default`].
    pub materials: Vec<Material>,
    /// Textures that materials refer to.
    pub textures: Vec<Texture>,
    /// Mappings that materials refer to.
    pub mappings: Vec<SurfaceMapping>,
    /// Images, undecoded.
    pub images: Vec<ImageSource>,
    /// Cameras, in the order of the file.
    pub cameras: Vec<Camera>,
    /// Punctual lights, in world space.
    pub lights: Vec<PunctualLight>,
    /// What the reader met and could not honour, each said once.
    pub warnings: Vec<String>,
}

/// A primitive placed in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// Name of the node, or empty.
    pub name: String,
    /// Index into [`Scene::primitives`].
    pub primitive: usize,
    /// From the primitive's space to the world.
    pub world: DMat4,
}

impl Scene {
    /// The material of a primitive: its own, or glTF's default.
    #[must_use]
    pub fn material(&self, primitive: &Primitive) -> Material {
        primitive
            .material
            .and_then(|i| self.materials.get(i))
            .cloned()
            .unwrap_or_default()
    }
}
