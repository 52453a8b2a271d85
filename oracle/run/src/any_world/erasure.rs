//! Type-erased worlds, scenarios, simulators and scores.

use std::any::{Any, TypeId};
use std::fmt::Debug;
use std::marker::PhantomData;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use config::toml_file::TomlError;
use contract::{Interface, PipelineFactory};
use files::{Failure, RunDirectory, format_utc};
use indexmap::IndexMap;
use pipeline::external::ExternalFactory;
use scenario::AttitudeChoice;
use scenario::run_file::{RunFile, ScenarioFile};
use schemars::{Schema, SchemaGenerator};
use score::{Figure, FigureSpec, UnitTable};
use serde_json::Value;

use crate::any_world::{
    AnyFactory, AnyJudgement, AnyMission, AnyScenario, AnyWorld, DatasetAnswers, Options, ProcessingOrder,
    ScenarioSource,
};
use crate::check::unit_mistakes::unit_mistakes;
use crate::choice::pipeline_choice::PipelineChoice;
use crate::frame_jobs::FrameJobs;
use crate::run_result::RunResult;
use crate::sequence::{self, process};
use crate::world::{Answers, Judgement, World};

impl<S: Judgement + Send + 'static> AnyJudgement for S {
    fn json(&self) -> Result<String, Failure> {
        serde_json::to_string_pretty(self.score())
            .map_err(|error| Failure::Usage(format!("the score cannot be written as JSON: {error}")))
    }

    fn figures(&self) -> &IndexMap<String, Figure> {
        Judgement::figures(self)
    }

    fn units(&self) -> UnitTable {
        Judgement::units(self)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }
}

/// The world `W` without its type parameters.
pub struct ErasedWorld<W>(PhantomData<fn() -> W>);

impl<W> ErasedWorld<W> {
    /// The only value of this type.
    pub const NEW: Self = Self(PhantomData);
}

impl<W: World> ErasedWorld<W> {
    fn scenario(source: &ScenarioSource) -> Result<&W::Scenario, Failure> {
        source.typed(W::CODE)
    }
}

/// A scenario of the world `W`.
#[derive(Clone)]
struct ErasedScenario<W: World>(W::Scenario);

impl<W: World> AnyWorld for ErasedWorld<W> {
    fn code(&self) -> &'static str {
        W::CODE
    }

    fn image(&self) -> &'static str {
        W::Interface::IMAGE
    }

    fn starting_point(&self) -> &'static str {
        W::STARTING_POINT
    }

    fn setup_file(&self) -> &'static str {
        W::SETUP_FILE
    }

    fn truth_file(&self) -> &'static str {
        W::TRUTH_FILE
    }

    fn evidence_file(&self) -> Option<&'static str> {
        W::EVIDENCE_FILE
    }

    fn are_groups_apart(&self) -> bool {
        W::ARE_GROUPS_APART
    }

    fn headline(&self) -> &'static str {
        W::HEADLINE
    }

    fn pictures(&self) -> &'static str {
        W::PICTURES
    }

    fn figures(&self) -> Vec<FigureSpec> {
        W::figures()
    }

    fn causes(&self) -> Vec<(&'static str, &'static str)> {
        W::causes()
    }

    fn has_scenario_type(&self, type_id: TypeId) -> bool {
        type_id == TypeId::of::<W::Scenario>()
    }

    fn schema(&self, generator: SchemaGenerator) -> Schema {
        W::Scenario::schema(generator)
    }

    fn subschema(&self, generator: &mut SchemaGenerator) -> Schema {
        W::Scenario::subschema(generator)
    }

    fn parse(&self, file: &Path, text: &str) -> Result<Box<dyn AnyScenario>, Box<TomlError>> {
        Ok(Box::new(ErasedScenario::<W>(W::Scenario::parse(file, text)?)))
    }

    fn read_run(&self, file: &Path) -> Result<RunFile<Box<dyn AnyScenario>>, Failure> {
        let run = RunFile::<W::Scenario>::read(file)?;
        Ok(run.map(|scenario| Box::new(ErasedScenario::<W>(scenario)) as Box<dyn AnyScenario>))
    }

    fn prepare(&self, source: &ScenarioSource, options: Options) -> Result<Box<dyn AnyMission>, Failure> {
        Ok(Box::new(W::prepare(source, Self::scenario(source)?, options)?))
    }

    fn check_built_in(&self, source: &ScenarioSource) -> Result<(), Failure> {
        W::check_built_in(source, Self::scenario(source)?)
    }

    fn factory(
        &self,
        scenario: &dyn AnyScenario,
        choice: &PipelineChoice,
        scratch: &Path,
    ) -> Result<AnyFactory, Failure> {
        match scenario.as_any().downcast_ref::<W::Scenario>() {
            Some(scenario) => Ok(AnyFactory::new(choice.factory::<W>(W::config(scenario), scratch)?)),
            None => Err(Failure::Usage(format!("the scenario belongs to another world than {}", W::CODE))),
        }
    }

    fn check_images(&self, word: &str) -> Result<(), String> {
        word.parse::<W::Images>().map(drop)
    }

    fn process(&self, order: &ProcessingOrder<'_>) -> Result<DatasetAnswers, Failure> {
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
            files: W::Answers::files(order.measurements),
            first_failure: processed.first_failure,
            summary: processed.summary,
        })
    }

    fn score_files(
        &self,
        directory: &Path,
        measurements: &Path,
        evidence: Option<&Path>,
        attitude: Option<AttitudeChoice>,
    ) -> Result<Box<dyn AnyJudgement>, Failure> {
        Ok(Box::new(W::score_files(directory, measurements, evidence, attitude)?))
    }

    fn telemetry_rows(&self, directory: &Path, add: &mut dyn FnMut(&dyn Debug)) -> Result<(), Failure> {
        W::telemetry_rows(directory, add)
    }
}

