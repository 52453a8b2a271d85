//! Scenarios: what to run, in words.

mod builtin;
mod source;

pub use builtin::{BUILT_IN, BuiltIn, STARTING_POINT, is_argon};
pub use source::ScenarioSource;

use contract::Camera;
use pipeline::far_range::FarRangeConfig;
use schemars::{JsonSchema, Schema, schema_for};
use serde::{Deserialize, Serialize};
use sim::Simulation;
use sim::catalog::CatalogConfig;
use sim::onboard::{RoiConfig, ShutterConfig};
use sim::optics::{PsfConfig, RadiometryConfig};
use sim::scene::TargetConfig;
use sim::sensor::{SensorConfig, Switch};
use sim::truth::{AttitudeConfig, GroupConfig, KnowledgeConfig, MountingConfig, OrbitConfig};

/// A scenario, as a TOML file holds it. Units are in the names; unknown keys are errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// What it is, in one line.
    pub title: String,
    /// Seed of every random draw but the detector's fixed pattern.
    pub seed: u64,
    /// Which stars are drawn.
    #[serde(default)]
    pub catalog: CatalogConfig,
    /// Which stars the pipeline is told of.
    pub star_list: StarListConfig,
    /// Orbits of target and chaser.
    pub orbit: OrbitConfig,
    /// When images are taken, group by group.
    pub schedule: Vec<GroupConfig>,
    /// Where the chaser points, and how well.
    pub attitude: AttitudeConfig,
    /// What telemetry knows of the attitude.
    pub knowledge: KnowledgeConfig,
    /// How the camera sits on the chaser, in truth and by calibration.
    pub mounting: MountingConfig,
    /// Geometry of the camera.
    pub camera: Camera,
    /// Point spread function of the optics.
    pub psf: PsfConfig,
    /// From magnitudes to photoelectrons.
    pub radiometry: RadiometryConfig,
    /// The detector.
    pub sensor: SensorConfig,
    /// The law of the exposure time.
    pub shutter: ShutterConfig,
    /// Regions of interest kept on board; absent: whole images are transmitted.
    pub roi: Option<RoiConfig>,
    /// The target spacecraft as a source of light.
    pub target: TargetConfig,
    /// Whether the planets are drawn, "on" or "off" (the default). They are in no star list.
    #[serde(default = "off")]
    pub planets: Switch,
    /// Parameters of the pipeline `far_range`.
    #[serde(default)]
    pub far_range: FarRangeConfig,
}

fn off() -> Switch {
    Switch::Off
}

/// The star list uploaded to the pipeline.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StarListConfig {
    /// Faintest star of the list, V magnitude, −2 to 15.
    pub magnitude_limit: f64,
}

impl Scenario {
    /// What the simulator needs of it.
    pub fn simulation(&self) -> Simulation {
        Simulation {
            seed: self.seed,
            catalog: self.catalog.clone(),
            orbit: self.orbit.clone(),
            schedule: self.schedule.clone(),
            attitude: self.attitude.clone(),
            knowledge: self.knowledge.clone(),
            mounting: self.mounting,
            camera: self.camera.clone(),
            psf: self.psf.clone(),
            radiometry: self.radiometry.clone(),
            sensor: self.sensor.clone(),
            shutter: self.shutter.clone(),
            roi: self.roi.clone(),
            target: self.target.clone(),
            planets: self.planets,
        }
    }

    /// The JSON Schema of the file, from the types that read it.
    pub fn json_schema() -> Schema {
        schema_for!(Scenario)
    }
}
