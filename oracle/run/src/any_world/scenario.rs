//! Scenarios without their types.

use std::any::Any;
use std::fmt::{self, Debug, Formatter};
use std::ops::{Deref, DerefMut};

use scenario::run_file::{ScenarioFile, ScenarioValues};

use super::{AnyWorld, ErasedWorld};
use crate::world::World;

/// A scenario of any world: its values, without their type.
pub struct AnyScenario {
    world: &'static dyn AnyWorld,
    values: Box<dyn ScenarioValues>,
}

impl AnyScenario {
    /// Creates a scenario of the world `W`.
    pub(crate) fn of<W: World>(scenario: W::Scenario) -> Self {
        Self { world: const { &ErasedWorld::<W>::NEW }, values: Box::new(scenario) }
    }

    /// Returns the world of the scenario.
    pub fn world(&self) -> &'static dyn AnyWorld {
        self.world
    }

    /// Returns the values with their type `S`; `None` for a scenario of another world.
    pub fn values<S: ScenarioFile>(&self) -> Option<&S> {
        let values: &dyn Any = self.values.as_ref();
        values.downcast_ref()
    }

    /// Returns the mutable values with their type `S`; `None` for a scenario of another world.
    pub fn values_mut<S: ScenarioFile>(&mut self) -> Option<&mut S> {
        let values: &mut dyn Any = self.values.as_mut();
        values.downcast_mut()
    }
}

impl Deref for AnyScenario {
    type Target = dyn ScenarioValues;

    fn deref(&self) -> &Self::Target {
        self.values.as_ref()
    }
}

impl DerefMut for AnyScenario {
    fn deref_mut(&mut self) -> &mut Self::Target {
        self.values.as_mut()
    }
}

impl Clone for AnyScenario {
    fn clone(&self) -> Self {
        Self { world: self.world, values: self.values.boxed() }
    }
}

impl Debug for AnyScenario {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.values.fmt(f)
    }
}