impl<W: World> Debug for ErasedScenario<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl<W: World> AnyScenario for ErasedScenario<W> {
    fn world(&self) -> &'static dyn AnyWorld {
        const { &ErasedWorld::<W>::NEW }
    }

    fn title(&self) -> &str {
        self.0.title()
    }

    fn seed(&self) -> u64 {
        self.0.seed()
    }

    fn set_seed(&mut self, seed: u64) {
        self.0.set_seed(seed);
    }

    fn paths(&mut self) -> Vec<(&'static str, &mut String)> {
        self.0.paths()
    }

    fn to_json(&self) -> Result<Value, Failure> {
        self.0.to_json()
    }

    fn to_toml(&self) -> Result<String, Failure> {
        self.0.to_toml()
    }

    fn boxed(&self) -> Box<dyn AnyScenario> {
        Box::new(Self(self.0.clone()))
    }

    fn as_any(&self) -> &dyn Any {
        &self.0
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        &mut self.0
    }
}

impl<W: World> AnyMission for W {
    fn frame_count(&self) -> u64 {
        World::frame_count(self)
    }

    fn summary(&self) -> (Value, String) {
        World::summary(self)
    }

    fn warnings(&self) -> Vec<String> {
        let scenario = self.scenario().to_json().unwrap_or_default();
        World::warnings(self).into_iter().chain(unit_mistakes(&scenario)).collect()
    }

    fn factory(&self, choice: &PipelineChoice, scratch: &Path) -> Result<AnyFactory, Failure> {
        Ok(AnyFactory::new(choice.factory::<W>(W::config(self.scenario()), scratch)?))
    }

    fn check_frame_jobs(&self, frame_jobs: &FrameJobs<String>) -> Result<(), Failure> {
        World::check_frame_jobs(self, &frame_jobs.parse()?)
    }

    fn render(
        &self,
        directory: &RunDirectory,
        frame_jobs: &FrameJobs<String>,
        done: &dyn Fn(),
    ) -> Result<String, Failure> {
        let frame_jobs: FrameJobs<W::Images> = frame_jobs.parse()?;
        let images = frame_jobs.images.unwrap_or(W::IMAGES);
        let frame_jobs = FrameJobs { images: Some(images), ..frame_jobs };
        sequence::render(self, directory, &frame_jobs, done)?;
        Ok(W::files_for_pipelines(images))
    }

    fn check_stream(&self, frame_jobs: &FrameJobs<String>) -> Result<(), Failure> {
        World::check_stream(self, &frame_jobs.parse()?)
    }

    fn stream(&self, frame_jobs: &FrameJobs<String>) -> Result<(), Failure> {
        World::stream(self, &frame_jobs.parse()?)
    }

    fn run(
        &self,
        directory: &RunDirectory,
        frame_jobs: &FrameJobs<String>,
        factory: &AnyFactory,
        go_on: &dyn Fn() -> Result<(), Failure>,
    ) -> Result<RunResult<Box<dyn AnyJudgement>>, Failure> {
        Ok(sequence::run(self, directory, &frame_jobs.parse()?, factory.downcast()?, go_on)?.boxed())
    }

    fn score(
        &self,
        frames: Range<u64>,
        factory: &AnyFactory,
    ) -> Result<RunResult<Box<dyn AnyJudgement>>, Failure> {
        Ok(sequence::score(self, frames, factory.downcast()?)?.boxed())
    }

    fn into_any(self: Box<Self>) -> Box<dyn Any> {
        self
    }
}

impl<S: Judgement + Send + 'static> RunResult<S> {
    fn boxed(self) -> RunResult<Box<dyn AnyJudgement>> {
        let Self { scored, first_failure, incomplete } = self;
        RunResult { scored: Box::new(scored), first_failure, incomplete }
    }
}

impl FrameJobs<String> {
    /// Returns the flight with the image format parsed for a world.
    fn parse<F: std::str::FromStr<Err = String>>(&self) -> Result<FrameJobs<F>, Failure> {
        let images = self.images.as_deref().map(str::parse).transpose().map_err(Failure::Usage)?;
        Ok(FrameJobs {
            frames: self.frames.clone(),
            jobs: self.jobs,
            images,
            expectation: self.expectation,
            states_of: self.states_of.clone(),
        })
    }
}

impl PipelineChoice {
    /// Returns the factory of a pipeline of the world `W`, whose built-in pipeline has the parameters
    /// `config`. An external program receives its images in `scratch`.
    ///
    /// # Errors
    /// A [`Failure`] for a name that is not a pipeline of that world, an invalid command, or a limit outside
    /// its range.
    pub fn factory<W: World>(
        &self,
        config: &W::Config,
        scratch: &Path,
    ) -> Result<Box<dyn PipelineFactory<W::Interface> + Send>, Failure> {
        let Some(command) = self.command(W::CODE)? else { return W::built_in(config) };
        let mut factory = ExternalFactory::<W::Interface>::new(
            command,
            scratch.to_path_buf(),
            Arc::new(W::write_image),
            format_utc,
        );
        factory.timeout_s = self.timeout_s;
        factory.memory_mb = self.memory_mb;
        factory.sandbox.clone_from(&self.sandbox);
        // Checked here, before anything is written for the program.
        factory.check()?;
        Ok(Box::new(factory))
    }
}
