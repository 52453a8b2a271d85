//! `SHA256SUMS`: checksums of the files of a directory at its completion, used to reject results that were
//! damaged or changed later.
//!
//! The lines have the format of `sha256sum`, and `sha256sum --check SHA256SUMS` reads them. Boresight checks
//! them itself, after it has read the files: for damage that a file's reader detects, the reader reports the
//! location.

use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::path::{Component, Path};

use sha2::{Digest, Sha256};

use super::sha256::hex;
use crate::error::FileLocation;
use crate::{AtomicFile, FileError, ReplaceableFile};

/// Name of the checksum file.
const NAME: &str = "SHA256SUMS";
/// Largest checksum file that is read, bytes.
const MAX_BYTES: u64 = 1 << 20;
/// Largest file that is hashed, bytes: the tables of a hundred million frames are shorter.
const MAX_HASHED_BYTES: u64 = 1 << 38;
/// Number of bytes read at a time for hashing.
const CHUNK_BYTES: usize = 1 << 16;

/// Checksum file of a directory.
#[derive(Debug, Clone, Copy)]
pub struct Checksums;

impl Checksums {
    /// Checks that a checksum file in `directory`, if present, covers only files in `names`: other checksums
    /// were not written by Boresight.
    ///
    /// # Errors
    /// [`FileError::NotReplaced`] if it covers other files, [`FileError::Io`].
    pub fn check_own(directory: &Path, names: &[&str]) -> Result<(), FileError> {
        replaceable(&|beginning| are_checksums_of(beginning, names)).check(&directory.join(NAME))
    }

    /// Writes the checksums of those files of `names` that exist in a directory, replacing earlier checksums
    /// of the same names.
    ///
    /// # Errors
    /// Those of [`Checksums::check_own`]; [`FileError::Io`] if a file cannot be read or the checksums cannot
    /// be written.
    pub fn write(directory: &Path, names: &[&str]) -> Result<(), FileError> {
        let mut lines = String::new();
        for name in names {
            if let Some(sum) = file_sha256(&directory.join(name))? {
                lines += &format!("{sum}  {name}\n");
            }
        }
        let file = AtomicFile::with_text(&directory.join(NAME), &lines)?;
        file.replace(replaceable(&|beginning| are_checksums_of(beginning, names)))
    }

    /// Removes the checksum file of a directory whose files are about to change.
    ///
    /// # Errors
    /// [`FileError::Io`].
    pub fn remove(directory: &Path) -> Result<(), FileError> {
        let path = directory.join(NAME);
        match std::fs::remove_file(&path) {
            Err(source) if source.kind() != ErrorKind::NotFound => {
                Err(FileError::io(&path, "remove", source))
            }
            _ => Ok(()),
        }
    }

    /// Compares the files of a directory that `is_used` selects by name with the directory's checksums, if it
    /// has any. Files without a line are ignored: Boresight did not write them. Absent files are ignored too:
    /// the reader that needs a file reports its absence.
    ///
    /// # Errors
    /// [`FileError::Value`] for a file that has changed; [`FileError::Format`] for malformed lines;
    /// [`FileError::Io`].
    pub fn check(directory: &Path, is_used: impl Fn(&str) -> bool) -> Result<(), FileError> {
        let path = directory.join(NAME);
        let text = match config::regular_file::read_text(&path, MAX_BYTES) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
            Err(source) => return Err(FileError::io(&path, "read", source)),
        };
        for (number, line) in (1..).zip(text.lines()) {
            let wrong =
                |expected: &str| FileError::value(&path, FileLocation::Line(number), "line", line, expected);
            let (recorded, name) =
                parse(line).ok_or_else(|| wrong("64 hexadecimal digits, two spaces and a name"))?;
            if !is_inside(name) {
                return Err(wrong("the name of a file in this directory, without `..`"));
            }
            if !is_used(name) {
                continue;
            }
            let file = directory.join(name);
            if let Some(found) = file_sha256(&file)?.filter(|found| found != recorded) {
                let expected = format!(
                    "{recorded} as in {}: the file is damaged or was changed after it was written; after an \
                     intended change, remove its line from that list",
                    path.display()
                );
                return Err(FileError::value(&file, FileLocation::Whole, "SHA-256", found, expected));
            }
        }
        Ok(())
    }
}

