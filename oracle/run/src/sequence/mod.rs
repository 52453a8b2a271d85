//! A sequence of frames: rendered, run and scored, followed, or only scored, in the same way for every world.

mod labelling;
mod processing;
mod state_log;

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use contract::{FailedStarts, Interface, Pipeline, PipelineFactory};
use files::{AtomicFile, Failure, RunDirectory};
use labels::{LabelCounts, LabelFormats};
use serde::Serialize;

pub use self::processing::{AnswerCount, process, process_into};
use self::processing::{check_machine, check_starts};
pub use self::state_log::STATES_FILE;
use self::state_log::{StateLog, StateLogWriter};
use crate::frame_jobs::{FrameJobs, process_in_order};
use crate::run_result::{FirstFailure, IncompleteRun, RunResult};
use crate::world::{
    Answers as _, Dataset as _, FrameAnswer, ImageOf, InformedPipeline, Judgement as _, Scorer as _, World,
};

/// Makes frames and writes them as a dataset, and then their labels, if any are requested; `done` is called
/// after each frame and after its labels. The frames of a run that is rendered again have the states of its
/// log, all others the default state. Returns the numbers of labels.
///
/// # Errors
/// A [`Failure`] when a file cannot be written, or the log of the run cannot be read.
pub fn render<W: World>(
    world: &W,
    directory: &RunDirectory,
    frame_jobs: &FrameJobs<W::Images>,
    label_formats: Option<&LabelFormats>,
    done: impl Fn(),
) -> Result<Option<LabelCounts>, Failure> {
    let mut dataset = world.dataset(directory, frame_jobs)?;
    let states: StateLog<W::State> = match &frame_jobs.states_of {
        Some(run) => StateLog::read(run)?,
        None => StateLog::default(),
    };
    let mut number = frame_jobs.frames.start;
    expose_in_parallel(
        world,
        directory,
        frame_jobs,
        |frame| states.at(frame),
        |exposure| {
            let (image, telemetry, truth) = W::receive(exposure, &states.at(number));
            number += 1;
            dataset.add(&image, telemetry, truth)?;
            done();
            Ok(image)
        },
    )?;
    dataset.finish()?;
    let Some(formats) = label_formats else {
        directory.seal()?;
        return Ok(None);
    };
    let (counts, tables) = labelling::write_labels(world, directory, frame_jobs, formats, &done)?;
    directory.seal_with(&tables)?;
    Ok(Some(counts))
}

/// Makes frames, processes them with the pipeline, scores its outcomes and writes everything. `go_on` is
/// called after each frame; its failure stops the run. A scenario is one sequence: the pipeline is built
/// once. If the result of a stage is replaced by the truth, the pipeline is the built-in one, regardless
/// of `factory`. If the pipeline does not start, the run ends after three frames, which are scored.
///
/// # Errors
/// A [`Failure`] when a file cannot be written or the pipeline cannot be built; the error of `go_on`.
pub fn run<W: World>(
    world: &W,
    directory: &RunDirectory,
    frame_jobs: &FrameJobs<W::Images>,
    factory: &dyn PipelineFactory<W::Interface>,
    go_on: impl Fn() -> Result<(), Failure>,
) -> Result<RunResult<W::Judgement>, Failure> {
    let mut dataset = world.dataset(directory, frame_jobs)?;
    let mut running = RunningPipeline::build(world, factory)?;
    let mut answers = W::Answers::create(&W::Answers::files(&directory.measurements()))?;
    let mut scorer = world.scorer();
    let mut beside = match world.comparison_pipeline()? {
        Some(factory) => Some((factory.build(world.setup())?, world.scorer())),
        None => None,
    };
    let mut first_failure = None;
    let mut states = StateLogWriter::new(directory.path());
    let take = |running: &mut RunningPipeline<'_, W>, frame, exposure| {
        let FrameAnswer { image, telemetry, truth, outcome } = running.process(frame, exposure)?;
        states.note(frame + 1, &running.state)?;
        let number = W::Interface::number(&image);
        first_failure =
            first_failure.take().or_else(|| FirstFailure::from_outcome::<W::Interface>(number, &outcome));
        answers.add(number, &telemetry, &outcome)?;
        scorer.add(&truth, &telemetry, &outcome)?;
        if let Some((pipeline, scorer)) = &mut beside {
            scorer.add(&truth, &telemetry, &pipeline.process(&image, &telemetry))?;
        }
        dataset.add(&image, telemetry, truth)?;
        go_on()?;
        running.check_starts().map(|()| image)
    };
    let ran = run_frames(world, directory, frame_jobs, &mut running, take);
    let incomplete = running.incomplete(&frame_jobs.frames);
    match ran {
        Err(Failure::NotStarted(_)) => {}
        ran => ran?,
    }
    dataset.finish()?;
    states.finish()?;
    answers.finish()?;
    let mut scored = scorer.finish();
    if let Some((_, scorer)) = beside {
        scored.show_comparison(scorer.finish());
    }
    let json =
        serde_json::to_string_pretty(&ScoreFile { score: scored.score(), incomplete: incomplete.as_ref() })
            .map_err(|error| Failure::Usage(format!("the score cannot be written as JSON: {error}")))?;
    AtomicFile::with_text(&directory.score(), &(json + "\n"))?.commit_new()?;
    directory.seal()?;
    Ok(RunResult { scored, first_failure, incomplete })
}

