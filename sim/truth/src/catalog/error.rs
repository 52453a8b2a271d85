//! Errors of a catalogue.

use std::path::PathBuf;

use thiserror::Error;

/// Reason why a catalogue cannot be used.
#[derive(Debug, Error)]
pub enum CatalogError {
    /// The file cannot be read.
    #[error("catalogue {}: {source}", path.display())]
    Io {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// The file has none of the known formats.
    #[error(
        "catalogue {}: unknown format; expected CSV (name ending in .csv), hip2.dat (I/311) or \
         hip_main.dat (I/239)",
        path.display()
    )]
    UnknownFormat {
        /// Path of the file.
        path: PathBuf,
    },
    /// A field has an invalid value.
    #[error(
        "catalogue {}, line {line}, column {column}: {field} is `{value}`, expected {expected}",
        path.display()
    )]
    Field {
        /// Path of the file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Position of the field's first character in its line, counted from 1.
        column: usize,
        /// Name of the field in its format.
        field: &'static str,
        /// Text of the field.
        value: String,
        /// Allowed values.
        expected: &'static str,
    },
    /// A line does not have the structure of its format.
    #[error("catalogue {}, line {line}: {problem}", path.display())]
    Line {
        /// Path of the file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Description of the problem.
        problem: String,
    },
    /// A column of a CSV file has an unknown name.
    #[error("catalogue {}: unknown column `{name}`, did you mean `{nearest}`?", path.display())]
    UnknownColumn {
        /// Path of the file.
        path: PathBuf,
        /// Name of the column.
        name: String,
        /// Known name that is most similar.
        nearest: &'static str,
    },
    /// A CSV file lacks a column that every catalogue needs.
    #[error("catalogue {}: the column {name} is missing", path.display())]
    MissingColumn {
        /// Path of the file.
        path: PathBuf,
        /// Name of the column, or the columns of which at least one is required.
        name: &'static str,
    },
    /// Two stars have the same number.
    #[error("catalogue {}, line {line}: the id {id} is already used in line {first_line}", path.display())]
    DuplicateId {
        /// Path of the file.
        path: PathBuf,
        /// Line of the second star, counted from 1.
        line: usize,
        /// Number of the stars.
        id: u32,
        /// Line of the first star, counted from 1.
        first_line: usize,
    },
}
