//! A Parquet file that is read: opened by one way, so that no reader forgets a check.

use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use arrow_array::RecordBatch;
use arrow_schema::SchemaRef;
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::{ParquetRecordBatchReader, ParquetRecordBatchReaderBuilder};

use super::FileError;
use super::error::open_regular;
use super::parquet_claims::{check_claims, check_footer};

/// A Parquet file whose claims were held against its length. Nothing but its headers is read yet.
pub(crate) struct ParquetFile {
    path: PathBuf,
    builder: ParquetRecordBatchReaderBuilder<File>,
}

impl ParquetFile {
    /// Opens a file.
    ///
    /// # Errors
    /// [`FileError::Io`]; [`FileError::Format`] for a file that is not Parquet, is cut short, claims more than it can hold, or has
    /// nested columns.
    pub(crate) fn open(path: &Path) -> Result<Self, FileError> {
        let mut file = open_regular(path)?;
        let length = file.metadata().map_err(|source| FileError::io(path, "read", source))?.len();
        check_footer(path, &mut file, length)?;
        let opened = file.try_clone().map_err(|source| FileError::io(path, "open", source))?;
        let builder =
            guarded(path, || ParquetRecordBatchReaderBuilder::try_new(opened).map_err(|e| damaged(path, e)))?;
        check_claims(path, &mut file, length, builder.metadata())?;
        Ok(Self { path: path.to_owned(), builder })
    }

    /// The columns.
    pub(crate) fn schema(&self) -> &SchemaRef {
        self.builder.schema()
    }

    /// What the writer said beside the columns.
    pub(crate) fn notes(&self) -> impl Iterator<Item = (&str, &str)> {
        let pairs = self.builder.metadata().file_metadata().key_value_metadata();
        pairs.into_iter().flatten().filter_map(|pair| Some((pair.key.as_str(), pair.value.as_deref()?)))
    }

    /// The rows, so many at a time; of the columns that are named, or of all.
    ///
    /// # Errors
    /// [`FileError::Format`] for a file that is damaged.
    pub(crate) fn batches(self, columns: Option<&[&str]>, rows: usize) -> Result<Batches, FileError> {
        let Self { path, builder } = self;
        let claimed = u64::try_from(builder.metadata().file_metadata().num_rows()).unwrap_or(0);
        let reader = guarded(&path, || {
            let builder = match columns {
                Some(names) => {
                    let mask = ProjectionMask::columns(builder.parquet_schema(), names.iter().copied());
                    builder.with_projection(mask)
                }
                None => builder,
            };
            builder.with_batch_size(rows).build().map_err(|error| damaged(&path, error))
        })?;
        Ok(Batches { path, reader, rows_left: claimed, failed: false })
    }
}

/// The rows of a file, batch by batch. After an error there is nothing more.
pub(crate) struct Batches {
    path: PathBuf,
    reader: ParquetRecordBatchReader,
    /// Rows that the footer claims and that have not come yet.
    rows_left: u64,
    failed: bool,
}

impl Batches {
    fn next_batch(&mut self) -> Result<Option<RecordBatch>, FileError> {
        let next = || self.reader.next().transpose().map_err(|error| damaged(&self.path, error));
        let Some(batch) = guarded(&self.path, next)? else { return Ok(None) };
        match self.rows_left.checked_sub(batch.num_rows() as u64) {
            Some(left) => self.rows_left = left,
            // Pages may hold more than their footer says, and without end: a run of equal values is a few bytes.
            None => return Err(damaged(&self.path, "it has more rows than its footer says")),
        }
        Ok(Some(batch))
    }
}

impl Iterator for Batches {
    type Item = Result<RecordBatch, FileError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.failed {
            return None;
        }
        let next = self.next_batch();
        self.failed = next.is_err();
        next.transpose()
    }
}

/// Runs a call into the crate `parquet`, which has assertions that a damaged file can break: such a panic is the
/// file's fault and becomes its error.
fn guarded<T>(path: &Path, call: impl FnOnce() -> Result<T, FileError>) -> Result<T, FileError> {
    catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|_| Err(damaged(path, "it is damaged")))
}

pub(super) fn damaged(path: &Path, reason: impl ToString) -> FileError {
    FileError::format(path, "Parquet", reason)
}
