//! Slow errors about the three body axes, and fast ones frame by frame: functions of time and address, with no memory.

use std::f64::consts::PI;

use contract::bounds::require;
use contract::{Angle, Body, OutOfRange, Rotation};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::randomness::{Effect, Seed, normal};

/// The place of a frame's number in the address of draws that belong to the whole run; no frame has it.
const WHOLE_RUN: u64 = u64::MAX;

/// A slow error: about each body axis a sum of sinusoids whose amplitudes and phases are drawn from the seed.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DriftConfig {
    /// Root mean square about the body's x, y, z axes over many seeds, arcsec, 0 to 36000.
    #[serde(default)]
    #[schemars(inner(range(min = 0, max = 36000)))]
    pub rms_arcsec: [f64; 3],
    /// Periods of the sinusoids, s, each 1 to 1e7, at most 16; none only where the rms is 0.
    #[serde(default)]
    #[schemars(length(max = 16), inner(range(min = 1, max = 1e7)))]
    pub periods_s: Vec<f64>,
}

impl DriftConfig {
    /// Checks every number; `field` is where this stands in the scenario.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first one outside its range.
    pub(super) fn check(&self, path: &str) -> Result<(), OutOfRange> {
        let count = self.periods_s.len() as f64;
        require(path, count, "at least one of periods_s where the rms is not 0", |n| {
            self.is_still() || n > 0.0
        })
    }

    /// Whether it never moves.
    pub(super) fn is_still(&self) -> bool {
        self.rms_arcsec == [0.0; 3]
    }
}

/// A realisation of a [`DriftConfig`].
///
/// x(t) = Σ a_k cos ω_k t + b_k sin ω_k t with a_k and b_k normal of variance σ²/K: at any time the value over many
/// seeds is normal with standard deviation σ, whatever the number K of sinusoids.
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
    /// Draws amplitudes and phases. Each sinusoid and axis has an address of its own.
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

    /// The error about the body axes, rad, at a time in seconds since the orbit's epoch.
    pub(crate) fn error_rad_at(&self, time_s: f64) -> Vector3<f64> {
        self.terms.iter().fold(Vector3::zeros(), |sum, term| {
            let (sin, cos) = libm::sincos(term.rate_rad_s * time_s);
            sum + term.cosine_rad * cos + term.sine_rad * sin
        })
    }
}

/// A normal vector that is new in every frame; component k is at place `first_place` + k of the address.
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

/// Angles about three axes, in radians.
pub(crate) fn radians_from_arcsec(arcsec: [f64; 3]) -> Vector3<f64> {
    Vector3::from(arcsec.map(|a| Angle::from_arcsec(a).radians()))
}

/// The rotation from a body frame to the same frame turned by `error_rad`: the axes turn by the right-hand rule about
/// the vector, so components turn the other way.
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
    fn over_many_seeds_a_drift_has_the_rms_asked_for() {
        let n = 4000;
        let mut sum = Vector3::zeros();
        for case in 0..n {
            let seed = Seed { seed: 5, case };
            let value = Drift::new(&config(), seed, Effect::AttitudeControl).error_rad_at(1234.5);
            sum += value.component_mul(&value);
        }
        let rms = (sum / n as f64).map(f64::sqrt);
        // χ² with n degrees: relative standard error of the rms 1/√(2n) = 1.1 %; four of them.
        assert!((rms.x / radians_from_arcsec([10.0; 3]).x - 1.0).abs() < 0.045, "{rms}");
        assert!((rms.y / radians_from_arcsec([20.0; 3]).y - 1.0).abs() < 0.045, "{rms}");
        assert_eq!(rms.z, 0.0);
    }

    #[test]
    fn a_drift_of_one_period_comes_back() {
        let config = DriftConfig { periods_s: vec![100.0], ..config() };
        let drift = Drift::new(&config, Seed { seed: 1, case: 0 }, Effect::AttitudeControl);
        // A phase of some 2π·3 turns, rounded: 1e-15 of an amplitude of 1e-4 rad.
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
        // Turned by +ε about z, the body's x axis points to where y was: the old x axis has a negative y component.
        let old_x = turned_by(Vector3::new(0.0, 0.0, 1e-3)).rotate(&Vector3::x());
        assert!((old_x.y + 1e-3).abs() < 1e-9);
    }
}
