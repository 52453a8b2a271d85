//! Processing of images by a pipeline, real ones included.

use std::path::{Path, PathBuf};

use contract::{FailedStarts, Interface, Pipeline, PipelineFactory};
use files::{Failure, PartialFiles};

use crate::run_result::{AnswerSummary, FirstFailure};
use crate::world::Answers;

/// Number of consecutive failed starts of a pipeline after which a run ends.
const MAX_FAILED_STARTS: u32 = 3;

/// Processes images, including real ones, with a pipeline, and writes its outcomes to `measurements` and the
/// files beside it.
///
/// # Errors
/// A [`Failure`] when an image cannot be read, a file cannot be written, or the pipeline does not start.
pub fn process<I: Interface, A: Answers<I>>(
    images: impl IntoIterator<Item = Result<(I::Image, I::Telemetry), Failure>>,
    setup: &I::Setup,
    factory: &dyn PipelineFactory<I>,
    measurements: &Path,
    done: impl Fn(),
) -> Result<AnswerCount, Failure> {
    // The files have other names until all outcomes are written, so that a failed run leaves no files that
    // block the next run.
    let files = A::files(measurements);
    let partial = PartialFiles::for_paths(&files.iter().map(PathBuf::as_path).collect::<Vec<_>>())?;
    let waiting: Vec<PathBuf> = (0..files.len()).map(|index| partial.path(index).to_owned()).collect();
    let processed = process_into(images, setup, factory, A::create(&waiting)?, done)?;
    partial.complete()?;
    Ok(processed)
}

/// Processes images with a pipeline, and passes its outcomes to a writer.
///
/// # Errors
/// Those of [`process`].
pub fn process_into<I: Interface, A: Answers<I>>(
    images: impl IntoIterator<Item = Result<(I::Image, I::Telemetry), Failure>>,
    setup: &I::Setup,
    factory: &dyn PipelineFactory<I>,
    mut answers: A,
    done: impl Fn(),
) -> Result<AnswerCount, Failure> {
    let mut pipeline = factory.build(setup)?;
    let mut processed = AnswerCount { frames: 0, first_failure: None, summary: None };
    for image in images {
        let (image, telemetry) = image?;
        let (number, outcome) = (I::number(&image), pipeline.process(&image, &telemetry));
        check_machine(pipeline.as_ref())?;
        let failure = || FirstFailure::from_outcome::<I>(number, &outcome);
        processed.first_failure = processed.first_failure.or_else(failure);
        answers.add(number, &telemetry, &outcome)?;
        processed.frames += 1;
        done();
        check_starts(pipeline.failed_starts())?;
    }
    if let Some(failed) = pipeline.failed_starts() {
        return Err(failed.clone().into());
    }
    processed.summary = answers.summary(setup);
    answers.finish()?;
    Ok(processed)
}

/// Result of [`process`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AnswerCount {
    /// Number of processed images.
    pub frames: u64,
    /// First failure of the pipeline, if any.
    pub first_failure: Option<FirstFailure>,
    /// Summary of the outcomes, if the world provides one.
    pub summary: Option<AnswerSummary>,
}

/// Returns an error if the pipeline has repeatedly failed to start.
pub(crate) fn check_starts(failed: Option<&FailedStarts>) -> Result<(), Failure> {
    match failed.filter(|failed| failed.count >= MAX_FAILED_STARTS) {
        Some(failed) => Err(failed.clone().into()),
        None => Ok(()),
    }
}

/// Returns an error if the machine kept the last image from a pipeline.
pub(crate) fn check_machine<I: Interface>(pipeline: &dyn Pipeline<I>) -> Result<(), Failure> {
    match pipeline.machine_fault() {
        Some(fault) => Err(fault.clone().into()),
        None => Ok(()),
    }
}
