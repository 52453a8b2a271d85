//! A run in a world: expose, process, score, write.

use std::fmt::Debug;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::{Mutex, PoisonError};

use contract::{FailedStarts, Interface, Pipeline, PipelineFactory};
use files::{AtomicFile, Failure, FileError, PartialFiles, RunDirectory};
use indexmap::IndexMap;
use pipeline::external::Protocol;
use scenario::AttitudeChoice;
use scenario::run_file::{RunFile, ScenarioFile};
use score::{Figure, FigureSpec, UnitTable};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use crate::any_world::{Options, ScenarioSource};
use crate::frame_jobs::{FrameJobs, process_in_order};
use crate::run_result::{AnswerSummary, FirstFailure, IncompleteRun, RunResult};
use crate::state_log::{StateLog, StateLogWriter};

/// Number of consecutive failed starts of a pipeline after which a run ends.
const MAX_FAILED_STARTS: u32 = 3;

/// Setup that pipelines of a world are built with.
pub type SetupOf<W> = <<W as World>::Interface as Interface>::Setup;
/// Image of a world.
pub type ImageOf<W> = <<W as World>::Interface as Interface>::Image;
/// Telemetry of an image of a world.
pub type TelemetryOf<W> = <<W as World>::Interface as Interface>::Telemetry;
/// Outcome of a pipeline in a world.
pub type OutcomeOf<W> = <<W as World>::Interface as Interface>::Outcome;

