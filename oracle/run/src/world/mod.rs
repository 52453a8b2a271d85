//! A world: the parts in which runs differ. The run itself is the same for every world ([`crate::sequence`]).

mod answers;

use std::fmt::Debug;
use std::path::Path;
use std::str::FromStr;

use contract::{Interface, PipelineFactory};
use files::{Failure, FileError, RunDirectory};
use pipeline::external::Protocol;
use scenario::AttitudeChoice;
use scenario::run_file::{RunFile, ScenarioFile};
use score::FigureSpec;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

pub use self::answers::{Answers, Judgement, paths};
use crate::any_world::{Options, ScenarioSource};
use crate::frame_jobs::FrameJobs;

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
/// are logged ([`crate::sequence`]), so that any frame can be made again alone, bit for bit.
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

/// Refuses to grant an attitude in a world whose measurements are not lines of sight.
///
/// # Errors
/// [`Failure::Usage`] when an attitude is requested.
pub fn refuse_attitude(attitude: Option<AttitudeChoice>) -> Result<(), Failure> {
    attitude.map_or(Ok(()), |_| {
        Err(Failure::Usage("--attitude requires a world whose measurements are lines of sight".to_owned()))
    })
}

/// Returns the failure for a truth that cannot be scored.
pub fn unscorable(error: score::ScoreError) -> Failure {
    Failure::Usage(format!("the truth cannot be scored: {error}"))
}
