//! Scenario that is ready to run.

use boresight::failure::Failure;
use boresight::run::{Options, ScenarioSource};

use crate::worlds::{AnyPythonWorld, prepare_for_python};

/// Scenario with the world that makes its frames.
pub(crate) struct PreparedScenario {
    pub(crate) source: ScenarioSource,
    pub(crate) world: Box<dyn AnyPythonWorld>,
}

impl PreparedScenario {
    pub(crate) fn new(source: ScenarioSource) -> Result<Self, Failure> {
        let world = prepare_for_python(source.world(), source.prepare(Options::default())?)?;
        Ok(Self { source, world })
    }

    pub(crate) fn frame_count(&self) -> u64 {
        self.world.frame_count()
    }
}
