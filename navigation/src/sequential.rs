//! Sequential navigator: an unscented Kalman filter over events in order of time, with a buffer in which late
//! events are inserted and the following ones repeated.
//!
//! - An event later than all before is processed at once.
//! - An earlier event within the buffer is inserted at its time, and all later events are processed again:
//!   the result is that of the events in order.
//! - A measurement before the buffer is not used. A manoeuvre before the buffer changes the state by its
//!   linear effect.
//! - Without a prior, measurements wait until a batch over them determines the range to 30 %; the filter then
//!   starts from this batch.

use std::collections::BTreeSet;

use contract::ContractError;
use contract::navigation::{
    Answer, Disposition, Event, LineOfSightMeasurement, ManoeuvreReport, Mode, NavigationSetup, Navigator,
    NavigatorFactory, NoEstimate, PriorOrbit, Use,
};
use hifitime::Epoch;

use crate::batch::Batch;
use crate::config::{BatchConfig, SequentialConfig};
use crate::filter::{FilterState, Layout};
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

/// Sequential navigator.
#[derive(Debug, Clone)]
pub struct Sequential {
    setup: NavigationSetup,
    config: SequentialConfig,
    layout: Layout,
    reference: Option<Reference>,
    manoeuvres: Vec<ManoeuvreReport>,
    received: BTreeSet<(Epoch, u64)>,
    dispositions: Vec<Disposition>,
    /// States after the processed events, in order of time; the first is the start. Old ones are thinned.
    states: Vec<FilterState>,
    /// Processed events within the buffer with the index of the state after each.
    buffer: Vec<Buffered>,
    /// Measurements that wait for an initial orbit, with the index of their disposition.
    waiting: Vec<(usize, LineOfSightMeasurement)>,
}

#[derive(Debug, Clone)]
struct Buffered {
    seconds: f64,
    step: Step,
    /// State after the event.
    after: FilterState,
}

