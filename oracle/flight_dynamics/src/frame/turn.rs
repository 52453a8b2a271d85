//! Turns of axes.

use nalgebra::Matrix3;

/// Arcseconds to radians.
pub(super) const ARCSEC: f64 = std::f64::consts::PI / 648_000.0;

/// Components in axes that are turned by `angle` about axis 0, 1 or 2 (R1, R2, R3 of the IERS Conventions).
pub(super) fn turn(axis: usize, angle: f64) -> Matrix3<f64> {
    let (sin, cos) = libm::sincos(angle);
    match axis {
        0 => Matrix3::new(1.0, 0.0, 0.0, 0.0, cos, sin, 0.0, -sin, cos),
        1 => Matrix3::new(cos, 0.0, -sin, 0.0, 1.0, 0.0, sin, 0.0, cos),
        _ => Matrix3::new(cos, sin, 0.0, -sin, cos, 0.0, 0.0, 0.0, 1.0),
    }
}
