//! Which kind of directory it is, and files that several kinds have.

use std::path::Path;

use serde::de::DeserializeOwned;

use crate::failure::Failure;
use crate::files::FileError;

/// Longest JSON file that is read, bytes.
const LONGEST_JSON: u64 = 1 << 28;

/// What a directory holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResultKind {
    /// A run: `run.toml`.
    Run,
    /// A study: `summary.json`.
    Study,
    /// The answer to requirements: `visibility.json`.
    Visibility,
}

impl ResultKind {
    /// What `directory` holds, by its files.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a directory that holds none of them.
    pub fn of(directory: &Path) -> Result<Self, Failure> {
        let has = |name: &str| directory.join(name).is_file();
        if has("run.toml") {
            Ok(Self::Run)
        } else if has("visibility.json") {
            Ok(Self::Visibility)
        } else if has("summary.json") {
            Ok(Self::Study)
        } else if has("study.json") || has("study.toml") {
            Err(Failure::Usage(format!(
                "{}: there is no `summary.json`, expected a study that is complete: `boresight study run` again does what is missing",
                directory.display()
            )))
        } else if directory.is_dir() {
            Err(Failure::Usage(format!(
                "{}: there is neither `run.toml` nor `summary.json` nor `visibility.json`, expected the directory of a run, of a study \
                 or of `boresight visibility --out`",
                directory.display()
            )))
        } else {
            Err(Failure::Usage(format!("{}: expected a directory of results", directory.display())))
        }
    }
}

/// A file of a run that is not there.
pub(super) fn missing(directory: &Path, name: &str) -> Failure {
    Failure::Usage(format!(
        "{}: is missing, expected the directory of a run: of a rendered dataset there is nothing to report yet",
        directory.join(name).display()
    ))
}

/// Reads a JSON document.
pub(super) fn read_json<T: DeserializeOwned>(path: &Path, format: &'static str) -> Result<T, Failure> {
    let text = sim::regular_file::read_text(path, LONGEST_JSON).map_err(|source| FileError::Io {
        path: path.to_owned(),
        doing: "read",
        source,
    })?;
    serde_json::from_str(&text).map_err(|error| {
        FileError::Format { path: path.to_owned(), format, reason: error.to_string() }.into()
    })
}
