//! A scenario of either world.

use files::Failure;
use schemars::{JsonSchema, Schema, schema_for};

use super::{DockingScenario, FarRangeScenario, World};

/// A scenario of either world.
#[derive(Debug, Clone, PartialEq)]
pub enum Scenario {
    /// Star fields with a distant spacecraft.
    FarRange(Box<FarRangeScenario>),
    /// The approach to a docking target.
    Docking(Box<DockingScenario>),
}

impl Scenario {
    /// Its world.
    pub fn world(&self) -> World {
        match self {
            Self::FarRange(_) => World::FarRange,
            Self::Docking(_) => World::Docking,
        }
    }

    /// What it is, in one line.
    pub fn title(&self) -> &str {
        match self {
            Self::FarRange(scenario) => &scenario.title,
            Self::Docking(scenario) => &scenario.title,
        }
    }

    /// Gives it another seed.
    pub fn set_seed(&mut self, seed: u64) {
        match self {
            Self::FarRange(scenario) => scenario.seed = seed,
            Self::Docking(scenario) => scenario.seed = seed,
        }
    }

    /// All its values, defaults included.
    ///
    /// # Errors
    /// [`Failure::Usage`] when they cannot be written as JSON.
    pub fn to_json(&self) -> Result<serde_json::Value, Failure> {
        let json = match self {
            Self::FarRange(scenario) => serde_json::to_value(scenario),
            Self::Docking(scenario) => serde_json::to_value(scenario),
        };
        json.map_err(|error| Failure::Usage(format!("the scenario cannot be written as JSON: {error}")))
    }

    /// The JSON Schema of scenario files, from the types that read them: of one world, or of either.
    pub fn json_schema(world: Option<World>) -> Schema {
        /// A scenario file: by its key `world`, of one of two kinds.
        #[derive(JsonSchema)]
        #[schemars(untagged)]
        #[allow(dead_code, reason = "its schema is all that is asked of it")]
        enum Either {
            /// A far-range scenario: star fields with a distant spacecraft.
            FarRange(Box<FarRangeScenario>),
            /// A docking scenario: an approach as the television camera sees it.
            Docking(Box<DockingScenario>),
        }
        match world {
            None => schema_for!(Either),
            Some(World::FarRange) => schema_for!(FarRangeScenario),
            Some(World::Docking) => schema_for!(DockingScenario),
        }
    }
}
