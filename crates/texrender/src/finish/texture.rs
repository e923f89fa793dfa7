//! A texture as a picture file.

use std::io::Cursor;
use std::path::Path;

use image::codecs::png::{CompressionType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use sampler::{Texels, Texture};

use super::encode::PNG_FILTER;
use super::{FileFormat, replace};
use crate::error::Error;

/// Writes a texture of 8 or 16 bits to a PNG file, code for code. The file appears whole or not at all.
///
/// # Errors
/// [`Error::Write`] for another extension, for a texture of floats, or a folder that does not exist or cannot be
/// written.
pub fn save_texture(texture: &Texture, path: impl AsRef<Path>) -> Result<(), Error> {
    let path = path.as_ref();
    check_holds_texture(path)?;
    let bytes = encode(texture).map_err(|detail| Error::Write {
        path: path.to_owned(),
        detail,
    })?;
    replace::replace(path, &bytes)
}

/// Writes codes of 8 bits, RGB row by row, to a PNG file. The file appears whole or not at all.
pub(crate) fn save_rgb8(
    samples: &[u8],
    (width, height): (u32, u32),
    path: &Path,
) -> Result<(), Error> {
    check_holds_texture(path)?;
    let mut bytes = Cursor::new(Vec::new());
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, PNG_FILTER)
        .write_image(samples, width, height, ExtendedColorType::Rgb8)
        .map_err(|error| Error::Write {
            path: path.to_owned(),
            detail: error.to_string(),
        })?;
    replace::replace(path, &bytes.into_inner())
}

/// Checks that textures can be written to `path`, before any work is done for it.
///
/// # Errors
/// [`Error::Write`] for an extension other than .png, or a folder that does not exist.
pub fn check_holds_texture(path: &Path) -> Result<(), Error> {
    if FileFormat::of(path)? != FileFormat::Png {
        return Err(Error::Write {
            path: path.to_owned(),
            detail: "textures are written as PNG; end the name in .png".to_owned(),
        });
    }
    replace::check_folder(path)
}

fn encode(texture: &Texture) -> Result<Vec<u8>, String> {
    use ExtendedColorType::{L8, L16, La8, La16, Rgb8, Rgb16, Rgba8, Rgba16};
    let kind = usize::from(texture.channels()) - 1;
    let (samples, kind) = match texture.texels() {
        Texels::U8(codes) => (codes.clone(), [L8, La8, Rgb8, Rgba8][kind]),
        Texels::U16(codes) => (
            codes.iter().flat_map(|code| code.to_ne_bytes()).collect(),
            [L16, La16, Rgb16, Rgba16][kind],
        ),
        Texels::F16(_) | Texels::F32(_) => {
            return Err("PNG holds codes of 8 or 16 bits, not floats".to_owned());
        }
    };
    let mut bytes = Cursor::new(Vec::new());
    let size = texture.size();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, PNG_FILTER)
        .write_image(&samples, size.x, size.y, kind)
        .map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}
