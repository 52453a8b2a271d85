//! What the simulator of an approach is told.

use contract::Camera;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::lighting::LightingConfig;
use crate::SimError;
use crate::error::require;
use crate::television::{TelevisionConfig, can_be_written};
use crate::truth::approach::ApproachConfig;
use crate::truth::clock::parse_utc_of;

/// Most cameras of a spacecraft.
const MAX_CAMERAS: usize = 8;
/// Longest name of a camera.
const MAX_NAME: usize = 16;

/// An approach as its camera sees it: all that the simulator is told.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DockingSimulation {
    /// Seed of every random draw.
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
}

/// A camera and when it is in use. A field is taken by the first camera of the list whose `until_range_m` is not greater than the range:
/// a function of the moment alone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CameraConfig {
    /// Its name in the overlay: 1 to 16 of A to Z, 0 to 9, space and . : - + /.
    pub name: String,
    /// Least range at which it is in use, m; decreasing along the list, and 0 for the last.
    #[serde(default)]
    pub until_range_m: f64,
    /// Geometry.
    pub camera: Camera,
}

/// The lens.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LensConfig {
    /// Standard deviation of its Gaussian point spread, px, 0 to 10; 0 is a perfect lens.
    pub blur_sigma_px: f64,
}

impl Default for LensConfig {
    fn default() -> Self {
        Self { blur_sigma_px: 0.7 }
    }
}

impl DockingSimulation {
    /// Checks every value but the target and what depends on it.
    ///
    /// # Errors
    /// [`SimError`] for the first one that is not allowed.
    pub fn check(&self) -> Result<(), SimError> {
        parse_utc_of("start_utc", &self.start_utc)?;
        self.check_cameras()?;
        require("lens.blur_sigma_px", self.lens.blur_sigma_px, "0 to 10", |v| (0.0..=10.0).contains(&v))?;
        self.lighting.check()?;
        self.television.check()
    }

    fn check_cameras(&self) -> Result<(), SimError> {
        let first = self.cameras.first().filter(|_| self.cameras.len() <= MAX_CAMERAS).ok_or_else(|| {
            SimError::Parameter {
                field: "cameras",
                value: format!("a list of {}", self.cameras.len()),
                expected: "1 to 8 cameras",
            }
        })?;
        let mut before_m = f64::INFINITY;
        for (index, camera) in self.cameras.iter().enumerate() {
            let last = index + 1 == self.cameras.len();
            camera.check(&first.camera, before_m, last).map_err(|error| error.in_entry(index))?;
            before_m = camera.until_range_m;
        }
        Ok(())
    }
}

impl CameraConfig {
    fn check(&self, first: &Camera, before_m: f64, last: bool) -> Result<(), SimError> {
        if !(1..=MAX_NAME).contains(&self.name.chars().count()) || !can_be_written(&self.name) {
            return Err(SimError::Parameter {
                field: "cameras[].name",
                value: format!("{:?}", self.name),
                expected: "1 to 16 of A to Z, 0 to 9, space and . : - + /",
            });
        }
        require(
            "cameras[].until_range_m",
            self.until_range_m,
            "0 for the last camera, less than that of the one before, above 0 for the others",
            |m| if last { m == 0.0 } else { m > 0.0 && m < before_m },
        )?;
        self.camera.check().map_err(|error| match error {
            contract::ContractError::OutOfRange { field, value, expected } => {
                SimError::Entry { path: format!("cameras[].{field}"), value: value.to_string(), expected }
            }
            other => other.into(),
        })?;
        if (self.camera.columns, self.camera.rows) != (first.columns, first.rows) {
            return Err(SimError::Parameter {
                field: "cameras[].camera",
                value: format!("{} × {}", self.camera.columns, self.camera.rows),
                expected: "columns and rows of the first camera: one detector behind all lenses",
            });
        }
        Ok(())
    }
}
