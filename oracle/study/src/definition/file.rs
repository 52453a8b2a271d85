//! The file of a study.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::design::DesignKind;
use super::distribution::Distribution;
use crate::findings::requirement::StudyRequirement;

/// A study, as a TOML file holds it. Unknown keys are errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudyFile {
    /// What it is, in one line.
    pub title: String,
    /// A built-in scenario, or the path of a scenario file, starting from the study's folder.
    pub scenario: String,
    /// Seed of all draws of the study; the seed of a case's scenario is made from it and the case's number.
    #[schemars(range(max = u64::MAX))]
    pub seed: u64,
    /// Frames (docking: fields) of every case, `A..B`: from A up to and without B; absent: all of the scenario.
    pub frames: Option<String>,
    /// The first frames of every case, in which the pipeline starts up: they count in no figure. Absent: as the scenario says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1_u64 << 40))]
    pub warm_up_frames: Option<u64>,
    /// How the dispersed parameters are spread over their distributions.
    #[serde(default)]
    pub design: DesignKind,
    /// Of a Latin hypercube or of Sobol's sequence: independent replications of a smaller design, which the cases are cut into. Their scatter
    /// gives the intervals; five are the fewest of a mean. One has no scatter, and intervals as wide as those of independent draws.
    #[serde(default = "default_replications", skip_serializing_if = "is_default")]
    #[schemars(range(min = 1, max = 10_000))]
    pub replications: u64,
    /// Parameters that vary by a distribution.
    #[serde(default)]
    pub vary: Vec<Dispersion>,
    /// Parameters that take each of some values; of several, every combination is run, and each with the same draws of all other
    /// parameters, so that what differs is the sweep's doing.
    #[serde(default)]
    pub sweep: Vec<Sweep>,
    /// When it is done.
    pub stop: Stop,
    /// What is recorded.
    #[serde(default)]
    pub record: Record,
    /// What the figures must reach.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub require: Vec<StudyRequirement>,
}

const fn default_replications() -> u64 {
    1
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
const fn is_default(replications: &u64) -> bool {
    *replications == 1
}

/// A parameter that varies.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dispersion {
    /// Its path in the scenario, as in `psf.sigma_px`, `attitude.control.jitter_arcsec[2]` or `cameras[0].camera.focal_length_mm`.
    pub path: String,
    /// Its distribution.
    pub distribution: Distribution,
}

/// A parameter that is swept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// Its path in the scenario.
    pub path: String,
    /// Its values, of any type.
    pub values: Vec<Value>,
}

/// When a study is done.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stop {
    /// Number of cases; with `until`, the most there are. A multiple of the sweep's combinations.
    #[schemars(range(min = 1, max = 1_u64 << 40))]
    pub cases: u64,
    /// Stop earlier, as soon as a figure is known well enough. With the random design alone, whose first cases are a sample too.
    pub until: Option<Until>,
}

/// How well a figure is to be known.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Until {
    /// Name of a figure of the score, as in `hit_rate`.
    pub figure: String,
    /// Half the width of its 95 % interval, in its own unit, > 0. Looked at after 16 draws (a draw is one case at every point of the
    /// sweep), 32, 48, from 256 on after a sixteenth more each time, and after all, however the study is cut. A figure that is the same in
    /// all but seven draws or fewer is not waited for: its scatter is not known.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1e12))]
    pub half_width: f64,
}

/// What is recorded of a case.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// Names of figures; absent: all of the score.
    pub figures: Option<Vec<String>>,
    /// The figure by which cases are good or bad; absent: `correct_rate` in far range, `success_rate` in docking.
    pub worst_by: Option<String>,
}
