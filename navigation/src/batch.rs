//! Batch navigator: one weighted least squares over all events.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use contract::ContractError;
use contract::navigation::{
    Answer, Disposition, Event, LineOfSightMeasurement, ManoeuvreReport, Mode, NavigationSetup, Navigator,
    NavigatorFactory, NoEstimate, Use,
};
use hifitime::Epoch;

use crate::config::BatchConfig;
use crate::initial::{self, Hypothesis};
use crate::parameters::Parameters;
use crate::problem::{Problem, Solution};
use crate::reference::{Impulse, Reference};
use crate::sight::Sight;
use crate::time::seconds_between;

/// Builds batch navigators.
#[derive(Debug, Clone, Default)]
pub struct BatchFactory {
    /// Parameters.
    pub config: BatchConfig,
}

impl NavigatorFactory for BatchFactory {
    fn name(&self) -> String {
        "batch".to_owned()
    }

    fn mode(&self) -> Mode {
        Mode::Batch
    }

    fn build(&self, setup: &NavigationSetup) -> Result<Box<dyn Navigator>, ContractError> {
        Ok(Box::new(Batch::new(setup, &self.config)?))
    }
}

/// Batch least squares over relative elements at the epoch, differential drag, constant errors of the lines
/// of sight, errors of manoeuvres, and optionally stochastic impulses.
#[derive(Debug, Clone)]
pub struct Batch {
    setup: NavigationSetup,
    config: BatchConfig,
    measurements: Vec<LineOfSightMeasurement>,
    manoeuvres: Vec<ManoeuvreReport>,
    /// Result for the events received so far.
    estimation: Option<Estimation>,
}

/// Result of a batch with its input.
#[derive(Debug, Clone)]
struct Estimation {
    result: Result<(Solution, Reference), NoEstimate>,
    hypotheses: Vec<Hypothesis>,
    dispositions: Vec<Disposition>,
}

impl Batch {
    /// Creates a navigator.
    ///
    /// # Errors
    /// [`ContractError::OutOfRange`] for a number outside its range.
    pub fn new(setup: &NavigationSetup, config: &BatchConfig) -> Result<Self, ContractError> {
        setup.check()?;
        config.check()?;
        Ok(Self {
            setup: setup.clone(),
            config: config.clone(),
            measurements: Vec::new(),
            manoeuvres: Vec::new(),
            estimation: None,
        })
    }

    /// Returns the hypotheses of the initial orbit determination, the best first; empty with a prior.
    pub fn hypotheses(&mut self) -> Vec<Hypothesis> {
        self.estimation().hypotheses.clone()
    }

    fn estimation(&mut self) -> &Estimation {
        let (setup, config) = (&self.setup, &self.config);
        let (measurements, manoeuvres) = (&self.measurements, &mut self.manoeuvres);
        self.estimation.get_or_insert_with(|| {
            manoeuvres.sort_by_key(|manoeuvre| manoeuvre.time);
            Estimation::new(setup, config, measurements, manoeuvres)
        })
    }
}

impl Navigator for Batch {
    fn receive(&mut self, event: &Event) {
        match event {
            Event::LineOfSight(measurement) => self.measurements.push(*measurement),
            Event::Manoeuvre(manoeuvre) => {
                // A report that repeats another is the same manoeuvre.
                if manoeuvre.check().is_ok() && !self.manoeuvres.contains(manoeuvre) {
                    self.manoeuvres.push(*manoeuvre);
                }
            }
        }
        self.estimation = None;
    }

    fn estimates(&mut self, epochs: &[Epoch]) -> Vec<Answer> {
        let epoch = self.setup.epoch;
        let result = &self.estimation().result;
        let answer = |time: &Epoch| match result {
            Ok((solution, reference)) => solution.estimate(*time, epoch, reference),
            Err(reason) => Err(reason.clone()),
        };
        epochs.iter().map(answer).collect()
    }

    fn dispositions(&mut self) -> Vec<Disposition> {
        self.estimation().dispositions.clone()
    }
}

impl Estimation {
    fn new(
        setup: &NavigationSetup,
        config: &BatchConfig,
        measurements: &[LineOfSightMeasurement],
        manoeuvres: &[ManoeuvreReport],
    ) -> Self {
        let impulses: Vec<Impulse> = manoeuvres
            .iter()
            .map(|manoeuvre| Impulse {
                seconds: seconds_between(setup.epoch, manoeuvre.time),
                dv_m_s: manoeuvre.dv_rtn_m_s,
            })
            .collect();
        let disposition = |measurement: &LineOfSightMeasurement| Disposition {
            frame: measurement.frame,
            time: measurement.time,
            used: Use::Waiting,
            residual_rad: None,
        };
        let mut dispositions: Vec<Disposition> = measurements.iter().map(disposition).collect();
        let failed =
            |reason, dispositions| Self { result: Err(reason), hypotheses: Vec::new(), dispositions };
        let reference = Reference::new(&setup.chaser_orbit, setup.epoch, &impulses, config.osculation);
        let Some(reference) = reference else {
            return failed(NoEstimate::NoChaserOrbit, dispositions);
        };
        // In order of time and frame; the first of duplicates counts.
        let mut sights: BTreeMap<(Epoch, u64), (usize, Sight)> = BTreeMap::new();
        for (index, measurement) in measurements.iter().enumerate() {
            let key = (measurement.time, measurement.frame);
            dispositions[index].used = match sights.entry(key) {
                Entry::Occupied(_) => Use::Duplicate,
                Entry::Vacant(vacant) => {
                    match Sight::new(measurement, setup.epoch, &setup.errors, &reference) {
                        Ok(sight) => {
                            vacant.insert((index, sight));
                            Use::Waiting
                        }
                        Err(used) => used,
                    }
                }
            };
        }
        let (indices, sights): (Vec<usize>, Vec<Sight>) = sights.into_values().unzip();
        let (Some(first), Some(last)) = (sights.first(), sights.last()) else {
            return failed(NoEstimate::NoMeasurements, dispositions);
        };
        let span_s = (first.seconds, last.seconds);
        let parameters = Parameters::new(setup, manoeuvres, config.model_errors, span_s);
        let problem = Problem {
            setup,
            reference: &reference,
            sights: &sights,
            parameters: &parameters,
            outlier_sigma: config.outlier_sigma,
        };
        let (start, hypotheses) = match &setup.prior {
            Some(prior) => (Ok(prior.elements), Vec::new()),
            None => match initial::hypotheses(&problem) {
                Ok(hypotheses) => {
                    let best = hypotheses.first().map(|hypothesis| hypothesis.elements);
                    (best.ok_or(NoEstimate::NoInitialOrbit), hypotheses)
                }
                Err(reason) => (Err(reason), Vec::new()),
            },
        };
        let result = start.and_then(|start| problem.solve(&start));
        if let Ok(solution) = &result {
            for ((index, weight), residual) in indices.iter().zip(&solution.weights).zip(&solution.residuals)
            {
                dispositions[*index].used = if *weight > 0.0 { Use::Used } else { Use::Outlier };
                dispositions[*index].residual_rad = Some(*residual);
            }
        }
        Self { result: result.map(|solution| (solution, reference)), hypotheses, dispositions }
    }
}
