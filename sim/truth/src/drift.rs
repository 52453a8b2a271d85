//! Slow errors about the three body axes, and noise drawn in each frame: functions of time and address,
//! without memory.

use std::f64::consts::PI;

use contract::bounds::require;
use contract::{Angle, Body, OutOfRange, Rotation};
use draws::{Effect, Seed, normal};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Frame number in the address of draws that apply to the whole run; no frame has this number.
const WHOLE_RUN: u64 = u64::MAX;

/// Slow error: for each body axis a sum of sinusoids whose amplitudes and phases are drawn from the seed.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DriftConfig {
    /// Root mean square over many seeds about the body's x, y, z axes, arcsec, 0 to 36000.
    #[serde(default)]
    #[schemars(inner(range(min = 0, max = 36000)))]
    pub rms_arcsec: [f64; 3],
    /// Periods of the sinusoids, s, each 1 to 1e7, at most 16; may be empty only if the rms is 0.
    #[serde(default)]
    #[schemars(length(max = 16), inner(range(min = 1, max = 1e7)))]
    pub periods_s: Vec<f64>,
}

impl DriftConfig {
    /// Checks that there is at least one period unless the rms is 0; `path` is the path of the periods in the
    /// scenario.
    ///
    /// # Errors
    /// [`OutOfRange`] if the periods are missing.
    pub(super) fn check(&self, path: &str) -> Result<(), OutOfRange> {
        let count = self.periods_s.len() as f64;
        require(path, count, "at least one period, unless the rms is 0", |n| self.is_still() || n > 0.0)
    }

    /// Returns true if the error is always zero.
    pub(super) fn is_still(&self) -> bool {
        self.rms_arcsec == [0.0; 3]
    }
}

/// Realisation of a [`DriftConfig`].
///
/// x(t) = Σ a_k cos ω_k t + b_k sin ω_k t, where a_k and b_k are normal with variance σ²/K: over many seeds,
/// the value at any time is normal with standard deviation σ, independent of the number K of sinusoids.
#[derive(Debug, Clone)]
pub(crate) struct Drift {
    terms: Vec<Term>,
}

#[derive(Debug, Clone)]
struct Term {
    rate_rad_s: f64,
    cosine_rad: Vector3<f64>,
    sine_rad: Vector3<f64>,
}

impl Drift {
    /// Draws amplitudes and phases. Each sinusoid and axis has a separate address.
    pub(crate) fn new(config: &DriftConfig, seed: Seed, effect: Effect) -> Self {
        let share = 1.0 / (config.periods_s.len().max(1) as f64).sqrt();
        let terms = (0_u64..).zip(&config.periods_s).map(|(k, period_s)| {
            let mut term = Term {
                rate_rad_s: 2.0 * PI / period_s,
                cosine_rad: Vector3::zeros(),
                sine_rad: Vector3::zeros(),
            };
            for (axis, rms) in config.rms_arcsec.into_iter().enumerate() {
                let sigma = Angle::from_arcsec(rms).radians() * share;
                let mut stream = seed.stream(WHOLE_RUN, effect, 3 * k + axis as u64);
                term.cosine_rad[axis] = sigma * normal(&mut stream);
                term.sine_rad[axis] = sigma * normal(&mut stream);
            }
            term
        });
        Self { terms: terms.collect() }
    }

    /// Error about the body axes, rad, at a time in seconds since the orbit's epoch.
    pub(crate) fn error_rad_at(&self, time_s: f64) -> Vector3<f64> {
        self.terms.iter().fold(Vector3::zeros(), |sum, term| {
            let (sin, cos) = libm::sincos(term.rate_rad_s * time_s);
            sum + term.cosine_rad * cos + term.sine_rad * sin
        })
    }
}

/// Returns a normal vector drawn anew in every frame; component k has index `first_place` + k in the address.
pub(crate) fn white(
    seed: Seed,
    frame: u64,
    effect: Effect,
    first_place: u64,
    sigma: Vector3<f64>,
) -> Vector3<f64> {
    let draw = |k: u64| normal(&mut seed.stream(frame, effect, first_place + k));
    sigma.component_mul(&Vector3::new(draw(0), draw(1), draw(2)))
}

/// Converts angles about three axes to radians.
pub(crate) fn radians_from_arcsec(arcsec: [f64; 3]) -> Vector3<f64> {
    Vector3::from(arcsec.map(|a| Angle::from_arcsec(a).radians()))
}

/// Returns the rotation from a body frame to this frame rotated by `error_rad`: the axes rotate by the
/// right-hand rule about the vector, so components rotate in the opposite sense.
pub(crate) fn turned_by(error_rad: Vector3<f64>) -> Rotation<Body, Body> {
    Rotation::from_rotation_vector(-error_rad)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config() -> DriftConfig {
        DriftConfig { rms_arcsec: [10.0, 20.0, 0.0], periods_s: vec![97.0, 613.0, 5939.0] }
    }

    #[test]
    fn over_many_seeds_a_drift_has_its_configured_rms() {
        let n = 4000;
        let mut sum = Vector3::zeros();
        for case in 0..n {
            let seed = Seed { seed: 5, case };
            let value = Drift::new(&config(), seed, Effect::AttitudeControl).error_rad_at(1234.5);
            sum += value.component_mul(&value);
        }
        let rms = (sum / n as f64).map(f64::sqrt);
        // χ² with n degrees of freedom: relative standard error of the rms 1/√(2n) = 1.1 %; the tolerance is
        // four of them.
        assert!((rms.x / radians_from_arcsec([10.0; 3]).x - 1.0).abs() < 0.045, "{rms}");
        assert!((rms.y / radians_from_arcsec([20.0; 3]).y - 1.0).abs() < 0.045, "{rms}");
        assert_eq!(rms.z, 0.0);
    }

    #[test]
    fn a_drift_of_one_period_repeats() {
        let config = DriftConfig { periods_s: vec![100.0], ..config() };
        let drift = Drift::new(&config, Seed { seed: 1, case: 0 }, Effect::AttitudeControl);
        // Rounding of a phase of about 2π·3: 1e-15 of an amplitude of 1e-4 rad.
        assert!((drift.error_rad_at(20.0) - drift.error_rad_at(320.0)).norm() < 1e-18);
        assert!((drift.error_rad_at(20.0) + drift.error_rad_at(370.0)).norm() < 1e-18);
    }

    #[test]
    fn one_axis_off_leaves_the_others_as_they_were() {
        let seed = Seed { seed: 1, case: 0 };
        let all = Drift::new(&config(), seed, Effect::AttitudeControl).error_rad_at(77.0);
        let less = DriftConfig { rms_arcsec: [0.0, 20.0, 0.0], ..config() };
        assert_eq!(Drift::new(&less, seed, Effect::AttitudeControl).error_rad_at(77.0).y, all.y);
    }

    #[test]
    fn a_drift_without_a_period_is_refused() {
        let none = DriftConfig { periods_s: vec![], ..config() };
        assert!(none.check("attitude.control.drift").is_err());
        assert!(DriftConfig::default().check("attitude.control.drift").is_ok());
        let zero = DriftConfig { periods_s: vec![0.0], ..config() };
        assert!(contract::bounds::check(&zero, "attitude.control.drift").is_err());
    }

    #[test]
    fn a_body_turned_about_z_sees_a_star_turn_back() {
        // After a rotation by +ε about z, the body's x axis points towards the former y: the former x axis
        // has a negative y component.
        let old_x = turned_by(Vector3::new(0.0, 0.0, 1e-3)).rotate(&Vector3::x());
        assert!((old_x.y + 1e-3).abs() < 1e-9);
    }
}
