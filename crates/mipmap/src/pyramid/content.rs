use glam::UVec2;
use sampler::{AlphaMode, Format};

use crate::error::Error;

/// What a texture's texels mean, which decides how they may be averaged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Content {
    /// Light or reflectance. Straight colour is weighted by its alpha, so that a transparent texel's colour has no
    /// influence on a visible one's.
    Colour,
    /// Colour that is drawn where its alpha is at least `cutoff`, in 0..=1.
    ///
    /// Averaged as [`Content::Colour`]. Then the alpha of each level is scaled so that the share of its texels with
    /// alpha ≥ cutoff is that of level 0, to the nearest texel and in the codes as stored: foliage does not thin out
    /// with distance. The scale follows from the order statistic of the level's alpha. Texels tied at the cutoff
    /// are told apart by the mean alpha of their 3×3 neighbourhood; those that still tie stay together. Scaled
    /// alpha is at most 1, and premultiplied colour is scaled with it. Without an alpha channel this is `Colour`.
    ///
    /// Source: Castaño 2010, "Computing Alpha Mipmaps" (there by bisection).
    AlphaTested {
        /// The least alpha that is drawn.
        cutoff: f32,
    },
    /// Independent quantities: metalness, occlusion, masks. Every channel is averaged on its own.
    Data,
    /// Unit vectors n stored as (n + 1)/2. The vectors are averaged and **not** normalised again: what they lose in
    /// length is the measure of how much they disagree. (The average of the codes is the code of the average, so
    /// the arithmetic is that of [`Content::Data`]; alpha, if any, is independent.)
    Normal,
    /// Perceptual roughness r in one channel, whatever the others hold; those are averaged as [`Content::Data`].
    ///
    /// A microfacet lobe's width α = r² is √2 times the deviation of its slopes. The slopes of a patch are those of
    /// its parts together, so their variances add: α² = r⁴ is averaged, and
    ///
    /// ```text
    /// r = mean(r⁴)^¼
    /// ```
    ///
    /// Between the least and the greatest r, at least their mean, and monotone in each. Held to 0..=1; NaN counts
    /// as 0. Source: glTF 2.0, appendix B (α = r²); Olano and Baker 2010, "LEAN Mapping", section 3 (variances of
    /// slopes add).
    Roughness {
        /// The channel that holds r, from 0.
        channel: u8,
    },
    /// Heights, in the first channel. Averaged as [`Content::Data`], with the least and the greatest height under
    /// each texel kept beside: [`super::Pyramid::bounds`].
    Height,
    /// Radiance from all around, weighted by the solid angle that each texel covers; alpha is one more channel.
    Environment(EnvironmentChart),
}

/// How the sphere is laid out in an environment texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum EnvironmentChart {
    /// Longitude along s, polar angle along t from the pole at the top: a row's texels cover cos θ₀ − cos θ₁.
    #[doc(alias = "equirectangular")]
    LatLong,
    /// One square face of a cube: a texel covers (1 + u² + v²)^(−3/2) du dv, integrated exactly.
    CubeFace,
}

impl Content {
    /// Whether this can be the content of a texture.
    pub(super) fn check(self, size: UVec2, format: Format) -> Result<(), Error> {
        match self {
            Self::AlphaTested { cutoff } if !(0.0..=1.0).contains(&cutoff) => {
                Err(Error::Cutoff { cutoff })
            }
            Self::Roughness { channel } if channel >= format.channels => {
                Err(Error::RoughnessChannel {
                    channel,
                    channels: format.channels,
                })
            }
            Self::Environment(EnvironmentChart::CubeFace) if size.x != size.y => {
                Err(Error::CubeFaceNotSquare { size })
            }
            _ => Ok(()),
        }
    }

    /// Whether colour is to be weighted by the alpha beside it.
    pub(super) fn is_weighted_by_alpha(self, format: Format) -> bool {
        matches!(self, Self::Colour | Self::AlphaTested { .. })
            && format.alpha == AlphaMode::Straight
            && format.alpha_index().is_some()
    }
}
