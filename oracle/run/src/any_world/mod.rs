//! Worlds behind one face: all that commands, studies and gates need of any of them.

pub(crate) mod erased;
mod provenance;
pub(crate) mod source;

use std::any::{Any, TypeId};
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::ops::Range;
use std::path::{Path, PathBuf};

use contract::{Interface, OutOfRange, PipelineFactory};
use files::toml_file::{self, TomlError};
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

/// What a run is asked for beside its scenario. A world refuses what it does not have.
#[derive(Debug, Default)]
pub struct Options {
    /// The stage of the built-in pipeline whose result is replaced by the truth.
    pub inject: Option<Stage>,
    /// The attitude granted to answers with a centroid alone, in place of what the scenario says.
    pub attitude: Option<AttitudeChoice>,
    /// Who draws the scene.
    pub renderer: RendererChoice,
}

/// A world, without its types. [`ErasedWorld`](crate::Of) makes one of a [`World`](crate::World).
pub trait AnyWorld: Sync {
    /// [`World::CODE`](crate::World::CODE).
    fn code(&self) -> &'static str;

    /// What an image is called: `frame` or `field`.
    fn image(&self) -> &'static str;

    /// [`World::STARTING_POINT`](crate::World::STARTING_POINT).
    fn starting_point(&self) -> &'static str;

    /// [`World::SETUP_FILE`](crate::World::SETUP_FILE).
    fn setup_file(&self) -> &'static str;

    /// [`World::TRUTH_FILE`](crate::World::TRUTH_FILE).
    fn truth_file(&self) -> &'static str;

    /// [`World::EVIDENCE_FILE`](crate::World::EVIDENCE_FILE).
    fn evidence_file(&self) -> Option<&'static str>;

    /// [`World::ARE_GROUPS_APART`](crate::World::ARE_GROUPS_APART).
    fn are_groups_apart(&self) -> bool;

    /// [`World::HEADLINE`](crate::World::HEADLINE).
    fn headline(&self) -> &'static str;

    /// [`World::PICTURES`](crate::World::PICTURES).
    fn pictures(&self) -> &'static str;

    /// [`World::figures`](crate::World::figures).
    fn figures(&self) -> Vec<FigureSpec>;

    /// [`World::causes`](crate::World::causes).
    fn causes(&self) -> Vec<(&'static str, &'static str)>;

    /// Whether its scenarios are of the type `type_id`.
    fn has_scenario_type(&self, type_id: TypeId) -> bool;

    /// The JSON Schema of its scenario files.
    fn schema(&self, generator: SchemaGenerator) -> Schema;

    /// The same as a part of another schema.
    fn subschema(&self, generator: &mut SchemaGenerator) -> Schema;

    /// Reads the text of a scenario, which came from `file`.
    ///
    /// # Errors
    /// A [`TomlError`] with the place of the first mistake.
    fn parse(&self, file: &Path, text: &str) -> Result<Box<dyn AnyScenario>, Box<TomlError>>;

    /// Reads a `run.toml`.
    ///
    /// # Errors
    /// As [`RunFile::read`].
    fn read_run(&self, file: &Path) -> Result<RunFile<Box<dyn AnyScenario>>, Failure>;

    /// Checks all values of a scenario of this world and prepares its simulator.
    ///
    /// # Errors
    /// A [`Failure`] with the place of the first value that is not allowed, or for an option that the world does not have.
    fn prepare(&self, source: &ScenarioSource, options: Options) -> Result<Box<dyn AnyMission>, Failure>;

    /// Checks that the built-in pipeline can be run on the cameras of a scenario.
    ///
    /// # Errors
    /// A [`Failure`] with the place of the parameter by which it cannot.
    fn check_built_in(&self, source: &ScenarioSource) -> Result<(), Failure>;

    /// The factory of the pipeline chosen, for a scenario of this world. A program finds its images in `scratch`.
    ///
    /// # Errors
    /// As [`PipelineChoice::factory`].
    fn factory(
        &self,
        scenario: &dyn AnyScenario,
        choice: &PipelineChoice,
        scratch: &Path,
    ) -> Result<AnyFactory, Failure>;

    /// Refuses a format of images that the world does not have.
    ///
    /// # Errors
    /// A message with the word and those that there are.
    fn check_images(&self, word: &str) -> Result<(), String>;

