//! The Earth, as far as it stands before what is behind it. Its light in the camera is stray light ([`super::background`]).

use contract::{Direction, Icrs};
use nalgebra::Vector3;

use super::aberration::ABERRATION_MARGIN_RAD;
use crate::truth::shadow::EARTH_RADIUS_KM;

/// The Earth's disk: a sphere of its equatorial radius, without air. The limb of the ellipsoid is up to 21 km nearer to the
/// centre: 0.3° from a low orbit.
pub(crate) struct EarthDisk {
    nadir: Vector3<f64>,
    cos_radius: f64,
    /// Of its radius and [`ABERRATION_MARGIN_RAD`].
    cos_near: f64,
}

impl EarthDisk {
    /// The disk as it is seen from `position_km` (from its centre, ICRS axes).
    pub(crate) fn from_observer(position_km: &Vector3<f64>) -> Self {
        let sine = (EARTH_RADIUS_KM / position_km.norm()).min(1.0);
        Self {
            nadir: -position_km.normalize(),
            cos_radius: (1.0 - sine * sine).sqrt(),
            cos_near: libm::cos(libm::asin(sine) + ABERRATION_MARGIN_RAD),
        }
    }

    /// Whether it may stand before a far source with this astrometric direction: far quicker to tell than where it appears.
    pub(crate) fn is_near(&self, astrometric: &Direction<Icrs>) -> bool {
        self.nadir.dot(astrometric.vector()) > self.cos_near
    }

    /// Whether it stands before a far source that an ideal camera sees in the direction `apparent`. The Earth's own place is
    /// aberrated by the motion about it alone (5″), which is left out.
    pub(crate) fn hides(&self, apparent: &Direction<Icrs>) -> bool {
        self.nadir.dot(apparent.vector()) > self.cos_radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_reaches_to_the_horizon_and_no_farther() {
        // From one radius above the surface the disk has a radius of 30°.
        let disk = EarthDisk::from_observer(&Vector3::new(0.0, 2.0 * EARTH_RADIUS_KM, 0.0));
        for (off_nadir_deg, hidden) in [(0.0, true), (29.999, true), (30.001, false), (180.0, false)] {
            let (sin, cos) = libm::sincos(f64::to_radians(off_nadir_deg));
            let direction = Direction::from_vector(Vector3::new(sin, -cos, 0.0)).unwrap();
            assert_eq!(disk.hides(&direction), hidden, "{off_nadir_deg}° off the nadir");
        }
    }
}
