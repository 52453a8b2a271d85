//! Worlds without their types.

use std::any::TypeId;
use std::fmt::Debug;
use std::marker::PhantomData;
use std::path::Path;

use config::toml_file::TomlError;
use contract::Interface as _;
use files::Failure;
use scenario::AttitudeChoice;
use scenario::run_file::{RunFile, ScenarioFile as _};
use schemars::{Schema, SchemaGenerator};
use score::FigureSpec;

use super::erased::erased;
use super::{AnyFactory, AnyJudgement, AnyMission, AnyScenario, Options, ScenarioSource};
use crate::choice::pipeline_choice::PipelineChoice;
use crate::run_result::{AnswerSummary, FirstFailure};
use crate::sequence::process;
use crate::world::{Answers as _, World, WorldFacts};

/// The world `W` without its type parameters.
pub struct ErasedWorld<W>(PhantomData<fn() -> W>);

impl<W> ErasedWorld<W> {
    /// The only value of this type.
    pub const NEW: Self = Self(PhantomData);
}

erased! {
    /// A world without its types: [`ErasedWorld`] of a [`World`].
    pub trait AnyWorld: Sync;

    impl<W: World> for ErasedWorld<W> {
        /// Returns the code of the world.
        fn code(&self) -> &'static str {
            W::CODE
        }

        /// Returns the name of an image: `frame` or `field`.
        fn image(&self) -> &'static str {
            W::Interface::IMAGE
        }

        /// Returns a commented scenario as a starting point for the user.
        fn starting_point(&self) -> &'static str {
            W::Scenario::STARTING_POINT
        }

        /// Returns the constants of the world.
        fn facts(&self) -> WorldFacts {
            W::FACTS
        }

        /// Returns the figures of a score.
        fn figures(&self) -> Vec<FigureSpec> {
            W::figures()
        }

        /// Returns all causes that a unit's verdict may have, each as (verdict, cause).
        fn causes(&self) -> Vec<(&'static str, &'static str)> {
            W::causes()
        }

        /// Returns true if the scenarios of the world have the type `type_id`.
        fn has_scenario_type(&self, type_id: TypeId) -> bool {
            type_id == TypeId::of::<W::Scenario>()
        }

        /// Returns the JSON Schema of the scenario files.
        fn schema(&self, generator: SchemaGenerator) -> Schema {
            W::Scenario::schema(generator)
        }

        /// Returns the JSON Schema of the scenario files as a part of another schema.
        fn subschema(&self, generator: &mut SchemaGenerator) -> Schema {
            W::Scenario::subschema(generator)
        }

        /// Parses the text of a scenario, which was read from `file`.
        ///
        /// # Errors
        /// A [`TomlError`] with the location of the first mistake.
        fn parse(&self, file: &Path, text: &str) -> Result<AnyScenario, Box<TomlError>> {
            Ok(AnyScenario::of::<W>(W::Scenario::parse(file, text)?))
        }

        /// Reads a `run.toml`.
        ///
        /// # Errors
        /// Those of [`RunFile::read`].
        fn read_run(&self, file: &Path) -> Result<RunFile<AnyScenario>, Failure> {
            Ok(RunFile::<W::Scenario>::read(file)?.map(AnyScenario::of::<W>))
        }

        /// Checks all values of a scenario of this world and prepares its simulator.
        ///
        /// # Errors
        /// A [`Failure`] with the location of the first invalid value, or for an option that the world does
        /// not support.
        fn prepare(&self, source: &ScenarioSource, options: Options) -> Result<Box<dyn AnyMission>, Failure> {
            Ok(Box::new(W::prepare(source, source.typed(W::CODE)?, options)?))
        }

        /// Checks that the built-in pipeline can run with the cameras of a scenario.
        ///
        /// # Errors
        /// A [`Failure`] with the location of the parameter that prevents it.
        fn check_built_in(&self, source: &ScenarioSource) -> Result<(), Failure> {
            W::check_built_in(source, source.typed(W::CODE)?)
        }

        /// Returns the factory of the chosen pipeline, for a scenario of this world. An external program
        /// receives its images in `scratch`.
        ///
        /// # Errors
        /// Those of [`PipelineChoice::factory`].
        fn factory(
            &self,
            scenario: &AnyScenario,
            choice: &PipelineChoice,
            scratch: &Path,
        ) -> Result<AnyFactory, Failure> {
            match scenario.values::<W::Scenario>() {
                Some(scenario) => Ok(AnyFactory::new(choice.factory::<W>(W::config(scenario), scratch)?)),
                None => {
                    let message = format!("the scenario belongs to another world than {}", W::CODE);
                    Err(Failure::Usage(message))
                }
            }
        }

        /// Refuses an image format that the world does not support.
        ///
        /// # Errors
        /// A message with the unknown format and the supported ones.
        fn check_images(&self, word: &str) -> Result<(), String> {
            word.parse::<W::Images>().map(drop)
        }

        /// Processes a dataset with a pipeline, and writes the outcomes to the file `measurements` and the
        /// files beside it.
        ///
        /// # Errors
        /// A [`Failure`] for a dataset that cannot be read, or files that cannot be written.
        fn process(&self, order: &ProcessingOrder<'_>) -> Result<DatasetAnswers, Failure> {
            process_dataset::<W>(order)
        }

        /// Scores measurements of an external or a built-in pipeline against the truth in `directory`, with
        /// the file `evidence` beside them.
        ///
        /// # Errors
        /// A [`Failure`] for a file that cannot be read, or a row of a frame that the truth does not contain.
        fn score_files(
            &self,
            directory: &Path,
            measurements: &Path,
            evidence: Option<&Path>,
            attitude: Option<AttitudeChoice>,
        ) -> Result<Box<dyn AnyJudgement>, Failure> {
            Ok(Box::new(W::score_files(directory, measurements, evidence, attitude)?))
        }

        /// Passes to `add`, for every frame of a run, the input of a pipeline besides the image.
        ///
        /// # Errors
        /// A [`Failure`] for a file that cannot be read.
        fn telemetry_rows(&self, directory: &Path, add: &mut dyn FnMut(&dyn Debug)) -> Result<(), Failure> {
            W::telemetry_rows(directory, add)
        }
    }
}

/// Processes a dataset of the world `W`.
fn process_dataset<W: World>(order: &ProcessingOrder<'_>) -> Result<DatasetAnswers, Failure> {
    let dataset = W::open(order.directory)?;
    let factory = order.choice.factory::<W>(&dataset.config, order.scratch)?;
    (order.begin)(&factory.name(), dataset.count);
    let processed = process::<_, W::Answers>(
        dataset.images,
        &dataset.setup,
        factory.as_ref(),
        order.measurements,
        order.done,
    )?;
    Ok(DatasetAnswers {
        frames: processed.frames,
        beside: W::Answers::BESIDE,
        first_failure: processed.first_failure,
        summary: processed.summary,
    })
}

impl dyn AnyWorld {
    /// Refuses a pipeline that the world does not have, or a program that does not exist.
    ///
    /// # Errors
    /// Those of [`PipelineChoice::factory`].
    pub fn check_choice(&self, scenario: &AnyScenario, choice: &PipelineChoice) -> Result<(), Failure> {
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
    /// Names of the files written beside the measurements, of [`files::file_beside`].
    pub beside: &'static [&'static str],
    /// First failure of the pipeline, if any.
    pub first_failure: Option<FirstFailure>,
    /// Summary of the outcomes, if the world provides one.
    pub summary: Option<AnswerSummary>,
}
