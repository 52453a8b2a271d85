//! File of a picture: its path, and the files that it may replace.
use std::fs;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use files::{AtomicFile, Failure, FileError, ReplaceableFile};
use show::is_boresight_picture;

/// Directory of pictures in a run directory. The images of a dataset are kept separate, because each of them
/// must have a row in `telemetry.csv`.
const FOLDER: &str = "show";
/// Files that a picture may replace.
const PICTURES: ReplaceableFile<'static> = ReplaceableFile {
    description: "an earlier picture of `boresight show` (--out FILE.png)",
    matches: &is_boresight_picture,
};

/// A file that may be written.
pub(super) struct PictureFile {
    path: PathBuf,
    /// True if the directory of the file is created when it is missing.
    is_default: bool,
}

impl PictureFile {
    /// Returns the file of `--out` or, without it, the file in `directory` named by the frames.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a name without the extension of PNG, and for an existing file that is not an
    /// earlier picture of `boresight show`.
    pub(super) fn new(out: Option<&Path>, directory: &Path, frames: &[u64]) -> Result<Self, Failure> {
        let names: Vec<String> = frames.iter().map(|frame| format!("{frame:06}")).collect();
        let default = || directory.join(FOLDER).join(format!("{}.png", names.join("-")));
        let path = out.map_or_else(default, Path::to_path_buf);
        if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
            return Err(Failure::Usage(format!(
                "--out is {}, expected a file name that ends in .png",
                path.display()
            )));
        }
        PICTURES.check(&path)?;
        Ok(Self { path, is_default: out.is_none() })
    }

    /// Writes the file atomically.
    ///
    /// # Errors
    /// [`FileError::Io`] if the file cannot be written.
    pub(super) fn write(self, bytes: &[u8]) -> Result<PathBuf, Failure> {
        let Self { path, is_default } = self;
        if let Some(folder) = path.parent().filter(|_| is_default)
            && let Err(source) = fs::create_dir(folder)
            && source.kind() != ErrorKind::AlreadyExists
        {
            return Err(FileError::Io { path: folder.to_owned(), doing: "create", source }.into());
        }
        let file = AtomicFile::create(&path)?;
        file.file().write_all(bytes).map_err(|source| FileError::Io {
            path: path.clone(),
            doing: "write",
            source,
        })?;
        file.replace(PICTURES)?;
        Ok(path)
    }
}
