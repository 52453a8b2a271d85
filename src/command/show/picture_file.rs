//! The file of a picture: where it goes, and what it may replace.
use std::fs;
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use files::{Failure, FileError, WholeFile};
use show::is_own_picture;

/// Folder of pictures in a run directory. Not beside the images of a dataset: every image there must have a row in `telemetry.csv`.
const FOLDER: &str = "show";
/// Bytes in which a picture of ours names its program.
const HEADER_BYTES: u64 = 1 << 16;

/// A file that may be written.
pub(super) struct PictureFile {
    path: PathBuf,
    /// Whether its folder is made when it is missing.
    is_default: bool,
}

impl PictureFile {
    /// The file of `--out`, or without it that of some frames in the directory.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a name that is not of a PNG, and for a file that is not an earlier picture of `boresight show`.
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
        check_replaceable(&path)?;
        Ok(Self { path, is_default: out.is_none() })
    }

    /// Writes the file, at once or not at all.
    ///
    /// # Errors
    /// [`FileError::Io`] when it cannot be written.
    pub(super) fn write(self, bytes: &[u8]) -> Result<PathBuf, Failure> {
        let Self { path, is_default } = self;
        if let Some(folder) = path.parent().filter(|_| is_default)
            && let Err(source) = fs::create_dir(folder)
            && source.kind() != ErrorKind::AlreadyExists
        {
            return Err(FileError::Io { path: folder.to_owned(), doing: "create", source }.into());
        }
        let file = WholeFile::create(&path)?;
        file.file().write_all(bytes).map_err(|source| FileError::Io {
            path: path.clone(),
            doing: "write",
            source,
        })?;
        // It may have come while the picture was drawn.
        check_replaceable(&path)?;
        file.replace()?;
        Ok(path)
    }
}

/// Refuses a path where something else is than an earlier picture of this command.
fn check_replaceable(path: &Path) -> Result<(), Failure> {
    let refused = |what: &str| {
        Err(Failure::Usage(format!(
            "{} {what}, expected a free name or that of an earlier picture of `boresight show` (--out FILE.png)",
            path.display()
        )))
    };
    let error = |source| FileError::Io { path: path.to_owned(), doing: "open", source };
    match path.symlink_metadata() {
        // Of a folder that is missing or no folder, the writer tells.
        Err(source) if matches!(source.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Ok(()),
        Err(source) => Err(error(source).into()),
        Ok(metadata) if !metadata.is_file() => refused("exists and is not a regular file"),
        Ok(_) => {
            let mut bytes = Vec::new();
            let file = sim::regular_file::open(path).map_err(error)?;
            file.take(HEADER_BYTES).read_to_end(&mut bytes).map_err(error)?;
            if is_own_picture(&bytes) { Ok(()) } else { refused("exists and is another file") }
        }
    }
}
