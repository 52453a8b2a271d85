//! Stray light: light of bodies outside the field that the optics scatter onto the detector.

use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use truth::shadow::EARTH_RADIUS_KM;

/// Scattering of light from outside the field by baffle and optics: the point source transmittance
/// (irradiance of the detector over that of the aperture facing the source) as a power law of the angle
/// between the source and the direction of the pixel, with a bend at the exclusion angle of the baffle.
/// Within 1° of the source it has its value at 1°.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StrayLightConfig {
    /// Angle from which on the baffle blocks the source's light from the first lens, degrees, 1 to 180.
    #[schemars(range(min = 1, max = 180))]
    pub exclusion_deg: f64,
    /// Point source transmittance at the exclusion angle, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub transmittance: f64,
    /// Exponent of the decrease of the transmittance beyond the exclusion angle, 0 to 20.
    #[schemars(range(min = 0, max = 20))]
    pub power: f64,
    /// Exponent of the increase of the transmittance inside the exclusion angle, 0 to 20.
    #[schemars(range(min = 0, max = 20))]
    pub power_inside: f64,
}

impl StrayLightConfig {
    /// Angle below which the transmittance is constant, rad: 1°.
    const NEAREST_RAD: f64 = std::f64::consts::PI / 180.0;

    /// Point source transmittance for light from the unit vector `source` in the direction `pixel`; at most
    /// 1.
    pub(super) fn transmittance(&self, pixel: &Vector3<f64>, source: &Vector3<f64>) -> f64 {
        self.transmittance_at_angle(libm::atan2(pixel.cross(source).norm(), pixel.dot(source)))
    }

    /// Point source transmittance at an angle, rad, between the light and the direction of the pixel; at most
    /// 1.
    pub(super) fn transmittance_at_angle(&self, angle: f64) -> f64 {
        let ratio = self.exclusion_deg.to_radians() / angle.max(Self::NEAREST_RAD);
        let power = if ratio < 1.0 { self.power } else { self.power_inside };
        (self.transmittance * libm::pow(ratio, power)).min(1.0)
    }
}

/// Bundle of light that reaches the aperture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ray {
    /// Unit vector towards the source of the light, ICRS axes.
    pub(super) direction: Vector3<f64>,
    /// Irradiance of a surface facing the source, in units of that of the Sun at 1 au.
    pub(super) suns: f64,
}

/// Number of rings, and of patches in a ring, into which the Earth's disk is divided, all of equal solid
/// angle.
const RINGS: usize = 10;
const SECTORS: usize = 20;

/// Appends to `rays` the lit part of the Earth's disk as seen from `position_km` (from the Earth's centre,
/// ICRS axes): a Lambert sphere of albedo `albedo` in sunlight from `sun` (unit vector) of `suns`. Appends
/// nothing from inside the Earth.
pub(super) fn earth_rays(
    position_km: &Vector3<f64>,
    sun: &Vector3<f64>,
    suns: f64,
    albedo: f64,
    rays: &mut Vec<Ray>,
) {
    let distance = position_km.norm();
    if distance <= EARTH_RADIUS_KM {
        return;
    }
    let nadir = -position_km / distance;
    // Two transverse directions: the first is derived from a coordinate axis well away from the nadir.
    let axis = if nadir.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
    let across = nadir.cross(&axis).normalize();
    let other = nadir.cross(&across);
    let sine = EARTH_RADIUS_KM / distance;
    // 1 − cos of the disk's radius, without loss of digits for a small disk.
    let cap = sine * sine / (1.0 + (1.0 - sine * sine).sqrt());
    let solid_angle = 2.0 * std::f64::consts::PI * cap / (RINGS * SECTORS) as f64;
    for ring in 0..RINGS {
        let cos = 1.0 - cap * (ring as f64 + 0.5) / RINGS as f64;
        let sin = (1.0 - cos * cos).sqrt();
        let chord = (EARTH_RADIUS_KM * EARTH_RADIUS_KM - distance * distance * sin * sin).max(0.0).sqrt();
        let range = distance * cos - chord;
        for sector in 0..SECTORS {
            let turn = 2.0 * std::f64::consts::PI * (sector as f64 + 0.5) / SECTORS as f64;
            let (sin_turn, cos_turn) = libm::sincos(turn);
            let direction = nadir * cos + (across * cos_turn + other * sin_turn) * sin;
            let normal = (position_km + direction * range) / EARTH_RADIUS_KM;
            let incidence = normal.dot(sun);
            if incidence > 0.0 {
                let radiance_suns = suns * albedo * incidence / std::f64::consts::PI;
                rays.push(Ray { direction, suns: radiance_suns * solid_angle });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: StrayLightConfig =
        StrayLightConfig { exclusion_deg: 30.0, transmittance: 1e-6, power: 3.0, power_inside: 5.0 };

    fn at(degrees: f64) -> f64 {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        LAW.transmittance(&Vector3::z(), &Vector3::new(sin, 0.0, cos))
    }

    #[test]
    fn the_transmittance_bends_at_the_exclusion_angle_and_ends_at_one() {
        assert!((at(30.0) - 1e-6).abs() < 1e-18);
        assert!((at(60.0) / 1e-6 - 0.125).abs() < 1e-9);
        assert!((at(15.0) / 1e-6 - 32.0).abs() < 1e-9);
        assert_eq!(at(0.5), at(0.0));
        let bright = StrayLightConfig { transmittance: 0.5, ..LAW };
        assert_eq!(bright.transmittance(&Vector3::z(), &Vector3::z()), 1.0);
    }

    fn irradiance(distance_radii: f64, sun: Vector3<f64>) -> f64 {
        let mut rays = Vec::new();
        let position = Vector3::new(1.0, 2.0, -2.0).normalize() * (distance_radii * EARTH_RADIUS_KM);
        earth_rays(&position, &sun, 1.0, 0.3, &mut rays);
        rays.iter().map(|ray| ray.suns).sum()
    }

    /// From a large distance: 2/3 A Φ(α) (R/d)², Φ(0) = 1 and Φ(90°) = 1/π (Russell 1916).
    #[test]
    fn the_earth_from_afar_is_a_lambert_sphere() {
        let full = Vector3::new(1.0, 2.0, -2.0).normalize();
        let half = Vector3::new(2.0, -1.0, 0.0).normalize();
        let sphere = 2.0 / 3.0 * 0.3 * 1e-6;
        // Patches of 1/200 of the disk: an error of 1 % at full phase, and of 3 % where the terminator
        // crosses patches.
        assert!((irradiance(1000.0, full) / sphere - 1.0).abs() < 0.01);
        assert!((irradiance(1000.0, half) / sphere * std::f64::consts::PI - 1.0).abs() < 0.03);
        assert_eq!(irradiance(1000.0, -full), 0.0);
    }

    /// Just above the subsolar point the disk fills half of the sky, 2π sr, with ground lit from above, of
    /// radiance A S/π. Without a cosine this gives 2π A/π = 2 A.
    #[test]
    fn a_low_orbit_sees_half_a_sky_of_lit_ground() {
        let zenith = Vector3::new(1.0, 2.0, -2.0).normalize();
        assert!((irradiance(1.000_01, zenith) / 0.6 - 1.0).abs() < 0.01);
        assert_eq!(irradiance(0.9, zenith), 0.0);
    }
}
