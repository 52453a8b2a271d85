//! The docking world: an approach as the television camera sees it.

use pipeline::docking::DockingConfig;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sim::docking::{CameraConfig, DockingSimulation, LensConfig, LightingConfig};
use sim::scene::docking::TargetFile;
use sim::television::TelevisionConfig;
use sim::truth::approach::ApproachConfig;

use crate::scenario_file;

/// A docking scenario, as a TOML file holds it. Units are in the names; unknown keys are errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DockingScenario {
    /// The world, "docking".
    pub world: DockingWorld,
    /// What it is, in one line.
    pub title: String,
    /// Seed of every random draw.
    #[schemars(range(max = u64::MAX))]
    pub seed: u64,
    /// The moment of the first field, UTC, as in 2004-01-31T13:13:00Z.
    pub start_utc: String,
    /// Name of a built-in target, or the path of a target file, starting from the scenario's folder.
    pub target: String,
    /// How the camera moves.
    pub approach: ApproachConfig,
    /// The cameras (lenses), in the order of use, 1 to 8, all with the same columns and rows.
    pub cameras: Vec<CameraConfig>,
    /// What all lenses do to the image.
    #[serde(default)]
    pub lens: LensConfig,
    /// The light.
    pub lighting: LightingConfig,
    /// The television chain.
    #[serde(default)]
    pub television: TelevisionConfig,
    /// How answers are scored; nothing of it is simulated.
    #[serde(default, skip_serializing_if = "DockingScoreConfig::is_default")]
    pub score: DockingScoreConfig,
    /// Parameters of the pipeline `docking`.
    #[serde(default)]
    pub docking: DockingConfig,
}

/// How answers are scored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DockingScoreConfig {
    /// The first so many fields, in which the pipeline starts up, are a group of their own, `warm-up`; all other figures but the latency
    /// leave them out.
    #[serde(default, skip_serializing_if = "crate::zero::is_zero")]
    #[schemars(range(min = 0, max = 1_u64 << 40))]
    pub warm_up_frames: u64,
}

impl DockingScoreConfig {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

/// The one world of a [`DockingScenario`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DockingWorld {
    /// The last 500 m to a docking target.
    Docking,
}

scenario_file!(DockingScenario, "docking", paths_of_files);

impl DockingScenario {
    fn paths_of_files(&mut self) -> Vec<(&'static str, &mut String)> {
        match TargetFile::built_in(&self.target) {
            Some(_) => Vec::new(),
            None => vec![("target", &mut self.target)],
        }
    }

    /// What the simulator needs of it.
    pub fn simulation(&self) -> DockingSimulation {
        DockingSimulation {
            seed: self.seed,
            start_utc: self.start_utc.clone(),
            target: self.target.clone(),
            approach: self.approach.clone(),
            cameras: self.cameras.clone(),
            lens: self.lens,
            lighting: self.lighting.clone(),
            television: self.television.clone(),
        }
    }
}
