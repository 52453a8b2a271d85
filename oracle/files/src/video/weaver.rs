//! Fields into whole frames, for the writers of video.

use std::path::{Path, PathBuf};

use contract::docking::{Field, Lines};

use super::video_frame::weave;
use crate::FileError;
use crate::error::FileLocation;

/// Weaves fields, which come in pairs of an even and an odd one in either order, into frames of 8 bits.
pub(super) struct Weaver {
    path: PathBuf,
    columns: usize,
    rows: usize,
    /// Rows that the frame in hand still waits for.
    waits_for: Option<Lines>,
    frame: Vec<u8>,
}

impl Weaver {
    /// For the file at `path`, with frames of `columns` × `rows`.
    pub(super) fn new(path: &Path, (columns, rows): (usize, usize)) -> Self {
        Self { path: path.to_owned(), columns, rows, waits_for: None, frame: vec![0; columns * rows] }
    }

    /// Takes a field; whether the frame is complete.
    ///
    /// # Errors
    /// [`FileError::Value`] for a field of another size, for one that is not the other half of the one before, and for
    /// a value above 255.
    pub(super) fn add(&mut self, field: &Field) -> Result<bool, FileError> {
        let number = field.number();
        let wrong = |what: &str, value: String, expected: &str| {
            Err(FileError::value(&self.path, FileLocation::Row(number), what, value, expected))
        };
        let size = (field.image().columns(), field.camera_rows());
        if size != (self.columns, self.rows) {
            let expected = format!("{} × {}, those of the file", self.columns, self.rows);
            return wrong("size of a field's frame", format!("{} × {}", size.0, size.1), &expected);
        }
        match self.waits_for {
            Some(lines) if lines != field.lines() => {
                let expected = format!("{}, the other half of the field before", lines.code());
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

    /// Whether a field waits for its other half, which from now on is taken to stay black.
    pub(super) fn rest(&mut self) -> bool {
        self.waits_for.take().is_some()
    }

    /// The frame in hand, row by row from the top.
    pub(super) fn frame(&self) -> &[u8] {
        &self.frame
    }

    /// Begins the next frame, black.
    pub(super) fn next(&mut self) {
        self.frame.fill(0);
    }
}
