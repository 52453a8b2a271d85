//! Common interface of all worlds, for commands, studies and gates.

pub(crate) mod erasure;
mod provenance;
pub(crate) mod source;

use std::any::{Any, TypeId};
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::ops::Range;
use std::path::{Path, PathBuf};

use config::toml_file::{self, TomlError};
use contract::{Interface, OutOfRange, PipelineFactory};
use files::{Failure, RunDirectory};
use indexmap::IndexMap;
use scenario::run_file::{RunFile, ScenarioFile};
use scenario::{AttitudeChoice, Stage};
use schemars::{Schema, SchemaGenerator};
use score::{Figure, FigureSpec, UnitTable};
use serde_json::Value;
use sim::SimError;

use crate::choice::pipeline_choice::PipelineChoice;
use crate::choice::renderer_choice::RendererChoice;
use crate::frame_jobs::FrameJobs;
use crate::run_result::{AnswerSummary, FirstFailure, RunResult};

/// Options of a run in addition to its scenario. A world refuses options that it does not support.
#[derive(Debug, Default)]
pub struct Options {
    /// Stage of the built-in pipeline whose result is replaced by the truth.
    pub inject: Option<Stage>,
    /// Attitude granted to measurements that have only a centroid; overrides the scenario.
    pub attitude: Option<AttitudeChoice>,
    /// Renderer of the scene.
    pub renderer: RendererChoice,
}

/// A world without its types. [`ErasedWorld`](crate::ErasedWorld) converts a [`World`](crate::World) to it.
pub trait AnyWorld: Sync {
    /// Code of the world, [`World::CODE`](crate::World::CODE).
    fn code(&self) -> &'static str;

    /// Name of an image: `frame` or `field`.
    fn image(&self) -> &'static str;

    /// See [`World::STARTING_POINT`](crate::World::STARTING_POINT).
    fn starting_point(&self) -> &'static str;

    /// See [`World::SETUP_FILE`](crate::World::SETUP_FILE).
    fn setup_file(&self) -> &'static str;

    /// See [`World::TRUTH_FILE`](crate::World::TRUTH_FILE).
    fn truth_file(&self) -> &'static str;

    /// See [`World::EVIDENCE_FILE`](crate::World::EVIDENCE_FILE).
    fn evidence_file(&self) -> Option<&'static str>;

    /// See [`World::ARE_GROUPS_APART`](crate::World::ARE_GROUPS_APART).
    fn are_groups_apart(&self) -> bool;

    /// See [`World::HEADLINE`](crate::World::HEADLINE).
    fn headline(&self) -> &'static str;

    /// See [`World::PICTURES`](crate::World::PICTURES).
    fn pictures(&self) -> &'static str;

    /// See [`World::figures`](crate::World::figures).
    fn figures(&self) -> Vec<FigureSpec>;

    /// See [`World::causes`](crate::World::causes).
    fn causes(&self) -> Vec<(&'static str, &'static str)>;

    /// Returns true if the scenarios of the world have the type `type_id`.
    fn has_scenario_type(&self, type_id: TypeId) -> bool;

    /// Returns the JSON Schema of the scenario files.
    fn schema(&self, generator: SchemaGenerator) -> Schema;

    /// Returns the JSON Schema of the scenario files as a part of another schema.
    fn subschema(&self, generator: &mut SchemaGenerator) -> Schema;

    /// Parses the text of a scenario, which was read from `file`.
    ///
    /// # Errors
    /// A [`TomlError`] with the location of the first mistake.
    fn parse(&self, file: &Path, text: &str) -> Result<Box<dyn AnyScenario>, Box<TomlError>>;

    /// Reads a `run.toml`.
    ///
    /// # Errors
    /// Those of [`RunFile::read`].
    fn read_run(&self, file: &Path) -> Result<RunFile<Box<dyn AnyScenario>>, Failure>;

    /// Checks all values of a scenario of this world and prepares its simulator.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the first invalid value, or for an option that the world does not
    /// support.
    fn prepare(&self, source: &ScenarioSource, options: Options) -> Result<Box<dyn AnyMission>, Failure>;