fn replaceable<'a>(matches: &'a dyn Fn(&[u8]) -> bool) -> ReplaceableFile<'a> {
    ReplaceableFile { description: "checksums of the files to be written", matches }
}

/// Returns true if `text` consists only of checksum lines for files in `names`.
fn are_checksums_of(text: &[u8], names: &[&str]) -> bool {
    let lines = std::str::from_utf8(text).map(str::lines);
    lines.is_ok_and(|mut lines| lines.all(|line| parse(line).is_some_and(|(_, name)| names.contains(&name))))
}

/// Returns the checksum and the file name of a line.
fn parse(line: &str) -> Option<(&str, &str)> {
    line.split_once("  ").filter(|(sum, _)| is_sum(sum))
}

/// Returns true if a name refers to a file inside the directory.
fn is_inside(name: &str) -> bool {
    !name.is_empty() && Path::new(name).components().all(|part| matches!(part, Component::Normal(_)))
}

fn is_sum(text: &str) -> bool {
    text.len() == 64 && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
}

/// Computes the SHA-256 of a regular file, hexadecimal; `None` if the file does not exist.
///
/// # Errors
/// [`FileError`] for a file that cannot be read, is not a regular file or has more than 2^38 bytes.
pub fn file_sha256(path: &Path) -> Result<Option<String>, FileError> {
    let file = match config::regular_file::open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(source) => return Err(FileError::io(path, "open", source)),
    };
    let length = file.metadata().map_err(|source| FileError::io(path, "read", source))?.len();
    if length > MAX_HASHED_BYTES {
        let expected = format!("at most {MAX_HASHED_BYTES}");
        return Err(FileError::value(path, FileLocation::Whole, "length in bytes", length, expected));
    }
    let mut hash = Sha256::new();
    let mut file = BufReader::with_capacity(CHUNK_BYTES, file.take(length));
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
        // FIPS 180-4, one-block example.
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad  abc.txt\n";
        assert_eq!(std::fs::read_to_string(folder.path().join(NAME)).unwrap(), expected);
    }

    #[test]
    fn a_changed_file_is_named_and_an_unlisted_or_deleted_one_is_not() {
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

    #[test]
    fn names_stay_inside_the_directory() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("run")).unwrap();
        std::fs::write(folder.path().join("a.csv"), "1").unwrap();
        let sum = "0".repeat(64);
        for name in ["../a.csv", "truth/../../a.csv", "/etc/passwd", "/proc/kmsg", "..", ""] {
            std::fs::write(folder.path().join("run").join(NAME), format!("{sum}  {name}\n")).unwrap();
            let message = Checksums::check(&folder.path().join("run"), |_| true).unwrap_err().to_string();
            assert!(message.contains("line 1") && message.contains("in this directory"), "{name}: {message}");
        }
    }

    #[test]
    fn a_file_that_is_longer_than_any_table_is_not_hashed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        std::fs::File::create(&path).unwrap().set_len(MAX_HASHED_BYTES + 1).unwrap();
        std::fs::write(folder.path().join(NAME), format!("{}  a.csv\n", "0".repeat(64))).unwrap();
        let message = Checksums::check(folder.path(), |_| true).unwrap_err().to_string();
        assert!(message.contains("length in bytes"), "{message}");
    }

    #[test]
    fn checksums_of_other_files_stay() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a.csv"), "1").unwrap();
        std::fs::write(folder.path().join("b.csv"), "2").unwrap();
        Checksums::write(folder.path(), &["a.csv"]).unwrap();
        let message = Checksums::write(folder.path(), &["b.csv"]).unwrap_err().to_string();
        assert!(message.contains("SHA256SUMS") && message.contains("a file of another kind"), "{message}");
        assert!(Checksums::check_own(folder.path(), &["b.csv"]).is_err());
        Checksums::write(folder.path(), &["a.csv", "b.csv"]).unwrap();
        assert!(Checksums::check_own(folder.path(), &["b.csv", "a.csv"]).is_ok());
    }
}
