//! Tables of a report.

use super::inline_code::with_inline_code;
use crate::figures::words::capital;

/// A cell of a table.
pub(super) struct Cell<'a> {
    /// Text.
    pub(super) text: &'a str,
    /// Attribute of its element, with a space before it; empty for none.
    pub(super) attribute: String,
}

/// A table of text and numbers.
#[derive(Debug, Clone, Default)]
pub struct DataTable {
    /// Caption above the table; empty for none.
    pub caption: String,
    /// Names of the columns.
    pub head: Vec<String>,
    /// Rows, each with as many cells as the head.
    pub rows: Vec<Vec<String>>,
    /// True if the cells are sentences rather than numbers.
    pub is_wordy: bool,
    /// True if cells may be wrapped, because the page is too narrow for the number of columns.
    pub is_narrow: bool,
}

impl DataTable {
    /// Creates a table without rows.
    pub fn new<S: Into<String>>(head: impl IntoIterator<Item = S>) -> Self {
        Self { head: head.into_iter().map(Into::into).collect(), ..Self::default() }
    }

    /// Sets the caption above the table.
    pub fn caption(mut self, caption: impl Into<String>) -> Self {
        self.caption = caption.into();
        self
    }

    /// Marks the cells as sentences rather than numbers.
    pub fn wordy(mut self) -> Self {
        self.is_wordy = true;
        self
    }

    /// Permits wrapped cells, for a table with many columns.
    pub fn narrow(mut self) -> Self {
        self.is_narrow = true;
        self
    }

    /// Adds a row and returns the table.
    pub fn row<S: Into<String>>(mut self, cells: impl IntoIterator<Item = S>) -> Self {
        self.push(cells);
        self
    }

    /// Returns true if the table may need its own scroll bar, which is then reached by keyboard.
    pub(super) fn is_long(&self) -> bool {
        self.rows.len() > 12
    }

    /// Returns the cells of a row.
    pub(super) fn cells<'a>(&self, row: &'a [String]) -> Vec<Cell<'a>> {
        let cell = |(column, text): (usize, &'a String)| Cell { text, attribute: self.label_of(column) };
        row.iter().enumerate().map(cell).collect()
    }

    /// Returns the attribute that names the column of a cell, for a narrow screen, where the cells of a wordy
    /// table are stacked below each other; empty for other tables.
    fn label_of(&self, column: usize) -> String {
        let name = self.head.get(column).filter(|name| self.is_wordy && !name.is_empty());
        name.map_or_else(String::new, |name| format!(" data-label=\"{}\"", with_inline_code(&capital(name))))
    }

    /// Adds a row.
    pub fn push<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }
}
