//! Motion of the camera relative to the target at a given time.

use nalgebra::{Matrix6, SMatrix, Vector3};

use crate::docking::Pose;

/// Linear motion over a portion of fields, at the time of its last field (docking paper, 3.2).
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Time of the motion, s since the beginning of the sequence.
    pub time_s: f64,
    /// Pose at that time.
    pub pose: Pose,
    /// Velocity of the camera in the target frame, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// Rate dφ/dt, rad/s.
    pub phi_rate_rad_s: Vector3<f64>,
    /// Covariance of (d1, d2, d3, d1', d2', d3') at that time: m², m²/s, m²/s².
    pub position_covariance: Matrix6<f64>,
    /// Covariance of (φ1, φ2, φ3, φ1', φ2', φ3') at that time: rad², rad²/s, rad²/s².
    pub attitude_covariance: Matrix6<f64>,
    /// Covariance of (d1, d2, d3) with (φ1, φ2, φ3), m rad; zero if the method estimates position and
    /// attitude separately.
    pub cross_covariance: SMatrix<f64, 3, 3>,
    /// Number of measured fields in the portion.
    pub fields: u32,
}

/// Motion that a pipeline reports at the end of a portion; contains at least one of the two estimates.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionReport {
    /// Motion from the pipeline's best estimator; `None` if its fields do not determine a motion or
    /// contradict each other.
    pub best: Option<Motion>,
    /// Motion from the paper's formulas; `None` if the pipeline does not implement them or they give no
    /// motion.
    pub paper: Option<Motion>,
}

impl MotionReport {
    /// Creates a report of the two estimates; `None` if both are absent.
    pub fn from_estimates(best: Option<Motion>, paper: Option<Motion>) -> Option<Self> {
        (best.is_some() || paper.is_some()).then_some(Self { best, paper })
    }

    /// Iterates over the motions that the report contains.
    pub fn motions(&self) -> impl Iterator<Item = &Motion> {
        self.best.iter().chain(&self.paper)
    }
}
