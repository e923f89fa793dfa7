//! Reconstruction inside one image: from texels to a colour between them.

mod bicubic;
mod bilinear;
mod codes;
mod fixed;
mod nearest;
mod pick;
mod weights;

use glam::{DVec2, Vec4};

pub use bicubic::{BICUBIC_MAX_ERROR_ULPS, Cubic, bicubic};
pub use bilinear::{BILINEAR_MAX_ERROR_ULPS, bilinear};
pub use codes::bilinear_codes;
pub use fixed::{BILINEAR_FIXED_MAX_ERROR, FixedMean, Precision, bilinear_fixed};
pub use nearest::nearest;
pub use pick::pick;
pub(crate) use weights::AxisWeights;

use crate::address::Addressing;
use crate::texture::Texture;

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
    /// The sixteen texels around the coordinate, weighted by a cubic kernel.
    Bicubic(Cubic),
}

/// The colour at `st`: [`nearest`], [`bilinear`] or [`bicubic`], as `filter` says, as exactly as `precision` says.
///
/// `st`: normalised texture coordinates, (0, 0) the top left corner and (1, 1) the bottom right, any f64 (the
/// functions say what NaN and infinities give). `precision` concerns [`Filter::Bilinear`], which goes to
/// [`bilinear_fixed`] for [`Precision::Fixed`]; the others are exact.
///
/// # Examples
/// ```
/// use glam::{DVec2, UVec2};
/// use sampler::{AddressMode, Filter, Precision, Texels, Texture, Transfer, sample};
/// let ramp = Texture::new(UVec2::new(2, 1), 1, Transfer::Linear, Texels::F32(vec![0.0, 1.0]))?;
/// let colour = sample(&ramp, [AddressMode::ClampToEdge; 2], Filter::Bilinear, Precision::Exact, DVec2::splat(0.5));
/// assert_eq!(colour.x, 0.5);
/// # Ok::<(), sampler::Error>(())
/// ```
#[inline]
pub fn sample(
    texture: &Texture,
    address: impl Into<Addressing<2>>,
    filter: Filter,
    precision: Precision,
    st: DVec2,
) -> Vec4 {
    match (filter, precision) {
        (Filter::Nearest, _) => nearest(texture, address, st),
        (Filter::Bilinear, Precision::Exact) => bilinear(texture, address, st),
        (Filter::Bilinear, Precision::Fixed) => bilinear_fixed(texture, address, st),
        (Filter::Bicubic(kernel), _) => bicubic(texture, address, kernel, st),
    }
}
