//! A pipeline's answer to one field.

use std::fmt;

use crate::docking::{Digitiser, Features, MotionReport, Pose, PoseEstimate};

/// A field that was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldMeasurement {
    /// Pose by the pipeline's own best estimator, at the moment of the field.
    pub best: PoseEstimate,
    /// Pose by the paper's formulas (3.1), where the pipeline has them and the field allows them.
    pub paper: Option<Pose>,
}

/// Why there is no pose in the answer.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum NoPose {
    /// The image holds no signal: flat, or nothing but noise.
    EmptyField,
    /// So much is saturated that nothing can be told apart.
    SaturatedField,
    /// Nothing in the image has the structure of the target.
    NoTarget,
    /// More than one thing in the image has the structure of the target.
    AmbiguousTarget,
    /// The target is there, and too much of it lies outside the image.
    OutOfField,
    /// The target is there, and too few of its features are good.
    TooFewFeatures,
    /// What was found contradicts the structure of the scene (self-checking).
    Inconsistent,
    /// The pipeline failed; the text says how. Counted as an outcome like any other.
    Failed(String),
}

impl NoPose {
    const PLAIN: [Self; 7] = [
        Self::EmptyField,
        Self::SaturatedField,
        Self::NoTarget,
        Self::AmbiguousTarget,
        Self::OutOfField,
        Self::TooFewFeatures,
        Self::Inconsistent,
    ];

    /// The word used in files.
    pub fn code(&self) -> &'static str {
        match self {
            Self::EmptyField => "empty_field",
            Self::SaturatedField => "saturated_field",
            Self::NoTarget => "no_target",
            Self::AmbiguousTarget => "ambiguous_target",
            Self::OutOfField => "out_of_field",
            Self::TooFewFeatures => "too_few_features",
            Self::Inconsistent => "inconsistent",
            Self::Failed(_) => "failed",
        }
    }

    /// Reads what [`fmt::Display`] writes, and `failed` alone; `None` for an unknown word.
    pub fn parse(text: &str) -> Option<Self> {
        let failed = || if text == "failed" { Some(text) } else { text.strip_prefix("failed: ") };
        let plain = Self::PLAIN.into_iter().find(|reason| reason.code() == text);
        plain.or_else(|| failed().map(|reason| Self::Failed(reason.to_owned())))
    }
}

impl fmt::Display for NoPose {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Failed(reason) => write!(f, "failed: {reason}"),
            other => f.write_str(other.code()),
        }
    }
}

/// The test that a measured pose has failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum FailedCheck {
    /// What the measurement leaves of the image is not noise.
    Residuals,
    /// Cross, ring of marks, docking unit and station's outline do not belong to one scene.
    Features,
    /// The pose is not on the motion of the fields before.
    Motion,
    /// The field is an earlier one, bit for bit: the pose is of another moment.
    Repeated,
}

impl FailedCheck {
    /// Every one, in the order in which they are tested.
    pub const ALL: [Self; 4] = [Self::Repeated, Self::Residuals, Self::Features, Self::Motion];

    /// The word used in files, after `doubtful: `.
    pub fn code(self) -> &'static str {
        match self {
            Self::Residuals => "residuals",
            Self::Features => "features",
            Self::Motion => "motion",
            Self::Repeated => "repeated",
        }
    }
}

impl fmt::Display for FailedCheck {
    /// The status of a row in files: `doubtful: ` and [`FailedCheck::code`].
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "doubtful: {}", self.code())
    }
}

impl std::str::FromStr for FailedCheck {
    type Err = ();

    /// Reads what [`fmt::Display`] writes.
    fn from_str(text: &str) -> Result<Self, ()> {
        let code = text.strip_prefix("doubtful: ").ok_or(())?;
        Self::ALL.into_iter().find(|doubt| doubt.code() == code).ok_or(())
    }
}

/// The pose, less than that, or why not.
#[derive(Debug, Clone, PartialEq)]
pub enum DockingSolution {
    /// All six parameters were measured.
    Measured(Box<FieldMeasurement>),
    /// All six parameters were measured, and the measurement failed a test: a pose to look at, not to rely on.
    Doubtful {
        /// What was measured.
        measurement: Box<FieldMeasurement>,
        /// The test that it failed.
        doubt: FailedCheck,
    },
    /// The target is not resolved yet: the range alone, from the outline of the station.
    RangeOnly {
        /// d3, m.
        range_m: f64,
        /// Its standard deviation, m.
        sigma_m: f64,
    },
    /// Nothing was measured.
    NoSolution(NoPose),
}

/// A pipeline's whole answer to one field.
#[derive(Debug, Clone, PartialEq)]
pub struct DockingOutcome {
    /// The pose, or why not.
    pub solution: DockingSolution,
    /// What was recognised.
    pub features: Features,
    /// The motion, when this field ends a portion.
    pub motion: Option<MotionReport>,
    /// The setting of the digitiser that the pipeline asks for; `None`: as it is.
    pub digitiser: Option<Digitiser>,
}

impl DockingOutcome {
    /// An answer that has nothing but a reason.
    pub fn none(reason: NoPose) -> Self {
        Self {
            solution: DockingSolution::NoSolution(reason),
            features: Features::default(),
            motion: None,
            digitiser: None,
        }
    }

    /// The measurement, if there is one that is not doubtful.
    pub fn measurement(&self) -> Option<&FieldMeasurement> {
        match &self.solution {
            DockingSolution::Measured(measurement) => Some(measurement),
            _ => None,
        }
    }

    /// The measurement, doubtful or not.
    pub fn any_measurement(&self) -> Option<&FieldMeasurement> {
        match &self.solution {
            DockingSolution::Measured(measurement) | DockingSolution::Doubtful { measurement, .. } => {
                Some(measurement)
            }
            _ => None,
        }
    }
}
