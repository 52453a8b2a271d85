//! Tables of a report.

/// A table of words and numbers, written out.
#[derive(Debug, Clone, Default)]
pub struct DataTable {
    /// A line above it; empty for none.
    pub caption: String,
    /// Names of the columns.
    pub head: Vec<String>,
    /// The rows, each as long as the head.
    pub rows: Vec<Vec<String>>,
    /// Whether its cells are sentences rather than numbers.
    pub is_wordy: bool,
    /// Whether cells may be broken, as of many columns which a page has no room for otherwise.
    pub is_narrow: bool,
}

impl DataTable {
    /// A table without rows.
    pub fn new<S: Into<String>>(head: impl IntoIterator<Item = S>) -> Self {
        Self { head: head.into_iter().map(Into::into).collect(), ..Self::default() }
    }

    /// With a line above it.
    pub fn caption(mut self, caption: impl Into<String>) -> Self {
        self.caption = caption.into();
        self
    }

    /// Of sentences rather than numbers.
    pub fn wordy(mut self) -> Self {
        self.is_wordy = true;
        self
    }

    /// Of many columns.
    pub fn narrow(mut self) -> Self {
        self.is_narrow = true;
        self
    }

    /// With one more row.
    pub fn row<S: Into<String>>(mut self, cells: impl IntoIterator<Item = S>) -> Self {
        self.push(cells);
        self
    }

    /// Adds a row.
    pub fn push<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }
}
