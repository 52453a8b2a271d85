//! Axes of the ecliptic and equinox of J2000.0, and their conversion to ICRS.

use nalgebra::Vector3;

/// Obliquity of the ecliptic at J2000.0, degrees (IAU 1976: 84381.448″).
const OBLIQUITY_DEG: f64 = 84_381.448 / 3_600.0;

/// Converts a vector from ecliptic axes to ICRS axes.
pub fn to_icrs(v: Vector3<f64>) -> Vector3<f64> {
    let (sin, cos) = libm::sincos(OBLIQUITY_DEG.to_radians());
    Vector3::new(v.x, cos * v.y - sin * v.z, sin * v.y + cos * v.z)
}

/// Converts a vector from ICRS axes to ecliptic axes.
pub fn from_icrs(v: Vector3<f64>) -> Vector3<f64> {
    let (sin, cos) = libm::sincos(OBLIQUITY_DEG.to_radians());
    Vector3::new(v.x, cos * v.y + sin * v.z, cos * v.z - sin * v.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back_is_where_it_was() {
        let v = Vector3::new(0.3, -0.8, 0.5);
        assert!((to_icrs(from_icrs(v)) - v).norm() < 1e-15);
    }

    /// Right ascension 18 h, declination 66.561° (J2000).
    #[test]
    fn the_pole_of_the_ecliptic_is_in_draco() {
        let pole = to_icrs(Vector3::z());
        assert_eq!(pole.x, 0.0);
        assert!(pole.y < 0.0);
        assert!((libm::asin(pole.z).to_degrees() - 66.560_709).abs() < 1e-6);
    }
}
