//! Result of a run.

use std::fmt;
use std::path::Path;

use contract::{FailedStarts, Interface};
use files::{Failure, FileError};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// Maximum size of a score file, bytes.
const MAX_JSON_BYTES: u64 = 1 << 28;

/// Result of a run.
#[derive(Debug)]
pub struct RunResult<S> {
    /// Score and verdicts of the run.
    pub scored: S,
    /// First failure of the pipeline, if any.
    pub first_failure: Option<FirstFailure>,
    /// Unprocessed frames, if the pipeline never started. The frames of its failed starts were processed, and
    /// are scored.
    pub incomplete: Option<IncompleteRun>,
}

/// Summary of outcomes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AnswerSummary {
    /// Subject of the summary: a key of a JSON document.
    pub key: &'static str,
    /// Counts by name.
    pub counts: IndexMap<&'static str, u64>,
    /// Summary as one line of text.
    pub text: String,
}

/// Unprocessed part of a run whose pipeline never started.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct IncompleteRun {
    /// Number of unprocessed images; 0 if all images of the run were processed.
    pub frames: u64,
    /// Number of failed starts, one for each processed image.
    pub failed_starts: u32,
    /// Reason of the last failed start.
    pub reason: String,
}

impl IncompleteRun {
    /// Returns the unprocessed part of a run of `images` images.
    pub(crate) fn from_failed_starts(images: u64, FailedStarts { count, reason }: &FailedStarts) -> Self {
        let frames = images.saturating_sub(u64::from(*count));
        Self { frames, failed_starts: *count, reason: reason.clone() }
    }

    /// Returns the unprocessed part of the run in a directory, from its `score.json`; `None` for a complete
    /// run, or without that file.
    ///
    /// # Errors
    /// A [`Failure`] that names the file when it cannot be read.
    pub fn read_from_directory(directory: &Path) -> Result<Option<Self>, Failure> {
        /// The relevant part of `score.json`.
        #[derive(Deserialize)]
        struct ScoreDocument {
            #[serde(rename = "not_flown")]
            incomplete: Option<IncompleteRun>,
        }
        let path = directory.join("score.json");
        if !path.is_file() {
            return Ok(None);
        }
        let text = config::regular_file::read_text(&path, MAX_JSON_BYTES)
            .map_err(|source| FileError::io(&path, "read", source))?;
        let document: ScoreDocument =
            serde_json::from_str(&text).map_err(|error| FileError::format(&path, "score", error))?;
        Ok(document.incomplete)
    }
}

impl fmt::Display for IncompleteRun {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frames, failed_starts, reason } = self;
        let failed = FailedStarts { count: *failed_starts, reason: reason.clone() };
        write!(f, "{failed}; {failed_starts} frames were run and scored, {frames} were not run")
    }
}

/// First image on which a pipeline failed, and the reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FirstFailure {
    /// Number of the image.
    pub frame: u64,
    /// Reason of the failure.
    pub reason: String,
}

impl FirstFailure {
    /// Returns the failure of the pipeline on an image, if it failed.
    pub(crate) fn from_outcome<I: Interface>(frame: u64, outcome: &I::Outcome) -> Option<Self> {
        I::failure(outcome).map(|reason| Self { frame, reason: reason.to_owned() })
    }
}
