//! Textures from the `image` crate's pictures. Behind the feature `image`.

use glam::UVec2;
use image::DynamicImage;

use crate::{Error, Texels, Texture, Transfer};

impl Texture {
    /// A texture that takes over the buffer of `image`; its colour is said to be encoded by `transfer`.
    ///
    /// Channels and component type are kept. A layout that this crate has no storage for becomes f32 RGBA.
    /// Embedded profiles are not applied. Alpha is straight, as `image` decodes it.
    ///
    /// # Errors
    /// [`Error::EmptySize`] for a picture without pixels.
    /// # Examples
    /// ```
    /// use glam::UVec2;
    /// use sampler::{Texture, Transfer};
    /// let picture = image::DynamicImage::new_rgb8(4, 3);
    /// assert_eq!(Texture::from_image(picture, Transfer::Srgb)?.byte_len(), 36);
    /// # Ok::<(), sampler::Error>(())
    /// ```
    pub fn from_image(image: DynamicImage, transfer: Transfer) -> Result<Self, Error> {
        let size = UVec2::new(image.width(), image.height());
        let (channels, texels) = match image {
            DynamicImage::ImageLuma8(buffer) => (1, Texels::U8(buffer.into_raw())),
            DynamicImage::ImageLumaA8(buffer) => (2, Texels::U8(buffer.into_raw())),
            DynamicImage::ImageRgb8(buffer) => (3, Texels::U8(buffer.into_raw())),
            DynamicImage::ImageRgba8(buffer) => (4, Texels::U8(buffer.into_raw())),
            DynamicImage::ImageLuma16(buffer) => (1, Texels::U16(buffer.into_raw())),
            DynamicImage::ImageLumaA16(buffer) => (2, Texels::U16(buffer.into_raw())),
            DynamicImage::ImageRgb16(buffer) => (3, Texels::U16(buffer.into_raw())),
            DynamicImage::ImageRgba16(buffer) => (4, Texels::U16(buffer.into_raw())),
            DynamicImage::ImageRgb32F(buffer) => (3, Texels::F32(buffer.into_raw())),
            other => (4, Texels::F32(other.into_rgba32f().into_raw())),
        };
        Self::new(size, channels, transfer, texels)
    }
}
