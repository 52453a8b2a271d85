//! Sequential byte input from a file or a pipe, with the current position.

use std::io::{self, BufReader, ErrorKind, Read};
use std::path::{Path, PathBuf};

use files::{FileError, open_regular};

/// A source of bytes that is read once, from front to back.
pub(super) struct Input {
    path: PathBuf,
    bytes: Box<dyn Read + Send>,
    position: u64,
}

impl Input {
    pub(super) fn file(path: &Path) -> Result<Self, FileError> {
        let file = open_regular(path)?;
        Ok(Self::new(path, BufReader::with_capacity(1 << 16, file)))
    }

    pub(super) fn standard_input() -> Self {
        // Standard input is buffered and returns the bytes that have arrived: a frame is available as soon as
        // its last byte is.
        Self::new(Path::new("standard input"), io::stdin())
    }

    pub(super) fn new(path: &Path, bytes: impl Read + Send + 'static) -> Self {
        Self { path: path.to_owned(), bytes: Box::new(bytes), position: 0 }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the number of bytes read so far.
    pub(super) fn position(&self) -> u64 {
        self.position
    }

    /// Fills the buffer as far as bytes are available, and returns their number.
    pub(super) fn fill(&mut self, buffer: &mut [u8]) -> Result<usize, FileError> {
        let mut filled = 0;
        while let Some(rest) = buffer.get_mut(filled..).filter(|rest| !rest.is_empty()) {
            match self.bytes.read(rest) {
                Ok(0) => break,
                Ok(n) => filled += n,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(source) => return Err(FileError::io(&self.path, "read", source)),
            }
        }
        self.position += filled as u64;
        Ok(filled)
    }

    /// Skips bytes, and returns the number actually skipped.
    pub(super) fn skip(&mut self, bytes: u64) -> Result<u64, FileError> {
        let skipped = io::copy(&mut self.bytes.by_ref().take(bytes), &mut io::sink())
            .map_err(|source| FileError::io(&self.path, "read", source))?;
        self.position += skipped;
        Ok(skipped)
    }

    /// Creates the error of bytes that do not have the format.
    pub(super) fn error(&self, format: &'static str, reason: impl ToString) -> FileError {
        FileError::format(&self.path, format, reason)
    }
}