    /// Checks that the built-in pipeline can run with the cameras of a scenario.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the parameter that prevents it.
    fn check_built_in(&self, source: &ScenarioSource) -> Result<(), Failure>;

    /// Returns the factory of the chosen pipeline, for a scenario of this world. An external program receives
    /// its images in `scratch`.
    ///
    /// # Errors
    /// Those of [`PipelineChoice::factory`].
    fn factory(
        &self,
        scenario: &dyn AnyScenario,
        choice: &PipelineChoice,
        scratch: &Path,
    ) -> Result<AnyFactory, Failure>;

    /// Refuses an image format that the world does not support.
    ///
    /// # Errors
    /// A message with the unknown format and the supported ones.
    fn check_images(&self, word: &str) -> Result<(), String>;

    /// Processes a dataset with a pipeline, and writes the outcomes to the file `measurements` and the files
    /// beside it.
    ///
    /// # Errors
    /// A [`Failure`] for a dataset that cannot be read, or files that cannot be written.
    fn process(&self, order: &ProcessingOrder<'_>) -> Result<DatasetAnswers, Failure>;

    /// See [`World::score_files`](crate::World::score_files).
    ///
    /// # Errors
    /// A [`Failure`] for a file that cannot be read, or a row of a frame that the truth does not contain.
    fn score_files(
        &self,
        directory: &Path,
        measurements: &Path,
        evidence: Option<&Path>,
        attitude: Option<AttitudeChoice>,
    ) -> Result<Box<dyn AnyJudgement>, Failure>;

    /// See [`World::telemetry_rows`](crate::World::telemetry_rows).
    ///
    /// # Errors
    /// A [`Failure`] for a file that cannot be read.
    fn telemetry_rows(&self, directory: &Path, add: &mut dyn FnMut(&dyn Debug)) -> Result<(), Failure>;
}

impl dyn AnyWorld {
    /// Refuses a pipeline that the world does not have, or a program that does not exist.
    ///
    /// # Errors
    /// Those of [`PipelineChoice::factory`].
    pub fn check_choice(&self, scenario: &dyn AnyScenario, choice: &PipelineChoice) -> Result<(), Failure> {
        self.factory(scenario, choice, Path::new("")).map(drop)
    }

    /// Returns the keys of the figures in a score, in order.
    pub fn figure_names(&self) -> Vec<String> {
        self.figures().into_iter().map(|figure| figure.name).collect()
    }

    /// Returns true if the scenarios of the world have the type `S`.
    pub fn has_scenario<S: 'static>(&self) -> bool {
        self.has_scenario_type(TypeId::of::<S>())
    }
}

impl Debug for dyn AnyWorld {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.code())
    }
}

impl PartialEq for dyn AnyWorld {
    fn eq(&self, other: &Self) -> bool {
        self.code() == other.code()
    }
}

/// A request to process a dataset.
pub struct ProcessingOrder<'a> {
    /// Directory of the dataset.
    pub directory: &'a Path,
    /// File to which the measurements are written.
    pub measurements: &'a Path,
    /// Chosen pipeline.
    pub choice: &'a PipelineChoice,
    /// Directory in which an external program receives its images.
    pub scratch: &'a Path,
    /// Called before the first frame, with the name of the pipeline and the number of frames, if known.
    pub begin: &'a dyn Fn(&str, Option<u64>),
    /// Called after each frame.
    pub done: &'a dyn Fn(),
}

/// Result of processing a dataset.
#[derive(Debug)]
pub struct DatasetAnswers {
    /// Number of frames.
    pub frames: u64,
    /// Written files, the measurements first.
    pub files: Vec<PathBuf>,
    /// First failure of the pipeline, if any.
    pub first_failure: Option<FirstFailure>,
    /// Summary of the outcomes, if the world provides one.
    pub summary: Option<AnswerSummary>,
}

