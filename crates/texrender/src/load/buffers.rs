//! The buffers of a glTF file, read when first asked for.

use std::cell::OnceCell;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use gltf::buffer::Source;

use super::OutsidePaths;
use super::uri::{Target, resolve};
use crate::error::Error;

/// Bytes of the buffers, each read once.
#[derive(Debug)]
pub(crate) struct Buffers {
    path: PathBuf,
    outside: OutsidePaths,
    blob: Option<Arc<Vec<u8>>>,
    read: Vec<OnceCell<Arc<Vec<u8>>>>,
}

impl Buffers {
    pub(crate) fn new(
        path: &Path,
        outside: OutsidePaths,
        blob: Option<Vec<u8>>,
        document: &gltf::Document,
    ) -> Self {
        Self {
            path: path.to_owned(),
            outside,
            blob: blob.map(Arc::new),
            read: vec![OnceCell::new(); document.buffers().len()],
        }
    }

    /// The bytes of a buffer: at least as many as the file says.
    pub(super) fn get(&self, buffer: &gltf::Buffer) -> Result<&Arc<Vec<u8>>, Error> {
        let cell = &self.read[buffer.index()];
        if let Some(bytes) = cell.get() {
            return Ok(bytes);
        }
        let bytes = self.fetch(buffer)?;
        if bytes.len() < buffer.length() {
            return Err(Error::scene(
                &self.path,
                format!("buffers[{}]", buffer.index()),
                format!("promises {} bytes and has {}", buffer.length(), bytes.len()),
            ));
        }
        Ok(cell.get_or_init(|| bytes))
    }

    /// The bytes of a buffer view.
    pub(crate) fn view(&self, view: &gltf::buffer::View) -> Result<&[u8], Error> {
        let buffer = self.get(&view.buffer())?;
        view.offset()
            .checked_add(view.length())
            .and_then(|end| buffer.get(view.offset()..end))
            .ok_or_else(|| {
                Error::scene(
                    &self.path,
                    format!("bufferViews[{}]", view.index()),
                    format!(
                        "bytes {} to {} lie outside buffer {} of {} bytes",
                        view.offset(),
                        view.offset().saturating_add(view.length()),
                        view.buffer().index(),
                        buffer.len()
                    ),
                )
            })
    }

    fn fetch(&self, buffer: &gltf::Buffer) -> Result<Arc<Vec<u8>>, Error> {
        let place = format!("buffers[{}].uri", buffer.index());
        match buffer.source() {
            Source::Bin => self.blob.clone().ok_or_else(|| {
                Error::scene(
                    &self.path,
                    place,
                    "is missing, and the file has no binary chunk to stand in for it",
                )
            }),
            Source::Uri(uri) => match resolve(&self.path, &place, uri, self.outside)? {
                Target::Data(bytes) => Ok(Arc::new(bytes)),
                Target::File(file) => std::fs::read(&file)
                    .map(Arc::new)
                    .map_err(|source| Error::read(&file, source)),
            },
        }
    }
}
