//! Least squares with correlated errors: a filter that turns rows with slow errors into rows with independent
//! unit errors.
//!
//! The errors of a measurement are white noise plus slow errors, each a Gauss–Markov process: of first order
//! (Gelb, *Applied Optimal Estimation*, 1974, section 3.6) or, for a periodic error, damped rotation in two
//! dimensions with autocovariance σ² exp(−|Δt|/τ) cos(2π Δt/P). A Kalman filter for the slow errors alone
//! depends on times and covariances, not on the data. Applied to the residuals it yields independent
//! innovations; applied with the same gains to every column of the design matrix, it yields the design matrix
//! of these innovations. Ordinary least squares of the filtered rows is therefore generalised least squares
//! of the original ones (Ansley 1979, Biometrika 66, 59), in a time linear in the number of measurements.

use std::f64::consts::TAU;

use contract::navigation::AngleErrors;

use crate::sight::radians_from_arcsec;

/// Slow error on one axis.
#[derive(Debug, Clone, Copy)]
struct Process {
    axis: usize,
    variance: f64,
    memory_s: f64,
    rate_rad_s: f64,
    /// First index of its states; a periodic process has two.
    state: usize,
    is_periodic: bool,
}

/// Whitening filter for one class of errors.
#[derive(Debug, Clone)]
pub(crate) struct Whitener {
    processes: Vec<Process>,
    dimension: usize,
    columns: usize,
    /// Covariance of the states, dimension × dimension.
    covariance: Vec<f64>,
    /// States, one per process state and column, dimension × columns.
    states: Vec<f64>,
    seconds: Option<f64>,
    gain: Vec<f64>,
}

impl Whitener {
    /// Creates a filter for rows of `columns` values.
    pub(crate) fn new(errors: &AngleErrors, columns: usize) -> Self {
        let mut processes = Vec::new();
        let mut dimension = 0;
        for slow in &errors.slow {
            for axis in 0..2 {
                let sigma = radians_from_arcsec(slow.sigma_arcsec[axis]);
                if sigma > 0.0 {
                    let is_periodic = slow.period_s.is_some();
                    processes.push(Process {
                        axis,
                        variance: sigma * sigma,
                        memory_s: slow.memory_s,
                        rate_rad_s: slow.period_s.map_or(0.0, |period| TAU / period),
                        state: dimension,
                        is_periodic,
                    });
                    dimension += if is_periodic { 2 } else { 1 };
                }
            }
        }
        let mut filter = Self {
            processes,
            dimension,
            columns,
            covariance: vec![0.0; dimension * dimension],
            states: vec![0.0; dimension * columns],
            seconds: None,
            gain: vec![0.0; dimension],
        };
        for k in 0..filter.processes.len() {
            let Process { state, variance, is_periodic, .. } = filter.processes[k];
            for index in state..=state + usize::from(is_periodic) {
                filter.covariance[index * dimension + index] = variance;
            }
        }
        filter
    }

    /// Whitens the two rows of a measurement at a time not before that of the previous call: `rows` are those
    /// across columns and across rows, with white errors of covariance `noise` (xx, xy, yy).
    pub(crate) fn apply(&mut self, seconds: f64, noise: [f64; 3], rows: &mut [Vec<f64>; 2]) {
        // Rows with independent unit white errors: the inverse of the Cholesky factor of the covariance.
        let l11 = noise[0].sqrt();
        let l21 = noise[1] / l11;
        let l22 = (noise[2] - l21 * l21).sqrt();
        let (first, second) = rows.split_at_mut(1);
        for (x, y) in first[0].iter_mut().zip(second[0].iter_mut()) {
            *x /= l11;
            *y = (*y - l21 * *x) / l22;
        }
        if self.dimension == 0 {
            return;
        }
        self.predict(seconds);
        let inverse = [[1.0 / l11, 0.0], [-l21 / (l11 * l22), 1.0 / l22]];
        for (row, by_axis) in rows.iter_mut().zip(inverse) {
            self.update(by_axis, row);
        }
    }

