//! Scene files: TOML that says what glTF cannot. `docs/scene-file.md` is their reference; [`kinds`](self) of tables and
//! keys are one list that the reader, the schema and that page follow.

mod key;
mod kinds;
mod lights;
mod mappings;
mod materials;
mod objects;
mod page;
mod patches;
mod read;
mod schema;
mod shapes;
mod table;
mod textures;
mod value;
mod view;

use std::path::{Path, PathBuf};

use super::{LoadOptions, load};
use crate::error::Error;
use crate::finish::FinishOptions;
use crate::scene::Scene;
use crate::settings::Settings;
pub use page::reference_page;
pub use schema::json_schema;

/// A scene with the picture that its file asks for.
#[derive(Clone, Debug)]
pub struct Document {
    /// The scene.
    pub scene: Scene,
    /// The picture; of a glTF file the defaults.
    pub settings: Settings,
    /// How it is finished; of a glTF file the defaults.
    pub finish: FinishOptions,
    /// Where it is written, if the file says so.
    pub output: Option<PathBuf>,
}

/// Reads a scene file (.toml) or a glTF file with what it says of the picture.
///
/// # Errors
/// As [`load`]; and [`Error::Toml`] for a scene file with a key that its table does not have, a value that is not what
/// it should be, a name that nothing has, or an include that leads back to itself: with line, column and what would be
/// right.
pub fn load_document(path: impl AsRef<Path>, options: &LoadOptions) -> Result<Document, Error> {
    let path = path.as_ref();
    if is_scene_file(path) {
        return read::read(path, options);
    }
    Ok(Document {
        scene: load(path, options)?,
        settings: Settings::default(),
        finish: FinishOptions::default(),
        output: None,
    })
}

/// Whether a file is TOML by its name.
pub(super) fn is_scene_file(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}
