//! Kinds of result directories, and reading of files that several kinds contain.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use files::{Failure, FileError, Row, TableReader};
use serde::de::DeserializeOwned;

use crate::worlds::{OtherReport, other_reports};

/// Maximum size of a JSON file, bytes.
const MAX_JSON_BYTES: u64 = 1 << 28;

/// Kind of a directory of results.
#[derive(Clone, Copy)]
pub enum ResultKind {
    /// A run, with `run.toml`.
    Run,
    /// A study, with `summary.json`.
    Study,
    /// Other results, registered by a world.
    Other(OtherReport),
}

impl ResultKind {
    /// Determines the kind of `directory` from its files.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a directory that contains none of these files.
    pub fn from_directory(directory: &Path) -> Result<Self, Failure> {
        let has = |name: &str| directory.join(name).is_file();
        if has("run.toml") {
            Ok(Self::Run)
        } else if let Some(other) = other_reports().into_iter().find(|other| has(other.file)) {
            Ok(Self::Other(other))
        } else if has("summary.json") {
            Ok(Self::Study)
        } else if has("study.json") || has("study.toml") {
            Err(Failure::Usage(format!(
                "{}: no `summary.json` in it, expected a complete study; run `boresight study run` again to \
                 finish it",
                directory.display()
            )))
        } else if directory.is_dir() {
            let mut files = vec!["`run.toml`", "`summary.json`"];
            let others = other_reports();
            let names: Vec<String> = others.iter().map(|other| format!("`{}`", other.file)).collect();
            files.extend(names.iter().map(String::as_str));
            let mut results = vec!["a run", "a study"];
            results.extend(others.iter().map(|other| other.results));
            Err(Failure::Usage(format!(
                "{}: none of {} in it, expected the directory of {}",
                directory.display(),
                files.join(", "),
                results.join(", or ")
            )))
        } else {
            Err(Failure::Usage(format!("{}: expected a directory of results", directory.display())))
        }
    }
}

/// Returns the failure for a missing file of a run.
pub fn missing(directory: &Path, name: &str) -> Failure {
    Failure::Usage(format!(
        "{}: is missing, expected the directory of a run or of a rendered dataset",
        directory.join(name).display()
    ))
}

/// Returns the table rows of each given frame, in the order of `frames`, read in one pass; no rows without a
/// table.
pub fn rows_of_each<R: Row + Clone>(path: Option<&Path>, frames: &[u64]) -> Result<Vec<Vec<R>>, Failure> {
    let mut found = BTreeMap::new();
    if let Some(path) = path {
        let mut table = TableReader::<R>::open(path)?;
        for &frame in &BTreeSet::from_iter(frames) {
            found.insert(frame, table.rows_of(*frame)?);
        }
    }
    Ok(frames.iter().map(|frame| found.get(frame).cloned().unwrap_or_default()).collect())
}

/// Reads a JSON document.
pub fn read_json<T: DeserializeOwned>(path: &Path, format: &'static str) -> Result<T, Failure> {
    let text = config::regular_file::read_text(path, MAX_JSON_BYTES).map_err(|source| FileError::Io {
        path: path.to_owned(),
        doing: "read",
        source,
    })?;
    serde_json::from_str(&text).map_err(|error| {
        FileError::Format { path: path.to_owned(), format, reason: error.to_string() }.into()
    })
}
