//! Textures of three dimensions: digitised solids.

use glam::{DVec3, DVec4, UVec2, UVec3, Vec4};

use crate::address::{Addressing, OUTSIDE};
use crate::error::Error;
use crate::format::{AlphaMode, Format, Texels, Transfer};
use crate::texture::Texture;

/// A three-dimensional array of texels, in slices from p = 0 on, each slice as a [`Texture`] is.
#[derive(Debug, Clone)]
#[doc(alias = "voxel")]
#[doc(alias = "3D texture")]
pub struct Volume {
    /// The slices below each other: row k·height + j is row j of slice k.
    slices: Texture,
    size: UVec3,
}

impl Volume {
    /// A volume of `size` texels of `channels` components, which `texels` holds slice by slice, row by row.
    ///
    /// # Errors
    /// [`Error::EmptyVolume`], [`Error::VolumeTooLarge`], [`Error::Channels`], [`Error::Length`] (whose height is
    /// that of all slices).
    /// # Examples
    /// ```
    /// use glam::{DVec3, UVec3};
    /// use sampler::{AddressMode, Texels, Transfer};
    /// use sampler::volume::Volume;
    /// let corners = Texels::F32(vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
    /// let volume = Volume::new(UVec3::splat(2), 1, Transfer::Linear, corners)?;
    /// assert_eq!(volume.trilinear([AddressMode::ClampToEdge; 3], DVec3::splat(0.5)).x, 3.5);
    /// # Ok::<(), sampler::Error>(())
    /// ```
    pub fn new(
        size: UVec3,
        channels: u8,
        transfer: Transfer,
        texels: Texels,
    ) -> Result<Self, Error> {
        if size.min_element() == 0 {
            return Err(Error::EmptyVolume { size });
        }
        let too_large = Error::VolumeTooLarge { size, channels };
        let Some(rows) = size.y.checked_mul(size.z) else {
            return Err(too_large);
        };
        let slices = match Texture::new(UVec2::new(size.x, rows), channels, transfer, texels) {
            Err(Error::TooLarge { .. }) => return Err(too_large),
            other => other?,
        };
        Ok(Self { slices, size })
    }

    /// A volume of `depth` slices that lie below each other in an image, the first at the top.
    ///
    /// # Errors
    /// [`Error::Slices`] unless `depth` divides the image's height.
    /// # Examples
    /// ```
    /// use glam::{UVec2, UVec3};
    /// use sampler::volume::Volume;
    /// use sampler::{Texels, Texture, Transfer};
    /// let image = Texture::new(UVec2::new(2, 6), 1, Transfer::Linear, Texels::U8(vec![7; 12]))?;
    /// assert_eq!(Volume::from_slices(image.clone(), 3)?.size(), UVec3::new(2, 2, 3));
    /// assert!(Volume::from_slices(image, 4).is_err());
    /// # Ok::<(), sampler::Error>(())
    /// ```
    pub fn from_slices(image: Texture, depth: u32) -> Result<Self, Error> {
        let UVec2 { x, y: height } = image.size();
        if depth == 0 || !height.is_multiple_of(depth) {
            return Err(Error::Slices { height, depth });
        }
        Ok(Self {
            slices: image,
            size: UVec3::new(x, height / depth, depth),
        })
    }

    /// The same texels, their colour said to be straight or premultiplied. Nothing is converted.
    #[must_use]
    pub fn with_alpha(self, alpha: AlphaMode) -> Self {
        Self {
            slices: self.slices.with_alpha(alpha),
            ..self
        }
    }

    /// Width, height and depth in texels, each at least 1.
    pub fn size(&self) -> UVec3 {
        self.size
    }

    /// Component type, channels, transfer and kind of alpha.
    pub fn format(&self) -> Format {
        self.slices.format()
    }

    /// Bytes that the stored components take.
    pub fn byte_len(&self) -> usize {
        self.slices.byte_len()
    }

    /// The texel at `ijk`, decoded as by [`Texture::fetch`]. Indices beyond the volume give the last texel.
    #[inline]
    pub fn fetch(&self, ijk: UVec3) -> Vec4 {
        let inside = ijk.min(self.size - 1);
        self.fetch_inside(inside.x, inside.y, inside.z)
    }

    /// The texel that contains `stp`: index ⌊stp · size⌋ along each axis, then addressed.
    ///
    /// `stp`: any f64, each as st in [`crate::nearest`]. Exact, as it is.
    pub fn nearest(&self, address: impl Into<Addressing<3>>, stp: DVec3) -> Vec4 {
        let address = address.into();
        let (m, n) = (address.modes, self.size.to_array());
        let i = m[0].nearest_tap(stp.x, n[0]);
        let j = m[1].nearest_tap(stp.y, n[1]);
        let k = m[2].nearest_tap(stp.z, n[2]);
        self.texel(&address, i, j, k)
    }

    /// The eight texels whose centres surround `stp`, weighted by nearness along each axis.
    ///
    /// The bilinear blends of two slices, blended by their nearness along p. As [`crate::bilinear`]: never outside the
    /// texels read, a constant exact to the bit, a texel of weight 0 not read, defined for every `stp`.
    ///
    /// # Accuracy
    /// Within 1 ulp of the largest |texel| of the exact value of the same decoded texels (blended in f64); checked by
    /// `tests/properties/volume.rs`.
    /// # Source
    /// Vulkan 1.3, "Linear filtering" (three dimensions).
    pub fn trilinear(&self, address: impl Into<Addressing<3>>, stp: DVec3) -> Vec4 {
        let address = address.into();
        let (m, n) = (address.modes, self.size.to_array());
        let s = m[0].linear_taps(stp.x, n[0]);
        let t = m[1].linear_taps(stp.y, n[1]);
        let p = m[2].linear_taps(stp.z, n[2]);
        let at = |i, j, k| self.texel(&address, i, j, k).as_dvec4();
        let row = |j, k| blend(s.far_weight, at(s.near, j, k), || at(s.far, j, k));
        let slice = |k| blend(t.far_weight, row(t.near, k), || row(t.far, k));
        blend(p.far_weight, slice(p.near), || slice(p.far)).as_vec4()
    }

    fn texel(&self, address: &Addressing<3>, i: u32, j: u32, k: u32) -> Vec4 {
        if i == OUTSIDE || j == OUTSIDE || k == OUTSIDE {
            address.border
        } else {
            self.fetch_inside(i, j, k)
        }
    }

    fn fetch_inside(&self, i: u32, j: u32, k: u32) -> Vec4 {
        self.slices.fetch_inside(i, k * self.size.y + j)
    }
}

/// In f64, where the difference of two f32 cannot overflow; `far` is not made where it has no weight.
fn blend(far_weight: f64, near: DVec4, far: impl FnOnce() -> DVec4) -> DVec4 {
    if far_weight == 0.0 {
        near
    } else {
        near + (far() - near) * far_weight
    }
}
