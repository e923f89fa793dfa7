//! Stage 1: file → [`Scene`].
//!
//! Scene files (.toml) say what glTF cannot, and what the picture shall be: [`load_document`].
//!
//! glTF 2.0, as JSON with external or embedded data or as one binary file. Geometry is read and
//! posed; images stay encoded. Nothing is fetched from a network, and no path leaves the scene's
//! folder unless allowed.

pub(crate) mod accessor;
mod animation;
pub(crate) mod buffers;
pub(crate) mod container;
pub(crate) mod extensions;
mod material;
pub(crate) mod nodes;
mod picture;
mod pose;
pub(crate) mod primitive;
mod scene_file;
mod texture;
pub(crate) mod uri;

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::scene::Scene;
use buffers::Buffers;
pub use picture::load_texture;
pub use scene_file::{Document, json_schema, load_document, reference_page};

/// What a reader may do, and which moment of an animation it reads.
#[derive(Clone, Debug)]
pub struct LoadOptions {
    /// Seconds into the animation; the rest pose where `None`.
    pub time: Option<f64>,
    /// Name or index of the animation that `time` refers to; the first where `None`.
    pub animation: Option<String>,
    /// Whether URIs may leave the scene's folder.
    pub outside: OutsidePaths,
    /// Bytes that the scene may take in memory.
    pub max_memory: u64,
}

/// Whether files outside the scene's folder may be read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OutsidePaths {
    /// An error.
    #[default]
    Refused,
    /// Read like any other.
    Allowed,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self {
            time: None,
            animation: None,
            outside: OutsidePaths::Refused,
            max_memory: crate::DEFAULT_MAX_MEMORY,
        }
    }
}

/// A glTF file being read.
#[derive(Debug)]
pub(crate) struct File {
    pub(crate) path: PathBuf,
    pub(crate) options: LoadOptions,
    pub(crate) document: gltf::Document,
    pub(crate) buffers: Buffers,
}

impl File {
    pub(crate) fn error(&self, place: impl Into<String>, detail: impl Into<String>) -> Error {
        Error::scene(&self.path, place, detail)
    }
}

/// Reads a scene.
///
/// # Errors
/// [`Error`], naming the file, the place in it and what to do: a file that is missing, cut off or
/// not glTF; JSON that does not parse; an index, accessor or view out of range; nodes that form a
/// cycle; a URI that is remote or leaves the scene's folder; a required extension that is not
/// supported; an animation that does not exist.
pub fn load(path: impl AsRef<Path>, options: &LoadOptions) -> Result<Scene, Error> {
    let path = path.as_ref();
    if scene_file::is_scene_file(path) {
        return load_document(path, options).map(|document| document.scene);
    }
    let bytes = std::fs::read(path).map_err(|source| Error::read(path, source))?;
    read_gltf(path, bytes, options)
}

/// Reads the scene that `bytes`, the content of the glTF file `path`, hold.
pub(crate) fn read_gltf(
    path: &Path,
    bytes: Vec<u8>,
    options: &LoadOptions,
) -> Result<Scene, Error> {
    let container = container::parse(path, bytes)?;
    let mut warnings = container.warnings;
    extensions::check(path, &container.root, &mut warnings)?;
    let document = container::validated(path, container.root, &mut warnings)?;
    let buffers = Buffers::new(path, options.outside, container.blob, &document);
    let file = File {
        path: path.to_owned(),
        options: options.clone(),
        document,
        buffers,
    };

    let mut scene = Scene {
        path: path.to_owned(),
        textures: texture::textures(&file)?,
        images: texture::images(&file)?,
        materials: file
            .document
            .materials()
            .map(|m| material::material(&file, &m))
            .collect::<Result<_, _>>()?,
        ..Scene::default()
    };
    let tree = nodes::Tree::new(&file)?;
    let mut read = HashMap::new();
    for placed in tree.nodes() {
        nodes::add_to_scene(&file, &tree, placed, &mut read, &mut scene)?;
    }
    let mut seen = std::collections::HashSet::new();
    scene.warnings = warnings
        .into_iter()
        .chain(scene.warnings)
        .filter(|w| seen.insert(w.clone()))
        .collect();
    Ok(scene)
}
