//! Tables as Arrow has them, for whoever hands them on: whole, in memory.

use std::path::Path;
use std::str::FromStr;
use std::sync::Arc;

use arrow_array::{Array, ArrayRef, Float64Array, RecordBatch, StringArray, UInt64Array};
use arrow_schema::{ArrowError, Field, Schema, SchemaRef};

use super::FileError;
use super::csv_table::csv_error;
use super::error::{Place, open_regular};
use super::lines::Lines;
use super::parquet_file::{ParquetFile, damaged};
use super::parquet_table::{Row, schema};

/// Rows of a batch of a table that is handed on.
const BATCH_ROWS: usize = 8192;

/// Columns of our CSV tables that hold whole numbers from 0.
const WHOLE: [&str; 6] = ["frame", "field", "n_stars", "camera", "id", "fields"];
/// Those that hold words. All others hold floating-point numbers.
const WORDS: [&str; 7] = ["status", "attitude", "file", "time_utc", "windows", "lines", "estimator"];

/// Rows as a batch, with the columns and types of their file.
///
/// # Errors
/// [`ArrowError`] for columns of different lengths.
pub fn arrow_of_rows<R: Row>(rows: &[R]) -> Result<RecordBatch, ArrowError> {
    let columns = R::columns(rows);
    let schema = Arc::new(schema(&columns));
    RecordBatch::try_new(schema, columns.into_iter().map(|column| column.values).collect())
}

/// All of a Parquet table.
///
/// # Errors
/// [`FileError`] for a file that cannot be read, is none or is damaged.
pub fn arrow_of_parquet(path: &Path) -> Result<(SchemaRef, Vec<RecordBatch>), FileError> {
    let file = ParquetFile::open(path)?;
    // Without what a writer says of itself beside the columns.
    let schema = Arc::new(Schema::new(file.schema().fields().clone()));
    let plain = |batch: Result<RecordBatch, FileError>| {
        RecordBatch::try_new(Arc::clone(&schema), batch?.columns().to_vec())
            .map_err(|error| damaged(path, error))
    };
    let batches = file.batches(None, BATCH_ROWS)?.map(plain).collect::<Result<_, _>>()?;
    Ok((schema, batches))
}

/// All of one of our CSV tables, each column of the type that its name has. An empty cell is null.
///
/// # Errors
/// [`FileError`] for a file that cannot be read, or a cell that is no number where its column holds numbers.
pub fn arrow_of_csv(path: &Path) -> Result<RecordBatch, FileError> {
    let file = Lines::new(open_regular(path)?);
    let mut reader = csv::Reader::from_reader(file);
    let header = reader.headers().map_err(|error| csv_error(path, &error))?.clone();
    let rows: Result<Vec<csv::StringRecord>, _> = reader.records().collect();
    let rows = rows.map_err(|error| csv_error(path, &error))?;
    let mut fields = Vec::new();
    let mut columns: Vec<ArrayRef> = Vec::new();
    for (index, name) in header.iter().enumerate() {
        let cells = || rows.iter().map(|row| row.get(index).filter(|cell| !cell.is_empty()));
        let column: ArrayRef = if WHOLE.contains(&name) {
            Arc::new(UInt64Array::from_iter(numbers(path, name, cells())?))
        } else if WORDS.contains(&name) {
            Arc::new(StringArray::from_iter(cells()))
        } else {
            Arc::new(Float64Array::from_iter(numbers(path, name, cells())?))
        };
        fields.push(Field::new(name, column.data_type().clone(), true));
        columns.push(column);
    }
    let format = |error: ArrowError| FileError::format(path, "CSV", error);
    RecordBatch::try_new(Arc::new(Schema::new(fields)), columns).map_err(format)
}

/// The cells of a column that holds numbers.
fn numbers<'a, T: FromStr>(
    path: &Path,
    name: &str,
    cells: impl Iterator<Item = Option<&'a str>>,
) -> Result<Vec<Option<T>>, FileError> {
    let number = |(row, cell): (usize, Option<&str>)| {
        cell.map(|cell| {
            let wrong = || FileError::value(path, Place::Row(row as u64), name, cell, "a number or nothing");
            cell.trim().parse().map_err(|_| wrong())
        })
        .transpose()
    };
    cells.enumerate().map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_have_the_types_of_their_names_and_every_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("measurements.csv");
        std::fs::write(&path, "frame,status,x_px\n3,detected,0.1\n9,no_target,\n").unwrap();
        let batch = arrow_of_csv(&path).unwrap();
        let frames: &UInt64Array = batch.column(0).as_any().downcast_ref().unwrap();
        let words: &StringArray = batch.column(1).as_any().downcast_ref().unwrap();
        let x: &Float64Array = batch.column(2).as_any().downcast_ref().unwrap();
        assert_eq!((frames.value(1), words.value(0), x.value(0), x.is_null(1)), (9, "detected", 0.1, true));
    }

    #[test]
    fn a_word_among_numbers_is_refused_by_row_and_column() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("measurements.csv");
        std::fs::write(&path, "frame,x_px\n3,1\n4,here\n").unwrap();
        let message = arrow_of_csv(&path).unwrap_err().to_string();
        assert!(message.contains("row 1: `x_px` is `here`, expected a number"), "{message}");
    }
}
