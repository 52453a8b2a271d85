//! Tables of a report.

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

    /// Adds a row.
    pub fn push<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }
}
