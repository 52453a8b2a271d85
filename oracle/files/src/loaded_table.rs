//! Whole tables as columns in memory, for export.

use std::path::Path;
use std::str::FromStr;

use crate::FileError;
use crate::csv::lines::Lines;
use crate::csv::table::csv_error;
use crate::error::{FileLocation, open_regular};
use crate::parquet::file::ParquetFile;
use crate::table::column::{Column, ColumnType};
use crate::table::declarations::FieldDeclaration;

/// Number of rows in one part of an exported table.
const PART_ROWS: usize = 8192;

/// A table in memory.
#[derive(Debug, Clone)]
pub struct LoadedTable {
    /// Columns without rows.
    pub header: Vec<Column>,
    /// Rows, divided into parts, each with the columns of the header.
    pub parts: Vec<Vec<Column>>,
}

/// Reads a Parquet table with all its columns.
///
/// # Errors
/// [`FileError`] for a file that cannot be read, is damaged or not in Parquet format, or has a column of a
/// type that Boresight tables do not use.
pub fn read_parquet_table(path: &Path) -> Result<LoadedTable, FileError> {
    let file = ParquetFile::open(path)?;
    let names: Vec<String> = file.columns().iter().map(|column| column.name.clone()).collect();
    let batches = file.batches(&names, PART_ROWS)?;
    let header = batches.header();
    Ok(LoadedTable { header, parts: batches.collect::<Result<_, _>>()? })
}

/// Reads a CSV table. Each column has the type that its name has in `fields`: 64-bit counts, texts, or
/// floating-point numbers, which is also the type of undeclared columns. An empty cell is
/// null.
///
/// # Errors
/// [`FileError`] for a file that cannot be read, or a cell that is not a number in a column of numbers.
pub fn read_csv_table(path: &Path, fields: &[FieldDeclaration]) -> Result<Vec<Column>, FileError> {
    let file = Lines::new(open_regular(path)?);
    let mut reader = csv::Reader::from_reader(file);
    let header = reader.headers().map_err(|error| csv_error(path, &error))?.clone();
    let rows: Result<Vec<csv::StringRecord>, _> = reader.records().collect();
    let rows = rows.map_err(|error| csv_error(path, &error))?;
    let column = |(index, name): (usize, &str)| {
        let cells = rows.iter().map(|row| row.get(index).filter(|cell| !cell.is_empty()));
        let is_of_name = |field: &&FieldDeclaration| field.names.contains(&name);
        Ok(match fields.iter().find(is_of_name).map(|field| field.column_type) {
            Some(ColumnType::UInt32 | ColumnType::UInt64) => {
                Column::nullable(name, numbers::<u64>(path, name, cells)?)
            }
            Some(ColumnType::Utf8) => Column::nullable_texts(name, cells),
            _ => Column::nullable(name, numbers::<f64>(path, name, cells)?),
        })
    };
    header.iter().enumerate().map(column).collect()
}

/// Parses the cells of a column of numbers.
fn numbers<'a, T: FromStr>(
    path: &Path,
    name: &str,
    cells: impl Iterator<Item = Option<&'a str>>,
) -> Result<Vec<Option<T>>, FileError> {
    let number = |(row, cell): (usize, Option<&str>)| {
        cell.map(|cell| {
            let wrong = || {
                FileError::value(path, FileLocation::Row(row as u64), name, cell, "a number or an empty cell")
            };
            cell.trim().parse().map_err(|_| wrong())
        })
        .transpose()
    };
    cells.enumerate().map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table;
    use crate::table::column::ColumnValues;
    use crate::table::declarations::Table;

    table! {
        /// A row with a count, a text and a number.
        struct Measured: csv {
            /// number of the frame
            frame: u64,
            /// outcome
            status: String,
            /// position
            x_px: Option<f64>,
        }
    }

    #[test]
    fn columns_have_the_types_of_their_names_and_every_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("measurements.csv");
        std::fs::write(&path, "frame,status,x_px\n3,detected,0.1\n9,no_target,\n").unwrap();
        let columns = read_csv_table(&path, &Measured::declarations()).unwrap();
        let [ColumnValues::UInt64(frames), ColumnValues::Utf8(words), ColumnValues::Float64(x)] =
            [0, 1, 2].map(|index| columns[index].values())
        else {
            panic!("{columns:?}")
        };
        assert_eq!((frames.get(1), words.get(0)), (Some(9), Some("detected")));
        assert_eq!((x.get(0), x.get(1)), (Some(0.1), None));
        assert!(columns.iter().all(Column::is_nullable), "{columns:?}");
    }

    #[test]
    fn a_word_among_numbers_is_refused_by_row_and_column() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("measurements.csv");
        std::fs::write(&path, "frame,x_px\n3,1\n4,here\n").unwrap();
        let message = read_csv_table(&path, &Measured::declarations()).unwrap_err().to_string();
        assert!(message.contains("row 1: `x_px` is `here`, expected a number"), "{message}");
    }
}
