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

/// Number of fields over which the scatter of each component is averaged, and excess or lack that is
/// attributed to chance: 2.8 standard deviations, because 199 of the differences count as 84.
const COMPONENT_MEMORY: f64 = 100.0;
const COMPONENT_CHANCE: f64 = 0.43;

/// Number of fields without any scatter with which the average of a small target begins.
const UNSEEN_FIELDS: f64 = 20.0;

/// Number of the last measurements that are kept: differences of every second field need seven.
const KEPT: usize = 8;

/// Upper limit of a component's normalised square in its average: errors of twice the field's variance reach
/// it in one of forty fields, so that wrong fields do not hide a lack of scatter.
const MAX_COMPONENT_SQUARE: f64 = 10.0;

/// Upper limit of a normalised square in the average: a wrong field is not scatter.
const MAX_NORMALISED_SQUARE: f64 = 1e4;

/// Longest time between the fields of a difference, s.
const MAX_STEP_S: f64 = 0.1;

/// Measurement of a field.
#[derive(Debug, Clone)]
struct Measurement<const N: usize> {
    time_s: f64,
    value: SVector<f64, N>,
    covariance: SMatrix<f64, N, N>,
}

/// Scatter of the last fields' measurements, of N components each.
#[derive(Debug, Clone)]
pub(crate) struct Scatter<const N: usize> {
    last: VecDeque<Measurement<N>>,
    sum: f64,
    weight: f64,
    /// Sums of each component's normalised squares, and their number.
    component_sums: SVector<f64, N>,
    component_weight: f64,
}

impl<const N: usize> Default for Scatter<N> {
    fn default() -> Self {
        Self {
            last: VecDeque::new(),
            sum: 0.0,
            weight: 0.0,
            component_sums: SVector::zeros(),
            component_weight: 0.0,
        }
    }
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
        self.last.push_back(Measurement { time_s, value: *measured, covariance: *covariance });
        if self.last.len() > KEPT {
            self.last.pop_front();
        }
        if let Some(square) = self.square() {
            let kept = 1.0 - 1.0 / MEMORY;
            self.sum = self.sum * kept + square.min(MAX_NORMALISED_SQUARE);
            self.weight = self.weight * kept + 1.0;
        }
        if let Some(of_components) = self.component_squares() {
            let kept = 1.0 - 1.0 / COMPONENT_MEMORY;
            self.component_sums =
                self.component_sums * kept + of_components.map(|square| square.min(MAX_COMPONENT_SQUARE));
            self.component_weight = self.component_weight * kept + 1.0;
        }
        self.factor()
    }

    /// Returns the part of the last covariance that does not scatter from field to field, and is therefore
    /// common to neighbouring fields. `common` is the part that is already stated as common.
    ///
    /// The part is zero unless a component scatters by significantly less than its variance. The features of
    /// a small target are narrower than pixels and lines; their errors count as common as far as no scatter
    /// has been measured yet.
    pub(crate) fn common_part(
        &self,
        common: &SMatrix<f64, N, N>,
        is_small_target: bool,
    ) -> SMatrix<f64, N, N> {
        let Some(Measurement { covariance, .. }) = self.last.back() else { return SMatrix::zeros() };
        let chance = COMPONENT_CHANCE * (COMPONENT_MEMORY / self.component_weight.max(1.0)).sqrt();
        let shares = SVector::<f64, N>::from_fn(|i, _| {
            let scatter = self.component_sums[i] / self.component_weight;
            // Share of the variance that does not scatter.
            let lack = if is_small_target {
                1.0 - self.component_sums[i] / (self.component_weight + UNSEEN_FIELDS)
            } else if scatter < 1.0 - chance {
                1.0 - scatter
            } else {
                0.0
            };
            (lack - common[(i, i)] / covariance[(i, i)]).max(0.0).sqrt()
        });
        SMatrix::from_fn(|i, j| covariance[(i, j)] * shares[i] * shares[j])
    }

    /// Returns the factor by which the covariances are too small, 1 or more.
    pub(crate) fn factor(&self) -> f64 {
        let mean = (self.sum + TRUST) / (self.weight + TRUST);
        if mean > 1.0 + CHANCE / (N as f64).sqrt() { mean } else { 1.0 }
    }

    /// Returns the normalised square of the third difference of the last four fields, divided by its
    /// dimension. Returns `None` unless they are evenly spaced in time.
    fn square(&self) -> Option<f64> {
        let last = self.last.len().checked_sub(THIRD_DIFFERENCE.len())?;
        let fields: [&Measurement<N>; 4] = std::array::from_fn(|k| &self.last[last + k]);
        let first = fields[1].time_s - fields[0].time_s;
        let mut steps = fields.iter().zip(&fields[1..]).map(|(a, b)| b.time_s - a.time_s);
        if !(first > 0.0 && first < MAX_STEP_S && steps.all(|step| (step / first - 1.0).abs() < 0.1)) {
            return None;
        }
        let (difference, covariance) = third_difference(fields);
        Some(difference.dot(&(inverse(&covariance)? * difference)) / N as f64)
    }

    /// Returns the normalised squares of the components of the third difference of every second field: the
    /// two fields of a frame have different lines, and errors common to one field's lines do not cancel those
    /// of the other's. Returns `None` if one of the four fields is missing.
    fn component_squares(&self) -> Option<SVector<f64, N>> {
        let end_s = self.last.back()?.time_s;
        let steps = self.last.iter().zip(self.last.iter().skip(1)).map(|(a, b)| b.time_s - a.time_s);
        let step_s = steps.fold(f64::INFINITY, f64::min);
        if !(step_s > 0.0 && step_s < MAX_STEP_S) {
            return None;
        }
        let before = |fields: f64| {
            let time_s = end_s - fields * step_s;
            self.last.iter().find(|one| (one.time_s - time_s).abs() < 0.1 * step_s)
        };
        let fields = [before(6.0)?, before(4.0)?, before(2.0)?, before(0.0)?];
        let (difference, covariance) = third_difference(fields);
        Some(difference.component_mul(&difference).component_div(&covariance.diagonal()))
    }
}

