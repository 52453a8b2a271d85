//! On and off.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Whether an effect is simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Switch {
    /// It is.
    #[default]
    On,
    /// It is left out.
    Off,
}

impl Switch {
    /// `value` when on, 0 when off.
    pub fn apply(self, value: f64) -> f64 {
        match self {
            Self::On => value,
            Self::Off => 0.0,
        }
    }
}
