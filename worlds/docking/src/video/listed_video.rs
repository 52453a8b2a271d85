//! Fields of a video with an accompanying `telemetry.csv`, as written by `boresight render --format avi`.

use std::path::{Path, PathBuf};

use contract::Frame;
use contract::docking::{DockingSetup, Field, FieldTelemetry, Lines};
use files::{FileError, FileLocation};

use super::folder::camera_of;
use super::video_frame::{VideoFrame, take_rows};
use crate::rows::telemetry::FieldRow;

/// File names of a video with telemetry, in the order of the search.
const NAMES: [&str; 2] = ["fields.avi", "fields.y4m"];

/// Returns the video of a directory whose table names no images.
pub(super) fn video_of(directory: &Path, rows: &[(u64, FieldRow)]) -> Option<PathBuf> {
    let named = rows.iter().any(|(_, row)| row.file.is_some());
    NAMES.iter().map(|name| directory.join(name)).find(|path| !named && path.is_file())
}

/// Iterator over the fields of a video's frames, with the numbers, times, lenses and settings of the table:
/// two rows per frame, or one row if the table states that a field contains all lines.
pub(super) struct ListedVideo<F> {
    table: PathBuf,
    setup: DockingSetup,
    rows: std::vec::IntoIter<(u64, FieldRow)>,
    frames: F,
    /// Frame from which only one field has been taken.
    frame: Option<VideoFrame>,
}

impl<F: Iterator<Item = Result<VideoFrame, FileError>>> ListedVideo<F> {
    pub(super) fn new(
        table: PathBuf,
        rows: Vec<(u64, FieldRow)>,
        setup: &DockingSetup,
        frames: F,
    ) -> Result<Self, FileError> {
        for (line, row) in &rows {
            camera_of(&table, *line, row, setup)?;
        }
        Ok(Self { table, setup: setup.clone(), rows: rows.into_iter(), frames, frame: None })
    }

    fn field(&mut self, line: u64, row: &FieldRow) -> Result<(Field, FieldTelemetry), FileError> {
        let second = self.frame.take();
        let is_second = second.is_some();
        let frame = match second.map_or_else(|| self.frames.next(), |frame| Some(Ok(frame))) {
            Some(frame) => frame?,
            None => {
                let expected = "a field of the video, which ends before this row";
                return Err(FileError::value(
                    &self.table,
                    FileLocation::Line(line),
                    "field",
                    row.field,
                    expected,
                ));
            }
        };
        let camera = camera_of(&self.table, line, row, &self.setup)?;
        let (lines, depth) = (row.lines, self.setup.bit_depth);
        let wrong = |source| FileError::contract(&self.table, source);
        let dn = take_rows(&frame.dn, camera.columns, lines);
        let image = Frame::new(row.field, camera.columns, lines.rows(camera.rows), depth, dn, None);
        let field = Field::new(image.map_err(wrong)?, lines, camera.rows).map_err(wrong)?;
        self.frame = (lines != Lines::All && !is_second).then_some(frame);
        Ok((field, row.telemetry))
    }
}

impl<F: Iterator<Item = Result<VideoFrame, FileError>>> Iterator for ListedVideo<F> {
    type Item = Result<(Field, FieldTelemetry), FileError>;

    fn next(&mut self) -> Option<Self::Item> {
        if let Some((line, row)) = self.rows.next() {
            return Some(self.field(line, &row));
        }
        let more = self.frames.next()?;
        let unlisted = |frame: VideoFrame| {
            let expected = "a row for every field of the video";
            Err(FileError::value(
                &self.table,
                FileLocation::Header,
                "frame without a row",
                frame.index,
                expected,
            ))
        };
        Some(more.and_then(unlisted))
    }
}
