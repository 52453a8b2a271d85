//! Findings of a check of a file.

use std::path::Path;

use files::{FileError, FileLocation};

/// Findings of a check that does not stop at the first one.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    /// The first error in the order of the file.
    pub(crate) error: Option<FileError>,
    /// Remarks, each with its file and line.
    pub(crate) remarks: Vec<String>,
}

impl Findings {
    /// Returns the remarks.
    ///
    /// # Errors
    /// The error of the findings.
    pub(crate) fn into_result(self) -> Result<Vec<String>, FileError> {
        match self.error {
            Some(error) => Err(error),
            None => Ok(self.remarks),
        }
    }

    pub(super) fn refuse(&mut self, error: FileError) {
        self.error.get_or_insert(error);
    }

    pub(super) fn remark(&mut self, path: &Path, line: Option<u64>, text: &str) {
        let place = place(line);
        self.remarks.push(format!("{}{place}: {text}", path.display()));
    }
}

/// Returns the location of a record; the whole file for one without lines.
pub(super) fn place(line: Option<u64>) -> FileLocation {
    line.map_or(FileLocation::Whole, FileLocation::Line)
}