    /// Has a pipeline process a dataset, and writes its answers to the file `measurements` and those beside it.
    ///
    /// # Errors
    /// A [`Failure`] for a dataset that cannot be read, or files that cannot be written.
    fn process(&self, order: &ProcessingOrder<'_>) -> Result<DatasetAnswers, Failure>;

    /// [`World::score_files`](crate::World::score_files).
    ///
    /// # Errors
    /// A [`Failure`] for a file that cannot be read, or a row of a frame that the truth does not have.
    fn score_files(
        &self,
        directory: &Path,
        measurements: &Path,
        evidence: Option<&Path>,
        attitude: Option<AttitudeChoice>,
    ) -> Result<Box<dyn AnyJudgement>, Failure>;

    /// [`World::telemetry_rows`](crate::World::telemetry_rows).
    ///
    /// # Errors
    /// A [`Failure`] for a file that cannot be read.
    fn telemetry_rows(&self, directory: &Path, add: &mut dyn FnMut(&dyn Debug)) -> Result<(), Failure>;
}

impl dyn AnyWorld {
    /// Refuses a pipeline that the world does not have, or a program that is not there.
    ///
    /// # Errors
    /// As [`PipelineChoice::factory`].
    pub fn check_choice(&self, scenario: &dyn AnyScenario, choice: &PipelineChoice) -> Result<(), Failure> {
        self.factory(scenario, choice, Path::new("")).map(drop)
    }

    /// Keys of the figures of its scores, in their order.
    pub fn figure_names(&self) -> Vec<String> {
        self.figures().into_iter().map(|figure| figure.name).collect()
    }

    /// Whether its scenarios have the type `S`.
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

/// A dataset to be processed.
pub struct ProcessingOrder<'a> {
    /// The dataset.
    pub directory: &'a Path,
    /// Where the answers go.
    pub measurements: &'a Path,
    /// The pipeline.
    pub choice: &'a PipelineChoice,
    /// Folder in which a program finds its images.
    pub scratch: &'a Path,
    /// Called with the pipeline's name and the number of frames, where it is known, before the first.
    pub begin: &'a dyn Fn(&str, Option<u64>),
    /// Called after each frame.
    pub done: &'a dyn Fn(),
}

/// What came of a dataset that was processed.
#[derive(Debug)]
pub struct DatasetAnswers {
    /// Number of frames.
    pub frames: u64,
    /// The files of answers, the measurements first.
    pub files: Vec<PathBuf>,
    /// The first failure of the pipeline, if it failed at all.
    pub first_failure: Option<FirstFailure>,
    /// The answers in a few numbers, where the world has any.
    pub summary: Option<AnswerSummary>,
}

/// A scenario of any world.
pub trait AnyScenario: Debug + Send + Sync {
    /// Its world.
    fn world(&self) -> &'static dyn AnyWorld;

    /// What it is, in one line.
    fn title(&self) -> &str;

    /// Seed of its random draws.
    fn seed(&self) -> u64;

    /// Gives it another seed.
    fn set_seed(&mut self, seed: u64);

    /// [`ScenarioFile::paths`].
    fn paths(&mut self) -> Vec<(&'static str, &mut String)>;

    /// All its values, defaults included.
    ///
    /// # Errors
    /// [`Failure::Usage`] when they cannot be written as JSON.
    fn to_json(&self) -> Result<Value, Failure>;

    /// The scenario as TOML, all defaults written out.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a value that TOML does not have.
    fn to_toml(&self) -> Result<String, Failure>;

    /// A copy.
    fn boxed(&self) -> Box<dyn AnyScenario>;

    /// The scenario with its type.
    fn as_any(&self) -> &dyn Any;

    /// The same to be changed.
    fn as_any_mut(&mut self) -> &mut dyn Any;
}

impl Clone for Box<dyn AnyScenario> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}

/// The factory of a pipeline of any world.
pub struct AnyFactory {
    /// Name of the pipeline, for tables and logs.
    pub name: String,
    factory: Box<dyn Any + Send + Sync>,
}

impl AnyFactory {
    /// That of a world's factory.
    pub fn new<I: Interface>(factory: Box<dyn PipelineFactory<I> + Send>) -> Self {
        Self { name: factory.name(), factory: Box::new(factory) }
    }

    /// The factory of pipelines with the interface `I`.
    ///
    /// # Errors
    /// [`Failure::Usage`] when it is one of another world.
    pub fn downcast<I: Interface>(&self) -> Result<&dyn PipelineFactory<I>, Failure> {
        match self.factory.downcast_ref::<Box<dyn PipelineFactory<I> + Send>>() {
            Some(factory) => Ok(factory.as_ref()),
            None => Err(Failure::Usage("the pipeline is of another world than the scenario".to_owned())),
        }
    }
}

/// A scenario with its simulator, of any world. Its methods are those of [`World`](crate::World).
pub trait AnyMission: Send + Sync {
    /// [`World::frame_count`](crate::World::frame_count).
    fn frame_count(&self) -> u64;

    /// [`World::summary`](crate::World::summary).
    fn summary(&self) -> (Value, String);

    /// [`World::warnings`](crate::World::warnings).
    fn warnings(&self) -> Vec<String>;

    /// The factory of the pipeline chosen.
    ///
    /// # Errors
    /// As [`PipelineChoice::factory`].
    fn factory(&self, choice: &PipelineChoice, scratch: &Path) -> Result<AnyFactory, Failure>;

    /// Refuses a flight that cannot succeed, while nothing has been written.
    ///
    /// # Errors
    /// A [`Failure`] that says why it cannot.
    fn check_frame_jobs(&self, frame_jobs: &FrameJobs<String>) -> Result<(), Failure>;

