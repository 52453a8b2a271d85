//! A scenario that can be run.

use boresight::failure::Failure;
use boresight::run::{AnyPrepared, Options, Prepared, PreparedDocking, ScenarioSource};

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
        let world = match source.prepare(Options::default())?.into_any().downcast::<Prepared>() {
            Ok(prepared) => World::FarRange(prepared),
            Err(other) => World::Docking(other.downcast().map_err(|_| {
                Failure::Usage(format!("frames of the world {} have no class", source.world().code()))
            })?),
        };
        Ok(Self { source, world })
    }

    pub(crate) fn prepared(&self) -> &dyn AnyPrepared {
        match &self.world {
            World::FarRange(prepared) => prepared.as_ref(),
            World::Docking(prepared) => prepared.as_ref(),
        }
    }

    pub(crate) fn frame_count(&self) -> u64 {
        self.prepared().frame_count()
    }
}
