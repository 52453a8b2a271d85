//! `SHA256SUMS`: what the files of a directory were when they were complete, so that a bit that changed since does not pass for a result.
//!
//! The lines are those of `sha256sum`, and `sha256sum --check SHA256SUMS` reads them. Boresight reads them itself, after the files: of
//! damage that a reader of the file can tell, it tells the place.

use std::io::{BufRead, BufReader, ErrorKind};
use std::path::Path;

use sha2::{Digest, Sha256};

use super::error::Place;
use super::{FileError, WholeFile};
use crate::sha256::hex;

/// The file's name.
const NAME: &str = "SHA256SUMS";
/// Largest file that is read.
const MOST_BYTES: u64 = 1 << 20;
/// Bytes hashed at a time.
const CHUNK_BYTES: usize = 1 << 16;

/// The checksums of a directory.
#[derive(Debug, Clone, Copy)]
pub struct Checksums;

impl Checksums {
    /// Writes the checksums of those of `names` that are in a directory, in the place of earlier ones.
    ///
    /// # Errors
    /// [`FileError::Io`] when a file cannot be read, or the checksums not be written.
    pub fn write(directory: &Path, names: &[&str]) -> Result<(), FileError> {
        let mut lines = String::new();
        for name in names {
            if let Some(sum) = sha256(&directory.join(name))? {
                lines += &format!("{sum}  {name}\n");
            }
        }
        WholeFile::with_text(&directory.join(NAME), &lines)?.replace()
    }

    /// Holds files of a directory against its checksums, where it has any: those whose names `is_used`. A file that has no line is
    /// somebody else's, and one that is not there is missed by whoever needs it.
    ///
    /// # Errors
    /// [`FileError::Value`] for a file that is not what it was; [`FileError::Format`] for lines that are none;
    /// [`FileError::Io`].
    pub fn check(directory: &Path, is_used: impl Fn(&str) -> bool) -> Result<(), FileError> {
        let path = directory.join(NAME);
        let text = match sim::regular_file::read_text(&path, MOST_BYTES) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
            Err(source) => return Err(FileError::io(&path, "read", source)),
        };
        for (number, line) in (1..).zip(text.lines()) {
            let (told, name) = line.split_once("  ").filter(|(sum, _)| is_sum(sum)).ok_or_else(|| {
                FileError::value(
                    &path,
                    Place::Line(number),
                    "line",
                    line,
                    "64 hexadecimal digits, two blanks, a name",
                )
            })?;
            if !is_used(name) {
                continue;
            }
            let file = directory.join(name);
            if let Some(found) = sha256(&file)?.filter(|found| found != told) {
                let expected = format!(
                    "{told}, that of {}: the file was damaged, or changed since it was written; if on purpose, take its line out of there",
                    path.display()
                );
                return Err(FileError::value(&file, Place::Whole, "SHA-256", found, expected));
            }
        }
        Ok(())
    }
}

fn is_sum(text: &str) -> bool {
    text.len() == 64 && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
}

/// SHA-256 of a file, hexadecimal; `None` when it is not there.
fn sha256(path: &Path) -> Result<Option<String>, FileError> {
    let file = match sim::regular_file::open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(source) => return Err(FileError::io(path, "open", source)),
    };
    let mut hash = Sha256::new();
    let mut file = BufReader::with_capacity(CHUNK_BYTES, file);
    loop {
        let chunk = match file.fill_buf() {
            Ok([]) => break,
            Ok(chunk) => chunk,
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(source) => return Err(FileError::io(path, "read", source)),
        };
        hash.update(chunk);
        let read = chunk.len();
        file.consume(read);
    }
    Ok(Some(hex(hash.finalize())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sum_is_that_of_the_standard() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("abc.txt"), "abc").unwrap();
        Checksums::write(folder.path(), &["abc.txt", "none.txt"]).unwrap();
        // FIPS 180-4, example of one block.
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad  abc.txt\n";
        assert_eq!(std::fs::read_to_string(folder.path().join(NAME)).unwrap(), expected);
    }

    #[test]
    fn a_file_that_changed_is_named_and_one_without_a_line_or_gone_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let check = || Checksums::check(folder.path(), |_| true);
        assert!(check().is_ok(), "a directory without checksums");
        std::fs::write(path("a.csv"), "1").unwrap();
        Checksums::write(folder.path(), &["a.csv"]).unwrap();
        std::fs::write(path("b.csv"), "2").unwrap();
        assert!(check().is_ok());
        std::fs::write(path("a.csv"), "3").unwrap();
        let message = check().unwrap_err().to_string();
        assert!(message.contains("a.csv") && message.contains("damaged"), "{message}");
        assert!(Checksums::check(folder.path(), |name| name != "a.csv").is_ok());
        std::fs::remove_file(path("a.csv")).unwrap();
        assert!(check().is_ok());
        std::fs::write(path(NAME), "a.csv\n").unwrap();
        assert!(check().unwrap_err().to_string().contains("line 1"));
    }
}
