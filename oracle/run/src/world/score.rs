//! Outcomes of a world: their writers, and the score.

use std::path::{Path, PathBuf};

use contract::Interface;
use files::{Failure, FileError, file_beside};
use indexmap::IndexMap;
use scenario::AttitudeChoice;
use score::{Figure, FigureSpec, UnitTable};
use serde::Serialize;

use super::{OutcomeOf, TelemetryOf, WorldFrames};
use crate::run_result::AnswerSummary;

/// Outcomes and score of a world.
pub trait WorldScore: WorldFrames {
    /// Writes outcomes.
    type Answers: Answers<Self::Interface>;
    /// Scores outcomes.
    type Scorer<'a>: Scorer<Self>
    where
        Self: 'a;
    /// A scored run.
    type Judgement: Judgement + Send + 'static;

    /// Returns the figures of a score. Figures of several worlds with the same key have the same definition.
    fn figures() -> Vec<FigureSpec>;

    /// Returns all causes that a unit's verdict may have, each as (verdict, cause) in the terms of
    /// [`score::UnitVerdict`]; a study counts them.
    fn causes() -> Vec<(&'static str, &'static str)> {
        Vec::new()
    }

    /// Returns a scorer without any frame.
    fn scorer(&self) -> Self::Scorer<'_>;

    /// Scores measurements of an external or a built-in pipeline against the truth in `directory`, with the
    /// clusters or motions in the file `beside`. `attitude` is granted to measurements that have only a
    /// centroid; it overrides the run's scenario.
    ///
    /// # Errors
    /// A [`Failure`] for a file that cannot be read, a row of a frame that the truth does not contain, or an
    /// attitude in a world without it.
    fn score_files(
        directory: &Path,
        measurements: &Path,
        beside: Option<&Path>,
        attitude: Option<AttitudeChoice>,
    ) -> Result<Self::Judgement, Failure>;
}

/// Scores outcomes one after the other.
pub trait Scorer<W: WorldScore> {
    /// Scores an outcome with the precision of a run's files.
    ///
    /// # Errors
    /// A [`Failure`] for a truth that cannot be scored.
    fn add(
        &mut self,
        truth: &W::Truth,
        telemetry: &TelemetryOf<W>,
        outcome: &OutcomeOf<W>,
    ) -> Result<(), Failure>;

    /// Returns the score with the units from which it was counted.
    fn finish(self) -> W::Judgement;
}

/// Writes the outcomes of a pipeline.
pub trait Answers<I: Interface>: Sized {
    /// Names of the files that are written beside `measurements.csv`.
    const BESIDE: &'static [&'static str];

    /// Returns the paths of the files: the measurements first, then those of [`Self::BESIDE`].
    fn files(measurements: &Path) -> Vec<PathBuf> {
        let beside = Self::BESIDE.iter().map(|name| file_beside(measurements, name));
        [measurements.to_owned()].into_iter().chain(beside).collect()
    }

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

/// Returns the failure for a truth that cannot be scored.
pub fn unscorable(error: score::ScoreError) -> Failure {
    Failure::Usage(format!("the truth cannot be scored: {error}"))
}
