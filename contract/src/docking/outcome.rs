//! Outcome of a docking pipeline for one field.

use std::fmt;

use crate::docking::{Digitiser, Features, MotionReport, Pose, PoseEstimate};

/// Measurement from one field.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldMeasurement {
    /// Pose from the pipeline's best estimator, at the time of the field.
    pub best: PoseEstimate,
    /// Pose from the paper's formulas (3.1); `None` if the pipeline does not implement them or the field does
    /// not allow them.
    pub paper: Option<Pose>,
}

/// Reason why an outcome contains no pose.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum NoPose {
    /// The image contains no signal: it is flat or pure noise.
    EmptyField,
    /// Too much of the image is saturated to distinguish anything.
    SaturatedField,
    /// No object in the image has the structure of the target.
    NoTarget,
    /// More than one object in the image has the structure of the target.
    AmbiguousTarget,
    /// The target is visible, but too much of it lies outside the image.
    OutOfField,
    /// The target is visible, but too few of its features are usable.
    TooFewFeatures,
    /// The recognised features contradict the structure of the scene (self-checking).
    Inconsistent,
    /// The pipeline failed, with the reason as text. Counted as an outcome like any other.
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

    /// Returns the name used in files.
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

    /// Parses the output of [`fmt::Display`], or `failed` without a reason; `None` for an unknown text.
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

/// Test that a measured pose failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum FailedCheck {
    /// The residual image, after subtraction of the measurement's model, is more than noise.
    Residuals,
    /// The cross, the ring of marks, the docking unit and the station's outline do not form one consistent
    /// scene.
    Features,
    /// The pose deviates from the motion of the previous fields.
    Motion,
    /// No earlier field confirms the pose of a small target, whose features alone do not exclude another
    /// object; or the roll is above 20°, and no field has shown the docking unit: the target may be turned by
    /// a quarter.
    Unconfirmed,
    /// The picture is that of an earlier field, bit for bit, with new noise on it or coded again: the pose
    /// belongs to another time.
    Repeated,
}

impl FailedCheck {
    /// All tests, in the order in which they are applied.
    pub const ALL: [Self; 5] =
        [Self::Repeated, Self::Residuals, Self::Features, Self::Motion, Self::Unconfirmed];

    /// Returns the name used in files, after `doubtful: `.
    pub fn code(self) -> &'static str {
        match self {
            Self::Residuals => "residuals",
            Self::Features => "features",
            Self::Motion => "motion",
            Self::Unconfirmed => "unconfirmed",
            Self::Repeated => "repeated",
        }
    }
}

impl fmt::Display for FailedCheck {
    /// Writes the status of a row in files: `doubtful: ` and [`FailedCheck::code`].
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "doubtful: {}", self.code())
    }
}

impl std::str::FromStr for FailedCheck {
    type Err = ();

    /// Parses the output of [`fmt::Display`].
    fn from_str(text: &str) -> Result<Self, ()> {
        let code = text.strip_prefix("doubtful: ").ok_or(())?;
        Self::ALL.into_iter().find(|doubt| doubt.code() == code).ok_or(())
    }
}

/// Pose, range, or the reason why neither was measured.
#[derive(Debug, Clone, PartialEq)]
pub enum DockingSolution {
    /// All six parameters were measured.
    Measured(Box<FieldMeasurement>),
    /// All six parameters were measured, but the measurement failed a test: a pose for inspection that must
    /// not be relied on.
    Doubtful {
        /// The doubtful measurement.
        measurement: Box<FieldMeasurement>,
        /// Test that the measurement failed.
        doubt: FailedCheck,
    },
    /// The target is not resolved yet; only the range is measured, from the outline of the station.
    RangeOnly {
        /// Range d3, m.
        range_m: f64,
        /// Standard deviation of the range, m.
        sigma_m: f64,
    },
    /// Nothing was measured.
    NoSolution(NoPose),
}

/// Complete outcome of a docking pipeline for one field.
#[derive(Debug, Clone, PartialEq)]
pub struct DockingOutcome {
    /// Pose, range, or the reason why neither was measured.
    pub solution: DockingSolution,
    /// Features recognised in the field.
    pub features: Features,
    /// Motion, if this field ends a portion.
    pub motion: Option<MotionReport>,
    /// Digitiser setting that the pipeline requests; `None` leaves the setting unchanged.
    pub digitiser: Option<Digitiser>,
}

impl DockingOutcome {
    /// Creates an outcome without a solution, with its reason.
    pub fn without_pose(reason: NoPose) -> Self {
        Self {
            solution: DockingSolution::NoSolution(reason),
            features: Features::default(),
            motion: None,
            digitiser: None,
        }
    }

    /// Returns the measurement if it is present and not doubtful.
    pub fn measurement(&self) -> Option<&FieldMeasurement> {
        match &self.solution {
            DockingSolution::Measured(measurement) => Some(measurement),
            _ => None,
        }
    }

    /// Returns the measurement if it is present, doubtful or not.
    pub fn any_measurement(&self) -> Option<&FieldMeasurement> {
        match &self.solution {
            DockingSolution::Measured(measurement) | DockingSolution::Doubtful { measurement, .. } => {
                Some(measurement)
            }
            _ => None,
        }
    }
}
