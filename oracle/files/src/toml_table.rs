//! TOML files that contain one table of Boresight: checked after reading and before writing.

use std::path::Path;

use config::toml_file;
use contract::OutOfRange;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::FileLocation;
use crate::{AtomicFile, FileError};

/// A table that is stored as a file of its own.
pub trait TomlTable: Serialize + DeserializeOwned {
    /// Checks every value.
    fn check(&self) -> Result<(), OutOfRange>;
}

/// Reads and checks a file.
///
/// # Errors
/// [`FileError::Io`]; [`FileError::Toml`] with line and column for invalid TOML, for a wrong, unknown or
/// missing field, and for a value that is not allowed.
pub fn read<T: TomlTable>(path: &Path) -> Result<T, FileError> {
    let text = toml_file::read_text(path).map_err(|source| FileError::io(path, "read", source))?;
    let table: T = toml_file::parse(path, &text).map_err(FileError::Toml)?;
    table.check().map_err(|error| FileError::Toml(toml_file::out_of_range(path, &text, &error)))?;
    Ok(table)
}

/// Writes a file, which appears complete or not at all.
///
/// # Errors
/// [`FileError::OutputTaken`] if the file exists; [`FileError::Io`] if it cannot be written;
/// [`FileError::Value`] for a value that could not be read back.
pub fn write<T: TomlTable>(table: &T, path: &Path) -> Result<(), FileError> {
    table.check().map_err(|OutOfRange { path: key, value, expected }| {
        FileError::value(path, FileLocation::Whole, key, value, expected)
    })?;
    let text = toml::to_string(table).map_err(|error| FileError::format(path, "TOML", error))?;
    AtomicFile::with_text(path, &text)?.commit_new()
}
