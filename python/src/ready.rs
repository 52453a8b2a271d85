//! A scenario that can be run.

use boresight::failure::Failure;
use boresight::run::docking::renderer::DockingRenderer;
use boresight::run::{Prepared, PreparedDocking, World as _};
use boresight::scenario::{Scenario as Values, ScenarioSource};

/// A scenario with what makes its frames.
pub(crate) struct Ready {
    pub(crate) source: ScenarioSource,
    pub(crate) world: World,
}

/// What makes the frames of a world.
pub(crate) enum World {
    FarRange(Box<Prepared>),
    Docking(Box<PreparedDocking>),
}

impl Ready {
    pub(crate) fn new(source: ScenarioSource) -> Result<Self, Failure> {
        let world = match &source.scenario {
            Values::FarRange(_) => World::FarRange(Box::new(Prepared::new(&source)?)),
            Values::Docking(_) => {
                World::Docking(Box::new(PreparedDocking::new(&source, DockingRenderer::Fast)?))
            }
        };
        Ok(Self { source, world })
    }

    pub(crate) fn frame_count(&self) -> u64 {
        match &self.world {
            World::FarRange(prepared) => prepared.frame_count(),
            World::Docking(prepared) => prepared.frame_count(),
        }
    }
}
