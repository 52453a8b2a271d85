//! Parameters of the batch estimation: their order, their prior.

use contract::navigation::{ManoeuvreReport, NavigationSetup, PriorOrbit, RelativeElements};
use nalgebra::{Matrix6, Vector3, Vector6};

use crate::config::ModelErrors;
use crate::path::EstimatedImpulse;
use crate::sight::{ErrorClass, radians_from_arcsec};
use crate::time::seconds_between;

/// Seconds per day.
pub(crate) const DAY_S: f64 = 86_400.0;

/// Standard deviation of elements without a prior, m: no information in practice.
const DIFFUSE_M: f64 = 1e6;

/// Largest number of stochastic impulses.
const MAX_PULSES: f64 = 200.0;

/// Order and prior of the parameters.
#[derive(Debug, Clone)]
pub(crate) struct Parameters {
    /// Prior of the elements, parameters 0 to 5.
    orbit: Option<PriorOrbit>,
    /// Rate of aδa: expected value, m/s, and index.
    pub(crate) drag: (f64, Option<usize>),
    /// Index of the constant rotations of each class of errors.
    bias: [[Option<usize>; 3]; 2],
    /// Impulses with expected values, in order of time.
    impulses: Vec<EstimatedImpulse>,
    /// Standard deviations of the parameters from 6 on.
    sigmas: Vec<f64>,
}

impl Parameters {
    /// Orders the parameters of a setup. `span_s` are the times of the first and last measurement.
    pub(crate) fn new(
        setup: &NavigationSetup,
        manoeuvres: &[ManoeuvreReport],
        model_errors: Option<ModelErrors>,
        span_s: (f64, f64),
    ) -> Self {
        let mut sigmas = Vec::new();
        let mut column = |sigma: f64| {
            (sigma > 0.0).then(|| {
                sigmas.push(sigma);
                5 + sigmas.len()
            })
        };
        let drag = (setup.drag.a_da_rate_m_per_day / DAY_S, column(setup.drag.sigma_m_per_day / DAY_S));
        let mut bias = |arcsec: [f64; 3]| arcsec.map(|sigma| column(radians_from_arcsec(sigma)));
        let bias =
            [bias(setup.errors.with_stars.constant_arcsec), bias(setup.errors.without_stars.constant_arcsec)];
        let mut impulses: Vec<EstimatedImpulse> = manoeuvres
            .iter()
            .map(|manoeuvre| EstimatedImpulse {
                seconds: seconds_between(setup.epoch, manoeuvre.time),
                dv_m_s: manoeuvre.dv_rtn_m_s,
                columns: [0, 1, 2].map(|axis| column(manoeuvre.sigma_rtn_m_s[axis])),
            })
            .collect();
        if let Some(ModelErrors { interval_s, sigma_rtn_m_s }) = model_errors {
            let (first, last) = (span_s.0.min(0.0), span_s.1.max(0.0));
            let interval_s = interval_s.max((last - first) / MAX_PULSES);
            let count = ((last - first) / interval_s).floor() as usize;
            impulses.extend((0..count).map(|k| EstimatedImpulse {
                seconds: first + interval_s * (k as f64 + 0.5),
                dv_m_s: Vector3::zeros(),
                columns: sigma_rtn_m_s.map(&mut column),
            }));
        }
        impulses.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        Self { orbit: setup.prior, drag, bias, impulses, sigmas }
    }

    /// Returns the same parameters with another prior of the elements.
    pub(crate) fn with_orbit(&self, orbit: Option<PriorOrbit>) -> Self {
        Self { orbit, ..self.clone() }
    }

    /// Number of parameters.
    pub(crate) fn count(&self) -> usize {
        6 + self.sigmas.len()
    }

    /// Returns the elements of a parameter vector.
    pub(crate) fn elements(&self, values: &[f64]) -> RelativeElements {
        RelativeElements::from_vector(&Vector6::from_iterator(values.iter().take(6).copied()))
    }

    /// Returns the rate of aδa, m/s.
    pub(crate) fn drag_m_s(&self, values: &[f64]) -> f64 {
        self.drag.0 + self.drag.1.map_or(0.0, |column| values[column])
    }

    /// Returns the impulses with their corrections.
    pub(crate) fn impulses(&self, values: &[f64]) -> Vec<EstimatedImpulse> {
        let corrected = |impulse: &EstimatedImpulse| {
            let correction = impulse.columns.map(|column| column.map_or(0.0, |column| values[column]));
            EstimatedImpulse { dv_m_s: impulse.dv_m_s + Vector3::from(correction), ..*impulse }
        };
        self.impulses.iter().map(corrected).collect()
    }

    /// Returns the index of each constant rotation of a class.
    pub(crate) fn bias(&self, class: ErrorClass) -> [Option<usize>; 3] {
        match class {
            ErrorClass::WithStars => self.bias[0],
            ErrorClass::WithoutStars => self.bias[1],
        }
    }

    /// Returns the rows of the prior [A | b] for a correction of `values`, with unit errors.
    pub(crate) fn prior_rows(&self, values: &[f64]) -> Vec<Vec<f64>> {
        let count = self.count();
        let (mean, covariance) = match &self.orbit {
            Some(prior) => (prior.elements.vector(), *prior.covariance.matrix()),
            None => (Vector6::zeros(), Matrix6::identity() * (DIFFUSE_M * DIFFUSE_M)),
        };
        // C = L Lᵀ; the rows of L⁻¹ have unit errors. `Covariance6` is positive definite.
        let factor = covariance.cholesky().map(|factor| factor.l()).unwrap_or_else(Matrix6::identity);
        let inverse = factor.solve_lower_triangular(&Matrix6::identity()).unwrap_or_else(Matrix6::identity);
        let offset = mean - self.elements(values).vector();
        let right = inverse * offset;
        let of_elements = (0..6).map(|k| {
            let mut row = vec![0.0; count + 1];
            (0..6).for_each(|column| row[column] = inverse[(k, column)]);
            row[count] = right[k];
            row
        });
        let of_others = self.sigmas.iter().enumerate().map(|(k, sigma)| {
            let mut row = vec![0.0; count + 1];
            row[6 + k] = 1.0 / sigma;
            row[count] = -values[6 + k] / sigma;
            row
        });
        of_elements.chain(of_others).collect()
    }
}
