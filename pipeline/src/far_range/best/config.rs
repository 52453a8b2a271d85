//! Parameters of the best mode.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters of the best mode; all have defaults.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BestConfig {
    /// True if the frames are a sequence in order of time: mounting, point-spread function, hot pixels and
    /// the motion of the target are then estimated over frames. `false` for single, unrelated frames.
    pub sequence: bool,
    /// Initial attitude of a frame: `telemetry`, or `none` for an attitude from the stars of the frame only,
    /// independent of the attitude in the telemetry.
    pub prior: AttitudePrior,
    /// Largest relative error of the focal length with which the stars of a frame are looked up, 0 to 0.2:
    /// without a prior attitude always, with one where most bright sources are no listed stars. If they
    /// contradict the stated focal length, theirs is used.
    #[schemars(range(min = 0, max = 0.2))]
    pub focal_length_tolerance: f64,
    /// Position error of a star in addition to that of its centroid (list, distortion, trail), px, 0 to 10.
    #[schemars(range(min = 0, max = 10))]
    pub star_floor_px: f64,
    /// Centroid error of the target in addition to that of its fit (response within pixels, structure of the
    /// body), px, 0 to 10.
    #[schemars(range(min = 0, max = 10))]
    pub target_floor_px: f64,
    /// Relative error of the calibrated width of the point-spread function, 0.001 to 2.
    #[schemars(range(min = 0.001, max = 2))]
    pub psf_width_error: f64,
    /// Largest number of stars fitted for the attitude, brightest first, 1 to 1000.
    #[schemars(range(min = 1, max = 1000))]
    pub max_stars: u32,
    /// Largest speed of the target in the image, px/s, 1e-6 to 1e6.
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub max_speed_px_per_s: f64,
    /// Smallest natural logarithm of the odds that the reported cluster is the target, −100 to 100. With 3 a
    /// reported cluster is the target with a probability of at least 95 %.
    #[schemars(range(min = -100, max = 100))]
    pub min_log_odds: f64,
}

/// Initial attitude of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AttitudePrior {
    /// Attitude from the telemetry and the mounting, with the errors of the calibration.
    #[default]
    Telemetry,
    /// No initial attitude: determined from star patterns, independently for each frame (lost in space). A
    /// frame without four matching stars has no attitude.
    None,
}

impl Default for BestConfig {
    fn default() -> Self {
        Self {
            sequence: true,
            prior: AttitudePrior::default(),
            focal_length_tolerance: 0.02,
            star_floor_px: 0.015,
            target_floor_px: 0.0,
            psf_width_error: 0.05,
            max_stars: 12,
            max_speed_px_per_s: 5.0,
            min_log_odds: 3.0,
        }
    }
}
