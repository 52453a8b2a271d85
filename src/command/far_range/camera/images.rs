//! Folders of images.

use std::path::{Path, PathBuf};

use files::{Failure, FileError};

/// Extensions of image files.
const EXTENSIONS: [&str; 9] = ["fits", "fit", "fts", "png", "tif", "tiff", "exr", "jpg", "jpeg"];

/// Largest number of frames of a fit: the normal equations grow with the square.
const MAX_FRAMES: usize = 200;

/// Returns the image files of a directory, in order of their names.
pub(super) fn images(directory: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries = std::fs::read_dir(directory).map_err(|source| FileError::Io {
        path: directory.to_owned(),
        doing: "open",
        source,
    })?;
    let mut paths: Vec<PathBuf> = Vec::new();
    for entry in entries {
        let entry = entry.map_err(|source| FileError::io(directory, "read", source))?;
        let is_hidden = entry.file_name().to_string_lossy().starts_with('.');
        if !is_hidden && has_extension(&entry.path(), &EXTENSIONS) && entry.path().is_file() {
            paths.push(entry.path());
        }
    }
    paths.sort();
    if paths.is_empty() || paths.len() > MAX_FRAMES {
        return Err(Failure::Usage(format!(
            "{}: {} images in it ({}), expected 1 to {MAX_FRAMES}",
            directory.display(),
            paths.len(),
            EXTENSIONS.join(", ")
        )));
    }
    Ok(paths)
}

pub(super) fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    extension.is_some_and(|extension| extensions.contains(&extension.as_str()))
}
