//! Least squares with correlated errors: a filter that turns rows with slow errors into rows with independent
//! unit errors.
//!
//! The errors of a measurement are white noise plus slow errors ([`crate::slow_errors`]). A Kalman filter for
//! the slow errors alone depends on times, distances and covariances, not on the data. Applied to the
//! residuals it yields independent innovations; applied with the same gains to every column of the design
//! matrix, it yields the design matrix of these innovations. Ordinary least squares of the filtered rows is
//! therefore generalised least squares of the original ones (Ansley 1979, Biometrika 66, 59), in a time
//! linear in the number of measurements.

use contract::navigation::LineOfSightErrors;

use crate::sight::ErrorClass;
use crate::slow_errors::{SlowProcess, SlowTransition, slow_processes};

/// White errors of a measurement, and its relation to slow ones.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RowErrors {
    /// Time, s since the epoch.
    pub(crate) seconds: f64,
    /// Class of errors.
    pub(crate) class: ErrorClass,
    /// Covariance of the white errors, elements xx, xy, yy, rad².
    pub(crate) noise: [f64; 3],
    /// Derivatives of the angles with respect to a displacement of the target, rad/m.
    pub(crate) by_displacement: [f64; 2],
}

/// Whitening filter of a campaign.
#[derive(Debug, Clone)]
pub(crate) struct Whitener {
    processes: Vec<SlowProcess>,
    dimension: usize,
    columns: usize,
    /// Covariance of the states, dimension × dimension.
    covariance: Vec<f64>,
    /// States, one per process state and column, dimension × columns.
    states: Vec<f64>,
    seconds: Option<f64>,
    /// Derivatives of the current row with respect to the first state of each process.
    slopes: Vec<f64>,
    gain: Vec<f64>,
}

impl Whitener {
    /// Creates a filter for measurements of some classes, each with two rows of `columns` values.
    pub(crate) fn new(errors: &LineOfSightErrors, classes: &[ErrorClass], columns: usize) -> Self {
        let processes = slow_processes(errors, classes, 0);
        let dimension = processes.last().map_or(0, |last| last.states().end() + 1);
        let mut covariance = vec![0.0; dimension * dimension];
        for process in &processes {
            process.states().for_each(|index| covariance[index * dimension + index] = process.variance);
        }
        Self {
            slopes: vec![0.0; processes.len()],
            processes,
            dimension,
            columns,
            covariance,
            states: vec![0.0; dimension * columns],
            seconds: None,
            gain: vec![0.0; dimension],
        }
    }

    /// Whitens the two rows of a measurement, across columns and across rows, at a time not before that of
    /// the previous call. Returns the logarithm of the determinant of its covariance given the measurements
    /// before, relative to that of its white errors.
    pub(crate) fn apply(&mut self, errors: &RowErrors, rows: &mut [Vec<f64>; 2]) -> f64 {
        // Rows with independent unit white errors: the inverse of the Cholesky factor of the covariance.
        let [xx, xy, yy] = errors.noise;
        let l11 = xx.sqrt();
        let l21 = xy / l11;
        let l22 = (yy - l21 * l21).sqrt();
        let (first, second) = rows.split_at_mut(1);
        for (x, y) in first[0].iter_mut().zip(second[0].iter_mut()) {
            *x /= l11;
            *y = (*y - l21 * *x) / l22;
        }
        if self.dimension == 0 {
            return 0.0;
        }
        self.predict(errors.seconds);
        let inverse = [[1.0 / l11, 0.0], [-l21 / (l11 * l22), 1.0 / l22]];
        let mut log_determinant = 0.0;
        for (row, by_axis) in rows.iter_mut().zip(inverse) {
            for (slope, process) in self.slopes.iter_mut().zip(&self.processes) {
                let [x, y] = process.slopes(errors.class, errors.by_displacement);
                *slope = by_axis[0] * x + by_axis[1] * y;
            }
            log_determinant += libm::log(self.update(row));
        }
        log_determinant
    }

