//! The Earth as an occulting disk. Its contribution to stray light is in `super::background`.

use contract::{Direction, Icrs};
use nalgebra::Vector3;
use truth::shadow::EARTH_RADIUS_KM;

use super::aberration::ABERRATION_MARGIN_RAD;

/// The Earth's disk: a sphere of the equatorial radius, without atmosphere. The limb of the ellipsoid is up
/// to 21 km nearer to the centre: 0.3° from a low orbit.
pub struct EarthDisk {
    nadir: Vector3<f64>,
    cos_radius: f64,
    /// Cosine of the sum of the disk's radius and [`ABERRATION_MARGIN_RAD`].
    cos_near: f64,
}

impl EarthDisk {
    /// Returns the disk as seen from `position_km` (relative to the Earth's centre, ICRS axes).
    pub fn from_observer(position_km: &Vector3<f64>) -> Self {
        let sine = (EARTH_RADIUS_KM / position_km.norm()).min(1.0);
        Self {
            nadir: -position_km.normalize(),
            cos_radius: (1.0 - sine * sine).sqrt(),
            cos_near: libm::cos(libm::asin(sine) + ABERRATION_MARGIN_RAD),
        }
    }

    /// Returns true if the Earth may hide a distant source with this astrometric direction. This test is much
    /// faster than the computation of the apparent direction.
    pub fn is_near(&self, astrometric: &Direction<Icrs>) -> bool {
        self.nadir.dot(astrometric.vector()) > self.cos_near
    }

    /// Returns true if the Earth hides a distant source that an ideal camera sees in the direction
    /// `apparent`. Neglects the aberration of the Earth's direction, which is due only to the motion about
    /// the Earth (5″).
    pub fn hides(&self, apparent: &Direction<Icrs>) -> bool {
        self.nadir.dot(apparent.vector()) > self.cos_radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_reaches_to_the_horizon_and_no_farther() {
        // From an altitude of one Earth radius the disk has a radius of 30°.
        let disk = EarthDisk::from_observer(&Vector3::new(0.0, 2.0 * EARTH_RADIUS_KM, 0.0));
        for (off_nadir_deg, hidden) in [(0.0, true), (29.999, true), (30.001, false), (180.0, false)] {
            let (sin, cos) = libm::sincos(f64::to_radians(off_nadir_deg));
            let direction = Direction::from_vector(Vector3::new(sin, -cos, 0.0)).unwrap();
            assert_eq!(disk.hides(&direction), hidden, "{off_nadir_deg}° off the nadir");
        }
    }
}
