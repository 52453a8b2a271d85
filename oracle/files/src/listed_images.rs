//! Images that a table of a dataset names.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use crate::FileError;
use crate::error::FileLocation;

/// Returns the path of one image that a table names, independently of the other images; messages call it
/// `field`.
pub fn locate_alone(directory: &Path, file: &str, field: &str) -> Result<PathBuf, FileError> {
    let root = directory.canonicalize().map_err(|source| FileError::io(directory, "open", source))?;
    locate_image(directory, &root, Some(file)).map_err(|reason| {
        let expected = format!("an image in the dataset's directory; this path is {reason}");
        FileError::value(&directory.join("telemetry.csv"), FileLocation::Whole, field, file, expected)
    })
}

/// Rejects an image that belongs to two frames or fields (`what` is the name in messages), each identified by
/// its number.
pub fn refuse_twice<'a>(
    table: &Path,
    what: &str,
    images: impl Iterator<Item = (u64, &'a Path)>,
) -> Result<(), FileError> {
    let mut known = BTreeMap::new();
    for (number, path) in images {
        let identity = identity(path).map_err(|source| FileError::io(path, "open", source))?;
        if let Some(other) = known.insert(identity, number) {
            let field = format!("file of {what} {number}");
            let expected = format!("a separate image; {what} {other} has the same image");
            return Err(FileError::value(table, FileLocation::Whole, field, path.display(), expected));
        }
    }
    Ok(())
}

/// Returns what identifies a file under all its names, hard links included: its device and number.
#[cfg(unix)]
fn identity(path: &Path) -> std::io::Result<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    path.metadata().map(|metadata| (metadata.dev(), metadata.ino()))
}

/// Returns what identifies a file under all its names but hard links: its path without links.
#[cfg(not(unix))]
fn identity(path: &Path) -> std::io::Result<PathBuf> {
    path.canonicalize()
}

/// Returns the path of an image that a table row names, or the reason why it is invalid.
pub fn locate_image(directory: &Path, root: &Path, file: Option<&str>) -> Result<PathBuf, &'static str> {
    let file = Path::new(file.ok_or("not named")?);
    if !file.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
        return Err("outside the dataset's directory");
    }
    let path = directory.join(file);
    match path.canonicalize() {
        Err(_) => Err("missing"),
        Ok(real) if !real.starts_with(root) => Err("outside the dataset's directory"),
        Ok(real) if !real.is_file() => Err("not a file"),
        Ok(_) => Ok(path),
    }
}