/// Makes frames on `jobs` threads, processes them with a new pipeline, and passes each frame with its
/// outcome to `take`, in order, on the caller's thread. No files are written.
///
/// # Errors
/// A [`Failure`] when the pipeline cannot be built or does not start, and the first failure of `take`.
pub fn follow<W: World>(
    world: &W,
    frames: Range<u64>,
    jobs: usize,
    factory: &dyn PipelineFactory<W::Interface>,
    mut take: impl FnMut(FrameAnswer<W>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let mut running = RunningPipeline::build(world, factory)?;
    if W::IS_SEQUENTIAL {
        let mut workspace = world.workspace()?;
        for frame in frames {
            let exposure = world.expose(&mut workspace, frame, &running.state)?;
            take(running.process(frame, exposure)?)?;
            running.check_starts()?;
        }
        return Ok(());
    }
    let unused = W::State::default();
    let make =
        |workspace: &mut W::Workspace<'_>, frame| Ok((frame, world.expose(workspace, frame, &unused)?));
    let bytes = world.exposure_bytes() as u64;
    process_in_order(
        frames,
        jobs,
        bytes,
        || world.workspace(),
        make,
        |(frame, exposure)| {
            take(running.process(frame, exposure)?)?;
            running.check_starts()
        },
    )
}

/// Makes frames on this thread, processes them with the pipeline and scores its outcomes; no files are
/// written. If the pipeline does not start, scoring ends after three frames, as in [`run`].
///
/// # Errors
/// A [`Failure`] when the pipeline cannot be built.
pub fn score<W: World>(
    world: &W,
    frames: Range<u64>,
    factory: &dyn PipelineFactory<W::Interface>,
) -> Result<RunResult<W::Judgement>, Failure> {
    let mut running = RunningPipeline::build(world, factory)?;
    let mut first_failure = None;
    let mut scorer = world.scorer();
    let mut workspace = world.workspace()?;
    for frame in frames.clone() {
        let exposure = world.expose(&mut workspace, frame, &running.state)?;
        let processed = running.process(frame, exposure)?;
        let failure = || FirstFailure::from_outcome::<W::Interface>(frame, &processed.outcome);
        first_failure = first_failure.or_else(failure);
        scorer.add(&processed.truth, &processed.telemetry, &processed.outcome)?;
        W::reuse(&mut workspace, processed.image);
        if running.check_starts().is_err() {
            break;
        }
    }
    Ok(RunResult { scored: scorer.finish(), first_failure, incomplete: running.incomplete(&frames) })
}

/// A pipeline that processes a sequence, with the state that its outcomes change.
struct RunningPipeline<'a, W: World> {
    world: &'a W,
    pipeline: Processor<W>,
    state: W::State,
}

enum Processor<W: World> {
    Own(Box<dyn Pipeline<W::Interface>>),
    Informed(Box<dyn InformedPipeline<W>>),
}

impl<'a, W: World> RunningPipeline<'a, W> {
    fn build(world: &'a W, factory: &dyn PipelineFactory<W::Interface>) -> Result<Self, Failure> {
        let pipeline = match world.informed_pipeline()? {
            Some(informed) => Processor::Informed(informed),
            None => Processor::Own(factory.build(world.setup())?),
        };
        Ok(Self { world, pipeline, state: W::State::default() })
    }

