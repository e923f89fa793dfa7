//! Files that appear whole or not at all.

use std::io::Write;
use std::path::Path;

use crate::error::Error;

/// Checks that the folder of an output file exists, before any work is done for it.
///
/// # Errors
/// [`Error::Write`] if it does not, or if the path is a folder.
pub fn check_folder(path: &Path) -> Result<(), Error> {
    let error = |detail: String| {
        Err(Error::Write {
            path: path.to_owned(),
            detail,
        })
    };
    let folder = folder(path);
    if path.is_dir() {
        return error("it is a folder; name a file".to_owned());
    }
    if !folder.is_dir() {
        return error(format!(
            "the folder {} does not exist; create it first",
            folder.display()
        ));
    }
    Ok(())
}

fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// Writes `bytes` beside `path`, then puts them in its place in one step.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    check_folder(path)?;
    write(path, bytes).map_err(|error| Error::Write {
        path: path.to_owned(),
        detail: error.to_string(),
    })
}

fn write(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".texrender-");
    #[cfg(unix)]
    {
        // As any new file: the user's mask takes from this what it wants.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder(path))?;
    file.write_all(bytes)?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}
