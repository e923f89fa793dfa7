//! Which digitised solids are decoded.

use glam::UVec3;
use sampler::Addressing;

use super::Plan;
use super::texture::TextureRole;
use crate::error::Error;
use crate::prepare::decode;
use crate::scene::{Scene, VolumeTexture};

/// A digitised solid that the picture needs, in one role.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeNeed {
    /// Index into [`Scene::images`].
    pub image: usize,
    /// What its texels mean.
    pub role: TextureRole,
    /// What lies beyond it.
    pub address: Addressing<3>,
    /// Size in texels; width and height are known from the image's header.
    pub size: UVec3,
    /// Bytes of a decoded texel.
    pub texel_bytes: u64,
    /// What it is for, one entry a use.
    pub reasons: Vec<String>,
}

impl VolumeNeed {
    /// Lists a need, or finds it listed; returns its index.
    pub(super) fn list(
        needs: &mut Vec<Self>,
        texture: &VolumeTexture,
        role: TextureRole,
        reason: String,
    ) -> usize {
        let same = |need: &Self| {
            (need.image, need.role, need.size.z) == (texture.image, role, texture.depth)
                && need.address == texture.address
        };
        let index = needs.iter().position(same).unwrap_or_else(|| {
            needs.push(Self {
                image: texture.image,
                role,
                address: texture.address,
                size: UVec3::new(0, 0, texture.depth),
                texel_bytes: 0,
                reasons: Vec::new(),
            });
            needs.len() - 1
        });
        if !needs[index].reasons.contains(&reason) {
            needs[index].reasons.push(reason);
        }
        index
    }

    /// Bytes that it takes once decoded.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let [width, height, depth] = self.size.to_array().map(u64::from);
        width * height * depth * self.texel_bytes
    }
}

/// Reads the sizes of the listed solids from the headers of their images.
pub(super) fn measure(scene: &Scene, plan: &mut Plan) -> Result<(), Error> {
    for need in &mut plan.volumes {
        let image = &scene.images[need.image];
        let header = decode::header(image)?;
        let depth = need.size.z;
        if depth == 0 || header.size.y % depth != 0 {
            return Err(Error::Image {
                name: image.name.clone(),
                detail: format!(
                    "its {} rows do not divide into {depth} slices; give the number of slices that lie below each other",
                    header.size.y
                ),
            });
        }
        need.size = UVec3::new(header.size.x, header.size.y / depth, depth);
        need.texel_bytes = header.texel_bytes;
    }
    Ok(())
}
