//! Pipelines of a world: the built-in one, and the images of external programs.

use std::path::Path;

use contract::PipelineFactory;
use files::Failure;

use super::{ImageOf, OutcomeOf, TelemetryOf, WorldFrames, WorldScenario};
use crate::any_world::ScenarioSource;

/// Factory of pipelines of a world.
pub type FactoryOf<W> = Box<dyn PipelineFactory<<W as WorldFrames>::Interface> + Send>;

/// Pipelines of a world.
pub trait WorldPipelines: WorldScenario {
    /// Parameters of the built-in pipeline.
    type Config;

    /// Returns the parameters of the built-in pipeline in a scenario.
    fn config(scenario: &Self::Scenario) -> &Self::Config;

    /// Returns the factory of the built-in pipeline.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a parameter outside its range.
    fn built_in(config: &Self::Config) -> Result<FactoryOf<Self>, Failure>;

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

    /// Returns the factory of a second pipeline that processes the same frames and is scored for comparison;
    /// its outcomes are not written.
    ///
    /// # Errors
    /// A [`Failure`] when the pipeline cannot be configured.
    fn comparison_pipeline(&self) -> Result<Option<FactoryOf<Self>>, Failure> {
        Ok(None)
    }

    /// Returns the built-in pipeline with one stage's result replaced by the truth, if the run requests it.
    ///
    /// # Errors
    /// A [`Failure`] when the pipeline cannot be built.
    fn informed_pipeline(&self) -> Result<Option<Box<dyn InformedPipeline<Self>>>, Failure> {
        Ok(None)
    }
}

/// A pipeline that also receives the truth, for the one stage whose result it replaces.
pub trait InformedPipeline<W: WorldFrames> {
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
