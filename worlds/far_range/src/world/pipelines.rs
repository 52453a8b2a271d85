//! Pipelines of the far range.

use std::path::Path;

use contract::{Frame, Telemetry};
use files::{Failure, FrameHeader, ImageFormat, write_frame};
use pipeline::far_range::{FarRangeConfig, FarRangeFactory, Mode};
use run::any_world::ScenarioSource;
use run::world::{FactoryOf, InformedPipeline, WorldPipelines, WorldScenario as _};

use super::inject::InjectedPipeline;
use super::mission::FarRangeMission;
use crate::scenario::{FarRangeScenario, is_argon};

impl WorldPipelines for FarRangeMission {
    type Config = FarRangeConfig;

    fn config(scenario: &FarRangeScenario) -> &FarRangeConfig {
        &scenario.far_range
    }

    fn built_in(config: &FarRangeConfig) -> Result<FactoryOf<Self>, Failure> {
        let factory = FarRangeFactory::new(config.clone());
        Ok(Box::new(factory.map_err(|error| Failure::Usage(error.to_string()))?))
    }

    fn check_built_in(source: &ScenarioSource, scenario: &FarRangeScenario) -> Result<(), Failure> {
        let (floor_dn, bit_depth) = (scenario.zero_suppression_dn, scenario.sensor.bit_depth);
        source.check_part(Self::CODE, scenario.far_range.check_suppression(floor_dn, bit_depth))
    }

    /// Writes FITS with only the telemetry in its header.
    fn write_image(frame: &Frame, telemetry: &Telemetry, path: &Path) -> Result<(), String> {
        let header = FrameHeader {
            time: telemetry.time,
            exposure_s: telemetry.exposure_s,
            gain_e_per_dn: None,
            seed: 0,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            configuration_hash: String::new(),
            observer_velocity_km_s: None,
            wcs: None,
        };
        write_frame(path, ImageFormat::Fits, frame, &header).map_err(|error| error.to_string())
    }

    /// Returns the best mode for comparison with the paper's mode on ARGON; there the paper's published
    /// figures are shown too.
    fn comparison_pipeline(&self) -> Result<Option<FactoryOf<Self>>, Failure> {
        let scenario = self.scenario();
        let is_papers = scenario.far_range.mode == Mode::Paper && self.run_file.inject.is_none();
        let best = FarRangeConfig { mode: Mode::Best, ..scenario.far_range.clone() };
        let is_possible =
            best.check_suppression(scenario.zero_suppression_dn, scenario.sensor.bit_depth).is_ok();
        (is_papers && is_argon(scenario) && is_possible).then(|| Self::built_in(&best)).transpose()
    }

    fn informed_pipeline(&self) -> Result<Option<Box<dyn InformedPipeline<Self>>>, Failure> {
        let Some(stage) = self.run_file.inject else { return Ok(None) };
        let pipeline = InjectedPipeline::new(stage, &self.scenario().far_range, &self.setup)?;
        Ok(Some(Box::new(pipeline)))
    }
}
