//! Scenarios: what to run, in words. A scenario belongs to one of two worlds, each with a type of its own.

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

mod builtin;
mod cameras;
mod docking;
mod far_range;
pub mod run_file;
mod source;
mod stage;

pub use builtin::{BUILT_IN, BuiltIn, DOCKING, STARTING_POINT, is_argon};
pub use cameras::CAMERAS;
pub use docking::{DockingScenario, DockingWorld};
pub use far_range::{FarRangeScenario, FarRangeWorld, StarListConfig};
pub use source::{ScenarioSource, world};
pub use stage::Stage;
use std::fmt;
use std::str::FromStr;

use files::{Failure, toml_file};
use schemars::{JsonSchema, Schema, schema_for};

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

/// What a scenario is about: the key `world` of its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum World {
    /// Star fields with a distant spacecraft; the world of a file without the key.
    FarRange,
    /// The approach to a docking target.
    Docking,
}

impl World {
    /// Both.
    pub const ALL: [Self; 2] = [Self::FarRange, Self::Docking];

    /// The word used in files and on the command line; also the name of the world's built-in pipeline.
    pub fn code(self) -> &'static str {
        match self {
            Self::FarRange => "far_range",
            Self::Docking => "docking",
        }
    }
}

impl fmt::Display for World {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.code())
    }
}

impl FromStr for World {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|world| world.code() == text).ok_or_else(|| {
            let hint = toml_file::nearest(text, Self::ALL.map(Self::code))
                .map_or(String::new(), |name| format!("; did you mean `{name}`?"));
            format!("there is no world `{text}`, expected `far_range` or `docking`{hint}")
        })
    }
}
