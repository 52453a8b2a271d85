//! Geographic coordinates of a position.

use contract::Angle;
use hifitime::Epoch;
use nalgebra::Vector3;

use super::clock::jd_utc;

/// Earth rotation angle (IERS Conventions 2010, Eq. 5.15), radians from 0 to 2π. UTC is used for UT1; they
/// differ by less than 0.9 s, 0.004°.
fn earth_rotation_angle(time: Epoch) -> f64 {
    let days = jd_utc(time) - 2_451_545.0;
    let turns = 0.779_057_273_264_0 + 0.002_737_811_911_354_48 * days + (days - days.floor());
    2.0 * std::f64::consts::PI * (turns - turns.floor())
}

/// Geocentric latitude, −90° to 90°, and longitude, −180° to 180° east, below a position relative to the
/// Earth's centre in ICRS axes, km.
///
/// The pole of ICRS is used for the pole of date: precession moves it by 0.56° per century, at most 0.28°
/// from 1950 to 2050.
pub fn geographic(time: Epoch, position_km: &Vector3<f64>) -> (Angle, Angle) {
    let equatorial_km = (position_km.x * position_km.x + position_km.y * position_km.y).sqrt();
    let latitude = libm::atan2(position_km.z, equatorial_km);
    let (sin, cos) = libm::sincos(earth_rotation_angle(time));
    let (x, y) = (position_km.x * cos + position_km.y * sin, position_km.y * cos - position_km.x * sin);
    (Angle::from_radians(latitude), Angle::from_radians(libm::atan2(y, x)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::parse_utc;

    /// Test case of SOFA's iauEra00 (t_sofa_c.c): 0.4022837240028158102 rad at UT1 of JD 2454388.5.
    #[test]
    fn the_angle_is_that_of_sofa() {
        let angle = earth_rotation_angle(parse_utc("2007-10-15T00:00:00Z").unwrap());
        // A 64-bit Julian date has a resolution of 40 µs, 3e-9 rad.
        assert!((angle - 0.402_283_724_002_815_8).abs() < 1e-8, "{angle}");
    }

    #[test]
    fn a_point_on_the_ground_turns_east_with_the_earth() {
        let angle = 0.402_283_724_002_815_8;
        let time = parse_utc("2007-10-15T00:00:00Z").unwrap();
        let position = Vector3::new(7000.0 * libm::cos(angle), 7000.0 * libm::sin(angle), 7000.0);
        let (latitude, longitude) = geographic(time, &position);
        assert!((latitude.degrees() - 45.0).abs() < 1e-9 && longitude.degrees().abs() < 1e-6);
        // In one hour the Earth turns by 15.04° below the position.
        let later = geographic(parse_utc("2007-10-15T01:00:00Z").unwrap(), &position).1;
        assert!((later.degrees() + 15.041).abs() < 1e-3, "{later:?}");
    }
}
