//! Configuration of the simulator of a docking approach.

use contract::bounds::{self, require};
use contract::{Camera, OutOfRange};
use schemars::JsonSchema;
use sensor::television::{TelevisionConfig, can_be_written};
use serde::{Deserialize, Serialize};
use truth::approach::ApproachConfig;
use truth::clock::parse_utc_field;

use super::lighting::LightingConfig;

/// Maximum length of a camera name, characters.
const MAX_NAME: usize = 16;

/// Input of the simulator of a docking approach, as its camera sees it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DockingSimulation {
    /// Seed of all random draws.
    #[schemars(range(max = u64::MAX))]
    pub seed: u64,
    /// Time of the first field, UTC, for example 2004-01-31T13:13:00Z.
    pub start_utc: String,
    /// Name of a built-in target, or the path of a target file, relative to the scenario's directory.
    pub target: String,
    /// Motion of the camera.
    pub approach: ApproachConfig,
    /// Cameras (lenses), in the order of use, 1 to 8, all with equal numbers of columns and rows.
    #[schemars(length(min = 1, max = 8))]
    pub cameras: Vec<CameraConfig>,
    /// Image quality of all lenses.
    #[serde(default)]
    pub lens: LensConfig,
    /// Lighting of the scene.
    pub lighting: LightingConfig,
    /// Television chain.
    #[serde(default)]
    pub television: TelevisionConfig,
}

/// Camera and its range of use. A field is taken by the first camera of the list whose `until_range_m` is not
/// greater than the range, which depends on the time only.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CameraConfig {
    /// Name in the overlay: 1 to 16 of A to Z, 0 to 9, space and . : - + /.
    pub name: String,
    /// Least range at which the camera is in use, m; decreasing along the list, and 0 for the last camera.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1e6))]
    pub until_range_m: f64,
    /// Geometry of the camera.
    pub camera: Camera,
}

/// Lens of the camera.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LensConfig {
    /// Standard deviation of the Gaussian point-spread function, px, 0 to 10; 0 is a perfect lens.
    #[schemars(range(min = 0, max = 10))]
    pub blur_sigma_px: f64,
}

impl Default for LensConfig {
    fn default() -> Self {
        Self { blur_sigma_px: 0.7 }
    }
}

impl DockingSimulation {
    /// Checks every value except the target and values that depend on the target.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first invalid value.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "")?;
        parse_utc_field("start_utc", &self.start_utc)?;
        self.cameras.iter().enumerate().try_for_each(|(index, camera)| {
            let before = index.checked_sub(1).and_then(|before| self.cameras.get(before));
            let last = index + 1 == self.cameras.len();
            camera.check(before, last).map_err(|error| error.in_entry(index))
        })?;
        self.lighting.check()?;
        self.television.check()
    }
}

impl CameraConfig {
    /// Checks the camera against the previous camera of the list.
    fn check(&self, before: Option<&Self>, last: bool) -> Result<(), OutOfRange> {
        if !(1..=MAX_NAME).contains(&self.name.chars().count()) || !can_be_written(&self.name) {
            let expected = "1 to 16 of A to Z, 0 to 9, space and . : - + /";
            return Err(OutOfRange::new("cameras[].name", format!("{:?}", self.name), expected));
        }
        require(
            "cameras[].until_range_m",
            self.until_range_m,
            "0 for the last camera, above 0 for the others, less than for the previous camera",
            |m| if last { m == 0.0 } else { m > 0.0 && before.is_none_or(|before| m < before.until_range_m) },
        )?;
        let Camera { columns, rows, .. } = self.camera;
        if before.is_some_and(|Self { camera, .. }| (camera.columns, camera.rows) != (columns, rows)) {
            let expected = "the columns and rows of the first camera: all lenses share one detector";
            return Err(OutOfRange::new("cameras[].camera", format!("{columns} × {rows}"), expected));
        }
        Ok(())
    }
}
