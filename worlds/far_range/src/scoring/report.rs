//! Content of `score.json`.

use indexmap::IndexMap;
use score::Figure;
use serde::{Deserialize, Serialize};

/// Names of the far-range figures. Rates are fractions from 0 to 1.
pub mod names {
    /// Detected frames, as a fraction of all frames.
    pub const HIT_RATE: &str = "hit_rate";
    /// Missed frames, as a fraction of all frames.
    pub const MISS_RATE: &str = "miss_rate";
    /// Correct frames, as a fraction of all frames.
    pub const CORRECT_RATE: &str = "correct_rate";
    /// Wrong frames, as a fraction of all frames.
    pub const WRONG_RATE: &str = "wrong_rate";
    /// Wrong measurements in frames without a visible target, as a fraction of these frames.
    pub const FALSE_ALARM_RATE: &str = "false_alarm_rate";
    /// Frames whose measurement states a line of sight, as a fraction of the detected frames.
    pub const LINE_OF_SIGHT_RATE: &str = score::LINE_OF_SIGHT_RATE;
    /// Frames with an |error across columns| below the limit of one pixel, as a fraction of the detected
    /// frames with a line of sight.
    pub const RA_WITHIN_1PX: &str = "ra_within_1px";
    /// Frames with an |error across columns| below the limit of two pixels, as a fraction of the detected
    /// frames with a line of sight.
    pub const RA_WITHIN_2PX: &str = "ra_within_2px";
    /// Frames with an |error across rows| below the limit of one pixel, as a fraction of the detected frames
    /// with a line of sight.
    pub const DEC_WITHIN_1PX: &str = "dec_within_1px";
    /// Frames with an |error across rows| below the limit of two pixels, as a fraction of the detected frames
    /// with a line of sight.
    pub const DEC_WITHIN_2PX: &str = "dec_within_2px";
    /// Root mean square of the error across columns over correct measurements with a line of sight, degrees.
    pub const RA_RMS_DEG: &str = "ra_rms_deg";
    /// Root mean square of the error across rows over correct measurements with a line of sight, degrees.
    pub const DEC_RMS_DEG: &str = "dec_rms_deg";
    /// Mean error across columns (bias) over correct measurements with a line of sight, degrees.
    pub const RA_MEAN_DEG: &str = "ra_mean_deg";
    /// Mean error across rows (bias) over correct measurements with a line of sight, degrees.
    pub const DEC_MEAN_DEG: &str = "dec_mean_deg";
    /// Median error across columns over correct measurements with a line of sight, degrees.
    pub const RA_MEDIAN_DEG: &str = "ra_median_deg";
    /// Median error across rows over correct measurements with a line of sight, degrees.
    pub const DEC_MEDIAN_DEG: &str = "dec_median_deg";
    /// Root mean square of the centroid error across columns over correct measurements, px.
    pub const CENTROID_X_RMS_PX: &str = "centroid_x_rms_px";
    /// Root mean square of the centroid error across rows over correct measurements, px.
    pub const CENTROID_Y_RMS_PX: &str = "centroid_y_rms_px";
    /// Mean centroid error across columns (bias) over correct measurements, px.
    pub const CENTROID_X_MEAN_PX: &str = "centroid_x_mean_px";
    /// Mean centroid error across rows (bias) over correct measurements, px.
    pub const CENTROID_Y_MEAN_PX: &str = "centroid_y_mean_px";
    /// Median centroid error across columns over correct measurements, px.
    pub const CENTROID_X_MEDIAN_PX: &str = "centroid_x_median_px";
    /// Median centroid error across rows over correct measurements, px.
    pub const CENTROID_Y_MEDIAN_PX: &str = "centroid_y_median_px";
    /// Mean number of identified stars, over the frames whose outcome states this number.
    pub const STARS_MEAN: &str = "stars_mean";
    /// Prefix of the figures about the centroid's covariance: `centroid_nees_mean`,
    /// `centroid_within_1sigma_rate`, `centroid_within_3sigma_rate`.
    pub const CENTROID: &str = "centroid";
    /// Prefix of the corresponding figures about the covariance of the line of sight.
    pub const LINE_OF_SIGHT: &str = "line_of_sight";
    /// Mean NEES of the centroid, eᵀ C⁻¹ e / 2, over correct measurements with a centroid covariance.
    pub const CENTROID_NEES_MEAN: &str = "centroid_nees_mean";
    /// Fraction of the centroid's error components within one standard deviation, over correct measurements
    /// with a centroid covariance.
    pub const CENTROID_WITHIN_1SIGMA_RATE: &str = "centroid_within_1sigma_rate";
    /// Fraction of the centroid's error components within three standard deviations, over correct
    /// measurements with a centroid covariance.
    pub const CENTROID_WITHIN_3SIGMA_RATE: &str = "centroid_within_3sigma_rate";
    /// Mean NEES of the line of sight, eᵀ C⁻¹ e / 2, over correct measurements with a covariance of the line
    /// of sight.
    pub const LINE_OF_SIGHT_NEES_MEAN: &str = "line_of_sight_nees_mean";
    /// Fraction of the error components of the line of sight within one standard deviation, over correct
    /// measurements with a covariance of the line of sight.
    pub const LINE_OF_SIGHT_WITHIN_1SIGMA_RATE: &str = "line_of_sight_within_1sigma_rate";
    /// Fraction of the error components of the line of sight within three standard deviations, over correct
    /// measurements with a covariance of the line of sight.
    pub const LINE_OF_SIGHT_WITHIN_3SIGMA_RATE: &str = "line_of_sight_within_3sigma_rate";
    /// Number of frames before the first 20 consecutive correct measurements.
    pub const FRAMES_UNTIL_SETTLED: &str = "frames_until_settled";
    /// Frames whose attitude was solved from their stars, as a fraction of all frames.
    pub const ATTITUDE_FROM_STARS_RATE: &str = "attitude_from_stars_rate";
}

