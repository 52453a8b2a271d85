//! One run over a world: expose, process, score, write.

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
use serde_json::{Value, json};

use crate::any_world::{Options, ScenarioSource};
use crate::frame_jobs::{FrameJobs, process_in_order};
use crate::run_result::{AnswerSummary, FirstFailure, IncompleteRun, RunResult};

/// Starts of a pipeline in a row that may fail before a run is over.
const MAX_FAILED_STARTS: u32 = 3;

/// The setup that pipelines of a world are built with.
pub type SetupOf<W> = <<W as World>::Interface as Interface>::Setup;
/// An image of a world.
pub type ImageOf<W> = <<W as World>::Interface as Interface>::Image;
/// The telemetry of an image of a world.
pub type TelemetryOf<W> = <<W as World>::Interface as Interface>::Telemetry;
/// A pipeline's answer in a world.
pub type OutcomeOf<W> = <<W as World>::Interface as Interface>::Outcome;

/// A scenario with its simulator, ready to fly: what a world has of its own. The run itself is the same for every world.
///
/// Exposures are made on any number of threads. They are received and processed one after the other, because an answer may change how
/// later images are received ([`World::Feedback`]): a closed loop, which no number of threads can change.
pub trait World: Sized + Send + Sync + 'static {
    /// Its word in files and on the command line. Also the name of its built-in pipeline, and of that pipeline's table in a scenario.
    const CODE: &'static str = Self::Scenario::WORLD;
    /// A commented scenario to begin with.
    const STARTING_POINT: &'static str;
    /// The file of a dataset that tells a pipeline what it knows before the first frame.
    const SETUP_FILE: &'static str;
    /// The table of a run directory with a row for every frame of the truth.
    const TRUTH_FILE: &'static str;
    /// The file beside the measurements that a score reads as well, if it is there.
    const EVIDENCE_FILE: Option<&'static str> = None;
    /// The rate by which runs are good or bad, a figure of the score.
    const HEADLINE: &'static str;
    /// Whether a group of frames is apart from the next in time, so that what went wrong in the one says nothing of the other.
    const ARE_GROUPS_APART: bool = true;
    /// How images of a rendered dataset are kept, unless told otherwise.
    const IMAGES: Self::Images;
    /// The word of the format in which a person looks at images.
    const PICTURES: &'static str;

    /// Its scenarios.
    type Scenario: ScenarioFile;
    /// Parameters of the built-in pipeline.
    type Config;
    /// What its pipelines receive and answer.
    type Interface: Protocol;
    /// Formats in which images are kept.
    type Images: Copy + Sync + FromStr<Err = String>;
    /// What a thread makes of a frame, before it is received.
    type Exposure: Send;
    /// What a thread reuses from frame to frame.
    type Workspace<'a>
    where
        Self: 'a;
    /// The ground truth of a frame.
    type Truth;
    /// What answers change of later images.
    type Feedback: Clone + Default;
    /// Writes frames as a dataset.
    type Dataset<'a>: Dataset<Self>
    where
        Self: 'a;
    /// Writes answers.
    type Answers: Answers<Self::Interface>;
    /// Judges answers.
    type Scorer<'a>: Scorer<Self>
    where
        Self: 'a;
    /// A scored run.
    type Judgement: Judgement + Send + 'static;

    /// Checks all values of a scenario and prepares its simulator.
    ///
    /// # Errors
    /// A [`Failure`] with the place of the first value that is not allowed, or for an option that the world does not have.
    fn prepare(source: &ScenarioSource, scenario: &Self::Scenario, options: Options)
    -> Result<Self, Failure>;

    /// The content of `run.toml`.
    fn run_file(&self) -> &RunFile<Self::Scenario>;

    /// The scenario.
    fn scenario(&self) -> &Self::Scenario {
        &self.run_file().scenario
    }

    /// What a check of the scenario tells: for a machine, and for a person.
    fn summary(&self) -> (Value, String) {
        let (name, frames) = (&self.run_file().name, self.frame_count());
        let text = format!("{name}: {frames} {}s, no mistake found", Self::Interface::IMAGE);
        (json!({ "scenario": name, "ok": true, "world": Self::CODE, "frames": frames }), text)
    }

    /// What is allowed and may not be meant, beside numbers that look wrong by a factor of a thousand.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }

    /// Parameters of the built-in pipeline in a scenario.
    fn config(scenario: &Self::Scenario) -> &Self::Config;

    /// The factory of the built-in pipeline.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a parameter outside its range.
    fn built_in(config: &Self::Config) -> Result<Box<dyn PipelineFactory<Self::Interface> + Send>, Failure>;

    /// Checks that the built-in pipeline can be run on the cameras of a scenario.
    ///
    /// # Errors
    /// A [`Failure`] with the place of the parameter by which it cannot.
    fn check_built_in(_: &ScenarioSource, _: &Self::Scenario) -> Result<(), Failure> {
        Ok(())
    }

    /// Writes an image for a program, with no more beside the pixels than telemetry says.
    ///
    /// # Errors
    /// Why it cannot be written.
    fn write_image(image: &ImageOf<Self>, telemetry: &TelemetryOf<Self>, path: &Path) -> Result<(), String>;

    /// Refuses a flight that cannot succeed, while nothing has been written.
    ///
    /// # Errors
    /// A [`Failure`] that says why it cannot.
    fn check_frame_jobs(&self, _: &FrameJobs<Self::Images>) -> Result<(), Failure> {
        Ok(())
    }

    /// What a rendered dataset holds for a pipeline, in words.
    fn files_for_pipelines(_: Self::Images) -> String {
        format!("{} and the {}s", Self::SETUP_FILE, Self::Interface::IMAGE)
    }

    /// Refuses a flight whose images cannot be written to standard output.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a format that is no stream, or a world that has none.
    fn check_stream(&self, _: &FrameJobs<Self::Images>) -> Result<(), Failure> {
        let code = Self::CODE;
        Err(Failure::Usage(format!(
            "--out is -, expected the name of a place: {code} writes nothing to standard output (`./-` is a file)"
        )))
    }

    /// Writes images to standard output, in a format that is a stream.
    ///
    /// # Errors
    /// As [`World::check_stream`]; a [`Failure`] when it cannot be written.
    fn stream(&self, frame_jobs: &FrameJobs<Self::Images>) -> Result<(), Failure> {
        self.check_stream(frame_jobs)
    }

    /// Opens a dataset for a pipeline: real images, or a rendered one.
    ///
    /// # Errors
    /// A [`Failure`] with the first thing that is missing or wrong.
    fn open(directory: &Path) -> Result<OpenDataset<Self>, Failure>;

    /// Passes on, for every frame of a run, what a pipeline received besides the image: telemetry, transmitted regions. The default is a
    /// world without telemetry.
    ///
    /// # Errors
    /// A [`Failure`] for a file that cannot be read.
    fn telemetry_rows(_directory: &Path, _add: &mut dyn FnMut(&dyn Debug)) -> Result<(), Failure> {
        Ok(())
    }

    /// The figures of a score. A key that another world has too is the same figure.
    fn figures() -> Vec<FigureSpec>;

    /// All causes that a unit's verdict may have, each as (verdict, cause) in the words of [`score::UnitVerdict`]; a study counts them.
    fn causes() -> Vec<(&'static str, &'static str)> {
        Vec::new()
    }

    /// Number of frames of the whole scenario.
    fn frame_count(&self) -> u64;

    /// What a pipeline is told before the first frame.
    fn setup(&self) -> &SetupOf<Self>;

    /// Memory of the pixels of an exposure, bytes.
    fn exposure_bytes(&self) -> usize;

    /// A workspace for a thread.
    ///
    /// # Errors
    /// A [`Failure`] when it cannot be made.
    fn workspace(&self) -> Result<Self::Workspace<'_>, Failure>;

    /// Exposes a frame: the same bits whatever was exposed before.
    ///
    /// # Errors
    /// A [`Failure`] when there is no such frame.
    fn expose(&self, workspace: &mut Self::Workspace<'_>, frame: u64) -> Result<Self::Exposure, Failure>;

    /// Image, telemetry and ground truth of an exposure, received as earlier answers have it.
    fn receive(
        exposure: Self::Exposure,
        feedback: &Self::Feedback,
    ) -> (ImageOf<Self>, TelemetryOf<Self>, Self::Truth);

    /// The feedback from the next frame on, after an answer: that of before, unless a world closes the loop.
    fn feedback(before: Self::Feedback, _outcome: &OutcomeOf<Self>) -> Self::Feedback {
        before
    }

    /// Writes what is kept of an exposure in files of its own, on the thread that made it.
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

    /// Gives the memory of an image to a workspace.
    fn reuse(_: &mut Self::Workspace<'_>, _: ImageOf<Self>) {}

    /// A pipeline that is flown and scored beside that of a run, for comparison; its answers are not written.
    ///
    /// # Errors
    /// A [`Failure`] when it cannot be configured.
    fn comparison_pipeline(
        &self,
    ) -> Result<Option<Box<dyn PipelineFactory<Self::Interface> + Send>>, Failure> {
        Ok(None)
    }

    /// The built-in pipeline with the truth in the place of a stage's result, where the run was asked for it.
    ///
    /// # Errors
    /// A [`Failure`] when the pipeline cannot be built.
    fn informed_pipeline(&self) -> Result<Option<Box<dyn InformedPipeline<Self>>>, Failure> {
        Ok(None)
    }

    /// Begins a dataset: writes what does not depend on frames.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written.
    fn dataset<'a>(
        &'a self,
        directory: &'a RunDirectory,
        frame_jobs: &FrameJobs<Self::Images>,
    ) -> Result<Self::Dataset<'a>, Failure>;

    /// A scorer that has seen no frame.
    fn scorer(&self) -> Self::Scorer<'_>;

    /// Scores measurements, somebody's or our own, against the truth in `directory`, with what lies beside them: clusters, or motions;
    /// `attitude` is granted to answers with a centroid alone, in place of what the run's scenario says.
    ///
    /// # Errors
    /// A [`Failure`] for a file that cannot be read, a row of a frame that the truth does not have, or an attitude in a world without it.
    fn score_files(
        directory: &Path,
        measurements: &Path,
        beside: Option<&Path>,
        attitude: Option<AttitudeChoice>,
    ) -> Result<Self::Judgement, Failure>;

    /// Makes frames and writes them as a dataset; `done` is called after each.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written.
    fn render(
        &self,
        directory: &RunDirectory,
        frame_jobs: &FrameJobs<Self::Images>,
        done: impl Fn(),
    ) -> Result<(), Failure> {
        let mut dataset = self.dataset(directory, frame_jobs)?;
        run_frames(self, directory, frame_jobs, |exposure| {
            let (image, telemetry, truth) = Self::receive(exposure, &Self::Feedback::default());
            dataset.add(&image, telemetry, truth)?;
            done();
            Ok(image)
        })?;
        dataset.finish()?;
        Ok(directory.seal()?)
    }

    /// Makes frames, has the pipeline process them and scores its answers; writes all of it, as long as `go_on`, asked after each
    /// frame, does not fail. A scenario is one sequence: the pipeline is built once. With the truth for a stage, the pipeline is the
    /// built-in one, whatever `factory` builds. Where the pipeline does not start, the run is over after three frames, which are scored.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written or the pipeline cannot be built; what `go_on` says.
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
        let ran = run_frames(self, directory, frame_jobs, |exposure| {
            let FrameAnswer { image, telemetry, truth, outcome } = running.process(exposure)?;
            let number = Self::Interface::number(&image);
            first_failure = first_failure
                .take()
                .or_else(|| FirstFailure::from_outcome::<Self::Interface>(number, &outcome));
            answers.add(number, &outcome)?;
            scorer.add(&truth, &telemetry, &outcome)?;
            if let Some((pipeline, scorer)) = &mut beside {
                scorer.add(&truth, &telemetry, &pipeline.process(&image, &telemetry))?;
            }
            dataset.add(&image, telemetry, truth)?;
            go_on()?;
            running.check_starts().map(|()| image)
        });
        let incomplete = running.incomplete(&frame_jobs.frames);
        match ran {
            Err(Failure::NotStarted(_)) => {}
            ran => ran?,
        }
        dataset.finish()?;
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

    /// Makes frames on `jobs` threads, has a fresh pipeline process them, and hands each with its answer to `take`, in order, on
    /// the caller's thread. Nothing is written.
    ///
    /// # Errors
    /// A [`Failure`] when the pipeline cannot be built or does not start, and the first one of `take`.
    fn follow(
        &self,
        frames: Range<u64>,
        jobs: usize,
        factory: &dyn PipelineFactory<Self::Interface>,
        mut take: impl FnMut(FrameAnswer<Self>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let mut running = RunningPipeline::build(self, factory)?;
        let make = |workspace: &mut Self::Workspace<'_>, frame| self.expose(workspace, frame);
        let bytes = self.exposure_bytes() as u64;
        process_in_order(
            frames,
            jobs,
            bytes,
            || self.workspace(),
            make,
            |exposure| {
                take(running.process(exposure)?)?;
                running.check_starts()
            },
        )
    }

    /// Makes frames on this thread, has the pipeline process them and scores its answers; nothing is written. Where the pipeline does not
    /// start, it is over after three frames, as [`World::run`].
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
            let processed = running.process(self.expose(&mut workspace, frame)?)?;
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

/// A dataset for a pipeline, not read yet.
pub struct OpenDataset<W: World> {
    /// What a pipeline is told before the first image.
    pub setup: SetupOf<W>,
    /// Parameters of the built-in pipeline.
    pub config: W::Config,
    /// Number of images, where it is known.
    pub count: Option<u64>,
    /// The images, in order.
    pub images: Images<W>,
}

/// Images with their telemetry, read one by one.
pub type Images<W> = Box<dyn Iterator<Item = Result<(ImageOf<W>, TelemetryOf<W>), Failure>>>;

/// An image of a run, and what the pipeline answered.
pub struct FrameAnswer<W: World> {
    /// The image, as it was received.
    pub image: ImageOf<W>,
    /// What the pipeline was told of it.
    pub telemetry: TelemetryOf<W>,
    /// The ground truth.
    pub truth: W::Truth,
    /// The pipeline's answer.
    pub outcome: OutcomeOf<W>,
}

/// A pipeline that is given the truth as well, for the one stage whose result it replaces.
pub trait InformedPipeline<W: World> {
    /// Answers an image.
    ///
    /// # Errors
    /// A [`Failure`] when the truth is none.
    fn process(
        &mut self,
        image: &ImageOf<W>,
        telemetry: &TelemetryOf<W>,
        truth: &W::Truth,
    ) -> Result<OutcomeOf<W>, Failure>;
}

/// Writes what a run and a rendered dataset have in common: everything but answers and score.
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

    /// Completes the files, the telemetry last: it makes a dataset of the directory.
    ///
    /// # Errors
    /// [`FileError`] when a file cannot be written.
    fn finish(self) -> Result<(), FileError>;
}

/// Writes a pipeline's answers.
pub trait Answers<I: Interface>: Sized {
    /// The files: that of the measurements, which comes first, and those beside it.
    fn files(measurements: &Path) -> Vec<PathBuf>;

    /// Creates the files.
    ///
    /// # Errors
    /// [`FileError`] when one exists or cannot be created.
    fn create(files: &[PathBuf]) -> Result<Self, FileError>;

    /// Adds an answer.
    ///
    /// # Errors
    /// [`FileError`] when a file cannot be written.
    fn add(&mut self, number: u64, outcome: &I::Outcome) -> Result<(), FileError>;

    /// All answers so far in a few numbers, where the world has any.
    fn summary(&self) -> Option<AnswerSummary> {
        None
    }

    /// Completes the files, the measurements last: without them, nobody misses the others.
    ///
    /// # Errors
    /// [`FileError`] when a file cannot be written.
    fn finish(self) -> Result<(), FileError>;
}

/// Judges answers, one after the other.
pub trait Scorer<W: World> {
    /// Judges an answer, as it stands in the files of a run.
    ///
    /// # Errors
    /// A [`Failure`] for a truth that cannot be scored.
    fn add(
        &mut self,
        truth: &W::Truth,
        telemetry: &TelemetryOf<W>,
        outcome: &OutcomeOf<W>,
    ) -> Result<(), Failure>;

    /// The score, with what it was counted from.
    fn finish(self) -> W::Judgement;
}

/// A scored run.
pub trait Judgement {
    /// The content of `score.json`.
    type Score: Serialize;

    /// The score.
    fn score(&self) -> &Self::Score;

    /// The figures over all frames.
    fn figures(&self) -> &IndexMap<String, Figure>;

    /// The run frame by frame, for a comparison with another.
    fn units(&self) -> UnitTable;

    /// Takes the judgement of another pipeline on the same frames, to be shown beside this one.
    fn show_comparison(&mut self, _: Self)
    where
        Self: Sized,
    {
    }
}

/// A pipeline at work on a sequence.
struct RunningPipeline<W: World> {
    pipeline: Processor<W>,
    feedback: W::Feedback,
}

enum Processor<W: World> {
    Own(Box<dyn Pipeline<W::Interface>>),
    Informed(Box<dyn InformedPipeline<W>>),
}

impl<W: World> RunningPipeline<W> {
    fn build(world: &W, factory: &dyn PipelineFactory<W::Interface>) -> Result<Self, Failure> {
        let pipeline = match world.informed_pipeline()? {
            Some(informed) => Processor::Informed(informed),
            None => Processor::Own(factory.build(world.setup())?),
        };
        Ok(Self { pipeline, feedback: W::Feedback::default() })
    }

    fn process(&mut self, exposure: W::Exposure) -> Result<FrameAnswer<W>, Failure> {
        let (image, telemetry, truth) = W::receive(exposure, &self.feedback);
        let outcome = match &mut self.pipeline {
            Processor::Own(pipeline) => pipeline.process(&image, &telemetry),
            Processor::Informed(pipeline) => pipeline.process(&image, &telemetry, &truth)?,
        };
        self.feedback = W::feedback(self.feedback.clone(), &outcome);
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

    fn incomplete(&self, frames: &Range<u64>) -> Option<IncompleteRun> {
        self.failed_starts()
            .map(|failed| IncompleteRun::from_failed_starts(frames.end - frames.start, failed))
    }
}

/// Refuses to go on with a pipeline that does not start.
fn check_starts(failed: Option<&FailedStarts>) -> Result<(), Failure> {
    match failed.filter(|failed| failed.count >= MAX_FAILED_STARTS) {
        Some(failed) => Err(failed.clone().into()),
        None => Ok(()),
    }
}

/// The content of `score.json`.
#[derive(Serialize)]
struct ScoreFile<'a, S> {
    #[serde(flatten)]
    score: &'a S,
    #[serde(rename = "not_flown", skip_serializing_if = "Option::is_none")]
    incomplete: Option<&'a IncompleteRun>,
}

/// Makes frames, saves what is kept of each apart, and hands them to `take`, which gives back their images: later ones are made in
/// their memory.
fn run_frames<W: World>(
    world: &W,
    directory: &RunDirectory,
    frame_jobs: &FrameJobs<W::Images>,
    mut take: impl FnMut(W::Exposure) -> Result<ImageOf<W>, Failure>,
) -> Result<(), Failure> {
    let spare = Mutex::new(Vec::new());
    let spares = || spare.lock().unwrap_or_else(PoisonError::into_inner);
    let make = |workspace: &mut W::Workspace<'_>, frame| {
        let reused = spares().pop();
        reused.into_iter().for_each(|image| W::reuse(workspace, image));
        let exposure = world.expose(workspace, frame)?;
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

/// Has a pipeline process images, real ones included, and writes its answers to `measurements` and beside it.
///
/// # Errors
/// A [`Failure`] when an image cannot be read, a file not be written, or the pipeline does not start.
pub fn process<I: Interface, A: Answers<I>>(
    images: impl IntoIterator<Item = Result<(I::Image, I::Telemetry), Failure>>,
    setup: &I::Setup,
    factory: &dyn PipelineFactory<I>,
    measurements: &Path,
    done: impl Fn(),
) -> Result<AnswerCount, Failure> {
    // Under other names until all is done, so that a run that fails leaves nothing in the way of the next one.
    let files = A::files(measurements);
    let partial = PartialFiles::for_paths(&files.iter().map(PathBuf::as_path).collect::<Vec<_>>())?;
    let waiting: Vec<PathBuf> = (0..files.len()).map(|index| partial.path(index).to_owned()).collect();
    let processed = process_into(images, setup, factory, A::create(&waiting)?, done)?;
    partial.complete()?;
    Ok(processed)
}

/// Has a pipeline process images, and hands its answers to a writer.
///
/// # Errors
/// As [`process`].
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
        let failure = || FirstFailure::from_outcome::<I>(number, &outcome);
        processed.first_failure = processed.first_failure.or_else(failure);
        answers.add(number, &outcome)?;
        processed.frames += 1;
        done();
        check_starts(pipeline.failed_starts())?;
    }
    if let Some(failed) = pipeline.failed_starts() {
        return Err(failed.clone().into());
    }
    processed.summary = answers.summary();
    answers.finish()?;
    Ok(processed)
}

/// What [`process`] did.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AnswerCount {
    /// Images answered.
    pub frames: u64,
    /// The first failure of the pipeline, if it failed at all.
    pub first_failure: Option<FirstFailure>,
    /// The answers in a few numbers, where the world has any.
    pub summary: Option<AnswerSummary>,
}

/// Refuses to grant an attitude in a world whose answers are not lines of sight.
///
/// # Errors
/// [`Failure::Usage`] when one is asked for.
pub fn refuse_attitude(attitude: Option<AttitudeChoice>) -> Result<(), Failure> {
    attitude.map_or(Ok(()), |_| {
        Err(Failure::Usage("--attitude is given, expected with a run of the far range alone".to_owned()))
    })
}

pub(crate) fn unscorable(error: score::ScoreError) -> Failure {
    Failure::Usage(format!("the truth cannot be scored: {error}"))
}

/// As many files as a writer of answers has.
pub(crate) fn paths<const N: usize>(files: &[PathBuf]) -> Result<[&Path; N], FileError> {
    let paths: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    let count = paths.len();
    let first = files.first().map_or_else(PathBuf::new, Clone::clone);
    paths.try_into().map_err(|_| FileError::format(&first, "answers", format!("{count} files, expected {N}")))
}
