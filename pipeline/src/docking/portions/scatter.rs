//! Scatter of the measurements of neighbouring fields, relative to their covariances.

use std::collections::VecDeque;

use nalgebra::{Const, DimMin, SMatrix, SVector};

use super::inverse;

/// Weights of four successive fields that cancel a motion with constant acceleration.
const THIRD_DIFFERENCE: [f64; 4] = [1.0, -3.0, 3.0, -1.0];

/// Number of fields over which the scatter is averaged, and weight of the stated covariances, in fields.
const MEMORY: f64 = 25.0;
const TRUST: f64 = 5.0;

/// Excess of the average over 1 that is attributed to chance, for a measurement of one component; it
/// decreases with the root of their number. It is 2.8 standard deviations: successive third differences are
/// correlated, so 49 of them count as 21.
const CHANCE: f64 = 0.86;

/// Upper limit of a normalised square in the average: a wrong field is not scatter.
const MAX_NORMALISED_SQUARE: f64 = 1e4;

/// Scatter of the last fields' measurements, of N components each.
#[derive(Debug, Clone, Default)]
pub(crate) struct Scatter<const N: usize> {
    last: VecDeque<(f64, SVector<f64, N>, SMatrix<f64, N, N>)>,
    sum: f64,
    weight: f64,
}

impl<const N: usize> Scatter<N>
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    /// Adds the measurement of a field. Returns the factor by which the covariances of this field and its
    /// neighbours are too small, 1 or more.
    pub(crate) fn add(
        &mut self,
        time_s: f64,
        measured: &SVector<f64, N>,
        covariance: &SMatrix<f64, N, N>,
    ) -> f64 {
        self.last.push_back((time_s, *measured, *covariance));
        if self.last.len() > THIRD_DIFFERENCE.len() {
            self.last.pop_front();
        }
        if let Some(square) = self.square() {
            let kept = 1.0 - 1.0 / MEMORY;
            self.sum = self.sum * kept + square.min(MAX_NORMALISED_SQUARE);
            self.weight = self.weight * kept + 1.0;
        }
        self.factor()
    }

    /// Returns the factor by which the covariances are too small, 1 or more.
    pub(crate) fn factor(&self) -> f64 {
        let mean = (self.sum + TRUST) / (self.weight + TRUST);
        if mean > 1.0 + CHANCE / (N as f64).sqrt() { mean } else { 1.0 }
    }

    /// Returns the normalised square of the third difference, divided by its dimension. Returns `None` unless
    /// the last four fields are evenly spaced in time.
    fn square(&self) -> Option<f64> {
        if self.last.len() < THIRD_DIFFERENCE.len() {
            return None;
        }
        let mut times = self.last.iter().zip(self.last.iter().skip(1)).map(|(a, b)| b.0 - a.0);
        let first = times.next()?;
        if !(first > 0.0 && first < 0.1 && times.all(|step| (step / first - 1.0).abs() < 0.1)) {
            return None;
        }
        let (mut difference, mut covariance) = (SVector::<f64, N>::zeros(), SMatrix::<f64, N, N>::zeros());
        for (weight, (_, measured, of_measured)) in THIRD_DIFFERENCE.iter().zip(&self.last) {
            difference += measured * *weight;
            covariance += of_measured * (weight * weight);
        }
        Some(difference.dot(&(inverse(&covariance)? * difference)) / N as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{approach, normal};
    use super::*;
    use crate::docking::pose::geometry::to_vector;
    use nalgebra::{Matrix6, Vector6};

    /// Returns the factor after 200 fields whose errors are `times` as large as their covariances state.
    fn factor(times: f64, seed: u64) -> f64 {
        let mut scatter = Scatter::default();
        let sigma = Vector6::new(1e-3, 1e-3, 2e-3, 1e-4, 1e-4, 1e-4);
        for k in 0..200 {
            let t = f64::from(k) * 0.02;
            let draw = Vector6::from_fn(|i, _| normal(seed * 7_919 + k as u64 * 8 + i as u64));
            let measured = to_vector(&approach(t)) + sigma.component_mul(&draw) * times;
            scatter.add(t, &measured, &Matrix6::from_diagonal(&sigma.component_mul(&sigma)));
        }
        scatter.factor()
    }

    #[test]
    fn consistent_covariances_are_unchanged() {
        let changed = (0..50).filter(|seed| factor(1.0, *seed) != 1.0).count();
        assert!(changed <= 5, "{changed} of 50");
    }

    #[test]
    fn covariances_that_are_too_small_are_found_so() {
        for seed in 0..10 {
            // Errors of three standard deviations: the factor is nine, less the trust in the covariances,
            // with an uncertainty of a third.
            let factor = factor(3.0, seed);
            assert!((4.5..13.0).contains(&factor), "{factor}");
        }
    }

    #[test]
    fn one_wrong_field_is_forgotten() {
        let mut scatter = Scatter::default();
        let covariance = Matrix6::identity() * 1e-6;
        for k in 0..400 {
            let mut pose = approach(f64::from(k) * 0.02);
            if k == 100 {
                pose.position_m.z += 5.0;
            }
            scatter.add(f64::from(k) * 0.02, &to_vector(&pose), &covariance);
        }
        assert_eq!(scatter.factor(), 1.0);
    }
}
