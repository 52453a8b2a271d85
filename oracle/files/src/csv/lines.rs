//! CSV input with bounded records, because readers keep a whole record in memory. A record is a line, or
//! several lines if a quoted cell continues on the next line.

use std::io::{Error, ErrorKind, Read, Result};

/// Longest record, bytes.
const MAX_RECORD_BYTES: usize = 1 << 20;

/// A reader that fails if a record exceeds 1 MiB, or if the last one has no line end: the file may be cut off
/// within a number, which would then be read as another one.
#[derive(Debug)]
pub struct Lines<R> {
    inner: R,
    /// Number of bytes since the end of the last record.
    length: usize,
    state: CellState,
}

/// Position of a byte within a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum CellState {
    /// Beginning of a cell.
    Start,
    /// Inside a cell without enclosing quotation marks; quotation marks are ordinary characters.
    Plain,
    /// Inside a cell with enclosing quotation marks.
    Quoted,
    /// After a quotation mark that ends a cell unless it is doubled.
    Closed,
}

impl CellState {
    fn after(self, byte: u8) -> Self {
        match (self, byte) {
            (Self::Start | Self::Closed, b'"') => Self::Quoted,
            (Self::Quoted, b'"') => Self::Closed,
            (Self::Quoted, _) => Self::Quoted,
            (_, b',' | b'\n' | b'\r') => Self::Start,
            _ => Self::Plain,
        }
    }
}

impl<R> Lines<R> {
    /// Creates a reader of the records of `inner`.
    pub fn new(inner: R) -> Self {
        Self { inner, length: 0, state: CellState::Start }
    }
}

impl<R: Read> Read for Lines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        let count = self.inner.read(buffer)?;
        if count == 0 && !buffer.is_empty() && self.length > 0 {
            let message = "the last line has no line end, so the file may be cut off: check its last value, \
                           and end the line";
            return Err(Error::new(ErrorKind::InvalidData, message));
        }
        for &byte in buffer.get(..count).unwrap_or_default() {
            self.state = self.state.after(byte);
            self.length += 1;
            if self.length > MAX_RECORD_BYTES {
                let message = format!("a line is longer than {MAX_RECORD_BYTES} bytes");
                return Err(Error::new(ErrorKind::InvalidData, message));
            }
            if matches!(byte, b'\n' | b'\r') && self.state == CellState::Start {
                self.length = 0;
            }
        }
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<usize> {
        let mut lines = Lines::new(text.as_bytes());
        std::io::copy(&mut lines, &mut std::io::sink()).map(|count| count as usize)
    }

    #[test]
    fn a_line_that_is_too_long_is_refused_wherever_it_stands() {
        let longest = "a".repeat(MAX_RECORD_BYTES - 1) + "\n";
        assert_eq!(read(&longest.repeat(3)).unwrap(), 3 * MAX_RECORD_BYTES);
        for text in [format!("a{longest}"), format!("{longest}a{longest}"), "a".repeat(MAX_RECORD_BYTES + 1)]
        {
            assert!(read(&text).unwrap_err().to_string().contains("longer than"));
        }
    }

    #[test]
    fn a_cell_in_quotation_marks_goes_on_in_the_next_line_and_is_bounded_too() {
        let lines = "a\n".repeat(MAX_RECORD_BYTES / 2);
        for begin in ["\"", "1,\"", "1,\"a\"\"b", "\n\""] {
            assert!(
                read(&format!("{begin}{lines}")).unwrap_err().to_string().contains("longer than"),
                "{begin}"
            );
        }
        // Closed quotation marks, and quotation marks as ordinary characters.
        for begin in ["\"a\"\n", "\"a\"\"\",1\n", "6\" of film\n", "1,a\"\n", "\"a\nb\",1\r\n"] {
            assert!(read(&format!("{begin}{lines}")).is_ok(), "{begin}");
        }
    }
}
