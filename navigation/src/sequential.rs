//! Sequential navigator: a Kalman filter over events in order of time, which linearises its past again
//! ([`crate::history`]) and inserts late events.
//!
//! - An event later than all before is processed at once.
//! - An earlier measurement within the buffer is inserted at its time, and all later events are processed
//!   again: the result is that of the events in order. So is a manoeuvre anywhere in the history.
//! - A measurement before the buffer is not used. A manoeuvre before the history changes the state by its
//!   linear effect.
//! - The chaser's orbit at an event is fitted to states until then, because those after an impulse that is
//!   not reported yet would bend it.
//! - Without a prior, measurements wait until a batch over them determines the range to 30 %; the filter then
//!   starts from this batch.

use std::collections::BTreeSet;

use contract::ContractError;
use contract::navigation::{
    Answer, ChaserOrbit, Disposition, Event, LineOfSightMeasurement, ManoeuvreReport, Mode, NavigationSetup,
    Navigator, NavigatorFactory, NoEstimate, PriorOrbit, ReportedState, SlowError, Use,
};
use hifitime::Epoch;

use crate::batch::Batch;
use crate::config::{BatchConfig, SequentialConfig};
use crate::filter::FilterState;
use crate::history::{Entry, Happening, History};
use crate::layout::Layout;
use crate::reference::{Impulse, Reference};
use crate::relative_state;
use crate::sight::Sight;
use crate::time::seconds_between;

/// Largest σ of aδλ relative to aδλ with which a filter without a prior starts.
const START_SIGMA: f64 = 0.3;

/// Builds sequential navigators.
#[derive(Debug, Clone, Default)]
pub struct SequentialFactory {
    /// Parameters.
    pub config: SequentialConfig,
}

impl NavigatorFactory for SequentialFactory {
    fn name(&self) -> String {
        "sequential".to_owned()
    }

    fn mode(&self) -> Mode {
        Mode::Sequential
    }

    fn build(&self, setup: &NavigationSetup) -> Result<Box<dyn Navigator>, ContractError> {
        Ok(Box::new(Sequential::new(setup, &self.config)?))
    }
}

/// Time before an event from which the chaser's states are used, s.
const STATES_S: f64 = 6.0 * 3600.0;

/// Time after the last state of a fit until which the chaser's orbit is extrapolated, s.
const REFRESH_S: f64 = 1800.0;

/// Time over which the error of reported velocities moves the chaser's orbit, s: shortly after an impulse, a
/// fit to a few states is extrapolated by up to [`REFRESH_S`].
const REFERENCE_DRIFT_S: f64 = 600.0;

/// Returns the setup with the error of the chaser's orbit as a slow error of the lines of sight. It turns
/// both satellites by the error of one state, position and drift, over the distance from the Earth's centre.
/// A batch fits hours of states on both sides of a measurement, to a tenth of that.
fn with_reference_errors(setup: &NavigationSetup) -> NavigationSetup {
    let mut setup = setup.clone();
    let ChaserOrbit::States(states) = &setup.chaser_orbit else { return setup };
    let angle = |state: &ReportedState| {
        let drift_m = state.velocity_sigma_m_s * REFERENCE_DRIFT_S;
        libm::hypot(state.position_sigma_m, drift_m) * 1e-3 / state.position_km.norm()
    };
    let squares: f64 = states.iter().map(|state| angle(state) * angle(state)).sum();
    let sigma_rad = (squares / states.len().max(1) as f64).sqrt();
    let sigma_arcsec = [(sigma_rad.to_degrees() * 3600.0).min(36_000.0); 2];
    let error = SlowError { sigma_arcsec, memory_s: REFRESH_S, period_s: None };
    setup.errors.with_stars.slow.push(error);
    setup.errors.without_stars.slow.push(error);
    setup
}

