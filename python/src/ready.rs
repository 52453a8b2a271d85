//! A scenario that can be run.

use boresight::failure::Failure;
use boresight::run::{Options, ScenarioSource};

use crate::worlds::{AnyPythonWorld, in_python};

/// A scenario with what makes its frames.
pub(crate) struct Ready {
    pub(crate) source: ScenarioSource,
    pub(crate) world: Box<dyn AnyPythonWorld>,
}

impl Ready {
    pub(crate) fn new(source: ScenarioSource) -> Result<Self, Failure> {
        let world = in_python(source.world(), source.prepare(Options::default())?)?;
        Ok(Self { source, world })
    }

    pub(crate) fn frame_count(&self) -> u64 {
        self.world.frame_count()
    }
}
