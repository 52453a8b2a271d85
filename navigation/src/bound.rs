//! Posterior Cramér–Rao bound and observability of a campaign.
//!
//! For Gaussian errors and prior, the covariance of any unbiased estimator of the parameters is at least the
//! inverse of the sum of the prior's information and JᵀC⁻¹J, with the Jacobian J at the truth and the full
//! covariance C of the measurements, slow errors included (Van Trees, *Detection, Estimation, and Modulation
//! Theory I*, 1968, section 2.4; for a sequence of measurements Tichavský, Muravchik, Nehorai 1998, IEEE
//! Trans. SP 46, 1386). The bound of a filter at an epoch uses the measurements until then, that of a batch
//! all of them.

use contract::ContractError;
use contract::navigation::{
    Answer, Event, LineOfSightMeasurement, ManoeuvreReport, NavigationSetup, NoEstimate, RelativeElements,
};
use hifitime::Epoch;
use nalgebra::DMatrix;

use crate::config::BatchConfig;
use crate::parameters::Parameters;
use crate::problem::{Problem, Solution};
use crate::reference::{Impulse, Reference};
use crate::sight::Sight;
use crate::time::seconds_between;

/// Linearisation of a campaign about its truth.
#[derive(Debug)]
pub struct Bound {
    setup: NavigationSetup,
    reference: Reference,
    parameters: Parameters,
    sights: Vec<Sight>,
    values: Vec<f64>,
}

/// Determination of the relative orbit by a campaign, its prior apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observability {
    /// Condition number of the information on the six elements, each scaled to unit information: 1 if the
    /// elements are determined independently; above 1e8, one combination of them is practically unknown.
    pub condition: f64,
    /// σ of the along-track distance aδλ at the epoch from the measurements alone, relative to aδλ; infinite
    /// if it is undetermined.
    pub range_sigma: f64,
}

impl Bound {
    /// Linearises a campaign about true elements and true manoeuvres. Of each measurement, time, attitude and
    /// covariance count, not the direction.
    ///
    /// # Errors
    /// [`ContractError`] for a number outside its range, an unsupported orbit, or no usable measurement.
    pub fn new(
        setup: &NavigationSetup,
        config: &BatchConfig,
        events: &[Event],
        truth: &RelativeElements,
    ) -> Result<Self, ContractError> {
        setup.check()?;
        config.check()?;
        let refused = |reason: &str| ContractError::CannotBuild {
            pipeline: "bound".to_owned(),
            reason: reason.to_owned(),
        };
        let mut manoeuvres: Vec<ManoeuvreReport> = Vec::new();
        let mut measurements: Vec<LineOfSightMeasurement> = Vec::new();
        for event in events {
            match event {
                Event::Manoeuvre(manoeuvre) => {
                    manoeuvre.check()?;
                    manoeuvres.push(*manoeuvre);
                }
                Event::LineOfSight(measurement) => measurements.push(*measurement),
            }
        }
        manoeuvres.sort_by_key(|manoeuvre| manoeuvre.time);
        measurements.sort_by_key(|measurement| (measurement.time, measurement.frame));
        let impulses: Vec<Impulse> = manoeuvres
            .iter()
            .map(|manoeuvre| Impulse {
                seconds: seconds_between(setup.epoch, manoeuvre.time),
                dv_m_s: manoeuvre.dv_rtn_m_s,
            })
            .collect();
        let reference = Reference::new(&setup.chaser_orbit, setup.epoch, &impulses, config.osculation)
            .ok_or_else(|| refused("the chaser's orbit is not supported"))?;
        let sights: Vec<Sight> = measurements
            .iter()
            .filter_map(|measurement| Sight::new(measurement, setup.epoch, &setup.errors, &reference).ok())
            .collect();
        let (Some(first), Some(last)) = (sights.first(), sights.last()) else {
            return Err(refused("no measurement is usable"));
        };
        let span_s = (first.seconds, last.seconds);
        let parameters = Parameters::new(setup, &manoeuvres, config.model_errors, span_s);
        let mut values = vec![0.0; parameters.count()];
        values.iter_mut().zip(truth.vector().iter()).for_each(|(value, x)| *value = *x);
        Ok(Self { setup: setup.clone(), reference, parameters, sights, values })
    }

    /// Returns the true state with the bound of its covariance at each epoch, from all measurements.
    pub fn of_batch(&self, epochs: &[Epoch]) -> Vec<Answer> {
        let solution = self.solution(&self.sights);
        epochs.iter().map(|epoch| self.answer(solution.as_ref(), *epoch)).collect()
    }

    /// Returns the true state with the bound of its covariance at each epoch, from the measurements until
    /// then.
    pub fn of_filter(&self, epochs: &[Epoch]) -> Vec<Answer> {
        let until = |epoch: &Epoch| {
            let seconds = seconds_between(self.setup.epoch, *epoch);
            let end = self.sights.partition_point(|sight| sight.seconds <= seconds);
            self.answer(self.solution(&self.sights[..end]).as_ref(), *epoch)
        };
        epochs.iter().map(until).collect()
    }

    /// Returns how well the measurements and manoeuvres determine the relative orbit without its prior.
    pub fn observability(&self) -> Observability {
        let parameters = self.parameters.with_orbit(None);
        let unknown = Observability { condition: f64::INFINITY, range_sigma: f64::INFINITY };
        let problem = self.problem(&self.sights, &parameters);
        let Ok(covariance) = problem.covariance(&self.values) else { return unknown };
        let of_elements: DMatrix<f64> = covariance.view((0, 0), (6, 6)).into_owned();
        // The diffuse prior of the elements bounds an undetermined σ; as the scale of a million metres it is
        // far beyond the distances of the grid of initial orbits.
        let sigmas = of_elements.diagonal().map(f64::sqrt);
        let Some(information) = of_elements.clone().try_inverse() else { return unknown };
        let scale = information.diagonal().map(|x| 1.0 / x.max(f64::MIN_POSITIVE).sqrt());
        let scaled = DMatrix::from_fn(6, 6, |i, j| information[(i, j)] * scale[i] * scale[j]);
        let eigenvalues = scaled.symmetric_eigenvalues();
        let (low, high) = (eigenvalues.min(), eigenvalues.max());
        let condition = if low > 0.0 { high / low } else { f64::INFINITY };
        let range_sigma = sigmas[1] / self.values[1].abs().max(f64::MIN_POSITIVE);
        Observability { condition, range_sigma }
    }

    fn problem<'a>(&'a self, sights: &'a [Sight], parameters: &'a Parameters) -> Problem<'a> {
        let (setup, reference) = (&self.setup, &self.reference);
        Problem { setup, reference, sights, parameters, outlier_sigma: f64::INFINITY }
    }

    fn solution(&self, sights: &[Sight]) -> Result<Solution, NoEstimate> {
        self.problem(sights, &self.parameters).at(&self.values)
    }

    fn answer(&self, solution: Result<&Solution, &NoEstimate>, epoch: Epoch) -> Answer {
        match solution {
            Ok(solution) => solution.estimate(epoch, self.setup.epoch, &self.reference),
            Err(reason) => Err(reason.clone()),
        }
    }
}
