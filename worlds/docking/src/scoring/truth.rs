//! Part of a field's ground truth that the score uses.

use contract::docking::Pose;
use nalgebra::Vector3;
use sim::docking::FieldTruth;

/// Portion of the target inside the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TargetVisibility {
    /// Plate, all marks and cross.
    Full,
    /// The whole cross and at least half of the marks.
    Partial,
    /// Less than the whole cross and half of the marks.
    Outside,
}

/// Ground truth of one field, at the time of this field.
#[derive(Debug, Clone, PartialEq)]
pub struct TrueField {
    /// Number of the field.
    pub field: u64,
    /// Time of the field, s since the beginning of the sequence.
    pub time_s: f64,
    /// Camera that took the field: index into [`contract::docking::DockingSetup::cameras`].
    pub camera: usize,
    /// Pose of the camera.
    pub pose: Pose,
    /// Velocity of the camera in the target frame, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// Time derivative of φ, rad/s.
    pub phi_rate_rad_s: Vector3<f64>,
    /// Portion of the target inside the image.
    pub visibility: TargetVisibility,
    /// Fraction of the image's lines that were lost in transmission, 0 to 1.
    pub lost_lines: f64,
    /// Fraction of the marks that neither the Sun nor the lamp illuminates, 0 to 1.
    pub marks_in_shadow: f64,
}

impl TrueField {
    /// Returns the pose `since_s` later (earlier if negative), extrapolated with the rates of this field.
    pub(super) fn moved(&self, since_s: f64) -> Pose {
        Pose {
            position_m: self.pose.position_m + self.velocity_m_s * since_s,
            phi_rad: self.pose.phi_rad + self.phi_rate_rad_s * since_s,
        }
    }

    /// Extracts the truth that the score needs from the complete truth, for a target with `marks` marks and a
    /// camera with `camera_rows` rows.
    pub fn new(truth: &FieldTruth, marks: usize, camera_rows: usize) -> Self {
        let share = |bits: u64| if marks == 0 { 0.0 } else { f64::from(bits.count_ones()) / marks as f64 };
        let rows = truth.lines.rows(camera_rows).max(1) as f64;
        Self {
            field: truth.field,
            time_s: truth.time_s,
            camera: truth.camera,
            pose: truth.pose,
            velocity_m_s: truth.velocity_m_s,
            phi_rate_rad_s: truth.phi_rate_rad_s,
            visibility: if truth.target_in_field {
                TargetVisibility::Full
            } else if truth.cross_in_field && share(truth.marks_in_field) >= 0.5 {
                TargetVisibility::Partial
            } else {
                TargetVisibility::Outside
            },
            lost_lines: f64::from(truth.video.lost_lines) / rows,
            marks_in_shadow: share(truth.marks_dark),
        }
    }
}
