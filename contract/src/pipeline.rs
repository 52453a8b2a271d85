//! Traits that an external pipeline implements.

use std::fmt::Debug;

use thiserror::Error;

use crate::ContractError;

/// Input and output types of the pipelines of a world, selected by a marker type such as [`crate::FarRange`]
/// or [`crate::docking::Docking`].
pub trait Interface: Sized + 'static {
    /// Data that a pipeline receives before the first image.
    type Setup: Clone + Debug + Send + Sync;
    /// Type of an image.
    type Image: Clone + Debug + Send;
    /// Telemetry of an image: the data besides its pixels.
    type Telemetry: Clone + Debug + Send;
    /// Complete outcome of a pipeline for one image.
    type Outcome: Clone + PartialEq + Debug + Send;

    /// Name of an image in messages and in the external protocol: `frame` or `field`.
    const IMAGE: &'static str;

    /// Returns the number of the image in its sequence.
    fn number(image: &Self::Image) -> u64;

    /// Creates the outcome of a failed pipeline.
    fn failed(reason: String) -> Self::Outcome;

    /// Returns the reason of a failure, if the outcome is one.
    fn failure(outcome: &Self::Outcome) -> Option<&str>;
}

/// An image-processing pipeline under test.
///
/// A pipeline is built afresh for each sequence of images and receives the images in order; it may keep any
/// state between them. Images may be missing. The pipeline must return an outcome for every image, and no
/// outcome may contain NaN: see [`crate::conformance`].
pub trait Pipeline<I: Interface>: Send {
    /// Processes one image and returns its outcome.
    fn process(&mut self, image: &I::Image, telemetry: &I::Telemetry) -> I::Outcome;

    /// Returns the failed starts of a pipeline that must be started before it can process images and has
    /// never started.
    fn failed_starts(&self) -> Option<&FailedStarts> {
        None
    }

    /// Returns the fault of the machine that kept the last image from the pipeline, a full disk for instance;
    /// `None` if it received the image. The outcome of such an image is not the pipeline's: the caller ends
    /// the sequence.
    fn machine_fault(&self) -> Option<&MachineFault> {
        None
    }
}

/// Fault of the machine on which a pipeline runs, not of the pipeline.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{reason}; the image did not reach the pipeline, and nothing was scored")]
pub struct MachineFault {
    /// What failed, and why.
    pub reason: String,
}

/// Consecutive failed starts of a pipeline. One start is attempted per image until one succeeds.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the pipeline failed to start {count} times in a row: {reason}")]
pub struct FailedStarts {
    /// Number of failed starts.
    pub count: u32,
    /// Reason of the last failure.
    pub reason: String,
}

/// Builds pipelines, one per sequence.
pub trait PipelineFactory<I: Interface>: Sync {
    /// Returns the name for tables and logs.
    fn name(&self) -> String;

    /// Builds a fresh pipeline that has processed no image.
    ///
    /// # Errors
    /// [`ContractError::CannotBuild`] if the setup or the pipeline's own configuration does not allow it.
    fn build(&self, setup: &I::Setup) -> Result<Box<dyn Pipeline<I>>, ContractError>;
}
