//! Scenario files.

use contract::{Camera, OutOfRange, bounds};
use scenario::scenario_file;
use schemars::JsonSchema;
use sensor::SensorConfig;
use serde::{Deserialize, Serialize};

use crate::pipeline::LimbConfig;

/// A middle-range scenario, in the form of its TOML file. Units are in the names; unknown keys are errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MiddleRangeScenario {
    /// Code of the world, "middle_range".
    pub world: MiddleRangeWorld,
    /// Title of the scenario, one line.
    pub title: String,
    /// Seed of all random draws except the detector's fixed pattern.
    #[schemars(range(max = u64::MAX))]
    pub seed: u64,
    /// Approach to the body.
    pub approach: ApproachConfig,
    /// Body that is approached.
    pub body: BodyConfig,
    /// Geometry of the camera.
    pub camera: Camera,
    /// Detector.
    pub sensor: SensorConfig,
    /// Control of the exposure time.
    pub exposure: ExposureConfig,
    /// Parameters of the pipeline `middle_range`.
    #[serde(default)]
    pub middle_range: LimbConfig,
}

scenario_file!(MiddleRangeScenario, "middle_range", crate::STARTING_POINT);

/// World of a [`MiddleRangeScenario`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MiddleRangeWorld {
    /// A body that the camera resolves.
    MiddleRange,
}

/// Approach: the range falls by the same ratio from frame to frame, while the camera wanders about the body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ApproachConfig {
    /// Number of frames, 1 to 100,000.
    #[schemars(range(min = 1, max = 100_000))]
    pub frames: u64,
    /// Range at the first frame, km, 0.01 to 1000.
    #[schemars(range(min = 0.01, max = 1000))]
    pub from_km: f64,
    /// Range at the last frame, km, 0.01 to 1000.
    #[schemars(range(min = 0.01, max = 1000))]
    pub to_km: f64,
    /// Largest angle between the camera's axis and the body, degrees, 0 to 45.
    #[schemars(range(min = 0, max = 45))]
    pub wander_deg: f64,
}

/// Body: a Lambert sphere in sunlight.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodyConfig {
    /// Radius, m, 0.1 to 1000.
    #[schemars(range(min = 0.1, max = 1000))]
    pub radius_m: f64,
    /// Angle at the body between the Sun and the camera, degrees, 0 to 150.
    #[schemars(range(min = 0, max = 150))]
    pub phase_deg: f64,
    /// Direction of the Sun in the image, degrees from the direction of the columns towards that of the rows,
    /// −360 to 360.
    #[schemars(range(min = -360, max = 360))]
    pub sun_angle_deg: f64,
    /// Photoelectrons per second of a pixel on a surface that faces the Sun, 1 to 1e12.
    #[schemars(range(min = 1, max = 1e12))]
    pub electrons_per_s: f64,
}

/// Exposure time: that of the first frame; then the pipeline's answers control it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExposureConfig {
    /// Exposure time of the first frame, s, 1e-6 to 100.
    #[schemars(range(min = 1e-6, max = 100))]
    pub first_s: f64,
    /// Shortest exposure time, s, 1e-6 to 100.
    #[schemars(range(min = 1e-6, max = 100))]
    pub min_s: f64,
    /// Longest exposure time, s, 1e-6 to 100.
    #[schemars(range(min = 1e-6, max = 100))]
    pub max_s: f64,
    /// Brightest pixel at which the control aims, fraction of full scale, 0.01 to 1.
    #[schemars(range(min = 0.01, max = 1))]
    pub target: f64,
}

impl MiddleRangeScenario {
    /// Checks all values.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first invalid value.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(&self.approach, "approach")?;
        bounds::check(&self.body, "body")?;
        bounds::check(&self.exposure, "exposure")?;
        bounds::check(&self.middle_range, "middle_range")?;
        self.camera.check().map_err(|error| error.under("camera"))?;
        self.sensor.check().map_err(|error| error.under("sensor"))?;
        let closest_km = self.approach.from_km.min(self.approach.to_km);
        let expected = format!("less than {} m, the least distance to its centre", 1000.0 * closest_km);
        bounds::require("body.radius_m", self.body.radius_m, expected, |radius_m| {
            radius_m < 1000.0 * closest_km
        })?;
        let (min_s, expected) = (self.exposure.min_s, "exposure.min_s or more".to_owned());
        bounds::require("exposure.max_s", self.exposure.max_s, expected, |max_s| max_s >= min_s)
    }
}
