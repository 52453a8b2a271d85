//! The Earth's shadow: the visible fraction of the Sun.
//!
//! Sun and Earth are spheres, and light travels in straight lines. Neglected: the oblateness of the Earth
//! (its polar radius is 21 km smaller: the instant of a crossing shifts by up to several seconds in a low
//! orbit), the atmosphere (refraction and absorption lengthen and redden the twilight by about ten seconds),
//! the darkening of the Sun's limb.

use nalgebra::Vector3;

use super::Shadow;

/// Radius of the Earth as a body, km: equatorial, IERS Conventions (2010).
pub const EARTH_RADIUS_KM: f64 = 6_378.136_6;
/// Radius of the Sun, km: nominal, IAU 2015 Resolution B3.
pub const SUN_RADIUS_KM: f64 = 695_700.0;

/// Visible fraction of the Sun's disk, in [0, 1].
///
/// `position_km` is the position of the spacecraft and `sun_km` that of the Sun, relative to the Earth's
/// centre, in any common frame. The two disks are circles with the angular radii of the bodies, and their
/// overlap is computed as in the plane (Montenbruck & Gill, Satellite Orbits, 2000, Sec. 3.4.2, Eq.
/// 3.85–3.87). From a low orbit the Earth's disk is large, and its limb is more curved in the plane than on
/// the sphere: the error of the fraction is less than 0.001. The fraction is 0 at a position inside the
/// Earth.
pub fn sunlit_fraction(position_km: &Vector3<f64>, sun_km: &Vector3<f64>) -> f64 {
    visible_fraction(position_km, sun_km, SUN_RADIUS_KM)
}

/// Fraction of the disk of a body of radius `radius_km` at `body_km` that the Earth does not hide; otherwise
/// like [`sunlit_fraction`].
pub fn visible_fraction(position_km: &Vector3<f64>, body_km: &Vector3<f64>, radius_km: f64) -> f64 {
    let to_body = body_km - position_km;
    let body = libm::asin((radius_km / to_body.norm()).min(1.0));
    let distance = position_km.norm();
    if distance <= EARTH_RADIUS_KM {
        return 0.0;
    }
    let earth = libm::asin(EARTH_RADIUS_KM / distance);
    let separation = libm::atan2(position_km.cross(&to_body).norm(), -position_km.dot(&to_body));
    1.0 - covered_fraction(body, earth, separation)
}

/// Returns the class of a sunlit fraction.
pub fn classify(sunlit_fraction: f64) -> Shadow {
    match sunlit_fraction {
        f if f >= 1.0 => Shadow::Sunlit,
        f if f > 0.0 => Shadow::Penumbra,
        _ => Shadow::Umbra,
    }
}

/// Fraction of a disk of radius `sun` that a disk of radius `earth` covers, with the distance `separation`
/// between the centres.
fn covered_fraction(sun: f64, earth: f64, separation: f64) -> f64 {
    if separation >= sun + earth {
        return 0.0;
    }
    if separation <= earth - sun {
        return 1.0;
    }
    if separation <= sun - earth {
        // Beyond 1.4 million km the Earth does not cover the whole Sun.
        return (earth / sun) * (earth / sun);
    }
    // Common chord of the two circles: x from the Sun's centre towards the Earth's, half-length y.
    let x = (separation * separation + sun * sun - earth * earth) / (2.0 * separation);
    let y = (sun * sun - x * x).max(0.0).sqrt();
    let lens =
        sun * sun * libm::atan2(y, x) + earth * earth * libm::atan2(y, separation - x) - separation * y;
    (lens / (std::f64::consts::PI * sun * sun)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constants::AU_KM;

    fn sun() -> Vector3<f64> {
        Vector3::x() * AU_KM
    }

    fn fraction(x: f64, y: f64) -> f64 {
        sunlit_fraction(&Vector3::new(x, y, 0.0), &sun())
    }

    #[test]
    fn in_front_of_the_earth_is_sunlight_and_behind_it_umbra() {
        assert_eq!(fraction(7_100.0, 0.0), 1.0);
        assert_eq!(fraction(0.0, 7_100.0), 1.0);
        assert_eq!(fraction(-7_100.0, 0.0), 0.0);
        assert_eq!(fraction(-42_164.0, 0.0), 0.0);
        assert_eq!(fraction(0.0, 0.0), 0.0);
    }

    #[test]
    fn the_umbra_ends_where_the_cone_does() {
        // Length of the cone: R⊕ d / (R☉ − R⊕) = 1.384 million km for apparent radii asin(R/d).
        let tip = EARTH_RADIUS_KM * AU_KM / (SUN_RADIUS_KM - EARTH_RADIUS_KM);
        assert_eq!(fraction(-0.999 * tip, 0.0), 0.0);
        let beyond = fraction(-1.5 * tip, 0.0);
        let seen = EARTH_RADIUS_KM / (1.5 * tip) / (SUN_RADIUS_KM / (AU_KM + 1.5 * tip));
        // 1e-4: difference between sine and angle at 0.25°.
        assert!((beyond - (1.0 - seen * seen)).abs() < 1e-4, "{beyond}");
    }

    #[test]
    fn half_the_sun_is_visible_when_its_centre_is_on_the_limb() {
        for radius in [6_700.0, 7_100.0, 42_164.0] {
            // The line to the Sun's centre is tangent to the sphere.
            let x = -f64::sqrt(radius * radius - EARTH_RADIUS_KM * EARTH_RADIUS_KM);
            let seen = fraction(x, EARTH_RADIUS_KM);
            // The Sun is at a finite distance: its centre is 6378 km / 1 au from the limb, 0.6 % of its disk.
            // The limb is curved: 0.3 % from the highest orbit.
            assert!((seen - 0.5).abs() < 0.01, "{seen} at {radius} km");
        }
    }

    #[test]
    fn the_fraction_grows_without_a_jump_through_the_penumbra() {
        let mut last = 0.0;
        let mut partial = 0;
        // Steps of 20 m over the limb at 7100 km: the penumbra is 2 × 0.266° × 3120 km = 29 km wide.
        for i in 0..4_000 {
            let seen = fraction(-3_119.0, 6_338.0 + 0.02 * f64::from(i));
            assert!((0.0..=1.0).contains(&seen));
            // The steepest slope is 2/π per radius: 20 m / 14.5 km × 2 / π = 0.0009.
            assert!(seen >= last && seen - last < 1.5e-3, "{last} to {seen} at step {i}");
            partial += i32::from(seen > 0.0 && seen < 1.0);
            last = seen;
        }
        assert_eq!(last, 1.0);
        assert!((1_350..1_550).contains(&partial), "a penumbra of {partial} steps of 20 m");
    }

    #[test]
    fn classes_follow_the_fraction() {
        assert_eq!(classify(1.0), Shadow::Sunlit);
        assert_eq!(classify(1e-12), Shadow::Penumbra);
        assert_eq!(classify(1.0 - 1e-12), Shadow::Penumbra);
        assert_eq!(classify(0.0), Shadow::Umbra);
    }
}