/// A scenario with its simulator, ready to run: the world-specific parts of a run. The run itself is the same
/// for every world.
///
/// An outcome may change the state ([`World::State`]) with which later images are received or exposed: a
/// closed loop. Images are received and processed one after the other. Exposures that do not depend on the
/// state are made on any number of threads; the result does not depend on their number. The states of a run
/// are logged ([`crate::state_log`]), so that any frame can be made again alone, bit for bit.
pub trait World: Sized + Send + Sync + 'static {
    /// Code of the world in files and on the command line. It is also the name of the built-in pipeline, and
    /// of that pipeline's table in a scenario.
    const CODE: &'static str = Self::Scenario::WORLD;
    /// Commented scenario as a starting point for the user.
    const STARTING_POINT: &'static str;
    /// File of a dataset with the data that a pipeline receives before the first frame.
    const SETUP_FILE: &'static str;
    /// Table of a run directory with one row for every frame of the truth.
    const TRUTH_FILE: &'static str;
    /// File beside the measurements that scoring also reads, if it exists.
    const EVIDENCE_FILE: Option<&'static str> = None;
    /// Rate by which runs are judged, a figure of the score.
    const HEADLINE: &'static str;
    /// True if consecutive groups of frames are separated in time, so that errors in one group are
    /// independent of the next.
    const ARE_GROUPS_APART: bool = true;
    /// True if an exposure depends on the state: the frames of a run are then exposed one after the other,
    /// each with the state after the frame before. Otherwise only [`World::receive`] uses the state.
    const IS_SEQUENTIAL: bool = false;
    /// Default image format of a rendered dataset.
    const IMAGES: Self::Images;
    /// Name of the format for viewing images.
    const PICTURES: &'static str;

    /// Scenarios of the world.
    type Scenario: ScenarioFile;
    /// Parameters of the built-in pipeline.
    type Config;
    /// Input and output of the pipelines.
    type Interface: Protocol;
    /// Formats in which images are stored.
    type Images: Copy + Sync + FromStr<Err = String>;
    /// Result of exposing a frame on a thread, before it is received.
    type Exposure: Send;
    /// Data that a thread reuses from frame to frame.
    type Workspace<'a>
    where
        Self: 'a;
    /// Ground truth of a frame.
    type Truth;
    /// State that outcomes change and later images depend on; `()` for a world without a closed loop.
    type State: Clone + Default + PartialEq + Send + Sync + Serialize + DeserializeOwned;
    /// Writes frames as a dataset.
    type Dataset<'a>: Dataset<Self>
    where
        Self: 'a;
    /// Writes outcomes.
    type Answers: Answers<Self::Interface>;
    /// Scores outcomes.
    type Scorer<'a>: Scorer<Self>
    where
        Self: 'a;
    /// A scored run.
    type Judgement: Judgement + Send + 'static;

    /// Checks all values of a scenario and prepares its simulator.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the first invalid value, or for an option that the world does not
    /// support.
    fn prepare(source: &ScenarioSource, scenario: &Self::Scenario, options: Options)
    -> Result<Self, Failure>;

    /// Returns the content of `run.toml`.
    fn run_file(&self) -> &RunFile<Self::Scenario>;

    /// Returns the scenario.
    fn scenario(&self) -> &Self::Scenario {
        &self.run_file().scenario
    }

    /// Returns the summary of a scenario check: as JSON, and as text for the user.
    fn summary(&self) -> (Value, String) {
        let (name, frames) = (&self.run_file().name, self.frame_count());
        let text = format!("{name}: {frames} {}s, no mistake found", Self::Interface::IMAGE);
        (json!({ "scenario": name, "ok": true, "world": Self::CODE, "frames": frames }), text)
    }

    /// Returns warnings about values that are permitted and may be unintended, in addition to those that look
    /// wrong by a factor of a thousand.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }

    /// Returns the parameters of the built-in pipeline in a scenario.
    fn config(scenario: &Self::Scenario) -> &Self::Config;

    /// Returns the factory of the built-in pipeline.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a parameter outside its range.
    fn built_in(config: &Self::Config) -> Result<Box<dyn PipelineFactory<Self::Interface> + Send>, Failure>;

    /// Checks that the built-in pipeline can run with the cameras of a scenario.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the parameter that prevents it.
    fn check_built_in(_: &ScenarioSource, _: &Self::Scenario) -> Result<(), Failure> {
        Ok(())
    }

    /// Writes an image for an external program, with only pixels and telemetry.
    ///
    /// # Errors
    /// A message with the reason when it cannot be written.
    fn write_image(image: &ImageOf<Self>, telemetry: &TelemetryOf<Self>, path: &Path) -> Result<(), String>;

    /// Refuses a flight that cannot succeed, before anything is written.
    ///
    /// # Errors
    /// A [`Failure`] with the reason.
    fn check_frame_jobs(&self, _: &FrameJobs<Self::Images>) -> Result<(), Failure> {
        Ok(())
    }

    /// Describes the files of a rendered dataset for a pipeline.
    fn files_for_pipelines(_: Self::Images) -> String {
        format!("{} and the {}s", Self::SETUP_FILE, Self::Interface::IMAGE)
    }

    /// Refuses a flight whose images cannot be written to standard output.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a format that cannot be streamed, or a world without a stream.
    fn check_stream(&self, _: &FrameJobs<Self::Images>) -> Result<(), Failure> {
        let code = Self::CODE;
        Err(Failure::Usage(format!(
            "--out is -, expected a path: {code} writes nothing to standard output (`./-` names a file)"
        )))
    }

    /// Writes images to standard output, in a format that can be streamed.
    ///
    /// # Errors
    /// Those of [`World::check_stream`]; a [`Failure`] when standard output cannot be written.
    fn stream(&self, frame_jobs: &FrameJobs<Self::Images>) -> Result<(), Failure> {
        self.check_stream(frame_jobs)
    }

    /// Opens a dataset for a pipeline, of real or rendered images.
    ///
    /// # Errors
    /// A [`Failure`] with the first missing or wrong item.
    fn open(directory: &Path) -> Result<OpenDataset<Self>, Failure>;

    /// Passes to `add`, for every frame of a run, the input of a pipeline besides the image: telemetry,
    /// transmitted regions. The default is that of a world without telemetry.
    ///
    /// # Errors
    /// A [`Failure`] for a file that cannot be read.
    fn telemetry_rows(_directory: &Path, _add: &mut dyn FnMut(&dyn Debug)) -> Result<(), Failure> {
        Ok(())
    }

    /// Returns the figures of a score. Figures of several worlds with the same key have the same definition.
    fn figures() -> Vec<FigureSpec>;

    /// Returns all causes that a unit's verdict may have, each as (verdict, cause) in the terms of
    /// [`score::UnitVerdict`]; a study counts them.
    fn causes() -> Vec<(&'static str, &'static str)> {
        Vec::new()
    }

    /// Returns the number of frames of the whole scenario.
    fn frame_count(&self) -> u64;

    /// Returns the setup that a pipeline receives before the first frame.
    fn setup(&self) -> &SetupOf<Self>;

    /// Returns the size of the pixels of an exposure in memory, bytes.
    fn exposure_bytes(&self) -> usize;

    /// Creates the workspace of a thread.
    ///
    /// # Errors
    /// A [`Failure`] when the workspace cannot be created.
    fn workspace(&self) -> Result<Self::Workspace<'_>, Failure>;

    /// Exposes a frame in a state; its bits depend on these two alone. If exposures do not depend on the
    /// state ([`World::IS_SEQUENTIAL`]), it is the default one.
    ///
    /// # Errors
    /// A [`Failure`] when the frame does not exist.
    fn expose(
        &self,
        workspace: &mut Self::Workspace<'_>,
        frame: u64,
        state: &Self::State,
    ) -> Result<Self::Exposure, Failure>;

    /// Returns image, telemetry and ground truth of an exposure, received in a state.
    fn receive(
        exposure: Self::Exposure,
        state: &Self::State,
    ) -> (ImageOf<Self>, TelemetryOf<Self>, Self::Truth);

    /// Returns the state of the next frame, after the outcome of a frame: by default unchanged, for a world
    /// without a closed loop.
    fn advance(&self, state: Self::State, _frame: u64, _outcome: &OutcomeOf<Self>) -> Self::State {
        state
    }

    /// Writes the separate files of an exposure, on the thread that made it.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written.
    fn save(
        &self,
        _: &Self::Workspace<'_>,
        _: &Self::Exposure,
        _: &RunDirectory,
        _: &FrameJobs<Self::Images>,
    ) -> Result<(), Failure> {
        Ok(())
    }

    /// Returns the memory of an image to a workspace.
    fn reuse(_: &mut Self::Workspace<'_>, _: ImageOf<Self>) {}

    /// Returns the factory of a second pipeline that processes the same frames and is scored for comparison;
    /// its outcomes are not written.
    ///
    /// # Errors
    /// A [`Failure`] when the pipeline cannot be configured.
    fn comparison_pipeline(
        &self,
    ) -> Result<Option<Box<dyn PipelineFactory<Self::Interface> + Send>>, Failure> {
        Ok(None)
    }

    /// Returns the built-in pipeline with one stage's result replaced by the truth, if the run requests it.
    ///
    /// # Errors
    /// A [`Failure`] when the pipeline cannot be built.
    fn informed_pipeline(&self) -> Result<Option<Box<dyn InformedPipeline<Self>>>, Failure> {
        Ok(None)
    }

    /// Begins a dataset: writes the files that do not depend on frames.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written.
    fn dataset<'a>(
        &'a self,
        directory: &'a RunDirectory,
        frame_jobs: &FrameJobs<Self::Images>,
    ) -> Result<Self::Dataset<'a>, Failure>;

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

    /// Makes frames and writes them as a dataset; `done` is called after each frame. The frames of a run that
    /// is rendered again have the states of its log, all others the default state.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written, or the log of the run cannot be read.
    fn render(
        &self,
        directory: &RunDirectory,
        frame_jobs: &FrameJobs<Self::Images>,
        done: impl Fn(),
    ) -> Result<(), Failure> {
        let mut dataset = self.dataset(directory, frame_jobs)?;
        let states: StateLog<Self::State> = match &frame_jobs.states_of {
            Some(run) => StateLog::read(run)?,
            None => StateLog::default(),
        };
        let mut number = frame_jobs.frames.start;
        expose_in_parallel(
            self,
            directory,
            frame_jobs,
            |frame| states.at(frame),
            |exposure| {
                let (image, telemetry, truth) = Self::receive(exposure, &states.at(number));
                number += 1;
                dataset.add(&image, telemetry, truth)?;
                done();
                Ok(image)
            },
        )?;
        dataset.finish()?;
        Ok(directory.seal()?)
    }

    /// Makes frames, processes them with the pipeline, scores its outcomes and writes everything. `go_on` is
    /// called after each frame; its failure stops the run. A scenario is one sequence: the pipeline is built
    /// once. If the result of a stage is replaced by the truth, the pipeline is the built-in one, regardless
    /// of `factory`. If the pipeline does not start, the run ends after three frames, which are scored.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written or the pipeline cannot be built; the error of `go_on`.
    fn run(
        &self,
        directory: &RunDirectory,
        frame_jobs: &FrameJobs<Self::Images>,
        factory: &dyn PipelineFactory<Self::Interface>,
        go_on: impl Fn() -> Result<(), Failure>,
    ) -> Result<RunResult<Self::Judgement>, Failure> {
        let mut dataset = self.dataset(directory, frame_jobs)?;
        let mut running = RunningPipeline::build(self, factory)?;
        let mut answers = Self::Answers::create(&Self::Answers::files(&directory.measurements()))?;
        let mut scorer = self.scorer();
        let mut beside = match self.comparison_pipeline()? {
            Some(factory) => Some((factory.build(self.setup())?, self.scorer())),
            None => None,
        };
        let mut first_failure = None;
        let mut states = StateLogWriter::new(directory.path());
        let take = |running: &mut RunningPipeline<'_, Self>, frame, exposure| {
            let FrameAnswer { image, telemetry, truth, outcome } = running.process(frame, exposure)?;
            states.note(frame + 1, &running.state)?;
            let number = Self::Interface::number(&image);
            first_failure = first_failure
                .take()
                .or_else(|| FirstFailure::from_outcome::<Self::Interface>(number, &outcome));
            answers.add(number, &telemetry, &outcome)?;
            scorer.add(&truth, &telemetry, &outcome)?;
            if let Some((pipeline, scorer)) = &mut beside {
                scorer.add(&truth, &telemetry, &pipeline.process(&image, &telemetry))?;
            }
            dataset.add(&image, telemetry, truth)?;
            go_on()?;
            running.check_starts().map(|()| image)
        };
        let ran = run_frames(self, directory, frame_jobs, &mut running, take);
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
        let json = serde_json::to_string_pretty(&ScoreFile {
            score: scored.score(),
            incomplete: incomplete.as_ref(),
        })
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
    fn follow(
        &self,
        frames: Range<u64>,
        jobs: usize,
        factory: &dyn PipelineFactory<Self::Interface>,
        mut take: impl FnMut(FrameAnswer<Self>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let mut running = RunningPipeline::build(self, factory)?;
        if Self::IS_SEQUENTIAL {
            let mut workspace = self.workspace()?;
            for frame in frames {
                let exposure = self.expose(&mut workspace, frame, &running.state)?;
                take(running.process(frame, exposure)?)?;
                running.check_starts()?;
            }
            return Ok(());
        }
        let unused = Self::State::default();
        let make =
            |workspace: &mut Self::Workspace<'_>, frame| Ok((frame, self.expose(workspace, frame, &unused)?));
        let bytes = self.exposure_bytes() as u64;
        process_in_order(
            frames,
            jobs,
            bytes,
            || self.workspace(),
            make,
            |(frame, exposure)| {
                take(running.process(frame, exposure)?)?;
                running.check_starts()
            },
        )
    }

    /// Makes frames on this thread, processes them with the pipeline and scores its outcomes; no files are
    /// written. If the pipeline does not start, scoring ends after three frames, as in [`World::run`].
    ///
    /// # Errors
    /// A [`Failure`] when the pipeline cannot be built.
    fn score(
        &self,
        frames: Range<u64>,
        factory: &dyn PipelineFactory<Self::Interface>,
    ) -> Result<RunResult<Self::Judgement>, Failure> {
        let mut running = RunningPipeline::build(self, factory)?;
        let mut first_failure = None;
        let mut scorer = self.scorer();
        let mut workspace = self.workspace()?;
        for frame in frames.clone() {
            let exposure = self.expose(&mut workspace, frame, &running.state)?;
            let processed = running.process(frame, exposure)?;
            let failure = || FirstFailure::from_outcome::<Self::Interface>(frame, &processed.outcome);
            first_failure = first_failure.or_else(failure);
            scorer.add(&processed.truth, &processed.telemetry, &processed.outcome)?;
            Self::reuse(&mut workspace, processed.image);
            if running.check_starts().is_err() {
                break;
            }
        }
        Ok(RunResult { scored: scorer.finish(), first_failure, incomplete: running.incomplete(&frames) })
    }
}

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

/// Returns an error if the pipeline has repeatedly failed to start.
fn check_starts(failed: Option<&FailedStarts>) -> Result<(), Failure> {
    match failed.filter(|failed| failed.count >= MAX_FAILED_STARTS) {
        Some(failed) => Err(failed.clone().into()),
        None => Ok(()),
    }
}

/// Returns an error if the machine kept the last image from a pipeline.
fn check_machine<I: Interface>(pipeline: &dyn Pipeline<I>) -> Result<(), Failure> {
    match pipeline.machine_fault() {
        Some(fault) => Err(fault.clone().into()),
        None => Ok(()),
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

/// Refuses to grant an attitude in a world whose measurements are not lines of sight.
///
/// # Errors
/// [`Failure::Usage`] when an attitude is requested.
pub fn refuse_attitude(attitude: Option<AttitudeChoice>) -> Result<(), Failure> {
    attitude.map_or(Ok(()), |_| Err(Failure::Usage("--attitude requires a run of the far range".to_owned())))
}

pub(crate) fn unscorable(error: score::ScoreError) -> Failure {
    Failure::Usage(format!("the truth cannot be scored: {error}"))
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
