//! CCSDS navigation messages as records of located values, independent of their notation.

mod keywords;
mod kind;
mod kvn;
mod message;
mod record;
mod writer;
mod xml;

use std::path::Path;

use files::{FileError, FileLocation};

pub(crate) use keywords::COVARIANCE as COVARIANCE_KEYWORDS;
pub(crate) use kind::Kind;
pub use kind::Notation;
pub(crate) use message::{Document, Segment};
pub(crate) use record::{Entry, Record};
pub(crate) use writer::Writer;

/// Largest file that is read.
const MAX_BYTES: u64 = 1 << 29;

/// Reads a file of one kind in either notation, and converts it.
///
/// # Errors
/// [`FileError`] for a file that cannot be read, is not such a message, is truncated, or whose conversion
/// fails.
pub(crate) fn read<T>(
    path: &Path,
    kind: Kind,
    convert: impl FnOnce(&Document<'_>) -> Result<T, FileError>,
) -> Result<T, FileError> {
    let text = config::regular_file::read_text(path, MAX_BYTES)
        .map_err(|source| FileError::io(path, "read", source))?;
    parse(path, &text, kind, convert)
}

/// [`read`] for text that is already in memory.
pub(crate) fn parse<T>(
    path: &Path,
    text: &str,
    kind: Kind,
    convert: impl FnOnce(&Document<'_>) -> Result<T, FileError>,
) -> Result<T, FileError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    if text.trim().is_empty() {
        let expected = format!("`{} = …` or XML", kind.version_keyword());
        return Err(FileError::value(path, FileLocation::Line(1), "content", "empty", expected));
    }
    let checked = |document: Document<'_>| {
        let keyword = kind.version_keyword();
        let version = document.header.require(keyword)?;
        if !kind.versions().contains(&version.value) {
            return Err(document.header.refuse(version, format!("one of {}", kind.versions().join(", "))));
        }
        if document.segments.is_empty() {
            let place = FileLocation::Line(document.header.line);
            return Err(FileError::value(path, place, "META_START", "missing", "at least one segment"));
        }
        convert(&document)
    };
    check_characters(path, text)?;
    if text.trim_start().starts_with('<') {
        let tree = xml::tree(path, text, kind)?;
        checked(xml::document(path, text, &tree, kind)?)
    } else {
        checked(kvn::document(path, text, kind)?)
    }
}

/// Refuses control characters, which no value of either notation contains and a writer could not repeat. Tabs
/// are accepted as blanks.
fn check_characters(path: &Path, text: &str) -> Result<(), FileError> {
    for (line, number) in text.lines().zip(1..) {
        if let Some(found) = line.chars().find(|found| found.is_control() && *found != '\t') {
            let found = format!("the control character {}", found.escape_unicode());
            let place = FileLocation::Line(number);
            return Err(FileError::value(path, place, "text", &found, "printable characters and blanks"));
        }
    }
    Ok(())
}
