//! Images and samplers of a glTF file.

use gltf::image::Source;
use gltf::texture::{MagFilter, MinFilter, WrappingMode};
use mipmap::{MipFilter, SamplerState};
use sampler::{AddressMode, Filter};

use super::uri::{Target, resolve};
use super::{File, buffers};
use crate::error::Error;
use crate::scene::{ImageData, ImageSource, ImageTexture, Texture};

/// Every image of the file, undecoded; image files are not opened.
pub(super) fn images(file: &File) -> Result<Vec<ImageSource>, Error> {
    file.document
        .images()
        .map(|image| image_source(file, &image))
        .collect()
}

fn image_source(file: &File, image: &gltf::Image) -> Result<ImageSource, Error> {
    let place = format!("images[{}]", image.index());
    let name = |uri: Option<&str>| match (image.name(), uri) {
        (_, Some(uri)) if !uri.starts_with("data:") => format!("{place} '{uri}'"),
        (Some(name), _) => format!("{place} '{name}'"),
        _ => place.clone(),
    };
    match image.source() {
        Source::View { view, .. } => {
            let bytes = file.buffers.view(&view)?;
            let buffer: &std::sync::Arc<Vec<u8>> =
                buffers::Buffers::get(&file.buffers, &view.buffer())?;
            Ok(ImageSource {
                name: name(None),
                data: ImageData::Memory {
                    buffer: buffer.clone(),
                    offset: view.offset(),
                    length: bytes.len(),
                },
            })
        }
        Source::Uri { uri, .. } => {
            let data = match resolve(
                &file.path,
                &format!("{place}.uri"),
                uri,
                file.options.outside,
            )? {
                Target::File(path) => ImageData::File(path),
                Target::Data(bytes) => ImageData::Memory {
                    offset: 0,
                    length: bytes.len(),
                    buffer: bytes.into(),
                },
            };
            Ok(ImageSource {
                name: name(Some(uri)),
                data,
            })
        }
    }
}

/// Every texture of the file: an image and a sampler.
pub(super) fn textures(file: &File) -> Result<Vec<Texture>, Error> {
    Ok(file
        .document
        .textures()
        .map(|texture| {
            Texture::Image(ImageTexture {
                image: texture.source().index(),
                sampler: sampler_state(&texture.sampler()),
            })
        })
        .collect())
}

/// glTF 2.0, section 5.26; where the author leaves a filter open, the best one.
fn sampler_state(sampler: &gltf::texture::Sampler) -> SamplerState {
    let address = |mode| match mode {
        WrappingMode::Repeat => AddressMode::Repeat,
        WrappingMode::MirroredRepeat => AddressMode::MirrorRepeat,
        WrappingMode::ClampToEdge => AddressMode::ClampToEdge,
    };
    let magnify = match sampler.mag_filter() {
        Some(MagFilter::Nearest) => Filter::Nearest,
        Some(MagFilter::Linear) | None => Filter::Bilinear,
    };
    let (minify, mip) = match sampler.min_filter() {
        Some(MinFilter::Nearest) => (Filter::Nearest, MipFilter::None),
        Some(MinFilter::Linear) => (Filter::Bilinear, MipFilter::None),
        Some(MinFilter::NearestMipmapNearest) => (Filter::Nearest, MipFilter::Nearest),
        Some(MinFilter::LinearMipmapNearest) => (Filter::Bilinear, MipFilter::Nearest),
        Some(MinFilter::NearestMipmapLinear) => (Filter::Nearest, MipFilter::Linear),
        Some(MinFilter::LinearMipmapLinear) | None => (Filter::Bilinear, MipFilter::Linear),
    };
    SamplerState {
        address: [address(sampler.wrap_s()), address(sampler.wrap_t())].into(),
        magnify,
        minify,
        mip,
        max_anisotropy: 1.0,
        ..SamplerState::default()
    }
}
