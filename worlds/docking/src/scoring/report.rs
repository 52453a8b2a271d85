//! Content of `score.json` of a docking run.

use indexmap::IndexMap;
use score::Figure;
use serde::{Deserialize, Serialize};

/// Names of the docking figures that other code uses; `docs/evidence/formats.md` lists all of them.
pub mod names {
    /// Fields with six measured parameters, none grossly wrong, as a fraction of the fields in which they can
    /// be required: the target is resolved, or they are measured.
    pub const SUCCESS_RATE: &str = "success_rate";
    /// Fields with six measured parameters, none grossly wrong, as a fraction of the fields in which the
    /// target is resolved and completely in the image.
    pub const CLEAR_SUCCESS_RATE: &str = "clear_success_rate";
    /// Fields with six measured parameters that are not doubtful, right or wrong, as a fraction of all
    /// fields: the fields that the paper calls processed successfully.
    pub const MEASURED_RATE: &str = "measured_rate";
    /// Fields with only a range, as a fraction of all fields.
    pub const RANGE_ONLY_RATE: &str = "range_only_rate";
    /// Grossly wrong fields, as a fraction of all fields.
    pub const WRONG_RATE: &str = "wrong_rate";
    /// Fields measured and marked as doubtful by the pipeline, as a fraction of all fields.
    pub const DOUBTFUL_RATE: &str = "doubtful_rate";
    /// Grossly wrong fields, as a fraction of the doubtful ones: how often a doubt was justified.
    pub const DOUBTFUL_WRONG_RATE: &str = "doubtful_wrong_rate";
    /// Fields without a measurement, as a fraction of all fields.
    pub const MISS_RATE: &str = "miss_rate";
    /// Root mean square of the error of ρ, m.
    pub const RANGE_RMS_M: &str = "range_rms_m";
    /// Root mean square of the length of the error of (d1, d2), m.
    pub const LATERAL_RMS_M: &str = "lateral_rms_m";
    /// Root mean square of the angle between true and measured attitude, degrees.
    pub const ATTITUDE_RMS_DEG: &str = "attitude_rms_deg";
    /// Errors within three standard deviations, as a fraction of those of all six parameters.
    pub const WITHIN_3_SIGMA: &str = "within_3_sigma";
    /// Mean of the normalised estimation error squared over its dimension.
    pub const NEES_MEAN: &str = "nees_mean";
    /// Mean of the pose score of SPEED.
    pub const SPEED_SCORE_MEAN: &str = "speed_score_mean";
    /// Root mean square of the error of range-only measurements, m.
    pub const RANGE_ONLY_RMS_M: &str = "range_only_rms_m";
    /// Root mean square of the error of range-only measurements, percent of the true range.
    pub const RANGE_ONLY_RMS_PERCENT: &str = "range_only_rms_percent";
    /// Number of fields from the first clear one to the first success.
    pub const LATENCY_FIELDS: &str = "latency_fields";
    /// Number of fields of a portion, from its first measured one to its report.
    pub const PORTION_LATENCY_FIELDS: &str = "portion_latency_fields";
    /// Clear fields whose last report is at most a second old, as a fraction of the clear fields from a
    /// second after the first measured field on.
    pub const RENEWED_WITHIN_1S: &str = "renewed_within_1s";
    /// Prefix of the names of figures of the paper's formulas.
    pub const PAPER: &str = "paper_";
    /// Prefix of the names of figures of motions reported at the end of portions.
    pub const MOTION: &str = "motion_";
}

/// Score of a docking run: the content of its `score.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DockingScore {
    /// Always `docking`.
    pub world: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Seed of the scenario.
    pub seed: u64,
    /// Version of Boresight that made the score.
    pub version: String,
    /// Renderer of the scene: `fast` or `mitsuba`.
    pub renderer: String,
    /// Number of first fields, in which the pipeline starts up. They are counted in the group `warm-up` and,
    /// among all other numbers, only in the latency. Absent when 0.
    #[serde(default, skip_serializing_if = "score::is_zero")]
    pub warm_up_frames: u64,
    /// Number of fields, each counted once: success, range only, doubtful, wrong, missed.
    pub frames: u64,
    /// Number of reports at the end of a portion.
    pub portions: u64,
    /// Figures over all fields, by name.
    pub figures: IndexMap<String, Figure>,
    /// Scores by bin of range and lens ([`super::group_name`]), from far to near.
    pub groups: IndexMap<String, DockingGroup>,
    /// Misses by [`super::MissCause::code`], without causes that did not occur.
    pub misses: IndexMap<String, u64>,
    /// Wrong measurements by [`super::GrossError::code`].
    pub wrong: IndexMap<String, u64>,
    /// Doubtful poses by [`contract::docking::FailedCheck::code`].
    #[serde(default)]
    pub doubtful: IndexMap<String, u64>,
}

/// Score of one bin of range and lens.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DockingGroup {
    /// Number of fields.
    pub frames: u64,
    /// Number of reports at the end of a portion.
    pub portions: u64,
    /// Figures by name.
    pub figures: IndexMap<String, Figure>,
    /// Misses by cause.
    pub misses: IndexMap<String, u64>,
    /// Wrong measurements by kind of gross error.
    pub wrong: IndexMap<String, u64>,
    /// Doubtful poses by failed test.
    #[serde(default)]
    pub doubtful: IndexMap<String, u64>,
}
