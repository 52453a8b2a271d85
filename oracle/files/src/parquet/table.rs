//! Parquet tables of rows that belong to frames, written and read with memory independent of the table's
//! length.

use std::collections::VecDeque;
use std::fs::File;
use std::path::{Path, PathBuf};

use super::file::{Batches, ParquetFile};
use super::writer::{ParquetWriter, TableOptions};
use crate::error::FileLocation;
use crate::table::batch::Columns;
use crate::table::column::Column;
use crate::{AtomicFile, FileError};

/// Number of rows held before encoding, and read at a time.
const BATCH_ROWS: usize = 1024;
/// Number of rows in a row group, whose encoded bytes are held in memory before they are written.
const ROW_GROUP_ROWS: usize = 16_384;

/// A row of a table in Parquet format.
pub trait Row: Sized {
    /// Returns the columns of some rows, with units in their names. Names and types are the same for any
    /// number of rows, including zero.
    fn columns(rows: &[Self]) -> Vec<Column>;

    /// Returns the rows of a batch with those columns.
    ///
    /// # Errors
    /// [`FileError::Value`] for an invalid cell.
    fn rows(columns: &Columns<'_>) -> Result<Vec<Self>, FileError>;

    /// Returns the number of the frame or field to which the row belongs.
    fn frame(&self) -> u64;

    /// Name of the column with the number of the frame or field.
    const FRAME: &'static str = "frame";
}

/// Writer of a table in row groups, with memory independent of the table's length. The file gets its name
/// when it is complete.
pub struct TableWriter<R> {
    file: AtomicFile,
    writer: ParquetWriter<File>,
    waiting: Vec<R>,
}

impl<R: Row> TableWriter<R> {
    /// Creates the table.
    ///
    /// # Errors
    /// [`FileError::OutputTaken`] if the file exists; [`FileError::Io`] if it cannot be created.
    pub fn create(path: &Path) -> Result<Self, FileError> {
        let options = TableOptions { row_group_rows: ROW_GROUP_ROWS, ..TableOptions::default() };
        let file = AtomicFile::create_new(path)?;
        let out = file.file().try_clone().map_err(|source| FileError::io(path, "create", source))?;
        let writer = ParquetWriter::new(out, path, &R::columns(&[]), options)?;
        Ok(Self { file, writer, waiting: Vec::new() })
    }

    /// Adds rows. Frame numbers must ascend, because readers rely on it.
    ///
    /// # Errors
    /// [`FileError::Io`], [`FileError::Format`].
    pub fn write(&mut self, rows: impl IntoIterator<Item = R>) -> Result<(), FileError> {
        self.waiting.extend(rows);
        if self.waiting.len() >= BATCH_ROWS { self.encode() } else { Ok(()) }
    }

    /// Completes the file and gives it its name. Without this call no file remains.
    ///
    /// # Errors
    /// [`FileError::Io`], [`FileError::Format`].
    pub fn finish(mut self) -> Result<(), FileError> {
        self.encode()?;
        self.writer.finish()?;
        self.file.commit_new()
    }

    fn encode(&mut self) -> Result<(), FileError> {
        let columns = R::columns(&self.waiting);
        self.waiting.clear();
        self.writer.write(&columns)
    }
}

/// Reader of a table, frame by frame: an iterator over (frame number, rows of the frame), with ascending
/// frame numbers. It holds one batch in memory.
///
/// The iterator omits frames without rows; [`TableReader::rows_of`] returns no rows for them.
pub struct TableReader<R> {
    path: PathBuf,
    batches: Batches,
    rows_read: u64,
    waiting: VecDeque<R>,
    last_frame: Option<u64>,
    failed: bool,
}

impl<R: Row> TableReader<R> {
    /// Opens a table and checks that it contains every column with the right type. Other columns are ignored.
    ///
    /// # Errors
    /// [`FileError::Io`]; [`FileError::Format`] for a file that is not Parquet or is truncated;
    /// [`FileError::MissingColumn`]; [`FileError::Value`] for a column of another type.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let file = ParquetFile::open(path)?;
        let expected = R::columns(&[]);
        check_columns(path, &file, &expected)?;
        let names: Vec<&str> = expected.iter().map(Column::name).collect();
        let batches = file.batches(&names, BATCH_ROWS)?;
        Ok(Self {
            path: path.to_owned(),
            batches,
            rows_read: 0,
            waiting: VecDeque::new(),
            last_frame: None,
            failed: false,
        })
    }

    /// Returns the rows of one frame, which may be none. Earlier frames are skipped, so the frame numbers of
    /// successive calls must ascend.
    ///
    /// # Errors
    /// Those of the iterator.
    pub fn rows_of(&mut self, frame: u64) -> Result<Vec<R>, FileError> {
        while let Some(next) = self.peek_frame()? {
            match next.cmp(&frame) {
                std::cmp::Ordering::Less => {
                    self.take_frame(next)?;
                }
                std::cmp::Ordering::Equal => return self.take_frame(frame),
                std::cmp::Ordering::Greater => break,
            }
        }
        Ok(Vec::new())
    }

    /// Returns the frame number of the next row.
    fn peek_frame(&mut self) -> Result<Option<u64>, FileError> {
        while self.waiting.is_empty() {
            let Some(batch) = self.batches.next().transpose()? else { return Ok(None) };
            let columns = Columns::new(&self.path, &batch, self.rows_read);
            let rows = R::rows(&columns)?;
            for (i, row) in rows.iter().enumerate() {
                let frame = row.frame();
                if let Some(last) = self.last_frame.filter(|&last| frame < last) {
                    let expected = format!("{last} or more, because rows are ordered by frame");
                    return Err(columns.error(i, R::FRAME, frame, expected));
                }
                self.last_frame = Some(frame);
            }
            self.rows_read += rows.len() as u64;
            self.waiting = rows.into();
        }
        Ok(self.waiting.front().map(Row::frame))
    }

    fn take_frame(&mut self, frame: u64) -> Result<Vec<R>, FileError> {
        let mut rows = Vec::new();
        while self.peek_frame()? == Some(frame) {
            rows.extend(self.waiting.pop_front());
        }
        Ok(rows)
    }
}

impl<R: Row> Iterator for TableReader<R> {
    type Item = Result<(u64, Vec<R>), FileError>;

    /// The iterator ends after an error.
    fn next(&mut self) -> Option<Self::Item> {
        if self.failed {
            return None;
        }
        let frame = match self.peek_frame() {
            Ok(None) => return None,
            Ok(Some(frame)) => self.take_frame(frame).map(|rows| (frame, rows)),
            Err(error) => Err(error),
        };
        self.failed = frame.is_err();
        Some(frame)
    }
}

fn check_columns(path: &Path, file: &ParquetFile, expected: &[Column]) -> Result<(), FileError> {
    for column in expected {
        let Some(found) = file.column(column.name()) else {
            let names = file.columns().iter().map(|found| format!("`{}`", found.name));
            return Err(FileError::MissingColumn {
                path: path.to_owned(),
                column: column.name().to_owned(),
                found: names.collect::<Vec<_>>().join(", "),
            });
        };
        let wanted = column.values().column_type();
        let other = match &found.column_type {
            Ok(found) if *found == wanted => continue,
            Ok(found) => found.to_string(),
            Err(name) => name.clone(),
        };
        let wanted = format!("type {wanted}");
        return Err(FileError::value(path, FileLocation::Header, column.name(), other, wanted));
    }
    Ok(())
}
