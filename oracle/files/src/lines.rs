//! Text in lines, none of which is endless: whoever reads a line keeps it.

use std::io::{Error, ErrorKind, Read, Result};

/// Longest line, bytes.
const LONGEST: usize = 1 << 20;

/// A reader that fails at a line of more than [`LONGEST`] bytes.
#[derive(Debug)]
pub(super) struct Lines<R> {
    inner: R,
    /// Bytes since the last line ended.
    length: usize,
}

impl<R> Lines<R> {
    pub(super) fn new(inner: R) -> Self {
        Self { inner, length: 0 }
    }
}

impl<R: Read> Read for Lines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        let count = self.inner.read(buffer)?;
        for part in buffer.get(..count).unwrap_or_default().split_inclusive(|byte| *byte == b'\n') {
            self.length = self.length.saturating_add(part.len());
            if self.length > LONGEST {
                let message = format!("a line is longer than {LONGEST} bytes");
                return Err(Error::new(ErrorKind::InvalidData, message));
            }
            if part.ends_with(b"\n") {
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
        let longest = "a".repeat(LONGEST - 1) + "\n";
        assert_eq!(read(&longest.repeat(3)).unwrap(), 3 * LONGEST);
        for text in [format!("a{longest}"), format!("{longest}a{longest}"), "a".repeat(LONGEST + 1)] {
            assert!(read(&text).unwrap_err().to_string().contains("longer than"));
        }
    }
}