/// Sequential navigator.
#[derive(Debug, Clone)]
pub struct Sequential {
    setup: NavigationSetup,
    config: SequentialConfig,
    layout: Layout,
    manoeuvres: Vec<ManoeuvreReport>,
    received: BTreeSet<(Epoch, u64)>,
    /// Measurements and their dispositions in order of arrival.
    measurements: Vec<LineOfSightMeasurement>,
    dispositions: Vec<Disposition>,
    /// States before the history, in order of time.
    old: Vec<FilterState>,
    /// `None` until the filter starts.
    history: Option<History>,
    /// Measurements that wait for an initial orbit.
    waiting: Vec<usize>,
    /// Chaser's orbit at the last event and at the last answer.
    at_event: Option<LocalReference>,
    at_answer: Option<LocalReference>,
}

/// Chaser's orbit near a time.
#[derive(Debug, Clone)]
struct LocalReference {
    span_s: (f64, f64),
    /// Number of manoeuvres known at its fit.
    manoeuvres: usize,
    reference: Reference,
}

/// Event by the number of its measurement.
#[derive(Debug, Clone, Copy)]
enum Step {
    Sight(usize),
    Manoeuvre(ManoeuvreReport),
}

impl Sequential {
    /// Creates a navigator.
    ///
    /// # Errors
    /// [`ContractError::OutOfRange`] for a number outside its range.
    pub fn new(setup: &NavigationSetup, config: &SequentialConfig) -> Result<Self, ContractError> {
        setup.check()?;
        config.check()?;
        let layout = Layout::new(&with_reference_errors(setup), config.velocity_noise_m_s_per_hour);
        let start = setup.prior.as_ref().map(|prior| FilterState::new(&layout, 0.0, prior));
        Ok(Self {
            setup: setup.clone(),
            config: config.clone(),
            layout,
            manoeuvres: Vec::new(),
            received: BTreeSet::new(),
            measurements: Vec::new(),
            dispositions: Vec::new(),
            old: Vec::new(),
            history: start.map(|start| History::new(start, config.outlier_sigma, config.osculation)),
            waiting: Vec::new(),
            at_event: None,
            at_answer: None,
        })
    }

    fn seconds(&self, time: Epoch) -> f64 {
        seconds_between(self.setup.epoch, time)
    }

    /// Returns the chaser's orbit that covers a span, from a cache if it has states of the hours before its
    /// end.
    fn reference(&self, cache: Option<LocalReference>, (from_s, to_s): (f64, f64)) -> Option<LocalReference> {
        let is_recent = |local: &LocalReference| {
            local.manoeuvres == self.manoeuvres.len()
                && local.span_s.0 <= from_s
                && to_s <= local.span_s.1 + REFRESH_S
        };
        if let Some(local) = cache.filter(is_recent) {
            return Some(local);
        }
        let span_s = (from_s.min(to_s - STATES_S), to_s);
        let reference = Reference::within(
            &self.setup.chaser_orbit,
            self.setup.epoch,
            &self.impulses(),
            self.config.osculation,
            span_s,
        )?;
        Some(LocalReference { span_s, manoeuvres: self.manoeuvres.len(), reference })
    }

    /// Processes an event at its time, and the later ones again.
    fn process(&mut self, step: Step) {
        let seconds = match &step {
            Step::Sight(index) => self.seconds(self.measurements[*index].time),
            Step::Manoeuvre(manoeuvre) => self.seconds(manoeuvre.time),
        };
        let Some(mut history) = self.history.take() else { return };
        let oldest = history.state_before(0).seconds;
        let newest = history.last().seconds;
        let is_late = match &step {
            Step::Sight(_) => seconds < newest - self.config.buffer_s,
            Step::Manoeuvre(_) => false,
        };
        if seconds < oldest || is_late {
            match step {
                Step::Sight(index) => self.dispositions[index].used = Use::TooLate,
                Step::Manoeuvre(manoeuvre) => history = self.late_manoeuvre(history, &manoeuvre, seconds),
            }
            self.history = Some(history);
            return;
        }
        let later = history.split_off(history.position(seconds));
        self.append(&mut history, step);
        for entry in later {
            let step = match &entry.happening {
                Happening::Sight(_) => Step::Sight(entry.id),
                Happening::Manoeuvre(manoeuvre, _) => Step::Manoeuvre(*manoeuvre),
            };
            self.append(&mut history, step);
        }
        history.linearise(&self.layout);
        if history.entries().len() > self.config.history {
            self.note(&history);
            self.old.extend(history.thin(self.config.history));
        }
        self.history = Some(history);
    }

