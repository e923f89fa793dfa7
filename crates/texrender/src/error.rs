//! What can go wrong: what, where, and what to do about it.

use std::path::{Path, PathBuf};

/// An error of loading, preparing or writing.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A scene file is neither glTF JSON nor binary glTF.
    #[error("{} is not a glTF scene: {found}; expected JSON ('{{') or binary glTF (magic 'glTF')", path.display())]
    NotGltf {
        /// The file.
        path: PathBuf,
        /// What its first bytes are.
        found: String,
    },
    /// The container of a binary glTF is broken.
    #[error("{} is a damaged binary glTF: {detail}; export or download it again", path.display())]
    Glb {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        detail: String,
    },
    /// The JSON of a scene does not parse.
    #[error("{}:{line}:{column}: {detail}", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// Line of the JSON text, from 1.
        line: usize,
        /// Column of the JSON text, from 1.
        column: usize,
        /// What the parser said.
        detail: String,
    },
    /// A scene file, or a file that it names, says something it must not.
    #[error("{}:{line}:{column}: {detail}", path.display())]
    Toml {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong and what would be right.
        detail: String,
    },
    /// A scene says something it must not.
    #[error("{}: {place}: {detail}", path.display())]
    Scene {
        /// The file.
        path: PathBuf,
        /// Where in the JSON.
        place: String,
        /// What is wrong and what would be right.
        detail: String,
    },
    /// A scene needs an extension that is not supported.
    #[error("{}: extensionsRequired: {name} is not supported; export the scene without it", path.display())]
    RequiredExtension {
        /// The file.
        path: PathBuf,
        /// The extension.
        name: String,
    },
    /// An image cannot be decoded.
    #[error("image {name}: {detail}")]
    Image {
        /// Its name and where it stands.
        name: String,
        /// What is wrong and what to do.
        detail: String,
    },
    /// Something would need more memory than allowed.
    #[error(
        "{what} needs {needed} MiB and the limit leaves {available} MiB; raise it (--max-memory) or make it smaller"
    )]
    Memory {
        /// What was about to be made.
        what: String,
        /// MiB it needs.
        needed: u64,
        /// MiB that are left.
        available: u64,
    },
    /// The picture's size is out of range.
    #[error("a picture of {width}x{height} cannot be made: each side must be 1 to {max} pixels", max = raster::MAX_DIMENSION)]
    Size {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
    },
    /// A setting has a value it must not have.
    #[error("{setting}: {detail}")]
    Setting {
        /// The setting, as the command line spells it.
        setting: &'static str,
        /// What is wrong and what would be right.
        detail: String,
    },
    /// A table of comma-separated values is not what it should be.
    #[error("{}:{line}:{column}: {detail}", path.display())]
    Csv {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Field in the line, from 1.
        column: usize,
        /// What is wrong and what would be right.
        detail: String,
    },
    /// The output cannot be written.
    #[error("cannot write {}: {detail}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What is wrong and what to do.
        detail: String,
    },
}

impl Error {
    pub(crate) fn scene(path: &Path, place: impl Into<String>, detail: impl Into<String>) -> Self {
        Self::Scene {
            path: path.to_owned(),
            place: place.into(),
            detail: detail.into(),
        }
    }

    pub(crate) fn read(path: &Path, source: std::io::Error) -> Self {
        Self::Read {
            path: path.to_owned(),
            source,
        }
    }
}
