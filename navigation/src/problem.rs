//! Weighted nonlinear least squares over the parameters of a campaign.
//!
//! Gauss–Newton with Marquardt's damping, in square-root form, over rows whose slow errors are whitened
//! ([`crate::whitener`]). Coarse stages on a part of the measurements proceed from the first hours to the
//! whole campaign. Each excludes new measurements that disagree with the orbit so far and its covariance, and
//! weights large residuals of the others down (Huber 1964, Ann. Math. Stat. 35, 73, scaled by the median).
//! The fine stage uses all, and edits those whose innovation is beyond a gate, until the set is stable.

use contract::navigation::{Answer, NavigationSetup, NoEstimate, RelativeElements};
use hifitime::Epoch;
use nalgebra::{DMatrix, Matrix2, Matrix2x3, Matrix6, Vector2, Vector3};

use crate::parameters::Parameters;
use crate::path::{Path, PathSetup};
use crate::reference::Reference;
use crate::relative_state;
use crate::sight::{ErrorClass, Prediction, Sight};
use crate::square_root::SquareRoot;
use crate::time::seconds_between;
use crate::whitener::{RowErrors, Whitener};

/// Largest number of measurements of a coarse stage.
const COARSE: usize = 1000;

/// Fractions of the campaign that the coarse stages use, one after the other.
const PARTS: [f64; 5] = [0.06, 0.15, 0.35, 0.65, 1.0];

/// Gate of new measurements of a coarse stage, in gates of the fine stage: the orbit so far is predicted
/// linearly.
const COARSE_GATES: f64 = 2.0;

/// Largest number of iterations of one stage.
const ITERATIONS: usize = 25;

/// Largest step, in standard deviations, at which an iteration has converged.
const CONVERGED: f64 = 0.02;

/// Largest number of editings of the fine stage.
const EDITINGS: usize = 5;

/// Multiple of the scale above which Huber's weights decrease.
const HUBER: f64 = 2.5;

/// Median of the length of two independent unit normal values.
const RAYLEIGH_MEDIAN: f64 = 1.177_410_022_515_474_6;

/// Passes over the residuals to find weights: an outlier of degrees disturbs the whitened residuals of the
/// measurements after it until its weight is small.
const WEIGHTINGS: usize = 4;

/// Largest damping before an iteration is given up.
const MAX_DAMPING: f64 = 1e8;

/// Data of an estimation.
#[derive(Clone, Copy)]
pub(crate) struct Problem<'a> {
    /// Setup of the navigator.
    pub(crate) setup: &'a NavigationSetup,
    /// Absolute orbit of the chaser.
    pub(crate) reference: &'a Reference,
    /// Measurements in order of time.
    pub(crate) sights: &'a [Sight],
    /// Order and prior of the parameters.
    pub(crate) parameters: &'a Parameters,
    /// Gate of the residuals.
    pub(crate) outlier_sigma: f64,
}

/// Result of an estimation.
#[derive(Debug, Clone)]
pub(crate) struct Solution {
    /// Estimated parameters.
    pub(crate) values: Vec<f64>,
    /// Their covariance.
    pub(crate) covariance: DMatrix<f64>,
    /// Minus twice the logarithm of the likelihood at the minimum, prior included, less a constant: the sum
    /// of squares and the logarithm of the determinant of the covariance relative to that of white errors.
    pub(crate) cost: f64,
    /// Weight of each measurement: 1 used, 0 edited.
    pub(crate) weights: Vec<f64>,
    /// Measured minus predicted angles of each measurement, rad, without its bias.
    pub(crate) residuals: Vec<[f64; 2]>,
    /// Relative elements over time.
    pub(crate) path: Path,
}

/// Result of a coarse stage.
pub(crate) struct Coarse {
    /// Minus twice the logarithm of the likelihood, less a constant.
    pub(crate) cost: f64,
    /// Covariance of the parameters.
    pub(crate) covariance: DMatrix<f64>,
}

/// Step of an iteration.
struct Step {
    /// Largest component in standard deviations.
    length: f64,
    /// Sum of squares after the step.
    cost: f64,
    /// Covariance at the parameters before the step.
    covariance: DMatrix<f64>,
}

/// Residuals at parameters.
struct Residuals {
    /// Sum of squares of whitened, weighted residuals and prior.
    cost: f64,
    /// Logarithm of the determinant of the covariance of the measurements with a weight, relative to that of
    /// their white errors.
    log_determinant: f64,
    /// Length of each measurement's whitened residual.
    lengths: Vec<f64>,
    residuals: Vec<[f64; 2]>,
}

