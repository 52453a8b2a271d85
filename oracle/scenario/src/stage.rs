//! Stages of the built-in pipeline whose result an error budget replaces by the ground truth.

use std::fmt;

use clap::ValueEnum;
use serde::{Deserialize, Serialize};

/// The stage whose result is replaced by the truth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// Every cluster is where the object is that it belongs to
    Centroids,
    /// Every cluster is known for a star (and which), a hotspot or neither
    Identities,
    /// The camera's attitude is the true one
    Attitude,
    /// Whole images are transmitted: the scenario without its regions of interest
    Roi,
    /// The listed stars are where aberration and deflection make them appear, and nothing is corrected
    Aberration,
}

impl fmt::Display for Stage {
    /// The word of the command line and of files.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Centroids => "centroids",
            Self::Identities => "identities",
            Self::Attitude => "attitude",
            Self::Roi => "roi",
            Self::Aberration => "aberration",
        })
    }
}
