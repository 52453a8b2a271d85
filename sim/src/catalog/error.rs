//! What can be wrong with a catalogue.

use std::path::PathBuf;

use thiserror::Error;

/// Why a catalogue cannot be used.
#[derive(Debug, Error)]
pub enum CatalogError {
    /// The file cannot be read at all.
    #[error("catalogue {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file is none of the formats known.
    #[error(
        "catalogue {}: the format is not known; expected CSV (name ending in .csv), hip2.dat (I/311) or \
         hip_main.dat (I/239)",
        path.display()
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// A field that is not what it should be.
    #[error(
        "catalogue {}, line {line}, column {column}: {field} is `{value}`, expected {expected}",
        path.display()
    )]
    Field {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// First character of the field in its line, counted from 1.
        column: usize,
        /// Name of the field in its format.
        field: &'static str,
        /// What stands there.
        value: String,
        /// What is allowed there.
        expected: &'static str,
    },
    /// A line that does not have the shape of its format.
    #[error("catalogue {}, line {line}: {problem}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// What is wrong.
        problem: String,
    },
    /// A column of a CSV file that means nothing here.
    #[error("catalogue {}: the column `{name}` is not known, did you mean `{nearest}`?", path.display())]
    UnknownColumn {
        /// The file.
        path: PathBuf,
        /// The name met.
        name: String,
        /// The known name that is most like it.
        nearest: &'static str,
    },
    /// A CSV file without a column that every catalogue needs.
    #[error("catalogue {}: the column {name} is missing", path.display())]
    MissingColumn {
        /// The file.
        path: PathBuf,
        /// The column, or the columns of which one is needed.
        name: &'static str,
    },
    /// Two stars of one number.
    #[error("catalogue {}, line {line}: the id {id} was already given in line {first_line}", path.display())]
    DuplicateId {
        /// The file.
        path: PathBuf,
        /// Line of the second star, counted from 1.
        line: usize,
        /// The number.
        id: u32,
        /// Line of the first star, counted from 1.
        first_line: usize,
    },
}
