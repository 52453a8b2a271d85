//! Access to the rows of a file by the frame numbers of the truth.

use std::iter::Peekable;
use std::path::Path;
use std::vec::IntoIter;

use files::{Failure, line_of};

/// Rows in ascending order of their frame numbers, all of which must occur in the truth.
pub struct RowsByNumber<'a, T> {
    rows: Peekable<IntoIter<(u64, T)>>,
    path: &'a Path,
    /// Name of the column with the numbers.
    key: &'static str,
    truth: &'a Path,
}

impl<'a, T> RowsByNumber<'a, T> {
    /// Creates the access to the rows of the file `path`, which belong to frames of the table `truth`.
    pub fn new(rows: Vec<(u64, T)>, path: &'a Path, key: &'static str, truth: &'a Path) -> Self {
        Self { rows: rows.into_iter().peekable(), path, key, truth }
    }

    /// Returns the row of a frame, if present. The numbers passed must ascend.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a row of an earlier frame, which the truth does not contain.
    pub fn take(&mut self, number: u64) -> Result<Option<T>, Failure> {
        let next = self.rows.peek().map(|(next, _)| *next);
        match next.filter(|next| *next < number) {
            Some(earlier) => Err(self.unknown_frame(earlier)),
            None => Ok(self.rows.next_if(|(found, _)| *found == number).map(|(_, row)| row)),
        }
    }

    /// Checks that every row has been taken.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a row of a frame that the truth does not contain.
    pub fn end(mut self) -> Result<(), Failure> {
        self.rows.next().map_or(Ok(()), |(number, _)| Err(self.unknown_frame(number)))
    }

    fn unknown_frame(&self, number: u64) -> Failure {
        let line =
            line_of(self.path, self.key, number).map(|line| format!(", line {line}")).unwrap_or_default();
        Failure::Usage(format!(
            "{}{line}: `{key}` is `{number}`, expected a {key} of {}",
            self.path.display(),
            self.truth.display(),
            key = self.key
        ))
    }
}
