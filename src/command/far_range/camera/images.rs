//! Folders of images.

use std::path::{Path, PathBuf};

use camera_fit::SkyFrame;
use files::{Failure, FileError, read_grey_image};

use crate::command::output::Output;

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

/// Reads images, with a warning about JPEG.
pub(super) fn read_frames(paths: &[PathBuf], output: &Output) -> Result<Vec<SkyFrame>, Failure> {
    let progress = output.progress_of(paths.len() as u64, "images", "reading");
    let mut frames = Vec::with_capacity(paths.len());
    for path in paths {
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        frames.push(SkyFrame { name, image: read_grey_image(path)? });
        progress.inc(1);
    }
    progress.finish_and_clear();
    if paths.iter().any(|path| has_extension(path, &["jpg", "jpeg"])) {
        output.note("warning: JPEG changes faint stars and widths; raw images give a better camera");
    }
    Ok(frames)
}
