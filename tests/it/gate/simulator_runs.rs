//! Simulator runs within this process.

use std::ops::Range;

use boresight::docking::{DockingMission, DockingRenderer};
use boresight::far_range::scoring::FrameVerdict;
use boresight::far_range::{FarRangeMission, FarRangeScenario};
use boresight::pipeline_choice::PipelineChoice;
use boresight::run::{Judgement as _, ScenarioSource, WorldFrames as _, WorldScenario as _, sequence};
use boresight::score::UnitTable;
use contract::docking::{Docking, DockingOutcome, DockingSetup, DockingSolution, Field, FieldTelemetry};
use contract::{Pipeline, PipelineFactory};
use rayon::prelude::*;

const PIPELINE: PipelineChoice =
    PipelineChoice { word: None, timeout_s: 10.0, memory_mb: 4000, sandbox: None };

/// Scenario of one of the project's gates.
fn source(name: &str, seed: u64) -> ScenarioSource {
    let path = format!("{}/scenarios/gates/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    boresight::register_worlds();
    let mut source = ScenarioSource::read(&path).unwrap();
    source.scenario.set_seed(seed);
    source
}

/// Runs of the gate's ARGON by seed, with the first `stretches` stretches of each day and the first `frames`
/// frames of each stretch.
pub(crate) fn runs(seeds: Range<u64>, stretches: usize, frames: u64) -> Vec<Vec<FrameVerdict>> {
    let run = |seed: u64| {
        let mut source = source("argon", seed);
        let scenario = source.scenario.values_mut::<FarRangeScenario>().unwrap();
        let mut place = 0..;
        scenario.schedule.retain(|_| place.next().unwrap() % 6 < stretches);
        scenario.schedule.iter_mut().for_each(|stretch| stretch.count = frames);
        let prepared = FarRangeMission::new(&source).unwrap();
        let factory = PIPELINE
            .factory::<FarRangeMission>(&prepared.scenario().far_range, &std::env::temp_dir())
            .unwrap();
        sequence::score(&prepared, 0..prepared.frame_count(), factory.as_ref()).unwrap().scored.verdicts
    };
    seeds.into_par_iter().map(run).collect()
}

/// Runs of the gate's docking by seed, each one unchanged and with all ranges too long by a thousandth.
pub(crate) fn docking_runs(seeds: Range<u64>, fields: Range<u64>) -> Vec<(UnitTable, UnitTable)> {
    let run = |seed: u64| {
        let prepared = DockingMission::new(&source("docking", seed), DockingRenderer::Fast).unwrap();
        let factory =
            PIPELINE.factory::<DockingMission>(&prepared.scenario().docking, &std::env::temp_dir()).unwrap();
        let own = sequence::score(&prepared, fields.clone(), factory.as_ref()).unwrap().scored.units();
        let scaled =
            sequence::score(&prepared, fields.clone(), &Scaled(factory.as_ref())).unwrap().scored.units();
        (own, scaled)
    };
    seeds.into_par_iter().map(run).collect()
}

/// A pipeline whose ranges are too long by a thousandth.
struct Scaled<'a>(&'a dyn PipelineFactory<Docking>);

struct ScaledPipeline(Box<dyn Pipeline<Docking>>);

impl PipelineFactory<Docking> for Scaled<'_> {
    fn name(&self) -> String {
        "ranges a thousandth too long".to_owned()
    }

    fn build(&self, setup: &DockingSetup) -> Result<Box<dyn Pipeline<Docking>>, contract::ContractError> {
        Ok(Box::new(ScaledPipeline(self.0.build(setup)?)))
    }
}

impl Pipeline<Docking> for ScaledPipeline {
    fn process(&mut self, field: &Field, telemetry: &FieldTelemetry) -> DockingOutcome {
        let mut outcome = self.0.process(field, telemetry);
        if let DockingSolution::Measured(measurement) = &mut outcome.solution {
            measurement.best.pose.position_m *= 1.001;
        }
        outcome
    }
}
