//! URIs: data, or a file beside the scene.

use std::path::{Component, Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::OutsidePaths;
use crate::error::Error;

/// What a URI leads to.
pub(crate) enum Target {
    /// Bytes in the URI itself.
    Data(Vec<u8>),
    /// A file.
    File(PathBuf),
}

/// Resolves `uri`, found at `place` of the scene file `scene`.
pub(crate) fn resolve(
    scene: &Path,
    place: &str,
    uri: &str,
    outside: OutsidePaths,
) -> Result<Target, Error> {
    let error = |detail: String| Error::scene(scene, place, detail);
    if let Some(data) = uri.strip_prefix("data:") {
        return data_bytes(data).map(Target::Data).map_err(error);
    }
    if let Some(scheme) = scheme(uri) {
        return Err(error(format!(
            "'{uri}' is remote ({scheme}:) and nothing is fetched from a network; \
             download it beside the scene and refer to it by its relative path"
        )));
    }
    let relative = percent_encoding::percent_decode_str(uri)
        .decode_utf8()
        .map_err(|_| error(format!("'{uri}' is not UTF-8 once decoded")))?;
    local_file(scene, &relative, outside)
        .map(Target::File)
        .map_err(error)
}

/// A file by its path relative to the folder of the scene file `scene`; or why it is refused.
pub(super) fn local_file(
    scene: &Path,
    relative: &str,
    outside: OutsidePaths,
) -> Result<PathBuf, String> {
    let folder = scene.parent().unwrap_or(Path::new(""));
    let file = folder.join(Path::new(relative));
    if outside == OutsidePaths::Refused && leaves(folder, Path::new(relative), &file) {
        return Err(format!(
            "'{relative}' leads out of the scene's folder; move the file there, or allow it with --allow-outside"
        ));
    }
    Ok(file)
}

/// The scheme of an absolute URI. One letter is a drive, not a scheme.
pub(crate) fn scheme(uri: &str) -> Option<&str> {
    let (scheme, _) = uri.split_once(':')?;
    let valid = scheme.len() > 1
        && scheme.starts_with(|c: char| c.is_ascii_alphabetic())
        && scheme
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || matches!(c, '+' | '-' | '.'));
    valid.then_some(scheme)
}

/// Whether a path leads out of `folder`, by its components or through a link.
fn leaves(folder: &Path, relative: &Path, file: &Path) -> bool {
    let mut depth = 0i32;
    for component in relative.components() {
        match component {
            Component::Normal(_) => depth += 1,
            Component::CurDir => {}
            Component::ParentDir => depth -= 1,
            Component::RootDir | Component::Prefix(_) => return true,
        }
        if depth < 0 {
            return true;
        }
    }
    // A file that does not exist cannot be a link; opening it will say so.
    let home = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    match (home.canonicalize(), file.canonicalize()) {
        (Ok(home), Ok(file)) => !file.starts_with(home),
        _ => false,
    }
}

/// The bytes of a data URI, after `data:`.
fn data_bytes(data: &str) -> Result<Vec<u8>, String> {
    let (header, body) = data
        .split_once(',')
        .ok_or("a data URI without a comma; nothing follows its header")?;
    if header.ends_with(";base64") {
        let body: String = body.chars().filter(|c| !c.is_ascii_whitespace()).collect();
        STANDARD
            .decode(body.as_bytes())
            .map_err(|error| format!("a data URI whose base64 is broken: {error}"))
    } else {
        Ok(percent_encoding::percent_decode_str(body).collect())
    }
}