/// A scenario of any world.
pub trait AnyScenario: Debug + Send + Sync {
    /// Returns the world of the scenario.
    fn world(&self) -> &'static dyn AnyWorld;

    /// Returns the title of the scenario, one line.
    fn title(&self) -> &str;

    /// Returns the seed of the random draws.
    fn seed(&self) -> u64;

    /// Sets the seed of the random draws.
    fn set_seed(&mut self, seed: u64);

    /// See [`ScenarioFile::paths`].
    fn paths(&mut self) -> Vec<(&'static str, &mut String)>;

    /// Returns all values of the scenario, including defaults.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the values cannot be written as JSON.
    fn to_json(&self) -> Result<Value, Failure>;

    /// Returns the scenario as TOML, including defaults.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a value that TOML cannot express.
    fn to_toml(&self) -> Result<String, Failure>;

    /// Returns a boxed copy.
    fn boxed(&self) -> Box<dyn AnyScenario>;

    /// Returns the scenario for a downcast to its type.
    fn as_any(&self) -> &dyn Any;

    /// Returns the mutable scenario for a downcast to its type.
    fn as_any_mut(&mut self) -> &mut dyn Any;
}

impl Clone for Box<dyn AnyScenario> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}

/// Factory of a pipeline of any world.
pub struct AnyFactory {
    /// Name of the pipeline in tables and logs.
    pub name: String,
    factory: Box<dyn Any + Send + Sync>,
}

impl AnyFactory {
    /// Creates a factory from that of a world.
    pub fn new<I: Interface>(factory: Box<dyn PipelineFactory<I> + Send>) -> Self {
        Self { name: factory.name(), factory: Box::new(factory) }
    }

    /// Returns the factory of pipelines with the interface `I`.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the factory belongs to another world.
    pub fn downcast<I: Interface>(&self) -> Result<&dyn PipelineFactory<I>, Failure> {
        match self.factory.downcast_ref::<Box<dyn PipelineFactory<I> + Send>>() {
            Some(factory) => Ok(factory.as_ref()),
            None => Err(Failure::Usage("the pipeline belongs to another world than the scenario".to_owned())),
        }
    }
}

/// A scenario with its simulator, of any world. The methods correspond to those of [`World`](crate::World).
pub trait AnyMission: Send + Sync {
    /// See [`World::frame_count`](crate::World::frame_count).
    fn frame_count(&self) -> u64;

    /// See [`World::summary`](crate::World::summary).
    fn summary(&self) -> (Value, String);

    /// See [`World::warnings`](crate::World::warnings).
    fn warnings(&self) -> Vec<String>;

    /// Returns the factory of the chosen pipeline.
    ///
    /// # Errors
    /// Those of [`PipelineChoice::factory`].
    fn factory(&self, choice: &PipelineChoice, scratch: &Path) -> Result<AnyFactory, Failure>;

    /// Refuses a flight that cannot succeed, before anything is written.
    ///
    /// # Errors
    /// A [`Failure`] with the reason.
    fn check_frame_jobs(&self, frame_jobs: &FrameJobs<String>) -> Result<(), Failure>;

    /// Renders a dataset, as [`sequence::render`](crate::sequence::render); returns a description of the
    /// files that it contains for a pipeline.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written.
    fn render(
        &self,
        directory: &RunDirectory,
        frame_jobs: &FrameJobs<String>,
        done: &dyn Fn(),
    ) -> Result<String, Failure>;

    /// See [`World::check_stream`](crate::World::check_stream).
    ///
    /// # Errors
    /// [`Failure::Usage`] for a format that cannot be streamed, or a world without a stream.
    fn check_stream(&self, frame_jobs: &FrameJobs<String>) -> Result<(), Failure>;

    /// See [`World::stream`](crate::World::stream).
    ///
    /// # Errors
    /// A [`Failure`] when standard output cannot be written, or the world has no stream.
    fn stream(&self, frame_jobs: &FrameJobs<String>) -> Result<(), Failure>;

