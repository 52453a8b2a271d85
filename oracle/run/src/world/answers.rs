//! Outcomes of a run: their writers, and the score.

use std::path::{Path, PathBuf};

use contract::Interface;
use files::FileError;
use indexmap::IndexMap;
use score::{Figure, UnitTable};
use serde::Serialize;

use crate::run_result::AnswerSummary;

/// Writes the outcomes of a pipeline.
pub trait Answers<I: Interface>: Sized {
    /// Returns the paths of the files: the measurements first, then the files beside them.
    fn files(measurements: &Path) -> Vec<PathBuf>;

    /// Creates the files.
    ///
    /// # Errors
    /// [`FileError`] when a file exists or cannot be created.
    fn create(files: &[PathBuf]) -> Result<Self, FileError>;

    /// Adds an outcome.
    ///
    /// # Errors
    /// [`FileError`] when a file cannot be written.
    fn add(&mut self, number: u64, telemetry: &I::Telemetry, outcome: &I::Outcome) -> Result<(), FileError>;

    /// Returns a summary of all outcomes so far, if the world provides one.
    fn summary(&self, _setup: &I::Setup) -> Option<AnswerSummary> {
        None
    }

    /// Completes the files, the measurements last: without them, the other files are not used.
    ///
    /// # Errors
    /// [`FileError`] when a file cannot be written.
    fn finish(self) -> Result<(), FileError>;
}

/// A scored run.
pub trait Judgement {
    /// Content of `score.json`.
    type Score: Serialize;

    /// Returns the score.
    fn score(&self) -> &Self::Score;

    /// Returns the figures over all frames.
    fn figures(&self) -> &IndexMap<String, Figure>;

    /// Returns the run frame by frame, for a comparison with another run.
    fn units(&self) -> UnitTable;

    /// Adds the scored run of another pipeline on the same frames, to be shown beside this one.
    fn show_comparison(&mut self, _: Self)
    where
        Self: Sized,
    {
    }
}

/// Returns the paths of exactly as many files as a writer of outcomes has.
pub fn paths<const N: usize>(files: &[PathBuf]) -> Result<[&Path; N], FileError> {
    let paths: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    let count = paths.len();
    let first = files.first().map_or_else(PathBuf::new, Clone::clone);
    paths
        .try_into()
        .map_err(|_| FileError::format(&first, "measurements", format!("{count} files, expected {N}")))
}
