//! What a run gave.

use contract::Interface;

/// What a run gave.
#[derive(Debug)]
pub struct RunResult<S> {
    /// Score and verdicts.
    pub scored: S,
    /// The first failure of the pipeline, if it failed at all.
    pub first_failure: Option<FirstFailure>,
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
    pub(crate) fn of<I: Interface>(frame: u64, outcome: &I::Outcome) -> Option<Self> {
        I::failure(outcome).map(|reason| Self { frame, reason: reason.to_owned() })
    }
}
