//! TOML files that are one table of ours: read and checked, checked and written.

use std::path::Path;

use contract::ContractError;
use pipeline::PipelineError;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::error::Place;
use super::{FileError, WholeFile};
use crate::toml_file;

/// A value that is not allowed in a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Refused {
    /// Its dotted path in the file, as `cameras[1].focal_length_mm`.
    path: String,
    value: String,
    expected: String,
}

impl Refused {
    pub(super) fn new(path: impl Into<String>, value: impl ToString, expected: impl Into<String>) -> Self {
        Self { path: path.into(), value: value.to_string(), expected: expected.into() }
    }

    /// Of a value that the contract refuses: its path there begins with a table's name, in this file it begins with `table`.
    pub(super) fn by_contract(table: &str, error: &ContractError) -> Self {
        match error {
            ContractError::OutOfRange { field, value, expected } => {
                let rest = field.split_once('.').map_or("", |(_, rest)| rest);
                Self::new(format!("{table}.{rest}"), value, *expected)
            }
            other => Self::new(table, "not allowed", other.to_string()),
        }
    }

    /// Of a parameter of a pipeline whose configuration is the table `table`.
    pub(super) fn by_pipeline(table: &str, error: &PipelineError) -> Self {
        match error {
            PipelineError::Parameter { field, value, expected } => {
                Self::new(format!("{table}.{field}"), value, *expected)
            }
            PipelineError::Contract(error) => Self::by_contract(table, error),
        }
    }
}

/// A table that is a file of its own.
pub(super) trait TomlTable: Serialize + DeserializeOwned {
    /// Checks every value.
    fn check(&self) -> Result<(), Refused>;
}

/// Checks the bits of a digitiser, the key `bit_depth`.
pub(super) fn check_bit_depth(bit_depth: u8) -> Result<(), Refused> {
    if (1..=16).contains(&bit_depth) { Ok(()) } else { Err(Refused::new("bit_depth", bit_depth, "1 to 16")) }
}

/// Reads and checks a file.
///
/// # Errors
/// [`FileError::Io`]; [`FileError::Toml`] with line and column for what is not TOML, for a wrong, unknown or missing field,
/// and for a value that is not allowed.
pub(super) fn read<T: TomlTable>(path: &Path) -> Result<T, FileError> {
    let text = toml_file::read_text(path).map_err(|source| FileError::io(path, "read", source))?;
    let table: T = toml_file::parse(path, &text).map_err(FileError::Toml)?;
    table.check().map_err(|Refused { path: key, value, expected }| {
        FileError::Toml(toml_file::refuse(path, &text, &key, format!("is {value}, expected {expected}")))
    })?;
    Ok(table)
}

/// Writes a file, at once or not at all.
///
/// # Errors
/// [`FileError::Io`] when it exists or cannot be written; [`FileError::Value`] for what could not be read back.
pub(super) fn write<T: TomlTable>(table: &T, path: &Path) -> Result<(), FileError> {
    table.check().map_err(|Refused { path: key, value, expected }| {
        FileError::value(path, Place::Whole, key, value, expected)
    })?;
    let text = toml::to_string(table).map_err(|error| FileError::format(path, "TOML", error))?;
    WholeFile::with_text(path, &text)?.commit_new()
}
