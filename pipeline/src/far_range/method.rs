//! Far-range pipeline in either mode, and its factory.

use contract::{ContractError, FarRange, Frame, Outcome, Pipeline, PipelineFactory, Setup, Telemetry};

use super::best::BestPipeline;
use super::config::{FarRangeConfig, Mode};
use super::overrides::Overrides;
use super::pipeline::PaperPipeline;
use crate::PipelineError;

/// Far-range pipeline for one sequence of frames, in the mode of its configuration.
#[derive(Debug)]
pub struct FarRangePipeline(Method);

#[derive(Debug)]
enum Method {
    Paper(Box<PaperPipeline>),
    Best(Box<BestPipeline>),
}

impl FarRangePipeline {
    /// Creates a pipeline before its first frame.
    ///
    /// # Errors
    /// Those of the checks of configuration, camera, readout and calibration; [`contract::OutOfRange`] for
    /// parameters that conflict with a camera's zero suppression: thresholds below it, automatic thresholds,
    /// weights above the background, or the best mode.
    pub fn new(config: FarRangeConfig, setup: &Setup) -> Result<Self, PipelineError> {
        Ok(Self(match config.mode {
            Mode::Paper => Method::Paper(Box::new(PaperPipeline::new(config, setup)?)),
            Mode::Best => Method::Best(Box::new(BestPipeline::new(config, setup)?)),
        }))
    }

    /// Performs [`Pipeline::process`] with given results of single steps, for an error budget.
    pub fn process_with(
        &mut self,
        frame: &Frame,
        telemetry: &Telemetry,
        overrides: &Overrides<'_>,
    ) -> Outcome {
        match &mut self.0 {
            Method::Paper(pipeline) => pipeline.process_with(frame, telemetry, overrides),
            Method::Best(pipeline) => pipeline.process_with(frame, telemetry, overrides),
        }
    }
}

impl Pipeline<FarRange> for FarRangePipeline {
    fn process(&mut self, frame: &Frame, telemetry: &Telemetry) -> Outcome {
        self.process_with(frame, telemetry, &Overrides::default())
    }
}

/// Factory of [`FarRangePipeline`] pipelines.
#[derive(Debug, Clone, Default)]
pub struct FarRangeFactory {
    config: FarRangeConfig,
}

impl FarRangeFactory {
    /// Creates a factory of pipelines with this configuration.
    ///
    /// # Errors
    /// Those of [`FarRangeConfig::check`].
    pub fn new(config: FarRangeConfig) -> Result<Self, PipelineError> {
        config.check()?;
        Ok(Self { config })
    }
}

impl PipelineFactory<FarRange> for FarRangeFactory {
    fn name(&self) -> String {
        "far-range".to_owned()
    }

    fn build(&self, setup: &Setup) -> Result<Box<dyn Pipeline<FarRange>>, ContractError> {
        match FarRangePipeline::new(self.config.clone(), setup) {
            Ok(pipeline) => Ok(Box::new(pipeline)),
            Err(PipelineError::Contract(error)) => Err(error),
            Err(error) => {
                Err(ContractError::CannotBuild { pipeline: self.name(), reason: error.to_string() })
            }
        }
    }
}
