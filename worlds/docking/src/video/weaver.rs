//! Interleaving of fields to whole frames, for the video writers.

use std::path::{Path, PathBuf};

use contract::docking::{Field, Lines};
use files::{FileError, FileLocation};

use super::video_frame::weave;

/// Interleaves fields, which come in pairs of an even and an odd field in either order, to frames of 8 bits.
pub(super) struct Weaver {
    path: PathBuf,
    columns: usize,
    rows: usize,
    /// Rows that are still missing in the current frame.
    waits_for: Option<Lines>,
    frame: Vec<u8>,
}

impl Weaver {
    /// Creates a weaver for the file at `path`, with frames of `columns` × `rows`.
    pub(super) fn new(path: &Path, (columns, rows): (usize, usize)) -> Self {
        Self { path: path.to_owned(), columns, rows, waits_for: None, frame: vec![0; columns * rows] }
    }

    /// Adds a field to the current frame. Returns true if the frame is complete.
    ///
    /// # Errors
    /// [`FileError::Value`] for a field of another size, for a field that does not complete the frame of the
    /// previous one, and for a value above 255.
    pub(super) fn add(&mut self, field: &Field) -> Result<bool, FileError> {
        let number = field.number();
        let wrong = |what: &str, value: String, expected: &str| {
            Err(FileError::value(&self.path, FileLocation::Row(number), what, value, expected))
        };
        let size = (field.image().columns(), field.camera_rows());
        if size != (self.columns, self.rows) {
            let expected = format!("{} × {}, the size of the frames of the file", self.columns, self.rows);
            return wrong("size of a field's frame", format!("{} × {}", size.0, size.1), &expected);
        }
        match self.waits_for {
            Some(lines) if lines != field.lines() => {
                let expected = format!("{}, the other half of the previous field", lines.code());
                return wrong("lines of a field", field.lines().code().to_owned(), &expected);
            }
            _ => {}
        }
        if weave(field, &mut self.frame).is_none() {
            let most = field.image().dn().iter().copied().max().unwrap_or(0);
            return wrong("DN of a field", most.to_string(), "at most 255: video has 8 bits");
        }
        self.waits_for = match (field.lines(), self.waits_for) {
            (Lines::Even, None) => Some(Lines::Odd),
            (Lines::Odd, None) => Some(Lines::Even),
            _ => None,
        };
        Ok(self.waits_for.is_none())
    }

    /// Returns true if the current frame has only one field; the rows of the other then remain black.
    pub(super) fn rest(&mut self) -> bool {
        self.waits_for.take().is_some()
    }

    /// Returns the current frame, row by row from the top.
    pub(super) fn frame(&self) -> &[u8] {
        &self.frame
    }

    /// Begins the next frame, in black.
    pub(super) fn next(&mut self) {
        self.frame.fill(0);
    }
}