/// Score of a run: the content of `score.json`. Figures and groups keep their order in the file; groups are
/// in the order of their first frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Name of the scenario.
    pub scenario: String,
    /// Seed of the scenario.
    pub seed: u64,
    /// Version of Boresight that computed the score.
    pub version: String,
    /// Stage of the pipeline whose result was replaced by the truth; absent if none was. A score with an
    /// injected stage is not a score of the pipeline.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inject: Option<String>,
    /// Attitude that the lines of sight depend on: `own`, `telemetry` or `true`, `own and …` where
    /// measurements differ, `none` where no measurement has a line of sight ([`score::attitude_word`]).
    /// Absent when no frame is detected.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attitude: Option<String>,
    /// Number of first frames, during which the pipeline starts up; they count only in the group `warm-up`.
    /// Absent when 0.
    #[serde(default, skip_serializing_if = "score::is_zero")]
    pub warm_up_frames: u64,
    /// Number of frames, detected and missed, each counted once.
    pub frames: u64,
    /// Figures over all frames, by name (see [`names`] for far range).
    pub figures: IndexMap<String, Figure>,
    /// Scores of each group (day, portion).
    pub groups: IndexMap<String, GroupScore>,
    /// Number of misses by `crate::Cause::code`; causes that did not occur are left out.
    pub misses: IndexMap<String, u64>,
    /// Number of wrong measurements, by the cause that kept the target from being chosen.
    pub wrong: IndexMap<String, u64>,
    /// Number of wrong measurements, by the object chosen instead: `star`, `planet`, `moon`, `hot_pixel`,
    /// `cosmic_ray`, `nothing`.
    pub wrong_taken: IndexMap<String, u64>,
    /// Consistency of the covariances by the state of the target's image and by the source of the attitude.
    /// Absent where no correct measurement has a covariance.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub consistency: Vec<ConsistencyRow>,
    /// Rates by a threshold on the odds that measurements state. Absent where a measurement states none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub threshold_curve: Vec<ThresholdPoint>,
}

/// Consistency of the covariances in one class of frames: a row of `consistency` in `score.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ConsistencyRow {
    /// Criterion that divides the frames into classes: `image` or `attitude`.
    pub by: String,
    /// Class: `crate::ImageState::code` for `image`; [`contract::AttitudeSource::code`] or `unstated` for
    /// `attitude`.
    pub value: String,
    /// Number of correct measurements of this class with a covariance.
    pub frames: u64,
    /// Figures of consistency over these measurements, by name.
    pub figures: IndexMap<String, Figure>,
}

/// Rates if only measurements count whose stated odds reach a threshold: a row of `threshold_curve` in
/// `score.json`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ThresholdPoint {
    /// Threshold: natural logarithm of the odds.
    pub min_log_odds: f64,
    /// Correct measurements above the threshold, as a fraction of the frames with a visible target; `None`
    /// without such frames.
    pub correct_rate: Option<f64>,
    /// Wrong measurements above the threshold in frames with a visible target, as a fraction of these;
    /// `None` without such frames.
    pub wrong_rate: Option<f64>,
    /// Wrong measurements above the threshold in frames without a visible target, as a fraction of these;
    /// `None` without such frames.
    pub false_alarm_rate: Option<f64>,
}

/// Score of one group of frames.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GroupScore {
    /// Number of frames.
    pub frames: u64,
    /// Figures by name.
    pub figures: IndexMap<String, Figure>,
    /// Number of misses by cause.
    pub misses: IndexMap<String, u64>,
    /// Number of wrong measurements by cause.
    pub wrong: IndexMap<String, u64>,
    /// Number of wrong measurements by the object chosen instead.
    pub wrong_taken: IndexMap<String, u64>,
}
