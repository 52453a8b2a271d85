//! What a run gave.

use std::fmt;
use std::path::Path;

use contract::{FailedStarts, Interface};
use files::{Failure, FileError};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// Bytes of a score's file that are read, at most.
const LONGEST_JSON: u64 = 1 << 28;

/// What a run gave.
#[derive(Debug)]
pub struct RunResult<S> {
    /// Score and verdicts.
    pub scored: S,
    /// The first failure of the pipeline, if it failed at all.
    pub first_failure: Option<FirstFailure>,
    /// What was not flown, where the pipeline never started. Its failed starts were flown, and are scored.
    pub incomplete: Option<IncompleteRun>,
}

/// Answers in a few numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AnswerSummary {
    /// What they are of: a key of a JSON document.
    pub key: &'static str,
    /// The numbers, by word.
    pub counts: IndexMap<&'static str, u64>,
    /// The same as a line for people.
    pub text: String,
}

/// What was not flown of a run whose pipeline never started.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct IncompleteRun {
    /// Images that were not flown; 0 of a run that has no more than were flown.
    pub frames: u64,
    /// Starts that failed, one for each image that was flown.
    pub failed_starts: u32,
    /// Why the last one failed.
    pub reason: String,
}

impl IncompleteRun {
    /// What is missing of a run of so many images.
    pub(crate) fn from_failed_starts(images: u64, FailedStarts { count, reason }: &FailedStarts) -> Self {
        let frames = images.saturating_sub(u64::from(*count));
        Self { frames, failed_starts: *count, reason: reason.clone() }
    }

    /// What was not flown of the run in a directory, as its `score.json` tells; `None` of a complete run, and without that file.
    ///
    /// # Errors
    /// A [`Failure`] that names the file when it cannot be read.
    pub fn read_from_directory(directory: &Path) -> Result<Option<Self>, Failure> {
        /// The part of `score.json` that tells it.
        #[derive(Deserialize)]
        struct ScoreDocument {
            #[serde(rename = "not_flown")]
            incomplete: Option<IncompleteRun>,
        }
        let path = directory.join("score.json");
        if !path.is_file() {
            return Ok(None);
        }
        let text = sim::regular_file::read_text(&path, LONGEST_JSON)
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
        write!(f, "{failed}; {failed_starts} frames were flown and are scored, {frames} were not flown")
    }
}

/// The first image that a pipeline failed at, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FirstFailure {
    /// Number of the image.
    pub frame: u64,
    /// The reason.
    pub reason: String,
}

impl FirstFailure {
    /// That of an image, if the pipeline itself failed at it.
    pub(crate) fn from_outcome<I: Interface>(frame: u64, outcome: &I::Outcome) -> Option<Self> {
        I::failure(outcome).map(|reason| Self { frame, reason: reason.to_owned() })
    }
}
