//! Display pictures: PNG, JPEG, WebP; and linear HDR.

use std::io::Cursor;
use std::path::Path;

use fearless_simd::{Level, Simd, dispatch, prelude::*};
use glam::Vec3;
use image::codecs::hdr::HdrEncoder;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::codecs::webp::WebPEncoder;
use image::{ExtendedColorType, ImageEncoder, Rgb};
use sampler::transfer::{
    SrgbU8Encoder, encode_srgb_u16, encode_unorm_u8, encode_unorm_u8_packet, encode_unorm_u16,
};
use texcoord::packet::LANES;
use texcoord::unrolled::three;

use super::develop::{Alpha, Development, Row, developed_rows};
use super::rows::rows;
use super::{FinishOptions, ToneMap, gain};
use crate::error::Error;
use crate::render::Film;
use crate::settings::Background;

/// Quality of JPEG files, 1..=100.
const JPEG_QUALITY: u8 = 92;

/// Row filter of PNG files: of rendered pictures it makes files within 2 % of those whose rows choose one
/// each, in two thirds to nine tenths of the time.
pub(super) const PNG_FILTER: FilterType = FilterType::Paeth;

/// A format of picture files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileFormat {
    /// sRGB, lossless, with alpha.
    Png,
    /// sRGB, lossy.
    Jpeg,
    /// sRGB, lossless, with alpha.
    WebP,
    /// Linear, shared exponent.
    Hdr,
    /// Linear floats, with alpha and AOVs.
    Exr,
}

/// Bits a channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BitDepth {
    /// 8 bits.
    #[default]
    Eight,
    /// 16 bits, PNG only.
    Sixteen,
}

impl FileFormat {
    /// The format that a file's extension names.
    ///
    /// # Errors
    /// [`Error::Write`] for an extension that names none.
    pub fn of(path: &Path) -> Result<Self, Error> {
        let extension = path.extension().and_then(|e| e.to_str());
        match extension.map(str::to_ascii_lowercase).as_deref() {
            Some("png") => Ok(Self::Png),
            Some("jpg" | "jpeg") => Ok(Self::Jpeg),
            Some("webp") => Ok(Self::WebP),
            Some("hdr") => Ok(Self::Hdr),
            Some("exr") => Ok(Self::Exr),
            _ => Err(Error::Write {
                path: path.to_owned(),
                detail: "its extension names no format; use .png, .jpg, .webp, .hdr or .exr"
                    .to_owned(),
            }),
        }
    }
}

/// The bytes of a picture file.
pub(super) fn encode(
    film: &Film,
    format: FileFormat,
    options: &FinishOptions,
) -> Result<Vec<u8>, String> {
    use ExtendedColorType as Kind;
    let transparent = film.background() == Background::Transparent;
    let channels = if transparent { 4 } else { 3 };
    let development = Development {
        gain: gain(options),
        tonemap: options.tonemap,
        alpha: Alpha::Straight,
    };
    let (samples, kind) = match (format, options.bit_depth) {
        (FileFormat::Hdr, _) => return encode_hdr(film, &development),
        (FileFormat::Png, BitDepth::Sixteen) => (
            developed_rows(film, &development, (channels * 2, 0), write_u16),
            if transparent {
                Kind::Rgba16
            } else {
                Kind::Rgb16
            },
        ),
        _ => (
            developed_rows(film, &development, (channels, 0), write_u8),
            if transparent { Kind::Rgba8 } else { Kind::Rgb8 },
        ),
    };
    write(&samples, (film.width(), film.height()), kind, format)
}

/// The 8-bit codes of a row, of as many channels as there is room for.
fn write_u8(row: &Row, out: &mut [u8]) {
    dispatch!(Level::new(), simd => match out.len() / row.width() {
        3 => write_channels::<_, 3>(simd, row, out),
        _ => write_channels::<_, 4>(simd, row, out),
    });
}

