//! The one interface that outsiders implement.

use std::fmt::Debug;

use thiserror::Error;

use crate::ContractError;

/// What the pipelines of a world receive and answer: a family of types, named by a marker such as [`crate::FarRange`] or
/// [`crate::docking::Docking`].
pub trait Interface: Sized + 'static {
    /// What a pipeline knows before the first image.
    type Setup: Clone + Debug + Send + Sync;
    /// An image.
    type Image: Clone + Debug + Send;
    /// What is known of an image besides its pixels.
    type Telemetry: Clone + Debug + Send;
    /// A pipeline's whole answer to an image.
    type Outcome: Clone + PartialEq + Debug + Send;

    /// What an image is called, in messages and in the external protocol: `frame` or `field`.
    const IMAGE: &'static str;

    /// The image's number in its sequence.
    fn number(image: &Self::Image) -> u64;

    /// The answer of a pipeline that failed.
    fn failed(reason: String) -> Self::Outcome;

    /// Why the pipeline failed, if it did.
    fn failure(outcome: &Self::Outcome) -> Option<&str>;
}

/// An image-processing pipeline under test.
///
/// Built fresh for each sequence of images, and given them in order; it may remember what it likes in between.
/// Images may be missing. It must answer every image, and what it answers must hold no NaN: see
/// [`crate::conformance`].
pub trait Pipeline<I: Interface>: Send {
    /// Answers one image.
    fn process(&mut self, image: &I::Image, telemetry: &I::Telemetry) -> I::Outcome;

    /// What became of its starts, of a pipeline that has to be started before it can answer and never was.
    fn failed_starts(&self) -> Option<&FailedStarts> {
        None
    }
}

/// Starts of a pipeline, each of which failed. One is tried for every image, until one succeeds.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the pipeline did not start, {count} times in a row: {reason}")]
pub struct FailedStarts {
    /// How many there were.
    pub count: u32,
    /// Why the last one failed.
    pub reason: String,
}

/// Builds pipelines, one a sequence.
pub trait PipelineFactory<I: Interface>: Sync {
    /// Name, for tables and logs.
    fn name(&self) -> String;

    /// A fresh pipeline that has seen no image.
    ///
    /// # Errors
    /// [`ContractError::CannotBuild`] when the setup or the pipeline's own configuration does not allow it.
    fn build(&self, setup: &I::Setup) -> Result<Box<dyn Pipeline<I>>, ContractError>;
}
