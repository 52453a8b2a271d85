//! A docking scenario, ready to fly.

use contract::docking::DockingSetup;
use files::Failure;
use scenario::run_file::RunFile;
use scenario::{DockingScenario, ScenarioSource};
use sim::docking::DockingSimulator;

use super::renderer::DockingRenderer;

/// A docking scenario with its simulator, ready to fly.
pub struct PreparedDocking {
    pub(super) simulator: DockingSimulator,
    pub(super) setup: DockingSetup,
    pub(super) renderer: DockingRenderer,
    pub(super) run_file: RunFile<DockingScenario>,
}

impl PreparedDocking {
    /// Checks a scenario and prepares its simulator.
    ///
    /// # Errors
    /// A [`Failure`] with the place of the first value that is not allowed.
    pub fn new(source: &ScenarioSource, renderer: DockingRenderer) -> Result<Self, Failure> {
        let scenario = source.docking("docking")?;
        let simulator = source.docking_simulator(scenario)?;
        let mut run_file = RunFile::new(&source.name, scenario, None, None)?;
        run_file.mitsuba = renderer.record().cloned();
        Ok(Self { setup: simulator.setup(), simulator, renderer, run_file })
    }

    /// What makes its fields, as the fast renderer draws them.
    pub fn simulator(&self) -> &DockingSimulator {
        &self.simulator
    }

    /// The scenario.
    pub fn scenario(&self) -> &DockingScenario {
        &self.run_file.scenario
    }

    /// Who draws the scene.
    pub fn renderer(&self) -> &DockingRenderer {
        &self.renderer
    }

    /// Draws a field and forgets it: before anything is written, it shows whether the renderer can.
    ///
    /// # Errors
    /// A [`Failure`] when there is no such field, or the renderer gives no image.
    pub fn probe(&self, field: u64) -> Result<(), Failure> {
        let mut workspace = self.simulator.workspace()?;
        self.renderer.expose(&self.simulator, &self.setup, &mut workspace, field)?;
        Ok(())
    }
}
