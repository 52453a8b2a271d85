//! Parquet tables of rows that belong to frames, written and read in memory that does not grow with the table.

use std::collections::VecDeque;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow_array::{Array, ArrayRef, Float64Array, RecordBatch, StringArray, UInt32Array, UInt64Array};
use arrow_schema::{Field, Schema};
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::file::properties::WriterProperties;

use super::error::Place;
use super::parquet_file::{Batches, ParquetFile, damaged};
use super::{FileError, WholeFile};

/// Rows held before they are encoded, and read at a time.
const BATCH_ROWS: usize = 8192;
/// Rows whose encoded bytes are held before they are written.
const ROW_GROUP_ROWS: usize = 131_072;

/// One column of a table.
#[derive(Debug)]
pub struct Column {
    name: &'static str,
    nullable: bool,
    repeats: bool,
    pub(super) values: ArrayRef,
}

impl Column {
    /// A column in which every row has a value.
    pub fn new(name: &'static str, values: impl Array + 'static) -> Self {
        Self { name, nullable: false, repeats: true, values: Arc::new(values) }
    }

    /// A column in which rows may have no value.
    pub fn nullable(name: &'static str, values: impl Array + 'static) -> Self {
        Self { nullable: true, ..Self::new(name, values) }
    }

    /// The same column, of values that seldom repeat: it is written without a dictionary, which would only be in the way.
    pub fn seldom_repeating(self) -> Self {
        Self { repeats: false, ..self }
    }
}

/// A row of a table that is kept as Parquet.
pub trait Row: Sized {
    /// The columns of some rows, units in their names. Always the same names and types, for no rows as well.
    fn columns(rows: &[Self]) -> Vec<Column>;

    /// The rows of a batch that has those columns.
    ///
    /// # Errors
    /// [`FileError::Value`] for a cell that is not as it should be.
    fn rows(columns: &Columns<'_>) -> Result<Vec<Self>, FileError>;

    /// The frame, or the field, that the row belongs to.
    fn frame(&self) -> u64;

    /// The column that holds it.
    const FRAME: &'static str = "frame";
}

/// Writes a table, in row groups as it goes: memory stays the same however long the table. The file has its name when it is complete.
pub struct TableWriter<R> {
    path: PathBuf,
    file: WholeFile,
    writer: ArrowWriter<File>,
    schema: Arc<Schema>,
    waiting: Vec<R>,
}

impl<R: Row> TableWriter<R> {
    /// Creates the table.
    ///
    /// # Errors
    /// [`FileError::Io`] when the file exists or cannot be created.
    pub fn create(path: &Path) -> Result<Self, FileError> {
        let columns = R::columns(&[]);
        let schema = Arc::new(schema(&columns));
        // Dictionaries, on by default, take the columns that repeat: frame, kind, a star's number and magnitude.
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_max_row_group_row_count(Some(ROW_GROUP_ROWS));
        let properties =
            columns.iter().filter(|column| !column.repeats).fold(properties, |properties, column| {
                properties.set_column_dictionary_enabled(column.name.into(), false)
            });
        let file = WholeFile::create_new(path)?;
        let out = file.file().try_clone().map_err(|source| FileError::io(path, "create", source))?;
        let writer = ArrowWriter::try_new(out, Arc::clone(&schema), Some(properties.build()))
            .map_err(|error| unwritten(path, error))?;
        Ok(Self { path: path.to_owned(), file, writer, schema, waiting: Vec::new() })
    }

    /// Adds rows. Frames must come in ascending order; a reader relies on it.
    ///
    /// # Errors
    /// [`FileError::Io`], [`FileError::Format`].
    pub fn write(&mut self, rows: impl IntoIterator<Item = R>) -> Result<(), FileError> {
        self.waiting.extend(rows);
        if self.waiting.len() >= BATCH_ROWS { self.encode() } else { Ok(()) }
    }

    /// Completes the file. Without it there is none.
    ///
    /// # Errors
    /// [`FileError::Io`], [`FileError::Format`].
    pub fn finish(mut self) -> Result<(), FileError> {
        self.encode()?;
        self.writer.close().map_err(|error| unwritten(&self.path, error))?;
        self.file.commit_new()
    }

    fn encode(&mut self) -> Result<(), FileError> {
        let arrays = R::columns(&self.waiting).into_iter().map(|column| column.values).collect();
        self.waiting.clear();
        let batch = RecordBatch::try_new(Arc::clone(&self.schema), arrays)
            .map_err(|error| damaged(&self.path, error))?;
        self.writer.write(&batch).map_err(|error| unwritten(&self.path, error))
    }
}

pub(super) fn schema(columns: &[Column]) -> Schema {
    let field = |c: &Column| Field::new(c.name, c.values.data_type().clone(), c.nullable);
    Schema::new(columns.iter().map(field).collect::<Vec<_>>())
}

/// Reads a table, frame by frame: an iterator over (number of the frame, its rows), frames ascending, in memory
/// that holds one batch.
///
/// A frame without rows is not met; [`TableReader::rows_of`] answers it with none.
pub struct TableReader<R> {
    path: PathBuf,
    batches: Batches,
    rows_read: u64,
    waiting: VecDeque<R>,
    last_frame: Option<u64>,
    failed: bool,
}

impl<R: Row> TableReader<R> {
    /// Opens a table and checks that it has every column, of the right type. Other columns are ignored.
    ///
    /// # Errors
    /// [`FileError::Io`]; [`FileError::Format`] for a file that is not Parquet or is cut short;
    /// [`FileError::MissingColumn`]; [`FileError::Value`] for a column of another type.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let file = ParquetFile::open(path)?;
        let expected = schema(&R::columns(&[]));
        check_schema(path, file.schema(), &expected)?;
        let names: Vec<&str> = expected.fields().iter().map(|field| field.name().as_str()).collect();
        let batches = file.batches(Some(&names), BATCH_ROWS)?;
        Ok(Self {
            path: path.to_owned(),
            batches,
            rows_read: 0,
            waiting: VecDeque::new(),
            last_frame: None,
            failed: false,
        })
    }

