//! Switch of an effect: on or off.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Simulation of an effect: on or off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Switch {
    /// The effect is simulated.
    #[default]
    On,
    /// The effect is left out.
    Off,
}

impl Switch {
    /// Returns `value` if on, 0 if off.
    pub fn apply(self, value: f64) -> f64 {
        match self {
            Self::On => value,
            Self::Off => 0.0,
        }
    }
}
