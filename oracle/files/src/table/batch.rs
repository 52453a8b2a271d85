//! Columns of a batch of rows.

use std::path::Path;

use super::column::{Cell, Cells, Column, ColumnValues, TextCells};
use crate::FileError;
use crate::error::FileLocation;

/// Columns of a batch, accessed by name.
pub struct Columns<'a> {
    path: &'a Path,
    batch: &'a [Column],
    first_row: u64,
}

impl<'a> Columns<'a> {
    /// Creates the columns of a batch that starts at row `first_row` of a file.
    pub fn new(path: &'a Path, batch: &'a [Column], first_row: u64) -> Self {
        Self { path, batch, first_row }
    }

    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.batch.first().map_or(0, |column| column.values().len())
    }

    /// Returns true if there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Creates the error of a cell; `row` is counted within the batch.
    pub fn error(
        &self,
        row: usize,
        column: &str,
        value: impl ToString,
        expected: impl Into<String>,
    ) -> FileError {
        FileError::value(self.path, FileLocation::Row(self.first_row + row as u64), column, value, expected)
    }

    /// Returns a column of cells of type `T`.
    pub(crate) fn cells<T: Cell>(&self, name: &str) -> Result<&Cells<T>, FileError> {
        let cells = T::cells(self.values(name)?).ok_or_else(|| self.damaged(name))?;
        // A null is stored as 0, which is valid.
        match cells.values().iter().position(|value| !value.is_sound()) {
            Some(row) => {
                let shown = format!("{:?}", cells.get(row).unwrap_or_default());
                Err(self.error(row, name, shown, T::EXPECTED))
            }
            None => Ok(cells),
        }
    }

    /// Returns a column of texts.
    pub(crate) fn texts(&self, name: &str) -> Result<&TextCells, FileError> {
        match self.values(name)? {
            ColumnValues::Utf8(texts) => Ok(texts),
            _ => Err(self.damaged(name)),
        }
    }

    fn values(&self, name: &str) -> Result<&ColumnValues, FileError> {
        let column = self.batch.iter().find(|column| column.name() == name);
        column.map(Column::values).ok_or_else(|| self.damaged(name))
    }

    /// Names and types were checked when the file was opened; a batch that differs indicates a damaged file.
    fn damaged(&self, name: &str) -> FileError {
        FileError::format(self.path, "Parquet", format!("column `{name}` is damaged"))
    }
}
