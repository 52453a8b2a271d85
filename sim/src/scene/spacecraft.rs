//! The target spacecraft as a source of light.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::SimError;
use crate::error::require;
use crate::optics::SUN_V_MAG_AT_1_AU;

/// Kilometres in an astronomical unit (IAU 2012 Resolution B2, exact).
const AU_KM: f64 = 149_597_870.7;

/// The target as the sensor sees it: a point of light whose brightness follows from the Sun.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum TargetConfig {
    /// A source of constant brightness, whatever the phase angle and the shadow: a beacon.
    Beacon {
        /// Visual magnitude at a distance of 1 km; it fades with the square of the distance.
        magnitude_at_1_km: f64,
    },
    /// A diffusely reflecting sphere in sunlight (Lambert's phase law).
    LambertSphere {
        /// Radius, m, positive.
        radius_m: f64,
        /// Diffuse reflectance (Lambert albedo) in V, 0 to 1.
        albedo: f64,
    },
}

impl TargetConfig {
    /// Checks every number.
    ///
    /// # Errors
    /// [`SimError::Parameter`] for the first one outside its range.
    pub fn check(&self) -> Result<(), SimError> {
        match *self {
            Self::Beacon { magnitude_at_1_km } => {
                require("target.magnitude_at_1_km", magnitude_at_1_km, "-30 to 30", |m| {
                    (-30.0..=30.0).contains(&m)
                })
            }
            Self::LambertSphere { radius_m, albedo } => {
                require("target.radius_m", radius_m, "greater than 0, at most 1000", |r| {
                    r > 0.0 && r <= 1000.0
                })?;
                require("target.albedo", albedo, "0 to 1", |a| (0.0..=1.0).contains(&a))
            }
        }
    }

    /// Visual magnitude seen from `range_km`, with the Sun at `sun_distance_km` from the target, the angle
    /// Sun–target–observer `phase_rad`, and `sunlit_fraction` of the Sun's disk shining on it. Infinite when no light
    /// comes from it.
    pub fn magnitude(
        &self,
        range_km: f64,
        sun_distance_km: f64,
        phase_rad: f64,
        sunlit_fraction: f64,
    ) -> f64 {
        match *self {
            Self::Beacon { magnitude_at_1_km } => magnitude_at_1_km + 5.0 * libm::log10(range_km),
            Self::LambertSphere { radius_m, albedo } => {
                let range_ratio = radius_m / (range_km * 1000.0);
                let sun_au = sun_distance_km / AU_KM;
                let flux_ratio = 2.0 / 3.0
                    * albedo
                    * lambert_phase(phase_rad)
                    * range_ratio
                    * range_ratio
                    * sunlit_fraction
                    / (sun_au * sun_au);
                SUN_V_MAG_AT_1_AU - 2.5 * libm::log10(flux_ratio)
            }
        }
    }
}

/// Phase law of a Lambert sphere, 1 at full phase, 0 at π: (sin α + (π − α) cos α)/π (Russell 1916, ApJ 43, 173).
fn lambert_phase(phase_rad: f64) -> f64 {
    let (sin, cos) = libm::sincos(phase_rad);
    ((sin + (std::f64::consts::PI - phase_rad) * cos) / std::f64::consts::PI).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPHERE: TargetConfig = TargetConfig::LambertSphere { radius_m: 1.0, albedo: 0.9 };

    #[test]
    fn the_phase_law_has_its_known_values() {
        assert_eq!(lambert_phase(0.0), 1.0);
        assert!((lambert_phase(std::f64::consts::FRAC_PI_2) - 1.0 / std::f64::consts::PI).abs() < 1e-15);
        assert!(lambert_phase(std::f64::consts::PI) < 1e-15);
    }

    /// All light that a Lambert sphere takes up and reflects: the integral of the phase law over all directions
    /// times the geometric albedo 2/3 must give the Bond albedo 1: 2 ∫ Φ sin α dα = 3/2.
    #[test]
    fn a_white_sphere_reflects_all_that_it_receives() {
        let n = 10_000;
        let step = std::f64::consts::PI / n as f64;
        let integral: f64 = (0..n)
            .map(|i| {
                let alpha = (i as f64 + 0.5) * step;
                lambert_phase(alpha) * libm::sin(alpha) * step
            })
            .sum();
        // Midpoint rule: error of order step² = 1e-7.
        assert!((2.0 * integral - 1.5).abs() < 1e-6, "{integral}");
    }

    #[test]
    fn ten_times_the_distance_is_five_magnitudes() {
        let near = SPHERE.magnitude(3.0, AU_KM, 1.0, 1.0);
        let far = SPHERE.magnitude(30.0, AU_KM, 1.0, 1.0);
        assert!((far - near - 5.0).abs() < 1e-12);
    }

    #[test]
    fn half_the_sun_is_three_quarters_of_a_magnitude() {
        let lit = SPHERE.magnitude(3.0, AU_KM, 1.0, 1.0);
        let half = SPHERE.magnitude(3.0, AU_KM, 1.0, 0.5);
        assert!((half - lit - 2.5 * libm::log10(2.0)).abs() < 1e-12);
    }

    #[test]
    fn in_umbra_no_light_comes() {
        assert_eq!(SPHERE.magnitude(3.0, AU_KM, 1.0, 0.0), f64::INFINITY);
    }

    #[test]
    fn a_beacon_fades_with_distance_and_knows_no_sun() {
        let beacon = TargetConfig::Beacon { magnitude_at_1_km: 2.0 };
        assert_eq!(beacon.magnitude(1.0, AU_KM, 0.0, 1.0), 2.0);
        assert_eq!(beacon.magnitude(10.0, AU_KM, 3.0, 0.0), 7.0);
    }

    /// A white sphere of 1 m at 1 km, full phase, at 1 au: −26.76 − 2.5 log10(2/3 · 1e-6) = −11.32.
    #[test]
    fn a_sphere_has_the_magnitude_of_its_closed_form() {
        let white = TargetConfig::LambertSphere { radius_m: 1.0, albedo: 1.0 };
        assert!((white.magnitude(1.0, AU_KM, 0.0, 1.0) + 11.3198).abs() < 1e-4);
        // Twice as far from the Sun it is a quarter as bright.
        let far = white.magnitude(1.0, 2.0 * AU_KM, 0.0, 1.0) - white.magnitude(1.0, AU_KM, 0.0, 1.0);
        assert!((far - 5.0 * libm::log10(2.0)).abs() < 1e-12);
    }

    #[test]
    fn a_black_sphere_and_a_new_one_give_no_light() {
        let black = TargetConfig::LambertSphere { radius_m: 1.0, albedo: 0.0 };
        assert_eq!(black.magnitude(1.0, AU_KM, 0.0, 1.0), f64::INFINITY);
        // Φ(π) is 4e-17, not 0: fainter than anything all the same.
        assert!(SPHERE.magnitude(1.0, AU_KM, std::f64::consts::PI, 1.0) > 25.0);
    }

    #[test]
    fn numbers_out_of_range_are_named() {
        let message = |config: TargetConfig| config.check().unwrap_err().to_string();
        assert!(
            message(TargetConfig::LambertSphere { radius_m: 0.0, albedo: 0.5 })
                .contains("target.radius_m is 0")
        );
        assert!(
            message(TargetConfig::LambertSphere { radius_m: 1.0, albedo: 1.1 }).contains("target.albedo")
        );
        assert!(message(TargetConfig::Beacon { magnitude_at_1_km: f64::NAN }).contains("magnitude_at_1_km"));
    }
}