/// Returns the third difference of four measurements, and its covariance.
fn third_difference<const N: usize>(fields: [&Measurement<N>; 4]) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
    let weighted = || THIRD_DIFFERENCE.iter().zip(fields);
    (
        weighted().map(|(weight, one)| one.value * *weight).sum(),
        weighted().map(|(weight, one)| one.covariance * (weight * weight)).sum(),
    )
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

    /// Returns the common part of each component after `fields` fields, relative to the covariance. Of each
    /// component's variance, `white` scatters from field to field.
    fn common_parts(white: f64, is_small: bool, fields: u32, seed: u64) -> Vector6<f64> {
        let mut scatter = Scatter::default();
        let sigma = Vector6::new(1e-3, 1e-3, 2e-3, 1e-4, 1e-4, 1e-4);
        let covariance = Matrix6::from_diagonal(&sigma.component_mul(&sigma));
        for k in 0..fields {
            let draw = Vector6::from_fn(|i, _| normal(seed * 7_919 + u64::from(k) * 8 + i as u64));
            let error = sigma.component_mul(&draw) * white.sqrt();
            let t = f64::from(k) * 0.02;
            scatter.add(t, &(to_vector(&approach(t)) + error), &covariance);
        }
        scatter.common_part(&Matrix6::zeros(), is_small).diagonal().component_div(&covariance.diagonal())
    }

    #[test]
    fn variance_that_does_not_scatter_is_common() {
        for seed in 0..10 {
            let parts = common_parts(0.2, false, 300, seed);
            assert!(parts.iter().all(|part| (0.65..0.9).contains(part)), "{parts}");
        }
        let wrong = (0..50).filter(|seed| common_parts(1.0, false, 300, *seed) != Vector6::zeros()).count();
        assert!(wrong <= 2, "{wrong} of 50");
        assert_eq!(common_parts(0.2, false, 5, 1), Vector6::zeros(), "too few fields");
    }

    #[test]
    fn variance_of_a_small_target_is_common_until_it_scatters() {
        assert_eq!(common_parts(1.0, true, 1, 1), Vector6::repeat(1.0));
        for seed in 0..10 {
            assert!(common_parts(1.0, true, 30, seed).mean() > 0.2);
            assert!(common_parts(1.0, true, 600, seed).mean() < 0.35);
            assert!(common_parts(0.2, true, 600, seed).iter().all(|part| *part > 0.65));
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
