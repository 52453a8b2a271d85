//! One numeric column of an arbitrary CSV table.

use std::path::Path;

use super::lines::Lines;
use super::table::csv_error;
use crate::FileError;
use crate::error::{FileLocation, open_regular};

/// Reads the numbers of the column `name`; other columns are ignored.
///
/// # Errors
/// [`FileError`] for a file that cannot be read, has no such column or no row, or has a cell that is not a
/// finite number.
pub fn read_column(path: &Path, name: &str) -> Result<Vec<f64>, FileError> {
    let file = Lines::new(open_regular(path)?);
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(file);
    let header = reader.headers().map_err(|error| csv_error(path, &error))?.clone();
    let Some(index) = header.iter().position(|column| column == name) else {
        return Err(FileError::MissingColumn {
            path: path.to_owned(),
            column: name.to_owned(),
            found: header.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", "),
        });
    };
    let mut numbers = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| csv_error(path, &error))?;
        let cell = record.get(index).unwrap_or("");
        let line = record.position().map_or(0, csv::Position::line);
        match cell.parse::<f64>() {
            Ok(number) if number.is_finite() => numbers.push(number),
            _ => return Err(FileError::value(path, FileLocation::Line(line), name, cell, "a finite number")),
        }
    }
    if numbers.is_empty() {
        return Err(FileError::value(path, FileLocation::Header, "number of rows", 0, "at least 1"));
    }
    Ok(numbers)
}