    /// [`World::render`](crate::World::render); gives what the dataset holds for a pipeline, in words.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written.
    fn render(
        &self,
        directory: &RunDirectory,
        frame_jobs: &FrameJobs<String>,
        done: &dyn Fn(),
    ) -> Result<String, Failure>;

    /// [`World::check_stream`](crate::World::check_stream).
    ///
    /// # Errors
    /// [`Failure::Usage`] for a format that is no stream, or a world that has none.
    fn check_stream(&self, frame_jobs: &FrameJobs<String>) -> Result<(), Failure>;

    /// [`World::stream`](crate::World::stream).
    ///
    /// # Errors
    /// A [`Failure`] when standard output cannot be written, or the world has no stream.
    fn stream(&self, frame_jobs: &FrameJobs<String>) -> Result<(), Failure>;

    /// [`World::run`](crate::World::run).
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written or the pipeline cannot be built; what `go_on` says.
    fn run(
        &self,
        directory: &RunDirectory,
        frame_jobs: &FrameJobs<String>,
        factory: &AnyFactory,
        go_on: &dyn Fn() -> Result<(), Failure>,
    ) -> Result<RunResult<Box<dyn AnyJudgement>>, Failure>;

    /// [`World::score`](crate::World::score).
    ///
    /// # Errors
    /// A [`Failure`] when the pipeline cannot be built.
    fn score(
        &self,
        frames: Range<u64>,
        factory: &AnyFactory,
    ) -> Result<RunResult<Box<dyn AnyJudgement>>, Failure>;

    /// The mission with its type.
    fn into_any(self: Box<Self>) -> Box<dyn Any>;
}

/// A scored run of any world.
pub trait AnyJudgement: Send {
    /// The content of `score.json`.
    ///
    /// # Errors
    /// A [`Failure`] when it cannot be written as JSON.
    fn json(&self) -> Result<String, Failure>;

    /// The figures over all frames.
    fn figures(&self) -> &IndexMap<String, Figure>;

    /// The run frame by frame, for a comparison with another.
    fn units(&self) -> UnitTable;

    /// The scored run with its type.
    fn as_any(&self) -> &dyn Any;

    /// The same to be changed.
    fn as_any_mut(&mut self) -> &mut dyn Any;
}

/// A scenario that was read, with its text for the places of later mistakes. [`ScenarioSource::prepare`] checks its values.
#[derive(Debug, Clone)]
pub struct ScenarioSource {
    /// Name: that of the built-in one, or the file's without its extension.
    pub name: String,
    /// Folder that relative paths in the scenario start from.
    pub folder: PathBuf,
    /// The scenario.
    pub scenario: Box<dyn AnyScenario>,
    pub(crate) file: PathBuf,
    pub(crate) text: String,
    /// SHA-256 of files as they were when the scenario was read, by absolute path. A file that changes before it is used is refused.
    pub(crate) contents: BTreeMap<PathBuf, String>,
}

impl ScenarioSource {
    /// The world of the scenario.
    pub fn world(&self) -> &'static dyn AnyWorld {
        self.scenario.world()
    }

    /// Checks all values of the scenario and prepares its simulator.
    ///
    /// # Errors
    /// A [`Failure`] with the place of the first value that is not allowed, or for an option that the world does not have.
    pub fn prepare(&self, options: Options) -> Result<Box<dyn AnyMission>, Failure> {
        self.world().prepare(self, options)
    }

    /// The scenario as one of the world that has the type `S`, for what that world alone can do.
    ///
    /// # Errors
    /// [`Failure::Usage`] when it is of another world; `what` is what was meant to be done with it.
    pub fn typed<S: ScenarioFile>(&self, what: &str) -> Result<&S, Failure> {
        self.scenario.as_any().downcast_ref().ok_or_else(|| {
            Failure::Usage(format!(
                "{what}: scenario `{}` is of another world, expected one of {}",
                self.name,
                S::WORLD
            ))
        })
    }

    /// Gives a value that the simulator refuses its place in the file.
    pub fn explain(&self, error: SimError) -> Failure {
        match error {
            SimError::OutOfRange(error) => self.out_of_range(&error),
            error => error.into(),
        }
    }

    /// Gives a value that is refused in the table `table` of the scenario its place in the file.
    ///
    /// # Errors
    /// A [`Failure`] with the place of the value.
    pub fn check_part(&self, table: &str, checked: Result<(), OutOfRange>) -> Result<(), Failure> {
        checked.map_err(|error| self.out_of_range(&error.under(table)))
    }

    /// Gives a value outside its range its place in the file.
    pub fn out_of_range(&self, error: &OutOfRange) -> Failure {
        toml_file::out_of_range(&self.file, &self.text, error).into()
    }

    /// The failure of a value at a path of the scenario.
    pub fn refuse(&self, path: &str, message: String) -> Failure {
        toml_file::refuse(&self.file, &self.text, path, message).into()
    }
}
