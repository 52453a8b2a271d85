//! Weighted nonlinear least squares over the parameters of a campaign.
//!
//! Gauss–Newton with Marquardt's damping, in square-root form, over rows whose slow errors are whitened
//! ([`crate::whitener`]). A coarse stage on a part of the measurements weights large residuals down (Huber
//! 1964, Ann. Math. Stat. 35, 73, scaled by the median) and proceeds from the first hours to the whole
//! campaign; the fine stage uses all, and edits those whose innovation is beyond a gate, until the set is
//! stable.

use contract::navigation::{Answer, NavigationSetup, NoEstimate, RelativeElements};
use hifitime::Epoch;
use nalgebra::{DMatrix, Matrix6};

use crate::parameters::Parameters;
use crate::path::{Path, PathSetup};
use crate::reference::Reference;
use crate::relative_state;
use crate::sight::{ErrorClass, Sight};
use crate::square_root::SquareRoot;
use crate::time::seconds_between;
use crate::whitener::Whitener;

/// Largest number of measurements of a coarse stage.
const COARSE: usize = 1000;

/// Fractions of the campaign that the coarse stages use, one after the other.
const PARTS: [f64; 5] = [0.06, 0.15, 0.35, 0.65, 1.0];

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
    /// Sum of squares at the minimum, prior included.
    pub(crate) cost: f64,
    /// Weight of each measurement: 1 used, 0 edited.
    pub(crate) weights: Vec<f64>,
    /// Measured minus predicted angles of each measurement, rad, without its bias.
    pub(crate) residuals: Vec<[f64; 2]>,
    /// Relative elements over time.
    pub(crate) path: Path,
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
        for part in PARTS {
            let end = self.sights.partition_point(|sight| sight.seconds <= first + part * (last - first));
            let chosen = &self.sights[..end.max(1)];
            let stride = chosen.len().div_ceil(COARSE);
            let coarse: Vec<Sight> = chosen.iter().step_by(stride).cloned().collect();
            Problem { sights: &coarse, ..*self }.robust(&mut values)?;
        }
        self.fine(values)
    }

    /// Iterates with Huber's weights; returns the sum of squares.
    pub(crate) fn robust(&self, values: &mut Vec<f64>) -> Result<f64, NoEstimate> {
        let all = vec![1.0; self.sights.len()];
        let mut damping = 0.0;
        let mut cost = f64::INFINITY;
        for iteration in 0..ITERATIONS {
            let weights = huber(&self.residuals(values, &all)?.lengths);
            let step = self.iterate(values, &weights, &mut damping, None)?;
            cost = step.cost;
            if step.length < CONVERGED && iteration > 0 {
                break;
            }
        }
        Ok(cost)
    }

    fn fine(&self, mut values: Vec<f64>) -> Result<Solution, NoEstimate> {
        let all = vec![1.0; self.sights.len()];
        let mut edited = self.edited(&values, &all)?;
        for editing in 1..=EDITINGS {
            if edited.iter().all(|weight| *weight == 0.0) {
                return Err(NoEstimate::NoMeasurements);
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
        let lengths = self.residuals(values, weights)?.lengths;
        Ok(lengths.iter().map(|length| f64::from(*length <= self.outlier_sigma)).collect())
    }

    /// Iterates to the minimum; returns the covariance there.
    fn converge(&self, values: &mut Vec<f64>, weights: &[f64]) -> Result<DMatrix<f64>, NoEstimate> {
        let mut damping = 0.0;
        let mut cost = None;
        for _ in 0..ITERATIONS {
            let step = self.iterate(values, weights, &mut damping, cost)?;
            if step.length < CONVERGED {
                return Ok(step.covariance);
            }
            cost = Some(step.cost);
        }
        Err(NoEstimate::NoConvergence)
    }

    /// Returns the covariance at parameters, with all measurements.
    pub(crate) fn covariance(&self, values: &[f64]) -> Result<DMatrix<f64>, NoEstimate> {
        let weights = vec![1.0; self.sights.len()];
        self.equations(values, &weights)?.covariance().ok_or(NoEstimate::NoConvergence)
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
        let Residuals { cost, residuals, .. } = self.residuals(&values, &weights)?;
        let path = self.path(&values).ok_or(NoEstimate::NoConvergence)?;
        Ok(Solution { values, covariance, cost, weights, residuals, path })
    }

    /// Makes one step from `values`, where the sum of squares is `cost` if known.
    fn iterate(
        &self,
        values: &mut Vec<f64>,
        weights: &[f64],
        damping: &mut f64,
        cost: Option<f64>,
    ) -> Result<Step, NoEstimate> {
        let mut root = self.equations(values, weights)?;
        let old = match cost {
            Some(cost) => cost,
            None => self.residuals(values, weights)?.cost,
        };
        let covariance = root.covariance().ok_or(NoEstimate::NoConvergence)?;
        let sigmas = covariance.diagonal().map(f64::sqrt);
        loop {
            let step = root.solve(*damping).ok_or(NoEstimate::NoConvergence)?;
            let length = step.component_div(&sigmas).abs().max();
            let moved: Vec<f64> = values.iter().zip(step.iter()).map(|(value, step)| value + step).collect();
            let new = self.residuals(&moved, weights).map_or(f64::INFINITY, |residuals| residuals.cost);
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

    fn whiteners(&self, columns: usize) -> [Whitener; 2] {
        let errors = &self.setup.errors;
        [&errors.with_stars, &errors.without_stars].map(|errors| Whitener::new(errors, columns))
    }

    /// Returns the linearised equations, prior included.
    fn equations(&self, values: &[f64], weights: &[f64]) -> Result<SquareRoot, NoEstimate> {
        let osculation = self.reference.osculation();
        let path = self.path(values).ok_or(NoEstimate::NoConvergence)?;
        let count = self.parameters.count();
        let mut whiteners = self.whiteners(count + 1);
        let mut root = SquareRoot::new(count);
        let mut rows = [vec![0.0; count + 1], vec![0.0; count + 1]];
        for (sight, weight) in self.sights.iter().zip(weights) {
            if *weight == 0.0 {
                continue;
            }
            let elements = path.at(sight.seconds).ok_or(NoEstimate::NoConvergence)?;
            let prediction = sight.predict(&elements, osculation);
            let by_elements = sight.by_elements(&elements, &prediction, osculation);
            let by_rotation = prediction.by_rotation();
            let bias = self.parameters.bias(sight.class);
            let residual = sight.residual(&prediction);
            for (axis, row) in rows.iter_mut().enumerate() {
                row.fill(0.0);
                let by_elements = [0, 1, 2, 3, 4, 5].map(|k| by_elements[(axis, k)]);
                path.pull_back(sight.seconds, &by_elements, row);
                row[count] = residual[axis];
                for (k, column) in bias.iter().enumerate() {
                    if let Some(column) = column {
                        row[*column] += by_rotation[(axis, k)];
                        row[count] -= by_rotation[(axis, k)] * values[*column];
                    }
                }
            }
            whitener(&mut whiteners, sight.class).apply(
                sight.seconds,
                sight.noise.map(|x| x / weight),
                &mut rows,
            );
            rows.iter().for_each(|row| root.add(row));
        }
        self.parameters.prior_rows(values).iter().for_each(|row| root.add(row));
        Ok(root)
    }

    /// Returns the residuals. A measurement of weight 0 has a residual and no effect on others.
    fn residuals(&self, values: &[f64], weights: &[f64]) -> Result<Residuals, NoEstimate> {
        let osculation = self.reference.osculation();
        let path = self.path(values).ok_or(NoEstimate::NoConvergence)?;
        let mut whiteners = self.whiteners(1);
        let count = self.parameters.count();
        let prior = self.parameters.prior_rows(values);
        let mut cost: f64 = prior.iter().map(|row| row[count] * row[count]).sum();
        let mut lengths = Vec::with_capacity(self.sights.len());
        let mut residuals = Vec::with_capacity(self.sights.len());
        let mut rows = [vec![0.0], vec![0.0]];
        for (sight, weight) in self.sights.iter().zip(weights) {
            let elements = path.at(sight.seconds).ok_or(NoEstimate::NoConvergence)?;
            let prediction = sight.predict(&elements, osculation);
            let mut residual = sight.residual(&prediction);
            let by_rotation = prediction.by_rotation();
            for (k, column) in self.parameters.bias(sight.class).iter().enumerate() {
                if let Some(column) = column {
                    (0..2).for_each(|axis| residual[axis] -= by_rotation[(axis, k)] * values[*column]);
                }
            }
            residuals.push(residual);
            rows.iter_mut().zip(residual).for_each(|(row, value)| row[0] = value);
            let whitener = whitener(&mut whiteners, sight.class);
            if *weight > 0.0 {
                whitener.apply(sight.seconds, sight.noise.map(|x| x / weight), &mut rows);
                let squared: f64 = rows.iter().map(|row| row[0] * row[0]).sum();
                cost += squared;
                lengths.push(squared.sqrt());
            } else {
                whitener.clone().apply(sight.seconds, sight.noise, &mut rows);
                lengths.push(rows.iter().map(|row| row[0] * row[0]).sum::<f64>().sqrt());
            }
        }
        if cost.is_finite() {
            Ok(Residuals { cost, lengths, residuals })
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

fn whitener(whiteners: &mut [Whitener; 2], class: ErrorClass) -> &mut Whitener {
    match class {
        ErrorClass::WithStars => &mut whiteners[0],
        ErrorClass::WithoutStars => &mut whiteners[1],
    }
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
