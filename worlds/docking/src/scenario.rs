//! Docking world: an approach imaged by a television camera.

use pipeline::docking::DockingConfig;
use scenario::scenario_file;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sim::docking::{CameraConfig, DockingSimulation, LensConfig, LightingConfig};
use sim::scene::docking::TargetFile;
use sim::television::TelevisionConfig;
use sim::truth::approach::ApproachConfig;

/// A docking scenario, in the form of its TOML file. Units are in the names; unknown keys are errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DockingScenario {
    /// Code of the world, "docking".
    pub world: DockingWorld,
    /// Title of the scenario, one line.
    pub title: String,
    /// Seed of all random draws.
    #[schemars(range(max = u64::MAX))]
    pub seed: u64,
    /// Time of the first field, UTC, as in 2004-01-31T13:13:00Z.
    pub start_utc: String,
    /// Name of a built-in target, or path of a target file, relative to the scenario's directory.
    pub target: String,
    /// Motion of the camera.
    pub approach: ApproachConfig,
    /// Cameras (lenses), in the order of use, 1 to 8, all with the same columns and rows.
    pub cameras: Vec<CameraConfig>,
    /// Image degradation common to all lenses.
    #[serde(default)]
    pub lens: LensConfig,
    /// Illumination.
    pub lighting: LightingConfig,
    /// Television chain.
    #[serde(default)]
    pub television: TelevisionConfig,
    /// Scoring of outcomes, without effect on the simulation.
    #[serde(default)]
    pub score: DockingScoreConfig,
    /// Parameters of the pipeline `docking`.
    #[serde(default)]
    pub docking: DockingConfig,
}

/// Scoring of outcomes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DockingScoreConfig {
    /// Number of first fields, in which the pipeline starts up. They form a separate group, `warm-up`; all
    /// other figures except the latency exclude them.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1_u64 << 40))]
    pub warm_up_frames: u64,
}

/// World of a [`DockingScenario`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DockingWorld {
    /// The last 500 m to a docking target.
    Docking,
}

scenario_file!(DockingScenario, "docking", crate::STARTING_POINT, paths_of_files);

impl DockingScenario {
    fn paths_of_files(&mut self) -> Vec<(&'static str, &mut String)> {
        match TargetFile::built_in(&self.target) {
            Some(_) => Vec::new(),
            None => vec![("target", &mut self.target)],
        }
    }

    /// Returns the input of the simulator.
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
