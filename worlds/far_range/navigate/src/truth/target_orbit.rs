//! Orbit of the target that a navigator estimated.

use std::path::Path;

use contract::navigation::Covariance6;
use far_range::FarRangeScenario;
use files::{Failure, FileError, FileLocation};
use hifitime::Epoch;
use nalgebra::{Matrix6, Vector3, Vector6};
use scenario::run_file::RunFile;
use sim::truth::State;

use crate::knowledge::orbital_period_s;
use crate::result::{NavigationResult, TABLE_FILE};
use crate::row::{NavigationRow, read_navigation_lines};
use crate::truth::{Truth, rotation_rate};

/// Largest interval between two estimates, revolutions of the target: polynomials between estimates further
/// apart do not follow the orbit.
const MAX_INTERVAL_REVOLUTIONS: f64 = 1.0 / 6.0;

/// Estimated state of the target at an instant, ICRS axes: time, state, and the covariance of position, km,
/// and velocity, km/s; `None` if the table has no correlations.
pub type TargetState = (Epoch, State, Option<Matrix6<f64>>);

/// Orbit of the target: the chaser's orbit and an estimated relative orbit.
#[derive(Debug, Clone, PartialEq)]
pub struct TargetOrbit {
    /// Name of the navigator.
    pub navigator: String,
    /// Estimates in order of time. At a requested time without an estimate, an arc ends.
    pub arcs: Vec<Vec<TargetState>>,
}

impl TargetOrbit {
    /// Reads the estimates in `directory`, which are of `run`. The orbit of the chaser is the true one:
    /// states and covariances have the errors of the relative orbit alone.
    ///
    /// # Errors
    /// A [`Failure`] that names file, line and field of the first invalid value; for estimates of another
    /// run, estimates out of order or more than a sixth of a revolution apart.
    pub fn read(directory: &Path, run: &RunFile<FarRangeScenario>) -> Result<Self, Failure> {
        let result = NavigationResult::read_figures(directory)?;
        result.check_run(directory, &run.hash)?;
        let truth = Truth::new(&run.scenario)?;
        let path = directory.join(TABLE_FILE);
        let mut arcs: Vec<Vec<TargetState>> = Vec::new();
        let mut is_continued = false;
        for (line, row) in read_navigation_lines(&path)? {
            let refused = |field: &str, value: String, expected: &str| {
                Err(Failure::from(FileError::value(&path, FileLocation::Line(line), field, value, expected)))
            };
            let (Some(time), Some(error)) = (row.time(), row.state_error()) else {
                is_continued = false;
                continue;
            };
            if !truth.trajectory().coverage_s().contains(&truth.trajectory().seconds(time)) {
                return refused("time_utc", row.time_utc, "a time that the run's trajectory covers");
            }
            let covariance = match row.state_covariance().map(Covariance6::from_matrix) {
                None => None,
                Some(Ok(covariance)) => Some(*covariance.matrix()),
                Some(Err(error)) => {
                    return refused("sigma_r_m to rho_v_n_v_t", error.value, &error.expected);
                }
            };
            let chaser = truth.trajectory().states_at(time).chaser;
            let Some(target) = target_state(&chaser, &(truth.state(time) + error), covariance.as_ref())
            else {
                let range_m = NavigationRow::true_range_m(&row) + row.range_error_m().unwrap_or(0.0);
                return refused(
                    "error_r_m to error_n_m",
                    format!("a distance of {range_m:.0} m"),
                    "an orbit",
                );
            };
            let before = arcs.last().and_then(|arc| arc.last()).map(|(time, ..)| *time);
            if before.is_some_and(|before| time <= before) {
                return refused("time_utc", row.time_utc, "a time after that of the row before");
            }
            match (arcs.last_mut(), before) {
                (Some(arc), Some(before)) if is_continued => {
                    let (interval_s, limit_s) = (
                        (time - before).to_seconds(),
                        MAX_INTERVAL_REVOLUTIONS * orbital_period_s(&target.0),
                    );
                    if interval_s > limit_s {
                        let expected = format!(
                            "a time within {limit_s:.0} s of the estimate before, a sixth of a revolution of \
                             the target: navigate with a shorter --every"
                        );
                        return refused("time_utc", row.time_utc, &expected);
                    }
                    arc.push((time, target.0, target.1));
                }
                _ => arcs.push(vec![(time, target.0, target.1)]),
            }
            is_continued = true;
        }
        Ok(Self { navigator: result.estimator, arcs })
    }
}

/// Returns the state of the target, ICRS axes, from that of the chaser and its position, m, and velocity in
/// the rotating frame, m/s, along the target's R, T, N, with their covariance in km and km/s. `None` if no
/// orbit of the target has these axes.
fn target_state(
    chaser: &State,
    relative: &Vector6<f64>,
    covariance: Option<&Matrix6<f64>>,
) -> Option<(State, Option<Matrix6<f64>>)> {
    let state = inverted(chaser, relative)?;
    let covariance = match covariance {
        Some(covariance) => {
            let jacobian = jacobian(chaser, relative)?;
            Some(jacobian * covariance * jacobian.transpose())
        }
        None => None,
    };
    Some((state, covariance))
}

