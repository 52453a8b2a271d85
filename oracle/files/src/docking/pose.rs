//! Poses in files: position in metres, angles in degrees.

use contract::docking::Pose;
use nalgebra::Vector3;

use crate::table::field::value;

/// Columns of a pose.
pub(super) const POSE: [&str; 6] = ["d1_m", "d2_m", "d3_m", "phi1_deg", "phi2_deg", "phi3_deg"];

value!(
    Pose: [f64; 6],
    |pose| {
        let (d, phi) = (&pose.position_m, pose.phi_rad.map(f64::to_degrees));
        [d.x, d.y, d.z, phi.x, phi.y, phi.z]
    },
    |[d1, d2, d3, phi1, phi2, phi3]| {
        let phi_rad = Vector3::new(phi1, phi2, phi3).map(f64::to_radians);
        Ok(Self { position_m: Vector3::new(d1, d2, d3), phi_rad })
    }
);

/// Returns an angle, rad, as it would be read back from a file: it is converted twice, which may change its
/// last bit.
pub(super) fn angle_as_filed(angle: f64) -> f64 {
    angle.to_degrees().to_radians()
}

/// Returns a pose as it would be read back from a file.
pub(super) fn as_filed(pose: &Pose) -> Pose {
    Pose { phi_rad: pose.phi_rad.map(angle_as_filed), ..*pose }
}
