//! Motion of the camera with respect to the target, at a moment.

use nalgebra::{Matrix6, SMatrix, Vector3};

use crate::docking::Pose;

/// The linear motion of a portion of fields, at the portion's last moment (docking paper, 3.2).
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// The moment, s since the beginning of the sequence.
    pub time_s: f64,
    /// Pose at that moment.
    pub pose: Pose,
    /// Velocity of the camera in the target frame, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// dφ/dt, rad/s.
    pub phi_rate_rad_s: Vector3<f64>,
    /// Covariance of (d1, d2, d3, d1', d2', d3') at that moment: m², m²/s, m²/s².
    pub position_covariance: Matrix6<f64>,
    /// Covariance of (φ1, φ2, φ3, φ1', φ2', φ3') at that moment: rad², rad²/s, rad²/s².
    pub attitude_covariance: Matrix6<f64>,
    /// Covariance of (d1, d2, d3) with (φ1, φ2, φ3), m rad; zero where the method estimates them apart.
    pub cross_covariance: SMatrix<f64, 3, 3>,
    /// Fields of the portion that were measured.
    pub fields: u32,
}

/// What a pipeline says at the end of a portion: at least one of the two, or there is no report.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionReport {
    /// By the pipeline's own best estimator; `None` where its fields do not determine a motion, or contradict each other.
    pub best: Option<Motion>,
    /// By the paper's formulas, where the pipeline has them and they give one.
    pub paper: Option<Motion>,
}

impl MotionReport {
    /// The report of these two; `None` when neither gave a motion.
    pub fn from_estimates(best: Option<Motion>, paper: Option<Motion>) -> Option<Self> {
        (best.is_some() || paper.is_some()).then_some(Self { best, paper })
    }

    /// Both motions, as far as there are any.
    pub fn motions(&self) -> impl Iterator<Item = &Motion> {
        self.best.iter().chain(&self.paper)
    }
}
