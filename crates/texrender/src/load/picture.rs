//! A picture file as a texture.

use std::path::Path;

use sampler::{Texture, Transfer};

use crate::error::Error;
use crate::prepare::decode;
use crate::scene::{ImageData, ImageSource};

/// The picture at `path` as a texture, its colour encoded by `transfer`. PNG, JPEG, WebP, HDR or EXR.
///
/// # Errors
/// [`Error::Read`] for a file that cannot be read, [`Error::Image`] for one that does not decode or needs more than
/// `max_memory` bytes.
pub fn load_texture(
    path: impl AsRef<Path>,
    transfer: Transfer,
    max_memory: u64,
) -> Result<Texture, Error> {
    let path = path.as_ref();
    let name = path
        .file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let source = ImageSource {
        name,
        data: ImageData::File(path.to_owned()),
    };
    let picture = decode::image(&source, max_memory)?;
    Texture::from_image(picture, transfer).map_err(|error| Error::Image {
        name: source.name,
        detail: error.to_string(),
    })
}