    fn predict(&mut self, seconds: f64) {
        let dt = self.seconds.map_or(0.0, |last| seconds - last);
        self.seconds = Some(seconds);
        if dt <= 0.0 {
            return;
        }
        let (n, columns) = (self.dimension, self.columns);
        for process in &self.processes {
            let SlowTransition { state, is_periodic, cos, sin, noise } = process.transition(dt);
            if is_periodic {
                turn(&mut self.states, columns, 1, columns, state, (cos, sin));
                turn(&mut self.covariance, n, 1, n, state, (cos, sin));
                turn(&mut self.covariance, 1, n, n, state, (cos, sin));
            } else {
                self.states[state * columns..(state + 1) * columns].iter_mut().for_each(|x| *x *= cos);
                (0..n).for_each(|j| self.covariance[state * n + j] *= cos);
                (0..n).for_each(|j| self.covariance[j * n + state] *= cos);
            }
            process.states().for_each(|index| self.covariance[index * n + index] += noise);
        }
    }

    /// Whitens a row; returns the variance of its innovation, whose white part is 1.
    fn update(&mut self, row: &mut [f64]) -> f64 {
        let (n, columns) = (self.dimension, self.columns);
        // P Hᵀ; H has one entry per process, on its first state.
        let slopes = || self.processes.iter().map(|process| process.state).zip(&self.slopes);
        for (j, gain) in self.gain.iter_mut().enumerate() {
            *gain = slopes().map(|(state, slope)| self.covariance[j * n + state] * slope).sum();
        }
        let variance = 1.0 + slopes().map(|(state, slope)| self.gain[state] * slope).sum::<f64>();
        for (state, slope) in slopes().filter(|(_, slope)| **slope != 0.0) {
            let states = &self.states[state * columns..(state + 1) * columns];
            row.iter_mut().zip(states).for_each(|(value, state)| *value -= slope * state);
        }
        for (j, gain) in self.gain.iter().enumerate() {
            let factor = gain / variance;
            let state = &mut self.states[j * columns..(j + 1) * columns];
            state.iter_mut().zip(row.iter()).for_each(|(state, value)| *state += factor * value);
            (0..n).for_each(|k| self.covariance[j * n + k] -= factor * self.gain[k]);
        }
        let scale = 1.0 / variance.sqrt();
        row.iter_mut().for_each(|value| *value *= scale);
        variance
    }
}