impl Problem<'_> {
    /// Estimates the parameters from a starting orbit.
    ///
    /// # Errors
    /// [`NoEstimate`] if there is no measurement or the iteration does not converge.
    pub(crate) fn solve(&self, start: &RelativeElements) -> Result<Solution, NoEstimate> {
        if self.sights.is_empty() {
            return Err(NoEstimate::NoMeasurements);
        }
        let mut values = vec![0.0; self.parameters.count()];
        values.iter_mut().zip(start.vector().iter()).for_each(|(value, x)| *value = *x);
        // Angles are nonlinear where the predicted chaser passes the target: a wrong orbit is corrected from
        // its first measurements before later ones are added.
        let last = self.sights.last().map_or(0.0, |sight| sight.seconds);
        let first = self.sights.first().map_or(0.0, |sight| sight.seconds);
        let mut covariance = self.prior_covariance(&values)?;
        let mut plausible: Vec<Sight> = Vec::new();
        let mut begin = 0;
        for part in PARTS {
            let end = self.sights.partition_point(|sight| sight.seconds <= first + part * (last - first));
            let new = Problem { sights: &self.sights[begin..end], ..*self };
            let weights = new.within(COARSE_GATES * self.outlier_sigma, &values, &covariance)?;
            let of_weight = new.sights.iter().zip(&weights).filter(|(_, weight)| **weight > 0.0);
            plausible.extend(of_weight.map(|(sight, _)| sight.clone()));
            begin = end;
            if plausible.is_empty() {
                continue;
            }
            let stride = plausible.len().div_ceil(COARSE);
            let coarse: Vec<Sight> = plausible.iter().step_by(stride).cloned().collect();
            covariance = Problem { sights: &coarse, ..*self }.robust(&mut values)?.covariance;
        }
        let edited = self.within(self.outlier_sigma, &values, &covariance)?;
        self.fine(values, edited)
    }

    /// Iterates with Huber's weights.
    pub(crate) fn robust(&self, values: &mut Vec<f64>) -> Result<Coarse, NoEstimate> {
        let mut weights = vec![1.0; self.sights.len()];
        let mut damping = 0.0;
        let mut iteration = 0;
        loop {
            let displaced = self.by_displacement(values)?;
            for _ in 0..WEIGHTINGS {
                weights = huber(&self.residuals(values, &weights, &displaced)?.lengths);
            }
            let Step { length, cost, covariance } = self.iterate(values, &weights, &mut damping)?;
            iteration += 1;
            if (length < CONVERGED && iteration > 1) || iteration == ITERATIONS {
                return Ok(Coarse { cost: cost + self.log_determinant(values)?, covariance });
            }
        }
    }

    /// Iterates with all measurements whose weight is 1, and edits them.
    fn fine(&self, mut values: Vec<f64>, mut edited: Vec<f64>) -> Result<Solution, NoEstimate> {
        for _ in 0..WEIGHTINGS {
            edited = self.edited(&values, &edited)?;
        }
        for editing in 1..=EDITINGS {
            if edited.iter().all(|weight| *weight == 0.0) {
                return Err(NoEstimate::Failed(format!(
                    "none of {} lines of sight is within {} σ of an orbit",
                    self.sights.len(),
                    self.outlier_sigma
                )));
            }
            let covariance = self.converge(&mut values, &edited)?;
            let again = self.edited(&values, &edited)?;
            if again == edited || editing == EDITINGS {
                return self.result(values, edited, covariance);
            }
            edited = again;
        }
        Err(NoEstimate::NoConvergence)
    }

    /// Returns weight 1 for each measurement within the gate, 0 for others.
    fn edited(&self, values: &[f64], weights: &[f64]) -> Result<Vec<f64>, NoEstimate> {
        let lengths = self.residuals(values, weights, &self.by_displacement(values)?)?.lengths;
        Ok(lengths.iter().map(|length| f64::from(*length <= self.outlier_sigma)).collect())
    }

    /// Returns weight 1 for each measurement that is within a gate of the orbit at `values`, whose parameters
    /// have a covariance, 0 for others. The measurements do not affect each other.
    fn within(&self, gate: f64, values: &[f64], covariance: &DMatrix<f64>) -> Result<Vec<f64>, NoEstimate> {
        let path = self.path(values).ok_or(NoEstimate::NoConvergence)?;
        let count = self.parameters.count();
        let displaced = self.by_displacement(values)?;
        let whitener = self.whitener(count + 1);
        let weight = |(sight, by_displacement): (&Sight, &[f64; 2])| {
            let mut rows = [vec![0.0; count + 1], vec![0.0; count + 1]];
            self.linearise(sight, &path, values, &mut rows)?;
            whitener.clone().apply(&row_errors(sight, 1.0, *by_displacement), &mut rows);
            let slopes = DMatrix::from_fn(2, count, |axis, column| rows[axis][column]);
            let residual = Vector2::new(rows[0][count], rows[1][count]);
            let variance =
                Matrix2::from_iterator((&slopes * covariance * slopes.transpose()).iter().copied());
            let inverse = (variance + Matrix2::identity()).try_inverse().ok_or(NoEstimate::NoConvergence)?;
            Ok(f64::from((residual.transpose() * inverse * residual).x <= gate * gate))
        };
        self.sights.iter().zip(&displaced).map(weight).collect()
    }

    /// Returns the covariance of the parameters without measurements.
    fn prior_covariance(&self, values: &[f64]) -> Result<DMatrix<f64>, NoEstimate> {
        Problem { sights: &[], ..*self }.covariance(values)
    }

    /// Iterates to the minimum; returns the covariance there.
    fn converge(&self, values: &mut Vec<f64>, weights: &[f64]) -> Result<DMatrix<f64>, NoEstimate> {
        let mut damping = 0.0;
        for _ in 0..ITERATIONS {
            let step = self.iterate(values, weights, &mut damping)?;
            if step.length < CONVERGED {
                return Ok(step.covariance);
            }
        }
        Err(NoEstimate::NoConvergence)
    }

    /// Returns the covariance at parameters, with all measurements.
    pub(crate) fn covariance(&self, values: &[f64]) -> Result<DMatrix<f64>, NoEstimate> {
        let weights = vec![1.0; self.sights.len()];
        self.equations(values, &weights, &self.by_displacement(values)?)?
            .covariance()
            .ok_or(NoEstimate::NoConvergence)
    }

    /// Returns the result at given parameters, with all measurements.
    pub(crate) fn at(&self, values: &[f64]) -> Result<Solution, NoEstimate> {
        let covariance = self.covariance(values)?;
        self.result(values.to_vec(), vec![1.0; self.sights.len()], covariance)
    }

    fn result(
        &self,
        values: Vec<f64>,
        weights: Vec<f64>,
        covariance: DMatrix<f64>,
    ) -> Result<Solution, NoEstimate> {
        let displaced = self.by_displacement(&values)?;
        let Residuals { cost, log_determinant, residuals, .. } =
            self.residuals(&values, &weights, &displaced)?;
        let cost = cost + log_determinant;
        let path = self.path(&values).ok_or(NoEstimate::NoConvergence)?;
        Ok(Solution { values, covariance, cost, weights, residuals, path })
    }

    /// Makes one step from `values`. The distances that turn displacements into angles remain those before
    /// the step: otherwise a longer distance would lower the sum of squares by larger residuals per σ.
    fn iterate(&self, values: &mut Vec<f64>, weights: &[f64], damping: &mut f64) -> Result<Step, NoEstimate> {
        let displaced = self.by_displacement(values)?;
        let mut root = self.equations(values, weights, &displaced)?;
        let old = self.residuals(values, weights, &displaced)?.cost;
        let covariance = root.covariance().ok_or(NoEstimate::NoConvergence)?;
        let sigmas = covariance.diagonal().map(f64::sqrt);
        loop {
            let step = root.solve(*damping).ok_or(NoEstimate::NoConvergence)?;
            let length = step.component_div(&sigmas).abs().max();
            let moved: Vec<f64> = values.iter().zip(step.iter()).map(|(value, step)| value + step).collect();
            let new =
                self.residuals(&moved, weights, &displaced).map_or(f64::INFINITY, |residuals| residuals.cost);
            // Rounding may raise the sum of squares by a step below the tolerance.
            if new <= old || (length < CONVERGED && new.is_finite()) {
                *values = moved;
                *damping = if *damping < 1e-6 { 0.0 } else { *damping * 0.1 };
                return Ok(Step { length, cost: new, covariance });
            }
            *damping = (*damping * 10.0).max(1e-4);
            if *damping > MAX_DAMPING {
                return Err(NoEstimate::NoConvergence);
            }
        }
    }

    /// Returns the relative elements over time.
    pub(crate) fn path(&self, values: &[f64]) -> Option<Path> {
        let impulses = self.parameters.impulses(values);
        Path::new(&PathSetup {
            reference: self.reference,
            elements: self.parameters.elements(values),
            drag_m_s: self.parameters.drag_m_s(values),
            drag_column: self.parameters.drag.1,
            impulses: &impulses,
            parameters: self.parameters.count(),
        })
    }

    fn whitener(&self, columns: usize) -> Whitener {
        let is_present = |class: &ErrorClass| self.sights.iter().any(|sight| sight.class == *class);
        let classes: Vec<ErrorClass> = ErrorClass::ALL.into_iter().filter(is_present).collect();
        Whitener::new(&self.setup.errors, &classes, columns)
    }

    /// Returns the derivatives of the angles of each measurement with respect to a displacement of the
    /// target, rad/m.
    fn by_displacement(&self, values: &[f64]) -> Result<Vec<[f64; 2]>, NoEstimate> {
        if self.setup.errors.displacements.is_empty() {
            return Ok(vec![[0.0; 2]; self.sights.len()]);
        }
        let path = self.path(values).ok_or(NoEstimate::NoConvergence)?;
        let slopes = |sight: &Sight| {
            let elements = path.at(sight.seconds).ok_or(NoEstimate::NoConvergence)?;
            Ok(sight.predict(&elements, self.reference.osculation()).by_displacement())
        };
        self.sights.iter().map(slopes).collect()
    }

    /// Returns the logarithm of the determinant of the covariance of the measurements, relative to that of
    /// their white errors.
    fn log_determinant(&self, values: &[f64]) -> Result<f64, NoEstimate> {
        let weights = vec![1.0; self.sights.len()];
        Ok(self.residuals(values, &weights, &self.by_displacement(values)?)?.log_determinant)
    }

    /// Returns the linearised equations, prior included.
    fn equations(
        &self,
        values: &[f64],
        weights: &[f64],
        displaced: &[[f64; 2]],
    ) -> Result<SquareRoot, NoEstimate> {
        let path = self.path(values).ok_or(NoEstimate::NoConvergence)?;
        let count = self.parameters.count();
        let mut whitener = self.whitener(count + 1);
        let mut root = SquareRoot::new(count);
        let mut rows = [vec![0.0; count + 1], vec![0.0; count + 1]];
        for ((sight, weight), by_displacement) in self.sights.iter().zip(weights).zip(displaced) {
            if *weight == 0.0 {
                continue;
            }
            self.linearise(sight, &path, values, &mut rows)?;
            whitener.apply(&row_errors(sight, *weight, *by_displacement), &mut rows);
            rows.iter().for_each(|row| root.add(row));
        }
        self.parameters.prior_rows(values).iter().for_each(|row| root.add(row));
        Ok(root)
    }

    /// Writes the linearised equations [A | b] of a measurement, rad, one row per angle.
    fn linearise(
        &self,
        sight: &Sight,
        path: &Path,
        values: &[f64],
        rows: &mut [Vec<f64>; 2],
    ) -> Result<(), NoEstimate> {
        let osculation = self.reference.osculation();
        let elements = path.at(sight.seconds).ok_or(NoEstimate::NoConvergence)?;
        let prediction = sight.predict(&elements, osculation);
        let by_elements = sight.by_elements(&elements, &prediction, osculation);
        let by_rotation = prediction.by_rotation();
        let residual = self.residual(sight, &prediction, &by_rotation, values);
        for (axis, row) in rows.iter_mut().enumerate() {
            row.fill(0.0);
            let by_elements = [0, 1, 2, 3, 4, 5].map(|k| by_elements[(axis, k)]);
            path.pull_back(sight.seconds, &by_elements, row);
            for (k, column) in self.parameters.bias(sight.class).iter().enumerate() {
                if let Some(column) = column {
                    row[*column] += by_rotation[(axis, k)];
                }
            }
            if let Some(right) = row.last_mut() {
                *right = residual[axis];
            }
        }
        Ok(())
    }

    /// Returns measured minus predicted angles without the constant rotation in `values`, rad.
    fn residual(
        &self,
        sight: &Sight,
        prediction: &Prediction,
        by_rotation: &Matrix2x3<f64>,
        values: &[f64],
    ) -> [f64; 2] {
        let rotation = self.parameters.bias(sight.class).map(|column| column.map_or(0.0, |k| values[k]));
        let angles = by_rotation * Vector3::from(rotation);
        let residual = sight.residual(prediction);
        [0, 1].map(|axis| residual[axis] - angles[axis])
    }

    /// Returns the residuals. The length of a residual is that of a measurement of full weight, but a
    /// measurement affects later ones by its own weight.
    fn residuals(
        &self,
        values: &[f64],
        weights: &[f64],
        displaced: &[[f64; 2]],
    ) -> Result<Residuals, NoEstimate> {
        let osculation = self.reference.osculation();
        let path = self.path(values).ok_or(NoEstimate::NoConvergence)?;
        let mut whitener = self.whitener(1);
        let count = self.parameters.count();
        let prior = self.parameters.prior_rows(values);
        let mut cost: f64 = prior.iter().map(|row| row[count] * row[count]).sum();
        let mut log_determinant = 0.0;
        let mut lengths = Vec::with_capacity(self.sights.len());
        let mut residuals = Vec::with_capacity(self.sights.len());
        let mut rows = [vec![0.0], vec![0.0]];
        for ((sight, weight), by_displacement) in self.sights.iter().zip(weights).zip(displaced) {
            let elements = path.at(sight.seconds).ok_or(NoEstimate::NoConvergence)?;
            let prediction = sight.predict(&elements, osculation);
            let residual = self.residual(sight, &prediction, &prediction.by_rotation(), values);
            residuals.push(residual);
            rows.iter_mut().zip(residual).for_each(|(row, value)| row[0] = value);
            if *weight < 1.0 {
                let mut of_full_weight = rows.clone();
                whitener.clone().apply(&row_errors(sight, 1.0, *by_displacement), &mut of_full_weight);
                lengths.push(squared(&of_full_weight).sqrt());
            }
            if *weight > 0.0 {
                log_determinant += whitener.apply(&row_errors(sight, *weight, *by_displacement), &mut rows);
                cost += squared(&rows);
            }
            if *weight >= 1.0 {
                lengths.push(squared(&rows).sqrt());
            }
        }
        if cost.is_finite() {
            Ok(Residuals { cost, log_determinant, lengths, residuals })
        } else {
            Err(NoEstimate::NoConvergence)
        }
    }
}

