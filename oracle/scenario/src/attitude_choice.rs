//! Attitude granted to measurements without a line of sight.

use clap::ValueEnum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Attitude that the score grants to measurements that have only a centroid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum AttitudeChoice {
    /// The measured attitude of telemetry, with the nominal mounting
    Telemetry,
    /// The true attitude
    True,
}
