//! Parts of a world: its datasets, the writers of its outcomes, its scorers.

use std::path::{Path, PathBuf};

use contract::Interface;
use files::{Failure, FileError};
use indexmap::IndexMap;
use score::{Figure, UnitTable};
use serde::Serialize;

use super::{ImageOf, OutcomeOf, SetupOf, TelemetryOf, World};
use crate::run_result::AnswerSummary;

/// A dataset for a pipeline, before its images are read.
pub struct OpenDataset<W: World> {
    /// Setup that a pipeline receives before the first image.
    pub setup: SetupOf<W>,
    /// Parameters of the built-in pipeline.
    pub config: W::Config,
    /// Number of images, if known.
    pub count: Option<u64>,
    /// Images in order.
    pub images: Images<W>,
}

/// Images with their telemetry, read one by one.
pub type Images<W> = Box<dyn Iterator<Item = Result<(ImageOf<W>, TelemetryOf<W>), Failure>>>;

/// An image of a run with the outcome of the pipeline.
pub struct FrameAnswer<W: World> {
    /// Image as received.
    pub image: ImageOf<W>,
    /// Telemetry that the pipeline received.
    pub telemetry: TelemetryOf<W>,
    /// Ground truth.
    pub truth: W::Truth,
    /// Outcome of the pipeline.
    pub outcome: OutcomeOf<W>,
}

/// A pipeline that also receives the truth, for the one stage whose result it replaces.
pub trait InformedPipeline<W: World> {
    /// Processes an image.
    ///
    /// # Errors
    /// A [`Failure`] when the truth is invalid.
    fn process(
        &mut self,
        image: &ImageOf<W>,
        telemetry: &TelemetryOf<W>,
        truth: &W::Truth,
    ) -> Result<OutcomeOf<W>, Failure>;
}

/// Writes the files common to a run and a rendered dataset: all except outcomes and score.
pub trait Dataset<W: World> {
    /// Adds a frame.
    ///
    /// # Errors
    /// [`FileError`] when a file cannot be written.
    fn add(
        &mut self,
        image: &ImageOf<W>,
        telemetry: TelemetryOf<W>,
        truth: W::Truth,
    ) -> Result<(), FileError>;

    /// Completes the files, the telemetry last: it marks the directory as a dataset.
    ///
    /// # Errors
    /// [`FileError`] when a file cannot be written.
    fn finish(self) -> Result<(), FileError>;
}

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

/// Scores outcomes one after the other.
pub trait Scorer<W: World> {
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
pub(crate) fn paths<const N: usize>(files: &[PathBuf]) -> Result<[&Path; N], FileError> {
    let paths: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    let count = paths.len();
    let first = files.first().map_or_else(PathBuf::new, Clone::clone);
    paths
        .try_into()
        .map_err(|_| FileError::format(&first, "measurements", format!("{count} files, expected {N}")))
}
