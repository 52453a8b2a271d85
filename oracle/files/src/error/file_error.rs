//! The one error type of reading and writing.

use std::fmt;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::toml_file::TomlError;

/// Where in a file a value stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileLocation {
    /// A line of a text file, counted from 1.
    Line(u64),
    /// A row of a table without lines, counted from 0.
    Row(u64),
    /// A pixel; the first is (0, 0).
    Pixel {
        /// Column.
        x: usize,
        /// Row.
        y: usize,
    },
    /// The file's header.
    Header,
    /// The file as a whole, a folder, or what is told of it from outside.
    Whole,
}

/// As it goes on from the file's name: `, line 3`.
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

/// Why a file cannot be read or written.
#[derive(Debug, Error)]
pub enum FileError {
    /// The operating system refused.
    #[error("{path}: cannot {doing}: {source}", path = path.display())]
    Io {
        /// The file or directory.
        path: PathBuf,
        /// What was tried: `open`, `create`, `read`, `write`.
        doing: &'static str,
        /// The system's reason.
        source: io::Error,
    },
    /// A value that is not what it should be.
    #[error("{path}{place}: `{field}` is `{value}`, expected {expected}", path = path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// Where in it.
        place: FileLocation,
        /// Column, keyword or property.
        field: String,
        /// The value met.
        value: String,
        /// What is allowed.
        expected: String,
    },
    /// A file that is not of its format, is cut short, or uses a part of the format that is not supported.
    #[error("{path}: not a readable {format} file: {reason}", path = path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// The format that was tried.
        format: &'static str,
        /// What is wrong.
        reason: String,
    },
    /// A mistake in a TOML file, with its place.
    #[error(transparent)]
    Toml(Box<TomlError>),
    /// A table without a column that it must have.
    #[error("{path}: column `{column}` is missing; found {found}", path = path.display())]
    MissingColumn {
        /// The table.
        path: PathBuf,
        /// The missing column.
        column: String,
        /// The columns that are there.
        found: String,
    },
    /// A table with a column that nobody knows.
    #[error("{path}: unknown column `{column}`; did you mean `{nearest}`?", path = path.display())]
    UnknownColumn {
        /// The table.
        path: PathBuf,
        /// The column met.
        column: String,
        /// The known name nearest to it.
        nearest: String,
    },
    /// A frame of a dataset whose image is not there.
    #[error("{path}, line {line}: the image `{file}` of frame {frame} is {reason}", path = path.display())]
    MissingImage {
        /// The table that names the image.
        path: PathBuf,
        /// Line of the frame.
        line: u64,
        /// Number of the frame.
        frame: u64,
        /// The image, as named there.
        file: String,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// A place for output that is taken.
    #[error("{path} {reason}; give another folder with --out", path = path.display())]
    OutputTaken {
        /// The directory.
        path: PathBuf,
        /// Why it cannot be used.
        reason: &'static str,
    },
    /// A file in whose place a new one was to be.
    #[error("{path} {reason}, expected {expected}", path = path.display())]
    NotReplaced {
        /// The file.
        path: PathBuf,
        /// Why it stays.
        reason: String,
        /// What may be there.
        expected: String,
    },
    /// A value that the contract refuses.
    #[error("{path}: {source}", path = path.display())]
    Contract {
        /// The file.
        path: PathBuf,
        /// Which value, and why.
        source: contract::ContractError,
    },
}

/// Opens a file of anybody's making for reading; a pipe or a device is refused.
pub fn open_regular(path: &Path) -> Result<File, FileError> {
    sim::regular_file::open(path).map_err(|source| FileError::io(path, "open", source))
}

impl FileError {
    /// An error of the operating system while `doing` something to a file.
    pub fn io(path: &Path, doing: &'static str, source: io::Error) -> Self {
        Self::Io { path: path.to_owned(), doing, source }
    }

    /// A file that is not of its format or is damaged.
    pub fn format(path: &Path, format: &'static str, reason: impl ToString) -> Self {
        Self::Format { path: path.to_owned(), format, reason: reason.to_string() }
    }

    /// A value that is not as expected.
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

    pub(crate) fn contract(path: &Path, source: impl Into<contract::ContractError>) -> Self {
        Self::Contract { path: path.to_owned(), source: source.into() }
    }
}

/// Creates a file for writing; one that exists is refused, not overwritten.
pub(crate) fn create_new(path: &Path) -> Result<File, FileError> {
    File::create_new(path).map_err(|source| FileError::io(path, "create", source))
}
