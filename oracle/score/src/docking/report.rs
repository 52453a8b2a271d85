//! What `score.json` of a docking run holds.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::Figure;

/// Names of the docking figures that something else asks for; `docs/formats.md` lists all of them.
pub mod names {
    /// Six parameters given, none grossly wrong, of the fields in which they can be asked for: the target is resolved, or they
    /// are given.
    pub const SUCCESS_RATE: &str = "success_rate";
    /// The same, of those in which the target is resolved and wholly in the image.
    pub const CLEAR_SUCCESS_RATE: &str = "clear_success_rate";
    /// Six parameters given and not doubted, rightly or wrongly, of all fields: what the paper calls processed successfully.
    pub const MEASURED_RATE: &str = "measured_rate";
    /// The range alone, of all fields.
    pub const RANGE_ONLY_RATE: &str = "range_only_rate";
    /// Grossly wrong, of all fields.
    pub const WRONG_RATE: &str = "wrong_rate";
    /// Given and doubted by the pipeline, of all fields.
    pub const DOUBTFUL_RATE: &str = "doubtful_rate";
    /// Grossly wrong, of the doubtful ones: how often a doubt was needed.
    pub const DOUBTFUL_WRONG_RATE: &str = "doubtful_wrong_rate";
    /// No answer, of all fields.
    pub const MISS_RATE: &str = "miss_rate";
    /// Root mean square of the error of ρ, m.
    pub const RANGE_RMS_M: &str = "range_rms_m";
    /// Root mean square of the length of the error of (d1, d2), m.
    pub const LATERAL_RMS_M: &str = "lateral_rms_m";
    /// Root mean square of the angle between true and measured attitude, degrees.
    pub const ATTITUDE_RMS_DEG: &str = "attitude_rms_deg";
    /// Errors within three standard deviations, of all six parameters.
    pub const WITHIN_3_SIGMA: &str = "within_3_sigma";
    /// Mean of the normalised estimation error squared over its dimension.
    pub const NEES_MEAN: &str = "nees_mean";
    /// Mean of SPEED's pose score.
    pub const SPEED_SCORE_MEAN: &str = "speed_score_mean";
    /// Root mean square of the error of a range that is given alone, m.
    pub const RANGE_ONLY_RMS_M: &str = "range_only_rms_m";
    /// The same in percent of the true one.
    pub const RANGE_ONLY_RMS_PERCENT: &str = "range_only_rms_percent";
    /// Fields from the first clear one to the first success.
    pub const LATENCY_FIELDS: &str = "latency_fields";
    /// Fields of a portion, from its first measured one to its report.
    pub const PORTION_LATENCY_FIELDS: &str = "portion_latency_fields";
    /// Reports at most a second after the one before.
    pub const RENEWED_WITHIN_1S: &str = "renewed_within_1s";
    /// Before the names of figures of the paper's formulas.
    pub const PAPER: &str = "paper_";
    /// Before the names of figures of what is said at the end of a portion.
    pub const MOTION: &str = "motion_";
}

/// The score of a docking run: the content of its `score.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DockingScore {
    /// Always `docking`.
    pub world: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Its seed.
    pub seed: u64,
    /// Version of Boresight that made the score.
    pub version: String,
    /// What drew the scene: `fast` or `mitsuba`.
    pub renderer: String,
    /// The first fields, in which the pipeline starts up: they are in the group `warm-up` and in no other number but the latency. Absent
    /// when 0.
    #[serde(default, skip_serializing_if = "crate::report::is_zero")]
    pub warm_up_frames: u64,
    /// Number of fields, each counted once: succeeded, range alone, doubtful, wrong, missed.
    pub frames: u64,
    /// Number of reports at the end of a portion.
    pub portions: u64,
    /// Figures over all fields, by name.
    pub figures: IndexMap<String, Figure>,
    /// The same for each bin of range and lens ([`super::group_name`]), from far to near.
    pub groups: IndexMap<String, DockingGroup>,
    /// Misses by [`super::MissCause::code`]; causes that did not occur are left out.
    pub misses: IndexMap<String, u64>,
    /// Wrong answers by [`super::GrossError::code`].
    pub wrong: IndexMap<String, u64>,
    /// Doubtful poses by [`contract::docking::FailedCheck::code`].
    #[serde(default)]
    pub doubtful: IndexMap<String, u64>,
}

/// The score of one bin of range and lens.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DockingGroup {
    /// Number of fields.
    pub frames: u64,
    /// Number of reports.
    pub portions: u64,
    /// Figures by name.
    pub figures: IndexMap<String, Figure>,
    /// Misses by cause.
    pub misses: IndexMap<String, u64>,
    /// Wrong answers by what is wrong.
    pub wrong: IndexMap<String, u64>,
    /// Doubtful poses by the test that they failed.
    #[serde(default)]
    pub doubtful: IndexMap<String, u64>,
}
