//! What of the truth about a field the score uses.

use contract::docking::Pose;
use nalgebra::Vector3;

/// The truth about one field, at its own moment.
#[derive(Debug, Clone, PartialEq)]
pub struct TrueField {
    /// Number of the field.
    pub field: u64,
    /// Its moment, s since the beginning of the sequence.
    pub time_s: f64,
    /// The camera that took it, as in [`contract::docking::DockingSetup::cameras`].
    pub camera: usize,
    /// Pose of the camera.
    pub pose: Pose,
    /// Velocity of the camera in the target frame, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// dφ/dt, rad/s.
    pub phi_rate_rad_s: Vector3<f64>,
    /// Fraction of the image's lines that were lost on the way, 0 to 1.
    pub lost_lines: f64,
    /// Fraction of the marks' area that neither the Sun nor the lamp lights, 0 to 1.
    pub marks_in_shadow: f64,
}