    /// The rows of one frame, none if it has none. Frames before it are passed over, so calls must ascend.
    ///
    /// # Errors
    /// As the iterator.
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

    /// The frame of the next row.
    fn peek_frame(&mut self) -> Result<Option<u64>, FileError> {
        while self.waiting.is_empty() {
            let Some(batch) = self.batches.next().transpose()? else { return Ok(None) };
            let columns = Columns { path: &self.path, batch: &batch, first_row: self.rows_read };
            let rows = R::rows(&columns)?;
            for (i, row) in rows.iter().enumerate() {
                let frame = row.frame();
                if let Some(last) = self.last_frame.filter(|&last| frame < last) {
                    let expected = format!("{last} or more, as rows are ordered by frame");
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

    /// After an error there is nothing more.
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

fn check_schema(path: &Path, found: &Schema, expected: &Schema) -> Result<(), FileError> {
    for field in expected.fields() {
        let Ok(index) = found.index_of(field.name()) else {
            let found =
                found.fields().iter().map(|f| format!("`{}`", f.name())).collect::<Vec<_>>().join(", ");
            return Err(FileError::MissingColumn {
                path: path.to_owned(),
                column: field.name().clone(),
                found,
            });
        };
        let (got, wanted) = (found.field(index).data_type(), field.data_type());
        if got != wanted {
            return Err(FileError::value(path, Place::Header, field.name(), got, format!("type {wanted}")));
        }
    }
    Ok(())
}

/// The columns of a batch, by name.
pub struct Columns<'a> {
    path: &'a Path,
    batch: &'a RecordBatch,
    first_row: u64,
}

impl Columns<'_> {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.batch.num_rows()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The error of a cell, `row` counted within the batch.
    pub fn error(
        &self,
        row: usize,
        column: &str,
        value: impl ToString,
        expected: impl Into<String>,
    ) -> FileError {
        FileError::value(self.path, Place::Row(self.first_row + row as u64), column, value, expected)
    }

    /// A column of finite numbers.
    ///
    /// # Errors
    /// [`FileError::Value`] for the first null, NaN or infinity.
    pub fn f64(&self, name: &str) -> Result<&[f64], FileError> {
        let array: &Float64Array = self.every(name)?;
        self.check_finite(name, array)?;
        Ok(array.values())
    }

    /// A column of finite numbers or nothing.
    ///
    /// # Errors
    /// [`FileError::Value`] for the first NaN or infinity.
    pub fn optional_f64(&self, name: &str) -> Result<&Float64Array, FileError> {
        let array = self.array(name)?;
        self.check_finite(name, array)?;
        Ok(array)
    }

    /// A column of 64-bit counts.
    ///
    /// # Errors
    /// [`FileError::Value`] for the first null.
    pub fn u64(&self, name: &str) -> Result<&[u64], FileError> {
        self.every::<UInt64Array>(name).map(|array| &array.values()[..])
    }

    /// A column of 32-bit counts.
    ///
    /// # Errors
    /// [`FileError::Value`] for the first null.
    pub fn u32(&self, name: &str) -> Result<&[u32], FileError> {
        self.every::<UInt32Array>(name).map(|array| &array.values()[..])
    }

    /// A column of texts.
    ///
    /// # Errors
    /// [`FileError::Value`] for the first null.
    pub fn text(&self, name: &str) -> Result<&StringArray, FileError> {
        self.every(name)
    }

    /// The word of a column at a row, read by `parse`.
    ///
    /// # Errors
    /// [`FileError::Value`] for a null or a word that `parse` does not know.
    pub fn word<T>(&self, name: &str, row: usize, parse: impl Fn(&str) -> Option<T>) -> Result<T, FileError> {
        let word = self.text(name)?.value(row);
        parse(word).ok_or_else(|| self.error(row, name, word, "one of the words of this column"))
    }

    /// A column without nulls.
    pub(super) fn every<A: Array + 'static>(&self, name: &str) -> Result<&A, FileError> {
        let array = self.array::<A>(name)?;
        // Counted when it was read: words are asked for row by row.
        if array.null_count() == 0 {
            return Ok(array);
        }
        match (0..array.len()).find(|&row| array.is_null(row)) {
            Some(row) => Err(self.error(row, name, "null", "a value in every row")),
            None => Ok(array),
        }
    }

    /// A column of a type.
    pub(super) fn array<A: Array + 'static>(&self, name: &str) -> Result<&A, FileError> {
        // The schema was checked when the file was opened; a batch of another one is a damaged file.
        self.batch
            .column_by_name(name)
            .and_then(|array| array.as_any().downcast_ref())
            .ok_or_else(|| FileError::format(self.path, "Parquet", format!("column `{name}` is damaged")))
    }

    fn check_finite(&self, name: &str, array: &Float64Array) -> Result<(), FileError> {
        match array.iter().position(|value| value.is_some_and(|value| !value.is_finite())) {
            Some(row) => Err(self.error(row, name, array.value(row), "a finite number")),
            None => Ok(()),
        }
    }
}

/// The error of a table that cannot be written: that of the operating system, where it is one.
pub(crate) fn unwritten(path: &Path, error: parquet::errors::ParquetError) -> FileError {
    match error {
        parquet::errors::ParquetError::External(source) => match source.downcast::<std::io::Error>() {
            Ok(source) => FileError::io(path, "write", *source),
            Err(source) => damaged(path, source),
        },
        other => damaged(path, other),
    }
}