    /// Appends an event that is later than the history.
    fn append(&mut self, history: &mut History, step: Step) {
        let seconds = match &step {
            Step::Sight(index) => self.seconds(self.measurements[*index].time),
            Step::Manoeuvre(manoeuvre) => self.seconds(manoeuvre.time),
        };
        let before_s = history.last().seconds;
        let cache = self.at_event.take();
        let local = self.reference(cache, (before_s, seconds));
        let reference = local.as_ref().map(|local| &local.reference);
        let departure = reference.and_then(|reference| reference.orbit(before_s));
        let prepared = reference.zip(departure).and_then(|(reference, departure)| {
            let (id, happening) = match &step {
                Step::Sight(index) => {
                    let measurement = &self.measurements[*index];
                    let sight = Sight::new(measurement, self.setup.epoch, &self.setup.errors, reference);
                    (*index, Happening::Sight(Box::new(sight.ok()?)))
                }
                Step::Manoeuvre(manoeuvre) => {
                    (usize::MAX, Happening::Manoeuvre(*manoeuvre, reference.orbit_before(seconds)?))
                }
            };
            Some(Entry::new(id, seconds, happening, departure))
        });
        self.at_event = local;
        match (prepared, step) {
            (Some(entry), _) => history.push(&self.layout, entry),
            (None, Step::Sight(index)) => self.dispositions[index].used = Use::NoChaserOrbit,
            (None, Step::Manoeuvre(_)) => (),
        }
    }

    /// Applies a manoeuvre before the history to its last state, from which a new history begins.
    fn late_manoeuvre(&mut self, history: History, manoeuvre: &ManoeuvreReport, seconds: f64) -> History {
        let mut state = history.last().clone();
        let local = self.reference(None, (seconds, seconds));
        let chaser = local.and_then(|local| local.reference.orbit_before(seconds));
        // Without a known orbit the state keeps its value.
        let Some(chaser) = chaser else { return history };
        state.late_manoeuvre(&chaser, manoeuvre, seconds);
        let after = history.entries().iter().filter_map(|entry| Some(entry.result()?.after.clone()));
        self.old.extend(after);
        History::new(state, self.config.outlier_sigma, self.config.osculation)
    }

    /// Stores the dispositions of the measurements in the history.
    fn note(&mut self, history: &History) {
        for entry in history.entries() {
            let Some(disposition) = self.dispositions.get_mut(entry.id) else { continue };
            match entry.result().map(|result| result.disposition) {
                Some(Some((used, innovation))) => {
                    disposition.used = used;
                    disposition.residual_rad = Some(innovation.into());
                }
                Some(None) => (),
                None => disposition.used = Use::NoChaserOrbit,
            }
        }
    }

    fn measure(&mut self, measurement: &LineOfSightMeasurement) {
        let index = self.dispositions.len();
        self.dispositions.push(Disposition {
            frame: measurement.frame,
            time: measurement.time,
            used: Use::Waiting,
            residual_rad: None,
        });
        self.measurements.push(*measurement);
        if !self.received.insert((measurement.time, measurement.frame)) {
            self.dispositions[index].used = Use::Duplicate;
            return;
        }
        let seconds = self.seconds(measurement.time);
        let cache = self.at_event.take();
        let local = self.reference(cache, (seconds, seconds));
        let sight = local.as_ref().map_or(Err(Use::NoChaserOrbit), |local| {
            Sight::new(measurement, self.setup.epoch, &self.setup.errors, &local.reference)
        });
        self.at_event = local;
        match sight {
            Err(used) => self.dispositions[index].used = used,
            Ok(_) if self.history.is_none() => {
                self.waiting.push(index);
                if self.waiting.len().is_multiple_of(self.config.initial_measurements) {
                    self.start();
                }
            }
            Ok(_) => self.process(Step::Sight(index)),
        }
    }