#[derive(Debug, Clone)]
enum Step {
    /// Index of the disposition, and the measurement: it is prepared when it is processed, with the chaser's
    /// orbit as known then.
    Sight(usize, Box<LineOfSightMeasurement>),
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
        let layout = Layout::new(setup, config.velocity_noise_m_s_per_hour);
        let states = setup.prior.iter().map(|prior| FilterState::new(&layout, 0.0, prior)).collect();
        let reference = Reference::new(&setup.chaser_orbit, setup.epoch, &[], config.osculation);
        Ok(Self {
            setup: setup.clone(),
            config: config.clone(),
            layout,
            reference,
            manoeuvres: Vec::new(),
            received: BTreeSet::new(),
            dispositions: Vec::new(),
            states,
            buffer: Vec::new(),
            waiting: Vec::new(),
        })
    }

    fn seconds(&self, time: Epoch) -> f64 {
        seconds_between(self.setup.epoch, time)
    }

    /// Inserts a step and processes it and the later ones.
    fn process(&mut self, seconds: f64, step: Step) {
        let Some(reference) = self.reference.clone() else { return };
        let Some(newest) = self.states.last().map(|state| state.seconds) else { return };
        let position = self.buffer.partition_point(|buffered| buffered.seconds <= seconds);
        let before = match position.checked_sub(1) {
            Some(index) => self.buffer[index].after.clone(),
            // The state before the first buffered event.
            None => self.states[self.states.len() - 1 - self.buffer.len()].clone(),
        };
        if seconds < before.seconds || seconds < newest - self.config.buffer_s {
            match step {
                Step::Sight(index, _) => self.dispositions[index].used = Use::TooLate,
                Step::Manoeuvre(manoeuvre) => {
                    if let Some(state) = self.states.last_mut() {
                        // Without a known orbit the state keeps its value.
                        let _ = state.late_manoeuvre(&reference, &manoeuvre, seconds);
                        let state = state.clone();
                        self.buffer.clear();
                        self.states.push(state);
                    }
                }
            }
            return;
        }
        let later: Vec<Step> = self.buffer.drain(position..).map(|buffered| buffered.step).collect();
        self.states.truncate(self.states.len() - later.len());
        let mut state = before;
        for step in std::iter::once(step).chain(later) {
            state = self.advance(&reference, state, step);
        }
        self.thin();
    }

    /// Processes one step from a state and stores the state after it.
    fn advance(&mut self, reference: &Reference, before: FilterState, step: Step) -> FilterState {
        let mut state = before.clone();
        let seconds = match &step {
            Step::Sight(_, measurement) => self.seconds(measurement.time),
            Step::Manoeuvre(manoeuvre) => self.seconds(manoeuvre.time),
        };
        let moved = state.propagate(&self.layout, reference, seconds);
        let done = moved.and_then(|()| match &step {
            Step::Sight(index, measurement) => {
                let sight = self.sight(measurement).ok()?;
                let gate = self.config.outlier_sigma;
                let (used, innovation) = state.update(&self.layout, reference, &sight, gate);
                self.dispositions[*index].used = used;
                self.dispositions[*index].residual_rad = Some(innovation);
                Some(())
            }
            Step::Manoeuvre(manoeuvre) => state.manoeuvre(reference, manoeuvre),
        });
        if done.is_none() {
            state = before;
            if let Step::Sight(index, _) = &step {
                self.dispositions[*index].used = Use::NoChaserOrbit;
            }
        }
        self.buffer.push(Buffered { seconds, step, after: state.clone() });
        self.states.push(state.clone());
        state
    }

    /// Removes events before the buffer.
    fn thin(&mut self) {
        let newest = self.buffer.last().map_or(0.0, |buffered| buffered.seconds);
        let old = self.buffer.partition_point(|buffered| buffered.seconds < newest - self.config.buffer_s);
        self.buffer.drain(..old);
    }

    fn sight(&self, measurement: &LineOfSightMeasurement) -> Result<Sight, Use> {
        let reference = self.reference.as_ref().ok_or(Use::NoChaserOrbit)?;
        Sight::new(measurement, self.setup.epoch, &self.setup.errors, reference)
    }

    fn measure(&mut self, measurement: &LineOfSightMeasurement) {
        let index = self.dispositions.len();
        self.dispositions.push(Disposition {
            frame: measurement.frame,
            time: measurement.time,
            used: Use::Waiting,
            residual_rad: None,
        });
        if !self.received.insert((measurement.time, measurement.frame)) {
            self.dispositions[index].used = Use::Duplicate;
            return;
        }
        match self.sight(measurement) {
            Err(used) => self.dispositions[index].used = used,
            Ok(_) if self.states.is_empty() => {
                self.waiting.push((index, *measurement));
                if self.waiting.len().is_multiple_of(self.config.initial_measurements) {
                    self.start();
                }
            }
            Ok(sight) => self.process(sight.seconds, Step::Sight(index, Box::new(*measurement))),
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
        self.manoeuvres.iter().for_each(|manoeuvre| batch.receive(&Event::Manoeuvre(*manoeuvre)));
        self.waiting.iter().for_each(|(_, measurement)| batch.receive(&Event::LineOfSight(*measurement)));
        let Some(last) = self.waiting.iter().map(|(_, measurement)| measurement.time).max() else { return };
        let Some(Ok(estimate)) = batch.estimates(&[last]).pop() else { return };
        let sigma = estimate.elements_covariance.sigmas()[1];
        if sigma > START_SIGMA * estimate.elements.a_dlambda_m.abs() {
            return;
        }
        let prior = PriorOrbit { elements: estimate.elements, covariance: estimate.elements_covariance };
        self.states.push(FilterState::new(&self.layout, self.seconds(last), &prior));
        for ((index, _), disposition) in self.waiting.drain(..).zip(batch.dispositions()) {
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

    fn answer(&self, time: Epoch) -> Answer {
        let seconds = self.seconds(time);
        let reference = self.reference.as_ref().ok_or(NoEstimate::NoChaserOrbit)?;
        let index = self.states.partition_point(|state| state.seconds <= seconds).saturating_sub(1);
        let mut state = self.states.get(index).ok_or(NoEstimate::NoInitialOrbit)?.clone();
        state.propagate(&self.layout, reference, seconds).ok_or(NoEstimate::NoChaserOrbit)?;
        let chaser = reference.orbit(seconds).ok_or(NoEstimate::NoChaserOrbit)?;
        let accuracy = reference.relative_accuracy(seconds);
        let (elements, covariance) = (state.elements(), state.elements_covariance());
        relative_state::estimate(time, &elements, &covariance, &chaser, reference.osculation(), accuracy)
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
                let setup = &self.setup;
                self.reference = Reference::new(
                    &setup.chaser_orbit,
                    setup.epoch,
                    &self.impulses(),
                    self.config.osculation,
                );
                let seconds = self.seconds(manoeuvre.time);
                // Until the filter starts, manoeuvres are part of the batch from which it starts. One before
                // the epoch is part of the prior.
                if !self.states.is_empty() && seconds > 0.0 {
                    self.process(seconds, Step::Manoeuvre(*manoeuvre));
                }
            }
        }
    }

    fn estimates(&mut self, epochs: &[Epoch]) -> Vec<Answer> {
        if self.states.is_empty() {
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
        self.dispositions.clone()
    }
}