    /// See [`sequence::run`](crate::sequence::run).
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written or the pipeline cannot be built; the error of `go_on`.
    fn run(
        &self,
        directory: &RunDirectory,
        frame_jobs: &FrameJobs<String>,
        factory: &AnyFactory,
        go_on: &dyn Fn() -> Result<(), Failure>,
    ) -> Result<RunResult<Box<dyn AnyJudgement>>, Failure>;

    /// See [`sequence::score`](crate::sequence::score).
    ///
    /// # Errors
    /// A [`Failure`] when the pipeline cannot be built.
    fn score(
        &self,
        frames: Range<u64>,
        factory: &AnyFactory,
    ) -> Result<RunResult<Box<dyn AnyJudgement>>, Failure>;

    /// Returns the mission for a downcast to its type.
    fn into_any(self: Box<Self>) -> Box<dyn Any>;
}

/// A scored run of any world.
pub trait AnyJudgement: Send {
    /// Returns the content of `score.json`.
    ///
    /// # Errors
    /// A [`Failure`] when the score cannot be written as JSON.
    fn json(&self) -> Result<String, Failure>;

    /// Returns the figures over all frames.
    fn figures(&self) -> &IndexMap<String, Figure>;

    /// Returns the run frame by frame, for a comparison with another run.
    fn units(&self) -> UnitTable;

    /// Returns the scored run for a downcast to its type.
    fn as_any(&self) -> &dyn Any;

    /// Returns the mutable scored run for a downcast to its type.
    fn as_any_mut(&mut self) -> &mut dyn Any;
}

/// A scenario that was read, with its text to locate mistakes found later. [`ScenarioSource::prepare`] checks
/// its values.
#[derive(Debug, Clone)]
pub struct ScenarioSource {
    /// Name of the built-in scenario, or of the file without its extension.
    pub name: String,
    /// Directory that relative paths in the scenario refer to.
    pub folder: PathBuf,
    /// Scenario with its world.
    pub scenario: Box<dyn AnyScenario>,
    pub(crate) file: PathBuf,
    pub(crate) text: String,
    /// SHA-256 of the files at the time when the scenario was read, by absolute path. A file that changes
    /// before it is used is refused.
    pub(crate) contents: BTreeMap<PathBuf, String>,
}

impl ScenarioSource {
    /// Returns the world of the scenario.
    pub fn world(&self) -> &'static dyn AnyWorld {
        self.scenario.world()
    }

    /// Checks all values of the scenario and prepares its simulator.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the first invalid value, or for an option that the world does not
    /// support.
    pub fn prepare(&self, options: Options) -> Result<Box<dyn AnyMission>, Failure> {
        self.world().prepare(self, options)
    }

    /// Returns the scenario with its type `S`, for an operation that only the world of `S` supports.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the scenario is of another world; `what` names the operation.
    pub fn typed<S: ScenarioFile>(&self, what: &str) -> Result<&S, Failure> {
        self.scenario.as_any().downcast_ref().ok_or_else(|| {
            Failure::Usage(format!(
                "{what}: scenario `{}` belongs to another world, expected a scenario of {}",
                self.name,
                S::WORLD
            ))
        })
    }

    /// Adds the location in the file to an error about a value that the simulator refuses.
    pub fn explain(&self, error: SimError) -> Failure {
        match error {
            SimError::OutOfRange(error) => self.out_of_range(&error),
            error => error.into(),
        }
    }

    /// Adds the location in the file to an error about a value in the table `table` of the scenario.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the value.
    pub fn check_part(&self, table: &str, checked: Result<(), OutOfRange>) -> Result<(), Failure> {
        checked.map_err(|error| self.out_of_range(&error.under(table)))
    }

    /// Adds the location in the file to an error about a value outside its range.
    pub fn out_of_range(&self, error: &OutOfRange) -> Failure {
        toml_file::out_of_range(&self.file, &self.text, error).into()
    }

    /// Returns the failure for a value at a path of the scenario.
    pub fn refuse(&self, path: &str, message: String) -> Failure {
        toml_file::refuse(&self.file, &self.text, path, message).into()
    }
}
