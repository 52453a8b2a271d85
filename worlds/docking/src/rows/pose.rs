//! Poses in files: position in metres, angles in degrees.

use contract::docking::Pose;
use files::value;
use nalgebra::Vector3;

/// Columns of a pose.
pub(crate) const POSE: [&str; 6] = ["d1_m", "d2_m", "d3_m", "phi1_deg", "phi2_deg", "phi3_deg"];

/// A pose in cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseCells(pub Pose);

value!(
    PoseCells: [f64; 6],
    |cells| {
        let (d, phi) = (&cells.0.position_m, cells.0.phi_rad.map(f64::to_degrees));
        [d.x, d.y, d.z, phi.x, phi.y, phi.z]
    },
    |[d1, d2, d3, phi1, phi2, phi3]| {
        let phi_rad = Vector3::new(phi1, phi2, phi3).map(f64::to_radians);
        Ok(Self(Pose { position_m: Vector3::new(d1, d2, d3), phi_rad }))
    }
);

/// Returns an angle, rad, as it would be read back from a file: it is converted twice, which may change its
/// last bit.
pub(crate) fn angle_as_filed(angle: f64) -> f64 {
    angle.to_degrees().to_radians()
}

/// Returns a pose as it would be read back from a file.
pub(crate) fn as_filed(pose: &Pose) -> Pose {
    Pose { phi_rad: pose.phi_rad.map(angle_as_filed), ..*pose }
}
