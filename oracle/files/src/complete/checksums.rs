//! `SHA256SUMS`: what the files of a directory were when they were complete, so that a bit that changed since does not pass for a result.
//!
//! The lines are those of `sha256sum`, and `sha256sum --check SHA256SUMS` reads them. Boresight reads them itself, after the files: of
//! damage that a reader of the file can tell, it tells the place.

use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::path::{Component, Path};

use sha2::{Digest, Sha256};

use super::sha256::hex;
use crate::error::FileLocation;
use crate::{AtomicFile, FileError, ReplaceableFile};

/// The file's name.
const NAME: &str = "SHA256SUMS";
/// Largest file that is read.
const MAX_BYTES: u64 = 1 << 20;
/// Largest file that is hashed: the tables of a hundred million frames are shorter.
const MAX_HASHED_BYTES: u64 = 1 << 38;
/// Bytes hashed at a time.
const CHUNK_BYTES: usize = 1 << 16;

/// The checksums of a directory.
#[derive(Debug, Clone, Copy)]
pub struct Checksums;

impl Checksums {
    /// Makes sure that a directory has no checksums of other files than `names`: they are somebody else's.
    ///
    /// # Errors
    /// [`FileError::NotReplaced`] when it has, [`FileError::Io`].
    pub fn check_own(directory: &Path, names: &[&str]) -> Result<(), FileError> {
        replaceable(&|beginning| are_checksums_of(beginning, names)).check(&directory.join(NAME))
    }

    /// Writes the checksums of those of `names` that are in a directory, in the place of earlier ones of the same names.
    ///
    /// # Errors
    /// Those of [`Checksums::check_own`]; [`FileError::Io`] when a file cannot be read, or the checksums not be written.
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

    /// Removes the checksums of a directory, whose files are about to change.
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

    /// Holds files of a directory against its checksums, where it has any: those whose names `is_used`. A file that has no line is
    /// somebody else's, and one that is not there is missed by whoever needs it.
    ///
    /// # Errors
    /// [`FileError::Value`] for a file that is not what it was; [`FileError::Format`] for lines that are none;
    /// [`FileError::Io`].
    pub fn check(directory: &Path, is_used: impl Fn(&str) -> bool) -> Result<(), FileError> {
        let path = directory.join(NAME);
        let text = match sim::regular_file::read_text(&path, MAX_BYTES) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
            Err(source) => return Err(FileError::io(&path, "read", source)),
        };
        for (number, line) in (1..).zip(text.lines()) {
            let wrong =
                |expected: &str| FileError::value(&path, FileLocation::Line(number), "line", line, expected);
            let (recorded, name) =
                parse(line).ok_or_else(|| wrong("64 hexadecimal digits, two blanks, a name"))?;
            if !is_inside(name) {
                return Err(wrong("the name of a file in this directory, without `..`"));
            }
            if !is_used(name) {
                continue;
            }
            let file = directory.join(name);
            if let Some(found) = file_sha256(&file)?.filter(|found| found != recorded) {
                let expected = format!(
                    "{recorded}, that of {}: the file was damaged, or changed since it was written; if on purpose, take its line out of there",
                    path.display()
                );
                return Err(FileError::value(&file, FileLocation::Whole, "SHA-256", found, expected));
            }
        }
        Ok(())
    }
}

fn replaceable<'a>(matches: &'a dyn Fn(&[u8]) -> bool) -> ReplaceableFile<'a> {
    ReplaceableFile { description: "the checksums of the files that are to be written", matches }
}

/// Whether a text is that of checksums of some of `names` and nothing else.
fn are_checksums_of(text: &[u8], names: &[&str]) -> bool {
    let lines = std::str::from_utf8(text).map(str::lines);
    lines.is_ok_and(|mut lines| lines.all(|line| parse(line).is_some_and(|(_, name)| names.contains(&name))))
}

/// Sum and name of a line.
fn parse(line: &str) -> Option<(&str, &str)> {
    line.split_once("  ").filter(|(sum, _)| is_sum(sum))
}

/// Whether a name leads to no place outside the directory.
fn is_inside(name: &str) -> bool {
    !name.is_empty() && Path::new(name).components().all(|part| matches!(part, Component::Normal(_)))
}

fn is_sum(text: &str) -> bool {
    text.len() == 64 && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
}

/// SHA-256 of a regular file, hexadecimal; `None` when it is not there.
///
/// # Errors
/// [`FileError`] for a file that cannot be read, is no regular file or has more than 2^38 bytes.
pub fn file_sha256(path: &Path) -> Result<Option<String>, FileError> {
    let file = match sim::regular_file::open(path) {
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
        assert!(message.contains("SHA256SUMS") && message.contains("another file"), "{message}");
        assert!(Checksums::check_own(folder.path(), &["b.csv"]).is_err());
        Checksums::write(folder.path(), &["a.csv", "b.csv"]).unwrap();
        assert!(Checksums::check_own(folder.path(), &["b.csv", "a.csv"]).is_ok());
    }
}
