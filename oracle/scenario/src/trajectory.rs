//! Origin of the motion of chaser and target: the table `[trajectory]` of a far-range scenario.

use files::Failure;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sim::truth::TrajectorySource;

/// Origin of the motion of chaser and target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum TrajectoryConfig {
    /// Mean elements of `[orbit]`, which drift at secular rates due to the Earth's oblateness.
    MeanElements {},
}

impl Default for TrajectoryConfig {
    fn default() -> Self {
        Self::MeanElements {}
    }
}

impl TrajectoryConfig {
    /// Returns true for the default, which resolved scenarios omit.
    pub(crate) fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the origin of the motion for the simulator; reads the files that it names.
    ///
    /// # Errors
    /// A [`Failure`] for a file that cannot be read.
    pub(crate) fn source(&self) -> Result<TrajectorySource, Failure> {
        match self {
            Self::MeanElements {} => Ok(TrajectorySource::MeanElements),
        }
    }
}