    /// Starts the filter from a batch over the waiting measurements if it determines the range.
    fn start(&mut self) {
        let config = BatchConfig {
            osculation: self.config.osculation,
            outlier_sigma: self.config.outlier_sigma,
            model_errors: None,
        };
        let Ok(mut batch) = Batch::new(&self.setup, &config) else { return };
        let waiting: Vec<LineOfSightMeasurement> =
            self.waiting.iter().map(|index| self.measurements[*index]).collect();
        self.manoeuvres.iter().for_each(|manoeuvre| batch.receive(&Event::Manoeuvre(*manoeuvre)));
        waiting.iter().for_each(|measurement| batch.receive(&Event::LineOfSight(*measurement)));
        let Some(last) = waiting.iter().map(|measurement| measurement.time).max() else { return };
        let Some(Ok(estimate)) = batch.estimates(&[last]).pop() else { return };
        let sigma = estimate.elements_covariance.sigmas()[1];
        if sigma > START_SIGMA * estimate.elements.a_dlambda_m.abs() {
            return;
        }
        let prior = PriorOrbit { elements: estimate.elements, covariance: estimate.elements_covariance };
        let state = FilterState::new(&self.layout, self.seconds(last), &prior);
        self.history = Some(History::new(state, self.config.outlier_sigma, self.config.osculation));
        for (index, disposition) in self.waiting.drain(..).zip(batch.dispositions()) {
            self.dispositions[index] = disposition;
        }
    }

    fn impulses(&self) -> Vec<Impulse> {
        let impulse = |manoeuvre: &ManoeuvreReport| Impulse {
            seconds: self.seconds(manoeuvre.time),
            dv_m_s: manoeuvre.dv_rtn_m_s,
        };
        self.manoeuvres.iter().map(impulse).collect()
    }

    fn answer(&mut self, time: Epoch) -> Answer {
        let seconds = self.seconds(time);
        let history = self.history.as_ref().ok_or(NoEstimate::NoInitialOrbit)?;
        let before = self.old.partition_point(|state| state.seconds <= seconds);
        let old = self.old.get(before.saturating_sub(1));
        let mut state = match old {
            Some(old) if seconds < history.state_before(0).seconds => old.clone(),
            _ => history.state_before(history.position(seconds)).clone(),
        };
        let span_s = (state.seconds.min(seconds), state.seconds.max(seconds));
        let cache = self.at_answer.take();
        let local = self.reference(cache, span_s).ok_or(NoEstimate::NoChaserOrbit)?;
        let reference = &local.reference;
        let departure = reference.orbit(state.seconds).ok_or(NoEstimate::NoChaserOrbit)?;
        state.propagate(&self.layout, &departure, seconds).ok_or(NoEstimate::NoChaserOrbit)?;
        let chaser = reference.orbit(seconds).ok_or(NoEstimate::NoChaserOrbit)?;
        let accuracy = reference.relative_accuracy(seconds);
        let (elements, covariance) = (state.elements(), state.elements_covariance());
        self.at_answer = Some(local);
        relative_state::estimate(time, &elements, &covariance, &chaser, self.config.osculation, accuracy)
    }
}

impl Navigator for Sequential {
    fn receive(&mut self, event: &Event) {
        match event {
            Event::LineOfSight(measurement) => self.measure(measurement),
            Event::Manoeuvre(manoeuvre) => {
                if manoeuvre.check().is_err() || self.manoeuvres.contains(manoeuvre) {
                    return;
                }
                self.manoeuvres.push(*manoeuvre);
                self.manoeuvres.sort_by_key(|manoeuvre| manoeuvre.time);
                // Until the filter starts, manoeuvres are part of the batch from which it starts. One before
                // the epoch is part of the prior.
                if self.history.is_some() && self.seconds(manoeuvre.time) > 0.0 {
                    self.process(Step::Manoeuvre(*manoeuvre));
                }
            }
        }
    }

    fn estimates(&mut self, epochs: &[Epoch]) -> Vec<Answer> {
        if self.history.is_none() {
            let reason = if self.received.is_empty() {
                NoEstimate::NoMeasurements
            } else {
                NoEstimate::NoInitialOrbit
            };
            return epochs.iter().map(|_| Err(reason.clone())).collect();
        }
        epochs.iter().map(|epoch| self.answer(*epoch)).collect()
    }

    fn dispositions(&mut self) -> Vec<Disposition> {
        if let Some(history) = self.history.take() {
            self.note(&history);
            self.history = Some(history);
        }
        self.dispositions.clone()
    }
}
