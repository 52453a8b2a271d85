//! JSON file that is written entry by entry and appears when it is complete: its size may exceed the memory.

use std::io::Write;
use std::path::{Path, PathBuf};

use files::{AtomicFile, FileError};

/// JSON list or map under construction.
pub(crate) struct JsonFile {
    file: AtomicFile,
    path: PathBuf,
    has_entries: bool,
}

impl JsonFile {
    /// Creates the file, which begins with `opening`.
    ///
    /// # Errors
    /// [`FileError::OutputTaken`] if it exists; [`FileError::Io`].
    pub(crate) fn create(path: &Path, opening: &str) -> Result<Self, FileError> {
        let mut file =
            Self { file: AtomicFile::create_new(path)?, path: path.to_owned(), has_entries: false };
        file.write(opening)?;
        Ok(file)
    }

    /// Adds an entry of the list, or `"key": value` of the map.
    ///
    /// # Errors
    /// [`FileError::Io`].
    pub(crate) fn entry(&mut self, text: &str) -> Result<(), FileError> {
        let separator = if self.has_entries { ",\n" } else { "\n" };
        self.has_entries = true;
        self.write(&format!("{separator}{text}"))
    }

    /// Ends the file with `closing` and gives it its name.
    ///
    /// # Errors
    /// [`FileError::OutputTaken`] if a file of that name has appeared in the meantime; [`FileError::Io`].
    pub(crate) fn finish(mut self, closing: &str) -> Result<(), FileError> {
        self.write(&format!("\n{closing}\n"))?;
        self.file.commit_new()
    }

    fn write(&mut self, text: &str) -> Result<(), FileError> {
        let mut file = self.file.file();
        file.write_all(text.as_bytes()).map_err(|source| FileError::io(&self.path, "write", source))
    }
}
