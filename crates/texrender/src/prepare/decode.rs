//! From the bytes of an image to its pixels.

use std::borrow::Cow;
use std::io::Cursor;

use glam::UVec2;
use image::{DynamicImage, ImageDecoder, ImageReader, Limits};

use crate::error::Error;
use crate::scene::{ImageData, ImageSource};

/// What the header of an image says.
pub(crate) struct Header {
    pub size: UVec2,
    pub texel_bytes: u64,
}

/// Reads the header of an image.
pub(crate) fn header(source: &ImageSource) -> Result<Header, Error> {
    let bytes = bytes(source)?;
    let decoder = decoder(source, &bytes)?;
    let (width, height) = decoder.dimensions();
    Ok(Header {
        size: UVec2::new(width, height),
        texel_bytes: decoder.color_type().bytes_per_pixel().into(),
    })
}

/// Decodes an image; nothing larger than `max_memory` bytes is made.
pub(crate) fn image(source: &ImageSource, max_memory: u64) -> Result<DynamicImage, Error> {
    let bytes = bytes(source)?;
    let mut decoder = decoder(source, &bytes)?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(max_memory);
    decoder
        .set_limits(limits)
        .and_then(|()| DynamicImage::from_decoder(decoder))
        .map_err(|error| failed(source, &error))
}

/// The picture without its alpha channel, if it has one.
pub(crate) fn without_alpha(picture: DynamicImage) -> DynamicImage {
    match picture {
        DynamicImage::ImageLumaA8(_) => DynamicImage::ImageLuma8(picture.into_luma8()),
        DynamicImage::ImageLumaA16(_) => DynamicImage::ImageLuma16(picture.into_luma16()),
        DynamicImage::ImageRgba8(_) => DynamicImage::ImageRgb8(picture.into_rgb8()),
        DynamicImage::ImageRgba16(_) => DynamicImage::ImageRgb16(picture.into_rgb16()),
        DynamicImage::ImageRgba32F(_) => DynamicImage::ImageRgb32F(picture.into_rgb32f()),
        other => other,
    }
}

fn bytes(source: &ImageSource) -> Result<Cow<'_, [u8]>, Error> {
    match &source.data {
        ImageData::File(path) => std::fs::read(path)
            .map(Cow::Owned)
            .map_err(|error| Error::read(path, error)),
        ImageData::Memory {
            buffer,
            offset,
            length,
        } => Ok(Cow::Borrowed(&buffer[*offset..*offset + *length])),
    }
}

fn decoder<'a>(
    source: &ImageSource,
    bytes: &'a [u8],
) -> Result<impl ImageDecoder + use<'a>, Error> {
    ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(image::ImageError::IoError)
        .and_then(ImageReader::into_decoder)
        .map_err(|error| failed(source, &error))
}

fn failed(source: &ImageSource, error: &image::ImageError) -> Error {
    let place = match &source.data {
        ImageData::File(path) => format!(" ({})", path.display()),
        ImageData::Memory { .. } => String::new(),
    };
    let remedy = match error {
        image::ImageError::Limits(_) => "raise --max-memory or make the image smaller",
        image::ImageError::Unsupported(_) => "use PNG, JPEG, WebP or HDR",
        _ => "the file is damaged or cut off: export it again",
    };
    Error::Image {
        name: format!("{}{place}", source.name),
        detail: format!("{error}; {remedy}"),
    }
}
