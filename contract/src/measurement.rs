//! Outcome of a far-range pipeline for one frame.

use std::fmt;

use crate::{CameraFrame, Covariance2, Direction, Icrs, PixelPoint, Rotation};

/// Measurement of the target in one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// Centre of the target's image.
    pub position: PixelPoint,
    /// Covariance of the position along columns and rows (standard deviations in px); `None` if the pipeline
    /// does not estimate it.
    pub position_covariance: Option<Covariance2>,
    /// Line of sight to the target; `None` if the pipeline measures only image positions.
    pub line_of_sight: Option<Direction<Icrs>>,
    /// Covariance of the line of sight (standard deviations in rad), as angles atan2(X, Z) across columns and
    /// atan2(Y, Z) across rows in the camera frame, including the error of the attitude; `None` without a
    /// line of sight, or if the pipeline does not estimate it.
    pub line_of_sight_covariance: Option<Covariance2>,
    /// Natural logarithm of the odds p/(1 − p) that this is the target's image, with the probability p by the
    /// pipeline; finite; `None` if the pipeline does not estimate it.
    pub log_odds: Option<f64>,
}

impl Measurement {
    /// Creates a measurement without covariances and odds.
    pub fn new(position: PixelPoint, line_of_sight: Option<Direction<Icrs>>) -> Self {
        Self {
            position,
            position_covariance: None,
            line_of_sight,
            line_of_sight_covariance: None,
            log_odds: None,
        }
    }
}

/// Reason why an outcome contains no target.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum NoSolution {
    /// No pixel exceeds the background.
    EmptyFrame,
    /// Too much of the frame is saturated to distinguish anything.
    SaturatedFrame,
    /// No previous frame is available to measure motion against.
    NoPreviousFrame,
    /// Clusters were found, but no candidate: all are stars, hotspots or unlinked.
    NoTarget,
    /// The pipeline failed, with the reason as text. Counted as an outcome like any other.
    Failed(String),
}

impl NoSolution {
    /// Returns the name used in files.
    pub fn code(&self) -> &'static str {
        match self {
            Self::EmptyFrame => "empty_frame",
            Self::SaturatedFrame => "saturated_frame",
            Self::NoPreviousFrame => "no_previous_frame",
            Self::NoTarget => "no_target",
            Self::Failed(_) => "failed",
        }
    }

    /// Parses the output of [`fmt::Display`], or `failed` without a reason; `None` for an unknown text.
    pub fn parse(text: &str) -> Option<Self> {
        Some(match text {
            "empty_frame" => Self::EmptyFrame,
            "saturated_frame" => Self::SaturatedFrame,
            "no_previous_frame" => Self::NoPreviousFrame,
            "no_target" => Self::NoTarget,
            "failed" => Self::Failed(text.to_owned()),
            other => Self::Failed(other.strip_prefix("failed: ")?.to_owned()),
        })
    }
}

impl fmt::Display for NoSolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Failed(reason) => write!(f, "failed: {reason}"),
            other => f.write_str(other.code()),
        }
    }
}

/// Measurement of the target, or the reason why there is none.
#[derive(Debug, Clone, PartialEq)]
pub enum Solution {
    /// A target was found.
    Detected(Measurement),
    /// No target was found.
    NoSolution(NoSolution),
}

/// Source of the camera attitude of an outcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AttitudeSource {
    /// Solved from a sufficient number of stars in this frame.
    Stars,
    /// Solved from the stars in this frame, at another focal length than that of the setup, which they
    /// contradict.
    RescaledStars,
    /// Too few stars to solve the attitude: the last filtered mounting was used.
    TooFewStars,
    /// No stars: the last filtered mounting was used.
    NoStars,
    /// Enough stars, but no set of them matches the star list: the last filtered mounting was used.
    NoMatch,
}

impl AttitudeSource {
    /// All variants.
    pub const ALL: [Self; 5] =
        [Self::Stars, Self::RescaledStars, Self::TooFewStars, Self::NoStars, Self::NoMatch];

    /// Returns the name used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Stars => "stars",
            Self::RescaledStars => "rescaled_stars",
            Self::TooFewStars => "too_few_stars",
            Self::NoStars => "no_stars",
            Self::NoMatch => "no_match",
        }
    }

    /// Returns true if the stars of the frame determine the attitude.
    pub fn is_by_stars(self) -> bool {
        matches!(self, Self::Stars | Self::RescaledStars)
    }

    /// Parses the result of [`AttitudeSource::code`].
    pub fn parse(code: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|source| source.code() == code)
    }
}

/// Classification of a cluster by a pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Label {
    /// Star with this number in the star list.
    Star(u32),
    /// A hotspot of the detector.
    Hotspot,
    /// Not linked to a cluster of the previous frame, and therefore without a motion to test.
    Unlinked,
    /// A candidate that was not selected by the motion test.
    Candidate,
    /// The target.
    Target,
}

impl Label {
    /// Returns the name used in files; the number of a star has a separate column.
    pub fn code(self) -> &'static str {
        match self {
            Self::Star(_) => "star",
            Self::Hotspot => "hotspot",
            Self::Unlinked => "unlinked",
            Self::Candidate => "candidate",
            Self::Target => "target",
        }
    }
}

/// A cluster of bright pixels with its classification, used to find the cause of a miss.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cluster {
    /// Centre of the cluster; the pipeline chooses the estimator.
    pub position: PixelPoint,
    /// Weighted size: the sum of the intensities, each in [0, 1].
    pub size: f64,
    /// Number of pixels.
    pub pixels: u32,
    /// Classification of the cluster.
    pub label: Label,
}

/// Complete outcome of a pipeline for one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Measurement of the target, or the reason why there is none.
    pub solution: Solution,
    /// Camera attitude used for the line of sight, if the pipeline has one.
    pub camera_from_icrs: Option<Rotation<CameraFrame, Icrs>>,
    /// Source of that attitude.
    pub attitude_source: Option<AttitudeSource>,
    /// Number of stars identified in the frame; `None` if the pipeline does not report it.
    pub n_stars: Option<u32>,
    /// All clusters with their labels; may be empty if the pipeline does not report them.
    pub clusters: Vec<Cluster>,
}

impl Outcome {
    /// Creates an outcome without a solution, with its reason.
    pub fn without_solution(reason: NoSolution) -> Self {
        Self {
            solution: Solution::NoSolution(reason),
            camera_from_icrs: None,
            attitude_source: None,
            n_stars: None,
            clusters: Vec::new(),
        }
    }

    /// Returns the measurement, if present.
    pub fn measurement(&self) -> Option<&Measurement> {
        match &self.solution {
            Solution::Detected(measurement) => Some(measurement),
            Solution::NoSolution(_) => None,
        }
    }
}
