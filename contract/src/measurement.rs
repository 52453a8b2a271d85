//! What a pipeline says about a frame.

use std::fmt;

use crate::{CameraFrame, Covariance2, Direction, Icrs, PixelPoint, Rotation};

/// The target, found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// Centre of the target's image.
    pub position: PixelPoint,
    /// Covariance of that centre along columns and rows, px; `None` when the pipeline does not estimate it.
    pub position_covariance: Option<Covariance2>,
    /// Line of sight to the target; `None` when the pipeline measures in the image only.
    pub line_of_sight: Option<Direction<Icrs>>,
    /// Covariance of the line of sight, rad: of its angles atan2(X, Z) across columns and atan2(Y, Z) across rows in the camera frame,
    /// the error of the attitude included; `None` without a line of sight, or when the pipeline does not estimate it.
    pub line_of_sight_covariance: Option<Covariance2>,
}

impl Measurement {
    /// A centre and a line of sight without covariances.
    pub fn new(position: PixelPoint, line_of_sight: Option<Direction<Icrs>>) -> Self {
        Self { position, position_covariance: None, line_of_sight, line_of_sight_covariance: None }
    }
}

/// Why there is no target in the answer.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum NoSolution {
    /// No pixel rises above the background.
    EmptyFrame,
    /// So much of the frame is saturated that nothing can be told apart.
    SaturatedFrame,
    /// There was no previous frame to measure motion against.
    NoPreviousFrame,
    /// Clusters were found, none of them a candidate: all are stars, hotspots or not linked.
    NoTarget,
    /// The pipeline failed; the text says how. Counted as an outcome like any other.
    Failed(String),
}

impl NoSolution {
    /// The word used in files.
    pub fn code(&self) -> &'static str {
        match self {
            Self::EmptyFrame => "empty_frame",
            Self::SaturatedFrame => "saturated_frame",
            Self::NoPreviousFrame => "no_previous_frame",
            Self::NoTarget => "no_target",
            Self::Failed(_) => "failed",
        }
    }

    /// Reads what [`fmt::Display`] writes, and `failed` alone; `None` for an unknown word.
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

/// The target, or why not.
#[derive(Debug, Clone, PartialEq)]
pub enum Solution {
    /// A target was found.
    Detected(Measurement),
    /// No target was found.
    NoSolution(NoSolution),
}

/// Where the camera's attitude of an answer comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AttitudeSource {
    /// Solved from enough stars of this frame.
    Stars,
    /// Some stars, too few to solve: the last filtered mounting was used.
    TooFewStars,
    /// No star: the last filtered mounting was used.
    NoStars,
    /// Enough stars seen, and no set of them that matches the list: the last filtered mounting was used.
    NoMatch,
}

impl AttitudeSource {
    /// Every one.
    pub const ALL: [Self; 4] = [Self::Stars, Self::TooFewStars, Self::NoStars, Self::NoMatch];

    /// The word used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Stars => "stars",
            Self::TooFewStars => "too_few_stars",
            Self::NoStars => "no_stars",
            Self::NoMatch => "no_match",
        }
    }

    /// Reads [`AttitudeSource::code`].
    pub fn parse(code: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|source| source.code() == code)
    }
}

/// What a pipeline took a cluster for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Label {
    /// The listed star of this number.
    Star(u32),
    /// A hotspot of the detector.
    Hotspot,
    /// Not linked to any cluster of the previous frame, so without a motion to judge.
    Unlinked,
    /// A candidate that lost the motion test.
    Candidate,
    /// The target.
    Target,
}

impl Label {
    /// The word used in files; a star's number has a column of its own.
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

/// A cluster of bright pixels, and what the pipeline took it for: evidence for the cause of a miss.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cluster {
    /// Its centre, however the pipeline measures it.
    pub position: PixelPoint,
    /// Weighted size: the sum of the intensities, each in [0, 1].
    pub size: f64,
    /// Number of pixels.
    pub pixels: u32,
    /// What it was taken for.
    pub label: Label,
}

/// A pipeline's whole answer to one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The target, or why not.
    pub solution: Solution,
    /// The camera's attitude used for the line of sight, if the pipeline has one.
    pub camera_from_icrs: Option<Rotation<CameraFrame, Icrs>>,
    /// Where that attitude comes from.
    pub attitude_source: Option<AttitudeSource>,
    /// Stars identified in the frame; `None` when the pipeline does not tell.
    pub n_stars: Option<u32>,
    /// Every cluster with its label; may be empty when the pipeline does not tell.
    pub clusters: Vec<Cluster>,
}

impl Outcome {
    /// An answer that has nothing but a reason.
    pub fn none(reason: NoSolution) -> Self {
        Self {
            solution: Solution::NoSolution(reason),
            camera_from_icrs: None,
            attitude_source: None,
            n_stars: None,
            clusters: Vec::new(),
        }
    }

    /// The measurement, if there is one.
    pub fn measurement(&self) -> Option<&Measurement> {
        match &self.solution {
            Solution::Detected(measurement) => Some(measurement),
            Solution::NoSolution(_) => None,
        }
    }
}