impl Solution {
    /// Returns the estimate at an epoch.
    pub(crate) fn estimate(&self, time: Epoch, epoch: Epoch, reference: &Reference) -> Answer {
        let seconds = seconds_between(epoch, time);
        let chaser = reference.orbit(seconds).ok_or(NoEstimate::NoChaserOrbit)?;
        let elements = self.path.at(seconds).ok_or(NoEstimate::NoChaserOrbit)?;
        let sensitivity = self.path.sensitivity_at(seconds).ok_or(NoEstimate::NoChaserOrbit)?;
        let product = &sensitivity * &self.covariance * sensitivity.transpose();
        let covariance = Matrix6::from_iterator(product.iter().copied());
        let accuracy = reference.relative_accuracy(seconds);
        relative_state::estimate(time, &elements, &covariance, &chaser, reference.osculation(), accuracy)
    }
}

fn squared(rows: &[Vec<f64>; 2]) -> f64 {
    rows.iter().flatten().map(|value| value * value).sum()
}

fn row_errors(sight: &Sight, weight: f64, by_displacement: [f64; 2]) -> RowErrors {
    let (seconds, class) = (sight.seconds, sight.class);
    RowErrors { seconds, class, noise: sight.noise.map(|x| x / weight), by_displacement }
}

/// Huber's weights of measurements with whitened residuals of these lengths, scaled by their median, which is
/// at least that of unit errors.
fn huber(lengths: &[f64]) -> Vec<f64> {
    let mut sorted = lengths.to_vec();
    sorted.sort_by(f64::total_cmp);
    let median = sorted.get(sorted.len() / 2).copied().unwrap_or(RAYLEIGH_MEDIAN);
    let limit = HUBER * (median / RAYLEIGH_MEDIAN).max(1.0);
    lengths.iter().map(|length| if *length > limit { limit / length } else { 1.0 }).collect()
}