#[inline(always)]
fn write_channels<S: Simd, const CHANNELS: usize>(simd: S, row: &Row, out: &mut [u8]) {
    let encoder = SrgbU8Encoder::shared();
    let (pixels, _) = out.as_chunks_mut::<CHANNELS>();
    for (([r, g, b, a], count), out) in row.packets(simd).zip(pixels.chunks_mut(LANES)) {
        let light = [r, g, b];
        let [r, g, b] = three(
            #[inline(always)]
            |k| encoder.encode_packet(simd, light[k]),
        );
        let colour = r | g << 8 | b << 16;
        let words = if CHANNELS == 4 {
            colour | encode_unorm_u8_packet(simd, a) << 24
        } else {
            colour
        };
        for (word, out) in words.to_array()[..count].iter().zip(out) {
            out.copy_from_slice(&word.to_le_bytes()[..CHANNELS]);
        }
    }
}

/// The 16-bit codes of a row, two bytes each; of as many channels as there is room for.
fn write_u16(row: &Row, out: &mut [u8]) {
    let (codes, _) = out.as_chunks_mut::<2>();
    let channels = codes.len() / row.width();
    for (pixel, codes) in row.pixels().zip(codes.chunks_exact_mut(channels)) {
        let [r, g, b] = pixel.truncate().to_array().map(encode_srgb_u16);
        let wanted = [r, g, b, encode_unorm_u16(pixel.w)];
        for (code, wanted) in codes.iter_mut().zip(wanted) {
            *code = wanted.to_ne_bytes();
        }
    }
}

fn encode_hdr(film: &Film, development: &Development) -> Result<Vec<u8>, String> {
    let linear = Development {
        tonemap: ToneMap::None,
        ..*development
    };
    let pixels = developed_rows(film, &linear, (1, Rgb([0.0; 3])), |row, out| {
        for (pixel, out) in row.pixels().zip(out) {
            *out = Rgb(within_shared_exponent(pixel.truncate()).to_array());
        }
    });
    let mut bytes = Vec::new();
    HdrEncoder::new(&mut bytes)
        .encode(&pixels, film.width() as usize, film.height() as usize)
        .map_err(|e| e.to_string())?;
    Ok(bytes)
}

/// What a shared exponent of 8 bits can hold: 0 for what is too small, the greatest for what is too
/// large; the encoder's exponent would wrap round. NaN becomes 0.
fn within_shared_exponent(color: Vec3) -> Vec3 {
    const LEAST: f32 = f32::MIN_POSITIVE;
    const GREATEST: f32 = f32::MAX * 0.499;
    // Not `clamp`, which keeps NaN.
    let held = color.max(Vec3::ZERO).min(Vec3::splat(GREATEST));
    if held.max_element() < LEAST {
        Vec3::ZERO
    } else {
        held
    }
}

/// The bytes of an 8-bit RGB picture whose channels are given in 0..=1, as they are to be stored.
pub(super) fn encode_rgb8(
    film: &Film,
    format: FileFormat,
    pixel: impl Fn(u32, u32) -> Vec3 + Sync,
) -> Result<Vec<u8>, String> {
    let samples = rows(film, (3, 0), |x, y, out| {
        out.copy_from_slice(&pixel(x, y).to_array().map(encode_unorm_u8));
    });
    let size = (film.width(), film.height());
    write(&samples, size, ExtendedColorType::Rgb8, format)
}

fn write(
    samples: &[u8],
    (width, height): (u32, u32),
    kind: ExtendedColorType,
    format: FileFormat,
) -> Result<Vec<u8>, String> {
    let mut bytes = Cursor::new(Vec::new());
    match format {
        FileFormat::Png => {
            PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, PNG_FILTER)
                .write_image(samples, width, height, kind)
        }
        FileFormat::Jpeg => JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY)
            .write_image(samples, width, height, kind),
        FileFormat::WebP => {
            WebPEncoder::new_lossless(&mut bytes).write_image(samples, width, height, kind)
        }
        FileFormat::Hdr | FileFormat::Exr => {
            return Err("the format holds radiance, not codes".to_owned());
        }
    }
    .map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}
