//! Error type of reading and writing files.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::{fmt, io};

use config::toml_file::TomlError;
use thiserror::Error;

/// Location of a value in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileLocation {
    /// A line of a text file, counted from 1.
    Line(u64),
    /// A row of a table that is not a text file, counted from 0.
    Row(u64),
    /// A pixel; the first is (0, 0).
    Pixel {
        /// Column of the pixel.
        x: usize,
        /// Row of the pixel.
        y: usize,
    },
    /// Header of the file.
    Header,
    /// The whole file, a directory, or a property of the file that is stated elsewhere.
    Whole,
}

/// Formats the location as a continuation of the file name: `, line 3`.
impl fmt::Display for FileLocation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, ", line {line}"),
            Self::Row(row) => write!(f, ", row {row}"),
            Self::Pixel { x, y } => write!(f, ", pixel ({x}, {y})"),
            Self::Header => f.write_str(", header"),
            Self::Whole => Ok(()),
        }
    }
}

/// Reason why a file cannot be read or written.
#[derive(Debug, Error)]
pub enum FileError {
    /// An error of the operating system.
    #[error("{path}: cannot {doing}: {source}", path = path.display())]
    Io {
        /// Path of the file or directory.
        path: PathBuf,
        /// The attempted operation: `open`, `create`, `read`, `write`.
        doing: &'static str,
        /// Error reported by the operating system.
        source: io::Error,
    },
    /// An invalid value.
    #[error("{path}{place}: `{field}` is `{value}`, expected {expected}", path = path.display())]
    Value {
        /// Path of the file.
        path: PathBuf,
        /// Location in the file.
        place: FileLocation,
        /// Column, keyword or property.
        field: String,
        /// The rejected value.
        value: String,
        /// Description of the allowed values.
        expected: String,
    },
    /// A file that does not have the expected format, is truncated, or uses an unsupported part of the
    /// format.
    #[error("{path}: not a readable {format} file: {reason}", path = path.display())]
    Format {
        /// Path of the file.
        path: PathBuf,
        /// The expected format.
        format: &'static str,
        /// Description of the fault.
        reason: String,
    },
    /// A mistake in a TOML file, with its location.
    #[error(transparent)]
    Toml(Box<TomlError>),
    /// A table without a required column.
    #[error("{path}: column `{column}` is missing; found {found}", path = path.display())]
    MissingColumn {
        /// Path of the table.
        path: PathBuf,
        /// The missing column.
        column: String,
        /// The columns found.
        found: String,
    },
    /// A table with an unknown column.
    #[error("{path}: unknown column `{column}`; did you mean `{nearest}`?", path = path.display())]
    UnknownColumn {
        /// Path of the table.
        path: PathBuf,
        /// The unknown column.
        column: String,
        /// The most similar known name.
        nearest: String,
    },
    /// A frame of a dataset with a missing or invalid image.
    #[error("{path}, line {line}: the image `{file}` of frame {frame} is {reason}", path = path.display())]
    MissingImage {
        /// Path of the table that names the image.
        path: PathBuf,
        /// Line of the frame in the table.
        line: u64,
        /// Number of the frame.
        frame: u64,
        /// Name of the image in the table.
        file: String,
        /// Fault of the image.
        reason: &'static str,
    },
    /// An output path that is already in use.
    #[error("{path} {reason}; give another folder with --out", path = path.display())]
    OutputTaken {
        /// The output path.
        path: PathBuf,
        /// Reason why the path cannot be used.
        reason: &'static str,
    },
    /// An existing file that must not be replaced.
    #[error("{path} {reason}, expected {expected}", path = path.display())]
    NotReplaced {
        /// Path of the file.
        path: PathBuf,
        /// Reason why the file is kept.
        reason: String,
        /// Description of the files that may be replaced.
        expected: String,
    },
    /// A value that the contract does not allow.
    #[error("{path}: {source}", path = path.display())]
    Contract {
        /// Path of the file.
        path: PathBuf,
        /// The value and the reason.
        source: contract::ContractError,
    },
}

/// Opens a file from an untrusted source for reading; a pipe or a device is rejected.
pub fn open_regular(path: &Path) -> Result<File, FileError> {
    config::regular_file::open(path).map_err(|source| FileError::io(path, "open", source))
}

impl FileError {
    /// Creates an error of the operating system; `doing` is the attempted operation.
    pub fn io(path: &Path, doing: &'static str, source: io::Error) -> Self {
        Self::Io { path: path.to_owned(), doing, source }
    }

    /// Creates the error of a file that is damaged or does not have the expected format.
    pub fn format(path: &Path, format: &'static str, reason: impl ToString) -> Self {
        Self::Format { path: path.to_owned(), format, reason: reason.to_string() }
    }

    /// Creates the error of an invalid value.
    pub fn value(
        path: &Path,
        place: FileLocation,
        field: impl Into<String>,
        value: impl ToString,
        expected: impl Into<String>,
    ) -> Self {
        Self::Value {
            path: path.to_owned(),
            place,
            field: field.into(),
            value: value.to_string(),
            expected: expected.into(),
        }
    }

    /// Creates the error for a file whose values the contract does not allow.
    pub fn contract(path: &Path, source: impl Into<contract::ContractError>) -> Self {
        Self::Contract { path: path.to_owned(), source: source.into() }
    }
}

/// Creates a file for writing, and the missing folders above it; an existing file is an error and is not
/// overwritten.
pub fn create_new(path: &Path) -> Result<File, FileError> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|source| FileError::io(path, "create", source))?;
    }
    File::create_new(path).map_err(|source| FileError::io(path, "create", source))
}
