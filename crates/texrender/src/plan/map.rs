//! Maps: textures as kernels read them.

use glam::Vec4;
use mipmap::{MipFilter, SamplerState};
use texcoord::AffineTransform;

use super::filter::{MapReading, chosen_filter, chosen_reading};
use super::kernel::KernelBuilder;
use super::texture::{PyramidNeed, Readers, SheetNeed, TextureNeed, TextureRole};
use super::volume::VolumeNeed;
use crate::scene::{Coordinates, ImageTexture, Texture, TextureUse};
use crate::settings::Aov;

/// A texture as a kernel samples it.
#[derive(Clone, Copy, Debug)]
pub struct Map {
    /// What is read.
    pub source: MapSource,
    /// Where.
    pub coordinates: Coordinates,
    /// Applied to (s,t); `None` for the identity.
    pub transform: Option<AffineTransform>,
    /// What stands for it where a mapping gives no coordinate: it changes nothing.
    pub neutral: Vec4,
}

/// What a map reads.
#[derive(Clone, Copy, Debug)]
pub enum MapSource {
    /// An image.
    Image(ImageMap),
    /// A formula: index into [`crate::scene::Scene::textures`].
    Solid(usize),
    /// A digitised solid: index into [`super::Plan::volumes`].
    Volume(usize),
}

/// An image as a kernel samples it.
#[derive(Clone, Copy, Debug)]
pub struct ImageMap {
    /// Index into [`super::Plan::textures`].
    pub texture: usize,
    /// Address modes and filters.
    pub sampler: SamplerState,
    /// Whether another filter than the sampler's reads it.
    pub reading: MapReading,
    /// Index into [`super::Plan::sheets`].
    pub sheet: usize,
}

impl KernelBuilder<'_> {
    /// A map, if the primitive has coordinates for it.
    pub(super) fn map(
        &mut self,
        source: Option<TextureUse>,
        role: TextureRole,
        purpose: &str,
    ) -> Option<Map> {
        let source = source?;
        let texture = self.scene.textures.get(source.texture)?;
        match source.coordinates {
            Coordinates::Set(set) if set >= self.primitive.texcoords.len() => {
                self.plan.warnings.push(format!(
                    "mesh '{}' has no TEXCOORD_{set} for the {purpose} map of material '{}'; drawn without that map",
                    self.primitive.name, self.material.name
                ));
                return None;
            }
            Coordinates::Mapping(mapping) if mapping >= self.scene.mappings.len() => return None,
            _ => {}
        }
        let reason = format!("{purpose} of '{}'", self.material.name);
        let read = match texture {
            Texture::Image(texture) => MapSource::Image(self.image(texture, role, reason)),
            Texture::Solid(_) => MapSource::Solid(source.texture),
            Texture::Volume(texture) => MapSource::Volume(VolumeNeed::list(
                &mut self.plan.volumes,
                texture,
                role,
                reason,
            )),
        };
        Some(Map {
            source: read,
            coordinates: source.coordinates,
            transform: (!source.transform.is_identity()).then(|| source.transform.affine()),
            neutral: match role {
                TextureRole::Normal => Vec4::new(0.5, 0.5, 1.0, 1.0),
                _ => Vec4::ONE,
            },
        })
    }

    fn image(&mut self, texture: &ImageTexture, role: TextureRole, reason: String) -> ImageMap {
        let sampler = chosen_filter(self.plan.settings.filter, texture.sampler);
        let minified = sampler.mip != MipFilter::None || sampler.max_anisotropy > 1.0;
        let pyramid = if minified {
            PyramidNeed::Full
        } else {
            PyramidNeed::None
        };
        let texture = TextureNeed::list(
            &mut self.plan.textures,
            texture.image,
            role,
            pyramid,
            reason,
        );
        let reading = chosen_reading(self.plan.settings.filter, &sampler);
        if self.plan.settings.aovs.contains(&Aov::MipLevel) {
            self.plan.textures[texture].readers = Readers::Pixels;
        }
        ImageMap {
            texture,
            reading,
            sheet: SheetNeed::list(&mut self.plan.sheets, texture, sampler.address),
            sampler,
        }
    }
}
