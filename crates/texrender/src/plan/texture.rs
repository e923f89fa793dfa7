//! Which images are decoded, as what.

use glam::UVec2;
use rayon::prelude::*;
use sampler::{AddressMode, Addressing, Transfer};

use super::Plan;
use crate::error::Error;
use crate::prepare::decode;
use crate::scene::Scene;

/// An image that the picture needs, in one role.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureNeed {
    /// Index into [`Scene::images`].
    pub image: usize,
    /// What its texels mean.
    pub role: TextureRole,
    /// Whether mip levels are built.
    pub pyramid: PyramidNeed,
    /// The finest level that is kept: what no pixel of the view can touch is left out.
    pub finest: u32,
    /// Size in texels, from its header.
    pub size: UVec2,
    /// Bytes of a decoded texel.
    pub texel_bytes: u64,
    /// Who reads it.
    pub readers: Readers,
    /// What it is for, one entry a use.
    pub reasons: Vec<String>,
}

/// How the maps that use a texture read it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Readers {
    /// All from sheets laid out for packets: the pyramid is not kept beside them.
    Packets,
    /// Some pixel by pixel, from the pyramid, to tell its level.
    Pixels,
}

/// What the texels of an image mean, which decides how they are decoded and filtered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TextureRole {
    /// sRGB colour; alpha, if there is any, is dropped.
    Colour,
    /// sRGB colour with the alpha that covers it.
    ColourWithAlpha,
    /// sRGB colour that is drawn where its alpha reaches a cutoff: mip levels keep the share that is drawn.
    AlphaTested {
        /// The least alpha of a texel that is drawn, in 0..=1, the material's factor taken out.
        cutoff: f32,
    },
    /// sRGB colour beside a number in alpha that has nothing to do with it.
    ColourAndData,
    /// Numbers.
    Data,
    /// Roughness in green, metalness in blue: mip levels average the squared widths of roughness.
    MetallicRoughness,
    /// Directions.
    Normal,
}

/// A pyramid to lay out for packets, under one pair of address modes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetNeed {
    /// Index into [`Plan::textures`].
    pub texture: usize,
    /// What lies beyond the border.
    pub address: Addressing<2>,
}

impl SheetNeed {
    /// Lists a need, unless it is listed already; returns its index.
    pub(super) fn list(needs: &mut Vec<Self>, texture: usize, address: Addressing<2>) -> usize {
        let need = Self { texture, address };
        let found = needs.iter().position(|listed| *listed == need);
        found.unwrap_or_else(|| {
            needs.push(need);
            needs.len() - 1
        })
    }
}

impl TextureRole {
    /// How the numbers of its colour channels stand for light.
    #[must_use]
    pub fn transfer(self) -> Transfer {
        match self {
            Self::Colour
            | Self::ColourWithAlpha
            | Self::AlphaTested { .. }
            | Self::ColourAndData => Transfer::Srgb,
            Self::Data | Self::MetallicRoughness | Self::Normal => Transfer::Linear,
        }
    }

    /// The role that serves both, if one does.
    ///
    /// Only the green of a metallic-roughness map is not plain data; no other map of data reads green (occlusion is
    /// red, specular alpha), so that one image that packs them all is prepared once.
    fn united(self, other: Self) -> Option<Self> {
        match (self, other) {
            (Self::Data, Self::MetallicRoughness) | (Self::MetallicRoughness, Self::Data) => {
                Some(Self::MetallicRoughness)
            }
            _ => (self == other).then_some(self),
        }
    }
}

/// Whether mip levels are built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PyramidNeed {
    /// The image alone.
    None,
    /// All levels down to one texel.
    Full,
}

impl TextureNeed {
    /// Lists a need, merged with one that serves it or that it serves; returns its index.
    pub(super) fn list(
        needs: &mut Vec<Self>,
        image: usize,
        role: TextureRole,
        pyramid: PyramidNeed,
        reason: String,
    ) -> usize {
        let found = needs
            .iter()
            .position(|need| need.image == image && need.role.united(role).is_some());
        let index = found.unwrap_or_else(|| {
            needs.push(Self {
                image,
                role,
                pyramid,
                finest: 0,
                size: UVec2::ZERO,
                texel_bytes: 0,
                readers: Readers::Packets,
                reasons: Vec::new(),
            });
            needs.len() - 1
        });
        let need = &mut needs[index];
        need.role = need.role.united(role).unwrap_or(role);
        need.pyramid = need.pyramid.max(pyramid);
        if !need.reasons.contains(&reason) {
            need.reasons.push(reason);
        }
        index
    }

    /// The number of its levels, those that are left out too.
    #[must_use]
    pub fn levels(&self) -> u32 {
        match self.pyramid {
            PyramidNeed::None => 1,
            PyramidNeed::Full => self.size.max_element().max(1).ilog2() + 1,
        }
    }

    /// Bytes that it takes once decoded, with the levels that are kept.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.bytes_from(self.finest)
    }

    /// Bytes that it takes while it is made: all its levels.
    #[must_use]
    pub fn whole_bytes(&self) -> u64 {
        self.bytes_from(0)
    }

    fn bytes_from(&self, level: u32) -> u64 {
        let finest = self.texels_of(level) * self.texel_bytes;
        match self.pyramid {
            PyramidNeed::None => finest,
            PyramidNeed::Full => finest + finest / 3,
        }
    }

    fn texels_of(&self, level: u32) -> u64 {
        let side = |texels: u32| u64::from((texels >> level).max(1));
        side(self.size.x) * side(self.size.y)
    }
}

impl SheetNeed {
    /// Bytes that it takes: half as many texels again as the finest level, of four channels in the least format that holds
    /// them.
    #[must_use]
    pub fn bytes(&self, textures: &[TextureNeed]) -> u64 {
        let texture = &textures[self.texture];
        let linear = matches!(
            texture.role,
            TextureRole::Data | TextureRole::MetallicRoughness | TextureRole::Normal
        );
        let bordered = self.address.modes.contains(&AddressMode::ClampToBorder);
        let texel: u64 = match texture.texel_bytes {
            _ if bordered => 16,
            ..=4 if linear => 4,
            ..=8 => 8,
            _ => 16,
        };
        let finest = texture.texels_of(texture.finest) * texel;
        match texture.pyramid {
            PyramidNeed::None => finest,
            PyramidNeed::Full => finest + finest / 2,
        }
    }
}

/// Reads the sizes of the listed images from their headers.
pub(super) fn measure(scene: &Scene, plan: &mut Plan) -> Result<(), Error> {
    let limit = plan.settings.max_memory;
    plan.textures.par_iter_mut().try_for_each(|need| {
        let image = &scene.images[need.image];
        let header = decode::header(image)?;
        need.size = header.size;
        need.texel_bytes = header.texel_bytes;
        if need.bytes() > limit {
            return Err(Error::Memory {
                what: format!(
                    "{}: {} of {}x{} texels",
                    scene.path.display(),
                    image.name,
                    need.size.x,
                    need.size.y
                ),
                needed: need.bytes() >> 20,
                available: limit >> 20,
            });
        }
        Ok(())
    })
}
