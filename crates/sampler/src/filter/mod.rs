//! Reconstruction inside one image: from texels to a colour between them.

mod bilinear;
mod nearest;

use glam::{DVec2, Vec4};

pub use bilinear::{BILINEAR_MAX_ERROR_ULPS, bilinear};
pub use nearest::nearest;

use crate::address::AddressMode;
use crate::texture::Texture;

/// The colour outside a texture addressed by [`AddressMode::ClampToBorder`]: transparent black.
pub const BORDER: Vec4 = Vec4::ZERO;

/// How a colour between texels is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[doc(alias = "magnify")]
#[doc(alias = "interpolation")]
pub enum Filter {
    /// The texel that contains the coordinate.
    Nearest,
    /// The four texels whose centres surround the coordinate, weighted linearly.
    #[default]
    #[doc(alias = "linear")]
    Bilinear,
}

/// The colour at `st`: [`nearest`] or [`bilinear`], as `filter` says.
///
/// `st`: normalised texture coordinates, (0, 0) the top left corner and (1, 1) the bottom right, any f64 (the
/// functions say what NaN and infinities give). `modes`: address modes of s and of t.
///
/// # Examples
/// ```
/// use glam::{DVec2, UVec2};
/// use sampler::{AddressMode, Filter, Texels, Texture, Transfer, sample};
/// let ramp = Texture::new(UVec2::new(2, 1), 1, Transfer::Linear, Texels::F32(vec![0.0, 1.0]))?;
/// let colour = sample(&ramp, [AddressMode::ClampToEdge; 2], Filter::Bilinear, DVec2::new(0.5, 0.5));
/// assert_eq!(colour.x, 0.5);
/// # Ok::<(), sampler::Error>(())
/// ```
#[inline]
pub fn sample(texture: &Texture, modes: [AddressMode; 2], filter: Filter, st: DVec2) -> Vec4 {
    match filter {
        Filter::Nearest => nearest(texture, modes, st),
        Filter::Bilinear => bilinear(texture, modes, st),
    }
}