/// Turns and damps the pairs (state, state + 1) of a matrix along one of its dimensions: `pair` is the stride
/// between the two, `along` that between pairs, `count` their number.
fn turn(matrix: &mut [f64], pair: usize, along: usize, count: usize, state: usize, (c, s): (f64, f64)) {
    for k in 0..count {
        let (i, j) = (state * pair + k * along, (state + 1) * pair + k * along);
        let (x, y) = (matrix[i], matrix[j]);
        matrix[i] = c * x - s * y;
        matrix[j] = s * x + c * y;
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use contract::navigation::{AngleErrors, SlowDisplacement, SlowError};
    use nalgebra::DMatrix;

    const TIMES: [f64; 7] = [0.0, 15.0, 30.0, 30.0, 400.0, 415.0, 2000.0];
    const NOISE: [f64; 3] = [0.8, 0.3, 1.2];
    const SIZE: usize = 2 * TIMES.len();
    const COLUMNS: usize = 3;

    fn value(i: usize, k: usize) -> f64 {
        libm::sin((1 + i * COLUMNS + k) as f64 * 1.7)
    }

    /// Compares the filtered rows with generalised least squares by the full covariance matrix, to which slow
    /// errors add `slow`, a function of the indices of two measurements and of two axes. The filtered rows
    /// are L⁻¹ A up to an orthogonal transformation, so the normal matrices Aᵀ C⁻¹ A agree.
    fn check(
        errors: &LineOfSightErrors,
        classes: [ErrorClass; 7],
        distances_m: [f64; 7],
        slow: impl Fn([usize; 2], [usize; 2]) -> f64,
    ) {
        let mut filter = Whitener::new(errors, &ErrorClass::ALL, COLUMNS);
        let mut filtered = DMatrix::zeros(SIZE, COLUMNS);
        let mut log_determinant = 0.0;
        let design = DMatrix::from_fn(SIZE, COLUMNS, value);
        for (index, seconds) in TIMES.into_iter().enumerate() {
            let mut rows = [0, 1].map(|axis| (0..COLUMNS).map(|k| value(2 * index + axis, k)).collect());
            let by_displacement = [1.0 / distances_m[index]; 2];
            let row_errors = RowErrors { seconds, class: classes[index], noise: NOISE, by_displacement };
            log_determinant += filter.apply(&row_errors, &mut rows);
            for (axis, row) in rows.iter().enumerate() {
                (0..COLUMNS).for_each(|k| filtered[(2 * index + axis, k)] = row[k]);
            }
        }
        let covariance = DMatrix::from_fn(SIZE, SIZE, |i, j| {
            let white = if i / 2 == j / 2 { NOISE[i % 2 + j % 2] } else { 0.0 };
            white + slow([i / 2, j / 2], [i % 2, j % 2])
        });
        let of_white = NOISE[0] * NOISE[2] - NOISE[1] * NOISE[1];
        let expected = libm::log(covariance.determinant()) - 7.0 * libm::log(of_white);
        assert!((log_determinant - expected).abs() < 1e-12 * expected.abs(), "{log_determinant} {expected}");
        let expected = design.transpose() * covariance.cholesky().unwrap().solve(&design);
        let got = filtered.transpose() * filtered;
        assert!((&got - &expected).abs().max() < 1e-12 * expected.abs().max(), "{got} {expected}");
    }

    fn dt(measurements: [usize; 2]) -> f64 {
        f64::abs(TIMES[measurements[0]] - TIMES[measurements[1]])
    }

    #[test]
    fn rows_with_angle_errors_have_the_normal_matrix_of_generalised_least_squares() {
        let arcsec = 3600.0_f64 / std::f64::consts::PI * 180.0;
        let with_stars = AngleErrors {
            slow: vec![
                SlowError { sigma_arcsec: [2.0 * arcsec, 1.5 * arcsec], memory_s: 300.0, period_s: None },
                SlowError { sigma_arcsec: [1.0 * arcsec, 0.0], memory_s: 1e5, period_s: Some(500.0) },
            ],
            ..AngleErrors::default()
        };
        let errors = LineOfSightErrors { with_stars, ..LineOfSightErrors::default() };
        let slow = |measurements: [usize; 2], axes: [usize; 2]| {
            let dt = dt(measurements);
            let slow = [4.0, 2.25][axes[0]] * libm::exp(-dt / 300.0);
            let periodic = [1.0, 0.0][axes[0]] * libm::exp(-dt / 1e5) * libm::cos(TAU / 500.0 * dt);
            if axes[0] == axes[1] { slow + periodic } else { 0.0 }
        };
        check(&errors, [ErrorClass::WithStars; 7], [1.0; 7], slow);
    }

    /// Displacements are common to both classes of measurements, the other slow errors are not.
    #[test]
    fn displacements_have_the_normal_matrix_of_generalised_least_squares_as_the_distance_changes() {
        let arcsec = 3600.0_f64 / std::f64::consts::PI * 180.0;
        let angle = SlowError { sigma_arcsec: [2.0 * arcsec; 2], memory_s: 300.0, period_s: None };
        let errors = LineOfSightErrors {
            with_stars: AngleErrors { slow: vec![angle], ..AngleErrors::default() },
            without_stars: AngleErrors { slow: vec![angle], ..AngleErrors::default() },
            displacements: vec![
                SlowDisplacement { sigma_m: [30.0, 40.0], memory_s: 800.0, period_s: None },
                SlowDisplacement { sigma_m: [0.0, 20.0], memory_s: 1e5, period_s: Some(500.0) },
            ],
        };
        let (stars, none) = (ErrorClass::WithStars, ErrorClass::WithoutStars);
        let classes = [stars, stars, none, stars, none, none, stars];
        let distances_m = [60.0, 55.0, 50.0, 50.0, 25.0, 24.0, 4.0];
        let slow = |measurements: [usize; 2], axes: [usize; 2]| {
            let dt = dt(measurements);
            let [first, second] = measurements;
            let angle = if classes[first] == classes[second] { 4.0 * libm::exp(-dt / 300.0) } else { 0.0 };
            let irregular = [900.0, 1600.0][axes[0]] * libm::exp(-dt / 800.0);
            let periodic = [0.0, 400.0][axes[0]] * libm::exp(-dt / 1e5) * libm::cos(TAU / 500.0 * dt);
            let displacement = (irregular + periodic) / (distances_m[first] * distances_m[second]);
            if axes[0] == axes[1] { angle + displacement } else { 0.0 }
        };
        check(&errors, classes, distances_m, slow);
    }
}
