//! Stage 5: [`Film`] → file: expose, tone-map or keep linear, encode, replace the file in one step.

mod aov;
mod develop;
mod encode;
mod exr;
mod replace;
mod rows;
mod texture;
mod tonemap;

use std::path::Path;

use crate::error::Error;
use crate::render::Film;
use crate::settings::{Aov, Background};
pub use encode::{BitDepth, FileFormat};
pub use replace::check_folder;
pub(crate) use replace::replace;
pub(crate) use texture::save_rgb8;
pub use texture::{check_holds_texture, save_texture};
pub use tonemap::ToneMap;

/// How a film becomes a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FinishOptions {
    /// Curve from radiance to display; linear files (EXR, HDR) are never tone-mapped.
    pub tonemap: ToneMap,
    /// Stops by which radiance is brightened, before the curve.
    pub exposure: f32,
    /// Bits a channel of PNG files.
    pub bit_depth: BitDepth,
}

impl Default for FinishOptions {
    fn default() -> Self {
        Self {
            tonemap: ToneMap::Neutral,
            exposure: 0.0,
            bit_depth: BitDepth::Eight,
        }
    }
}

/// Writes the picture to `path`, in the format that its extension names.
///
/// PNG, JPEG and WebP are exposed, tone-mapped and encoded as sRGB; EXR and HDR are exposed and stay
/// linear. `layers` are AOVs to store beside the colour, in EXR files. The file appears whole or not
/// at all.
///
/// # Errors
/// [`Error::Write`] for an unknown extension, a format that cannot hold what is asked, or a folder
/// that does not exist or cannot be written.
pub fn save(
    film: &Film,
    path: impl AsRef<Path>,
    options: &FinishOptions,
    layers: &[Aov],
) -> Result<(), Error> {
    let path = path.as_ref();
    let format = FileFormat::of(path)?;
    check_holds(path, film.background(), options.bit_depth, layers)?;
    let bytes = match format {
        FileFormat::Exr => exr::encode(film, options, layers),
        _ => encode::encode(film, format, options),
    }
    .map_err(|detail| Error::Write {
        path: path.to_owned(),
        detail,
    })?;
    replace::replace(path, &bytes)
}

/// Writes AOVs to a file of their own: their numbers to EXR, a picture of a single one to PNG, JPEG
/// or WebP.
///
/// # Errors
/// As [`save`]; also if the film does not hold one of them.
pub fn save_aovs(film: &Film, aovs: &[Aov], path: impl AsRef<Path>) -> Result<(), Error> {
    let path = path.as_ref();
    let format = FileFormat::of(path)?;
    let error = |detail: String| Error::Write {
        path: path.to_owned(),
        detail,
    };
    if let Some(missing) = aovs.iter().find(|aov| !film.aovs().contains(aov)) {
        return Err(error(format!("the film holds no {}", missing.name())));
    }
    let bytes = match (format, aovs) {
        (FileFormat::Exr, _) => exr::encode_aovs(film, aovs),
        (_, &[single]) => aov::picture(film, single, format),
        _ => Err("only EXR holds several AOVs; give each its own file".to_owned()),
    }
    .map_err(error)?;
    replace::replace(path, &bytes)
}

/// Refuses what the format of `path` cannot hold, before anything is rendered for it.
///
/// # Errors
/// [`Error::Write`], with the formats that can.
pub fn check_holds(
    path: &Path,
    background: Background,
    bit_depth: BitDepth,
    layers: &[Aov],
) -> Result<(), Error> {
    let format = FileFormat::of(path)?;
    let error = |detail: &str| {
        Err(Error::Write {
            path: path.to_owned(),
            detail: detail.to_owned(),
        })
    };
    match format {
        FileFormat::Jpeg | FileFormat::Hdr if background == Background::Transparent => {
            error("the format has no alpha for a transparent background; use PNG, WebP or EXR")
        }
        FileFormat::Jpeg | FileFormat::WebP if bit_depth == BitDepth::Sixteen => {
            error("only PNG holds 16 bits a channel; drop --bit-depth 16 or write .png")
        }
        FileFormat::Png | FileFormat::Jpeg | FileFormat::WebP | FileFormat::Hdr
            if !layers.is_empty() =>
        {
            error("only EXR holds AOVs beside the colour; give each its own file")
        }
        _ => Ok(()),
    }
}

/// The factor of an exposure in stops.
fn gain(options: &FinishOptions) -> f32 {
    libm::exp2f(options.exposure)
}