    fn predict(&mut self, seconds: f64) {
        let dt = self.seconds.map_or(0.0, |last| seconds - last);
        self.seconds = Some(seconds);
        if dt <= 0.0 {
            return;
        }
        let (n, columns) = (self.dimension, self.columns);
        for k in 0..self.processes.len() {
            let Process { variance, memory_s, rate_rad_s, state, is_periodic, .. } = self.processes[k];
            let decay = libm::exp(-dt / memory_s);
            let noise = variance * (1.0 - decay * decay);
            if is_periodic {
                let (sin, cos) = libm::sincos(rate_rad_s * dt);
                let (c, s) = (decay * cos, decay * sin);
                turn(&mut self.states, columns, 1, columns, state, (c, s));
                turn(&mut self.covariance, n, 1, n, state, (c, s));
                turn(&mut self.covariance, 1, n, n, state, (c, s));
                self.covariance[(state + 1) * n + state + 1] += noise;
            } else {
                self.states[state * columns..(state + 1) * columns].iter_mut().for_each(|x| *x *= decay);
                (0..n).for_each(|j| self.covariance[state * n + j] *= decay);
                (0..n).for_each(|j| self.covariance[j * n + state] *= decay);
            }
            self.covariance[state * n + state] += noise;
        }
    }

    fn update(&mut self, by_axis: [f64; 2], row: &mut [f64]) {
        let (n, columns) = (self.dimension, self.columns);
        // P Hᵀ; H has one entry per process, on its first state.
        self.gain.iter_mut().enumerate().for_each(|(j, gain)| {
            let terms = self.processes.iter().map(|p| self.covariance[j * n + p.state] * by_axis[p.axis]);
            *gain = terms.sum();
        });
        let variance = 1.0 + self.processes.iter().map(|p| self.gain[p.state] * by_axis[p.axis]).sum::<f64>();
        for process in &self.processes {
            let factor = by_axis[process.axis];
            if factor != 0.0 {
                let state = &self.states[process.state * columns..(process.state + 1) * columns];
                row.iter_mut().zip(state).for_each(|(value, state)| *value -= factor * state);
            }
        }
        for (j, gain) in self.gain.iter().enumerate() {
            let factor = gain / variance;
            let state = &mut self.states[j * columns..(j + 1) * columns];
            state.iter_mut().zip(row.iter()).for_each(|(state, value)| *state += factor * value);
            (0..n).for_each(|k| self.covariance[j * n + k] -= factor * self.gain[k]);
        }
        let scale = 1.0 / variance.sqrt();
        row.iter_mut().for_each(|value| *value *= scale);
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
    use super::*;
    use contract::navigation::SlowError;
    use nalgebra::DMatrix;

    /// Generalised least squares with the full covariance matrix is the witness: X = L⁻¹ A up to an
    /// orthogonal transformation, so the normal matrices Aᵀ C⁻¹ A agree.
    #[test]
    fn filtered_rows_have_the_normal_matrix_of_generalised_least_squares() {
        let arcsec = 3600.0_f64 / std::f64::consts::PI * 180.0;
        let errors = AngleErrors {
            white_arcsec: [0.0; 2],
            slow: vec![
                SlowError { sigma_arcsec: [2.0 * arcsec, 1.5 * arcsec], memory_s: 300.0, period_s: None },
                SlowError { sigma_arcsec: [1.0 * arcsec, 0.0], memory_s: 1e5, period_s: Some(500.0) },
            ],
            constant_arcsec: [0.0; 3],
        };
        let (times, columns) = ([0.0, 15.0, 30.0, 30.0, 400.0, 415.0, 2000.0], 3);
        let noise = [0.8, 0.3, 1.2];
        let value = |i: usize, k: usize| libm::sin((1 + i * columns + k) as f64 * 1.7);
        let mut filter = Whitener::new(&errors, columns);
        let size = 2 * times.len();
        let mut filtered = DMatrix::zeros(size, columns);
        let design = DMatrix::from_fn(size, columns, value);
        for (index, seconds) in times.into_iter().enumerate() {
            let mut rows = [0, 1].map(|axis| (0..columns).map(|k| value(2 * index + axis, k)).collect());
            filter.apply(seconds, noise, &mut rows);
            for (axis, row) in rows.iter().enumerate() {
                (0..columns).for_each(|k| filtered[(2 * index + axis, k)] = row[k]);
            }
        }
        let covariance = DMatrix::from_fn(size, size, |i, j| {
            let dt = f64::abs(times[i / 2] - times[j / 2]);
            let (axis, other) = (i % 2, j % 2);
            let white = if i / 2 == j / 2 { [noise[0], noise[1], noise[2]][axis + other] } else { 0.0 };
            let slow = [4.0, 2.25][axis] * libm::exp(-dt / 300.0);
            let periodic = [1.0, 0.0][axis] * libm::exp(-dt / 1e5) * libm::cos(TAU / 500.0 * dt);
            white + if axis == other { slow + periodic } else { 0.0 }
        });
        let expected = design.transpose() * covariance.cholesky().unwrap().solve(&design);
        let got = filtered.transpose() * filtered;
        assert!((&got - &expected).abs().max() < 1e-12 * expected.abs().max(), "{got} {expected}");
    }
}
