//! Textures from and to the `image` crate's pictures. Behind the feature `image`.

use glam::UVec2;
use image::{DynamicImage, ImageBuffer};

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

    /// The texture as a picture of the `image` crate, its stored components as they are.
    ///
    /// 8- and 16-bit components keep their type and channels. Floats become f32 RGB, or RGBA where there is alpha:
    /// `image` has no other layout for them. Neither transfer function nor kind of alpha is converted, nor kept.
    ///
    /// # Examples
    /// ```
    /// use glam::UVec2;
    /// use sampler::{Texels, Texture, Transfer};
    /// let texture = Texture::new(UVec2::ONE, 2, Transfer::Srgb, Texels::U8(vec![7, 9]))?;
    /// assert_eq!(texture.to_image().as_luma_alpha8().map(|picture| picture.as_raw().as_slice()), Some(&[7, 9][..]));
    /// # Ok::<(), sampler::Error>(())
    /// ```
    #[allow(
        clippy::missing_panics_doc,
        reason = "a texture always has as many components as its size says"
    )]
    pub fn to_image(&self) -> DynamicImage {
        let UVec2 { x, y } = self.size();
        let made = match (self.texels(), self.channels()) {
            (Texels::U8(texels), 1) => {
                ImageBuffer::from_raw(x, y, texels.clone()).map(DynamicImage::ImageLuma8)
            }
            (Texels::U8(texels), 2) => {
                ImageBuffer::from_raw(x, y, texels.clone()).map(DynamicImage::ImageLumaA8)
            }
            (Texels::U8(texels), 3) => {
                ImageBuffer::from_raw(x, y, texels.clone()).map(DynamicImage::ImageRgb8)
            }
            (Texels::U8(texels), _) => {
                ImageBuffer::from_raw(x, y, texels.clone()).map(DynamicImage::ImageRgba8)
            }
            (Texels::U16(texels), 1) => {
                ImageBuffer::from_raw(x, y, texels.clone()).map(DynamicImage::ImageLuma16)
            }
            (Texels::U16(texels), 2) => {
                ImageBuffer::from_raw(x, y, texels.clone()).map(DynamicImage::ImageLumaA16)
            }
            (Texels::U16(texels), 3) => {
                ImageBuffer::from_raw(x, y, texels.clone()).map(DynamicImage::ImageRgb16)
            }
            (Texels::U16(texels), _) => {
                ImageBuffer::from_raw(x, y, texels.clone()).map(DynamicImage::ImageRgba16)
            }
            (Texels::F16(texels), channels) => float_image(
                self.size(),
                channels,
                texels.iter().map(|value| value.to_f32()),
            ),
            (Texels::F32(texels), channels) => {
                float_image(self.size(), channels, texels.iter().copied())
            }
        };
        made.expect("as many components as the size of a texture says")
    }
}

fn float_image(
    size: UVec2,
    channels: u8,
    components: impl Iterator<Item = f32>,
) -> Option<DynamicImage> {
    let stored: Vec<f32> = components.collect();
    let texels = stored.chunks_exact(usize::from(channels));
    if channels.is_multiple_of(2) {
        let rgba = texels.flat_map(|texel| match *texel {
            [grey, alpha] => [grey, grey, grey, alpha],
            _ => [texel[0], texel[1], texel[2], texel[3]],
        });
        ImageBuffer::from_raw(size.x, size.y, rgba.collect()).map(DynamicImage::ImageRgba32F)
    } else {
        let rgb = texels.flat_map(|texel| match *texel {
            [grey] => [grey; 3],
            _ => [texel[0], texel[1], texel[2]],
        });
        ImageBuffer::from_raw(size.x, size.y, rgb.collect()).map(DynamicImage::ImageRgb32F)
    }
}
