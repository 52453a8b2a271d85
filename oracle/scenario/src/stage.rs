//! Stages of the built-in pipeline whose result an error budget replaces by the ground truth.

use std::fmt;

use clap::ValueEnum;
use serde::{Deserialize, Serialize};

/// Stage whose result is replaced by the truth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// Each cluster has the true position of the object that it belongs to
    Centroids,
    /// Each cluster is correctly identified as a star (and which), a hotspot or neither
    Identities,
    /// The attitude of the camera is the true one
    Attitude,
    /// Whole images are transmitted: the scenario without its regions of interest
    Roi,
    /// The listed stars are at their apparent positions, with aberration and deflection, and no correction is
    /// applied
    Aberration,
    /// The target's centroid is free of the offset of its centre of brightness from its centre of mass
    Brightness,
}

impl Stage {
    /// All stages, in the order of the pipeline.
    pub const ALL: [Self; 6] =
        [Self::Centroids, Self::Identities, Self::Attitude, Self::Roi, Self::Aberration, Self::Brightness];
}

impl fmt::Display for Stage {
    /// Writes the name of the stage on the command line and in files.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Centroids => "centroids",
            Self::Identities => "identities",
            Self::Attitude => "attitude",
            Self::Roi => "roi",
            Self::Aberration => "aberration",
            Self::Brightness => "brightness",
        })
    }
}