    fn process(&mut self, frame: u64, exposure: W::Exposure) -> Result<FrameAnswer<W>, Failure> {
        let (image, telemetry, truth) = W::receive(exposure, &self.state);
        let outcome = match &mut self.pipeline {
            Processor::Own(pipeline) => pipeline.process(&image, &telemetry),
            Processor::Informed(pipeline) => pipeline.process(&image, &telemetry, &truth)?,
        };
        self.check_machine()?;
        self.state = self.world.advance(self.state.clone(), frame, &outcome);
        Ok(FrameAnswer { image, telemetry, truth, outcome })
    }

    fn failed_starts(&self) -> Option<&FailedStarts> {
        match &self.pipeline {
            Processor::Own(pipeline) => pipeline.failed_starts(),
            Processor::Informed(_) => None,
        }
    }

    fn check_starts(&self) -> Result<(), Failure> {
        check_starts(self.failed_starts())
    }

    /// Returns an error if the machine kept the last image from the pipeline.
    fn check_machine(&self) -> Result<(), Failure> {
        match &self.pipeline {
            Processor::Own(pipeline) => check_machine(pipeline.as_ref()),
            Processor::Informed(_) => Ok(()),
        }
    }

    fn incomplete(&self, frames: &Range<u64>) -> Option<IncompleteRun> {
        self.failed_starts()
            .map(|failed| IncompleteRun::from_failed_starts(frames.end - frames.start, failed))
    }
}

/// Content of `score.json`.
#[derive(Serialize)]
struct ScoreFile<'a, S> {
    #[serde(flatten)]
    score: &'a S,
    #[serde(rename = "not_flown", skip_serializing_if = "Option::is_none")]
    incomplete: Option<&'a IncompleteRun>,
}

/// Exposes the frames of a run and passes them to `take`, which processes them and returns their images: one
/// after the other if an exposure depends on the state.
fn run_frames<W: World>(
    world: &W,
    directory: &RunDirectory,
    frame_jobs: &FrameJobs<W::Images>,
    running: &mut RunningPipeline<'_, W>,
    mut take: impl FnMut(&mut RunningPipeline<'_, W>, u64, W::Exposure) -> Result<ImageOf<W>, Failure>,
) -> Result<(), Failure> {
    let mut frames = frame_jobs.frames.clone();
    if !W::IS_SEQUENTIAL {
        return expose_in_parallel(
            world,
            directory,
            frame_jobs,
            |_| W::State::default(),
            |exposure| take(running, frames.next().unwrap_or_default(), exposure),
        );
    }
    let mut workspace = world.workspace()?;
    for frame in frames {
        let exposure = world.expose(&mut workspace, frame, &running.state)?;
        world.save(&workspace, &exposure, directory, frame_jobs)?;
        let image = take(running, frame, exposure)?;
        W::reuse(&mut workspace, image);
    }
    Ok(())
}

/// Makes frames in known states on all threads, saves the separate files of each, and passes them in order to
/// `take`, which returns their images: later images reuse their memory.
fn expose_in_parallel<W: World>(
    world: &W,
    directory: &RunDirectory,
    frame_jobs: &FrameJobs<W::Images>,
    state_at: impl Fn(u64) -> W::State + Sync,
    mut take: impl FnMut(W::Exposure) -> Result<ImageOf<W>, Failure>,
) -> Result<(), Failure> {
    let spare = Mutex::new(Vec::new());
    let spares = || spare.lock().unwrap_or_else(PoisonError::into_inner);
    let make = |workspace: &mut W::Workspace<'_>, frame| {
        let reused = spares().pop();
        reused.into_iter().for_each(|image| W::reuse(workspace, image));
        let exposure = world.expose(workspace, frame, &state_at(frame))?;
        world.save(workspace, &exposure, directory, frame_jobs)?;
        Ok(exposure)
    };
    let (frames, bytes) = (frame_jobs.frames.clone(), world.exposure_bytes() as u64);
    process_in_order(
        frames,
        frame_jobs.jobs,
        bytes,
        || world.workspace(),
        make,
        |exposure| {
            spares().push(take(exposure)?);
            Ok(())
        },
    )
}
