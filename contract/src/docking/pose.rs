//! Position and attitude of the camera in the target frame.

use nalgebra::{Matrix6, Vector3};

/// Position and attitude of the camera relative to the target.
///
/// Target frame: origin at the disk's centre, y3 along the disk's normal away from the station, y2 "up" on
/// the target, y1 completing the right-handed frame. Camera frame: x1 along columns, x2 along rows (down), x3
/// the optical axis. A point x of the camera frame is y = d + A x in the target frame, with the exact A =
/// diag(1, −1, −1) · exp(\[φ\]×); to first order it is the matrix of the paper (3.1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Position d of the camera in the target frame, m.
    pub position_m: Vector3<f64>,
    /// Rotation vector φ of the camera relative to its attitude in ideal docking, along the camera axes, rad.
    /// Its components are active pitch, yaw and roll.
    pub phi_rad: Vector3<f64>,
}

/// A pose with its covariance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseEstimate {
    /// Estimated pose.
    pub pose: Pose,
    /// Covariance of (d1, d2, d3, φ1, φ2, φ3), m², m rad, rad²; symmetric, positive semi-definite.
    pub covariance: Matrix6<f64>,
}
