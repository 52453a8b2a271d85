//! Journal of the finished cases of an incomplete shard, one line each: an interrupted study loses only the
//! cases in progress.

use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use files::FileError;
use files::sha256::sha256_hex;

use crate::cases::CaseRow;

/// Longest journal that is read, bytes.
const MAX_BYTES: u64 = 1 << 32;

/// File to which finished cases are appended. Several processes may append to one file: each line is written
/// at once.
pub(crate) struct Journal {
    path: PathBuf,
    /// Hash of the study that the rows belong to, part of the checksum of every line.
    hash: String,
    file: Mutex<File>,
}

impl Journal {
    /// Opens a journal, new or existing, and returns its rows. Lines that are cut short, damaged or of
    /// another `hash` are skipped.
    ///
    /// # Errors
    /// [`FileError::Io`] for a file that cannot be read or appended to.
    pub(crate) fn open(path: PathBuf, hash: &str) -> Result<(Self, Vec<CaseRow>), FileError> {
        let io = |source| FileError::io(&path, "open", source);
        let text = match config::regular_file::read(&path, MAX_BYTES) {
            Ok(bytes) => String::from_utf8_lossy(&bytes).into_owned(),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(io(error)),
        };
        let rows = text.lines().filter_map(|line| parse(line, hash)).collect();
        let file = OpenOptions::new().append(true).create(true).open(&path).map_err(io)?;
        Ok((Self { path, hash: hash.to_owned(), file: Mutex::new(file) }, rows))
    }

    /// Appends a row.
    ///
    /// # Errors
    /// [`FileError::Io`] when the row cannot be written.
    pub(crate) fn add(&self, row: &CaseRow) -> Result<(), FileError> {
        let json =
            serde_json::to_string(row).map_err(|error| FileError::format(&self.path, "case", error))?;
        // The leading line break ends a line that was cut short before.
        let line = format!("\n{} {json}\n", sum(&self.hash, &json));
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.write_all(line.as_bytes()).map_err(|source| FileError::io(&self.path, "write", source))
    }

    /// Removes the file, whose rows are in the shard's file.
    pub(crate) fn remove(self) {
        // A journal that cannot be removed is ignored later, because the shard is complete.
        let _ = std::fs::remove_file(&self.path);
    }
}

/// Returns the number of rows of a journal that [`Journal::open`] would return.
pub(crate) fn count(path: &Path, hash: &str) -> usize {
    let text = config::regular_file::read_text(path, MAX_BYTES).unwrap_or_default();
    text.lines().filter(|line| parse(line, hash).is_some()).count()
}

fn parse(line: &str, hash: &str) -> Option<CaseRow> {
    let (found, json) = line.split_once(' ')?;
    (found == sum(hash, json)).then(|| serde_json::from_str(json).ok()).flatten()
}

fn sum(hash: &str, json: &str) -> String {
    sha256_hex(format!("{hash} {json}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::{CaseFigure, DrawnValue};

    fn row(case: u64) -> CaseRow {
        let figure = CaseFigure { value: Some(0.1 + 0.2), count: 3, of: 10 };
        let drawn = vec![DrawnValue::Number(1.0 / 3.0), DrawnValue::Text("a\nb".to_owned())];
        let error = (case == 2).then(|| "no\nscenario".to_owned());
        let (figures, causes) = (vec![figure], vec![0, 7]);
        CaseRow {
            case,
            seed: u64::MAX - case,
            has_failed: case == 1,
            error,
            frames: 10,
            drawn,
            figures,
            causes,
        }
    }

    #[test]
    fn rows_round_trip_bit_for_bit_but_for_damaged_lines() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("journal");
        let open = |hash: &str| Journal::open(path.clone(), hash).unwrap();
        let (journal, rows) = open("ab");
        assert_eq!(rows, []);
        (0..3).for_each(|case| journal.add(&row(case)).unwrap());
        assert_eq!(open("ab").1, [row(0), row(1), row(2)]);
        assert_eq!((open("cd").1, count(&path, "ab")), (Vec::new(), 3));

        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, text.replacen("\"count\":3", "\"count\":4", 1)).unwrap();
        assert_eq!(open("ab").1, [row(1), row(2)]);
        std::fs::write(&path, &text[..text.len() - 5]).unwrap();
        let (journal, rows) = open("ab");
        assert_eq!(rows, [row(0), row(1)]);
        journal.add(&row(2)).unwrap();
        assert_eq!(open("ab").1, [row(0), row(1), row(2)]);
        journal.remove();
        assert!(!path.exists());
    }
}
