//! Structure of a study file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::design::DesignKind;
use super::distribution::Distribution;
use crate::findings::requirement::StudyRequirement;

/// A study, as stored in a TOML file. Unknown keys are errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudyFile {
    /// Description of the study, in one line.
    pub title: String,
    /// A built-in scenario, or the path of a scenario file, relative to the study's directory.
    pub scenario: String,
    /// Seed of all draws of the study; the seed of a case's scenario is derived from this seed and the number
    /// of the case's draw.
    #[schemars(range(max = u64::MAX))]
    pub seed: u64,
    /// Frames (docking: fields) of every case, `A..B`: from A inclusive to B exclusive; absent: all of the
    /// scenario.
    pub frames: Option<String>,
    /// Number of first frames of every case, during which the pipeline starts up: they count in no figure.
    /// Absent: as stated in the scenario.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1_u64 << 40))]
    pub warm_up_frames: Option<u64>,
    /// Navigator that determines the relative orbit from the measurements of every case, with the defaults of
    /// `boresight navigate`; its figures (`navigation_…`) are recorded after those of the score. Far range
    /// only. Absent: no navigation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub navigate: Option<StudyNavigator>,
    /// Method of spreading the dispersed parameters over their distributions.
    #[serde(default)]
    pub design: DesignKind,
    /// Number of independent replications of a smaller design, into which the cases of a Latin hypercube or
    /// of Sobol's sequence are divided. The scatter of the replications gives the intervals; a mean needs at
    /// least five. A single replication has no scatter, and its intervals are as wide as those of independent
    /// draws.
    #[serde(default = "default_replications")]
    #[schemars(range(min = 1, max = 10_000))]
    pub replications: u64,
    /// Parameters that vary according to a distribution.
    #[serde(default)]
    pub vary: Vec<Dispersion>,
    /// Parameters that take each of a list of values. With several of them, every combination is run, and
    /// each with the same draws of all other parameters: differences between sweep points are therefore due
    /// to the swept values.
    #[serde(default)]
    pub sweep: Vec<Sweep>,
    /// Stopping rule of the study.
    pub stop: Stop,
    /// Values that are recorded.
    #[serde(default)]
    pub record: Record,
    /// Requirements on the figures.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub require: Vec<StudyRequirement>,
}

/// Navigator of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StudyNavigator {
    /// Least squares over all measurements.
    Batch,
    /// Filter: each estimate from the measurements until then.
    Sequential,
}

impl StudyNavigator {
    /// Returns the name of the estimator.
    pub fn code(self) -> &'static str {
        match self {
            Self::Batch => "batch",
            Self::Sequential => "sequential",
        }
    }
}

const fn default_replications() -> u64 {
    1
}

/// A parameter that varies.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dispersion {
    /// Path of the parameter in the scenario, as in `psf.sigma_px`, `attitude.control.jitter_arcsec[2]` or
    /// `cameras[0].camera.focal_length_mm`.
    pub path: String,
    /// Distribution of the parameter.
    pub distribution: Distribution,
}

/// A parameter that is swept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// Path of the parameter in the scenario.
    pub path: String,
    /// Values of the parameter, of any type.
    pub values: Vec<Value>,
}

/// Stopping rule of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stop {
    /// Number of cases; with `until`, the largest number of cases. A multiple of the sweep's combinations.
    #[schemars(range(min = 1, max = 1_u64 << 40))]
    pub cases: u64,
    /// Condition for stopping earlier, as soon as a figure is known accurately enough. Only for the random
    /// design, whose first cases are also a sample.
    pub until: Option<Until>,
}

/// Required accuracy of a figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Until {
    /// Name of a figure of the score, as in `hit_rate`.
    pub figure: String,
    /// Half the width of the figure's 95 % interval, in the unit of the figure, > 0. Tested after 16 draws (a
    /// draw is one case at every point of the sweep), 32, 48, from 256 on after each further sixteenth, and
    /// after all draws, regardless of the division into shards. A figure that has the same value in all but
    /// seven or fewer draws does not stop the study, because its scatter is unknown.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1e12))]
    pub half_width: f64,
}

/// Values that are recorded for each case.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// Names of the recorded figures; absent: all figures of the score.
    pub figures: Option<Vec<String>>,
    /// Figure that ranks cases from good to bad; absent: `correct_rate` in far range, `success_rate` in
    /// docking.
    pub worst_by: Option<String>,
}