/// Solves the definition of the relative state for the target: its axes depend on the target's own state, so
/// the solution is that of a fixed point. An iteration reduces the error by the ratio of distance and radius.
fn inverted(chaser: &State, relative: &Vector6<f64>) -> Option<State> {
    /// Largest number of iterations: a ratio of 0.7 gives 1e-14.
    const MAX_ITERATIONS: usize = 100;
    /// Accepted change of the position, relative to the radius.
    const ACCURACY: f64 = 1e-14;
    let position_km: Vector3<f64> = relative.fixed_rows::<3>(0) * 1e-3;
    let velocity_km_s: Vector3<f64> = relative.fixed_rows::<3>(3) * 1e-3;
    let mut target = *chaser;
    for _ in 0..MAX_ITERATIONS {
        let icrs_from_rtn = target.rtn_from_icrs().inverse();
        let inertial_km_s = velocity_km_s + rotation_rate(&target).cross(&position_km);
        let next = State {
            position_km: chaser.position_km - icrs_from_rtn.rotate(&position_km),
            velocity_km_s: chaser.velocity_km_s - icrs_from_rtn.rotate(&inertial_km_s),
        };
        let change = (next.position_km - target.position_km).norm() / next.position_km.norm();
        target = next;
        if change < ACCURACY {
            return Some(target);
        }
    }
    None
}

/// Derivative of the target's position, km, and velocity, km/s, by the relative state, m and m/s: central
/// differences.
fn jacobian(chaser: &State, relative: &Vector6<f64>) -> Option<Matrix6<f64>> {
    const STEPS: [f64; 6] = [1.0, 1.0, 1.0, 1e-3, 1e-3, 1e-3];
    let mut jacobian = Matrix6::zeros();
    for (index, step) in STEPS.into_iter().enumerate() {
        let at = |offset: f64| {
            let moved = relative + Vector6::ith(index, offset);
            let State { position_km: p, velocity_km_s: v } = inverted(chaser, &moved)?;
            Some(Vector6::new(p.x, p.y, p.z, v.x, v.y, v.z))
        };
        jacobian.set_column(index, &((at(step)? - at(-step)?) / (2.0 * step)));
    }
    Some(jacobian)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::relative_state;

    fn chaser() -> State {
        State {
            position_km: Vector3::new(-3200.0, 5400.0, 3300.0),
            velocity_km_s: Vector3::new(3.0, -2.3, 6.4),
        }
    }

    fn relative(scale: f64) -> Vector6<f64> {
        Vector6::new(400.0, -30_000.0, 250.0, 0.3, -0.9, 0.2) * scale
    }

    #[test]
    fn the_target_has_the_relative_state_from_which_it_was_computed() {
        for scale in [0.0, 1e-3, 1.0, 30.0] {
            let target = inverted(&chaser(), &relative(scale)).unwrap();
            let error = relative_state(&chaser(), &target) - relative(scale);
            // Rounding of 7000 km and 7 km/s.
            assert!(error.fixed_rows::<3>(0).norm() < 1e-8, "{error}");
            assert!(error.fixed_rows::<3>(3).norm() < 1e-11, "{error}");
        }
        assert_eq!(inverted(&chaser(), &relative(1e6)), None);
        assert_eq!(inverted(&chaser(), &Vector6::repeat(f64::NAN)), None);
    }

    /// The normalised square of an error is independent of the coordinates.
    #[test]
    fn the_covariance_of_the_target_weighs_errors_as_that_of_the_relative_state() {
        let sigmas = Vector6::new(2.0, 90.0, 1.5, 0.09, 0.002, 0.001);
        let mut correlations = Matrix6::identity();
        (correlations[(3, 1)], correlations[(1, 3)]) = (-0.97, -0.97);
        (correlations[(5, 2)], correlations[(2, 5)]) = (0.4, 0.4);
        let covariance = correlations.component_mul(&(sigmas * sigmas.transpose()));
        let nees = |error: Vector6<f64>, covariance: &Matrix6<f64>| {
            error.dot(&(covariance.try_inverse().unwrap() * error))
        };
        let (target, of_target) = target_state(&chaser(), &relative(1.0), Some(&covariance)).unwrap();
        for index in 0..6 {
            let error = Vector6::from_fn(|row, _| sigmas[row] * if row == index { 2.0 } else { 0.3 });
            let moved = inverted(&chaser(), &(relative(1.0) + error)).unwrap();
            let (p, v) = (moved.position_km - target.position_km, moved.velocity_km_s - target.velocity_km_s);
            let moved = Vector6::new(p.x, p.y, p.z, v.x, v.y, v.z);
            let ratio = nees(moved, &of_target.unwrap()) / nees(error, &covariance);
            // Second order: 180 m of 7000 km turn the axes.
            assert!((ratio - 1.0).abs() < 1e-2, "{index}: {ratio}");
        }
    }
}
