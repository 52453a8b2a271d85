//! Events of a sequential filter with the states after them, and their linearisation about one trajectory.
//!
//! The first measurements do not determine the range, so their linearisation about the first estimates is
//! wrong. Once the estimate has moved so far that this counts, all measurements of the history are linearised
//! again about the smoothed trajectory and filtered again, until the estimate is stable: the iterated
//! posterior linearisation smoother (García-Fernández, Svensson, Särkkä 2017, IEEE Trans. AC 62, 2056), a
//! Gauss–Newton iteration for the whole history (Bell 1994, SIAM J. Optim. 4, 626).

use contract::navigation::{ManoeuvreReport, Use};
use nalgebra::{Matrix6, Vector2, Vector6};

use crate::filter::{FilterState, Update};
use crate::layout::Layout;
use crate::linearisation::Linearisation;
use crate::orbit::Orbit;
use crate::short_period::Osculation;
use crate::sight::Sight;
use crate::smoother::Smoother;
use crate::transition::Transition;

/// Largest departure from linearity before measurements are linearised again: bends of all angles relative to
/// their white errors, the sum of squares.
const MAX_DEPARTURE: f64 = 0.1;

/// Fraction by which a history grows at least between two linearisations.
const GROWTH: f64 = 0.02;

/// Largest number of iterations of one linearisation.
const ITERATIONS: usize = 4;

/// Change of the last estimate, in standard deviations, at which the iteration ends.
const CONVERGED: f64 = 0.05;

/// An event.
#[derive(Debug, Clone)]
pub(crate) enum Happening {
    Sight(Box<Sight>),
    /// A manoeuvre with the chaser's orbit before it.
    Manoeuvre(ManoeuvreReport, Orbit),
}

/// An event of the history.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    /// Number of the event in the order of arrival.
    pub(crate) id: usize,
    /// Time, s since the epoch.
    pub(crate) seconds: f64,
    pub(crate) happening: Happening,
    /// Chaser's orbit at the time of the state before the event.
    departure: Orbit,
    /// Smoothed elements, about which a measurement is linearised; `None` until the first smoothing.
    smoothed: Option<(Vector6<f64>, Matrix6<f64>)>,
    result: Option<Processed>,
}

/// Result of processing an event.
#[derive(Debug, Clone)]
pub(crate) struct Processed {
    transition: Transition,
    update: Option<Update>,
    /// Use and innovation of a measurement, rad.
    pub(crate) disposition: Option<(Use, Vector2<f64>)>,
    departure: f64,
    /// State after the event.
    pub(crate) after: FilterState,
}

impl Entry {
    /// Creates an entry that has not been processed.
    pub(crate) fn new(id: usize, seconds: f64, happening: Happening, departure: Orbit) -> Self {
        Self { id, seconds, happening, departure, smoothed: None, result: None }
    }

    /// Result of processing, absent if the state could not be moved to the event.
    pub(crate) fn result(&self) -> Option<&Processed> {
        self.result.as_ref()
    }
}

/// Events in order of time.
#[derive(Debug, Clone)]
pub(crate) struct History {
    /// State before the first entry.
    start: FilterState,
    entries: Vec<Entry>,
    gate: f64,
    osculation: Osculation,
    /// Number of entries at the last linearisation.
    linearised: usize,
}

impl History {
    /// Creates the history that begins with a state.
    pub(crate) fn new(start: FilterState, gate: f64, osculation: Osculation) -> Self {
        Self { start, entries: Vec::new(), gate, osculation, linearised: 0 }
    }

    pub(crate) fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Returns the state after the last event at or before a time, and before the entry of that index.
    pub(crate) fn state_before(&self, index: usize) -> &FilterState {
        let before = self.entries[..index.min(self.entries.len())].iter().rev();
        before.filter_map(Entry::result).map(|result| &result.after).next().unwrap_or(&self.start)
    }

    /// Returns the last state.
    pub(crate) fn last(&self) -> &FilterState {
        self.state_before(self.entries.len())
    }

    /// Returns the index at which an event at a time is inserted.
    pub(crate) fn position(&self, seconds: f64) -> usize {
        self.entries.partition_point(|entry| entry.seconds <= seconds)
    }

    /// Removes the entries from an index on.
    pub(crate) fn split_off(&mut self, index: usize) -> Vec<Entry> {
        self.entries.split_off(index)
    }

    /// Appends an entry that is not earlier than the last, and processes it.
    pub(crate) fn push(&mut self, layout: &Layout, mut entry: Entry) {
        let before = self.last().clone();
        self.process(layout, &before, &mut entry);
        self.entries.push(entry);
    }

    fn process(&self, layout: &Layout, before: &FilterState, entry: &mut Entry) {
        entry.result = self.processed(layout, before.clone(), entry);
    }

    fn processed(&self, layout: &Layout, mut state: FilterState, entry: &Entry) -> Option<Processed> {
        let transition = state.propagate(layout, &entry.departure, entry.seconds)?;
        let (update, disposition, departure) = match &entry.happening {
            Happening::Manoeuvre(manoeuvre, chaser) => {
                state.manoeuvre(chaser, manoeuvre, self.osculation)?;
                (None, None, 0.0)
            }
            Happening::Sight(sight) => {
                let by_filter = (state.centre, state.elements_covariance());
                let (centre, covariance) = entry.smoothed.unwrap_or(by_filter);
                let linearisation = Linearisation::new(sight, &centre, &covariance, self.osculation)
                    .or_else(|| Linearisation::new(sight, &centre, &by_filter.1, self.osculation));
                match linearisation {
                    None => (None, Some((Use::Unusable, Vector2::zeros())), 0.0),
                    Some(linearisation) => {
                        let (used, innovation, update) =
                            state.update(layout, sight, &linearisation, self.gate);
                        let departure = linearisation.departure(sight, &state.vector(), self.osculation);
                        (update, Some((used, innovation)), departure)
                    }
                }
            }
        };
        if let Some((centre, _)) = entry.smoothed {
            state.centre = centre;
        }
        Some(Processed { transition, update, disposition, departure, after: state })
    }

    /// Linearises all measurements again if the last one departs too far from linearity.
    pub(crate) fn linearise(&mut self, layout: &Layout) {
        let count = self.entries.len();
        let departure = self.entries.last().and_then(Entry::result).map_or(0.0, |result| result.departure);
        let is_due = count as f64 >= (1.0 + GROWTH) * self.linearised as f64 + 1.0;
        if !is_due || departure * count as f64 <= MAX_DEPARTURE {
            return;
        }
        for _ in 0..ITERATIONS {
            let before = self.last().clone();
            self.smooth(layout);
            self.filter(layout);
            let last = self.last();
            let sigmas = last.elements_covariance().diagonal().map(f64::sqrt);
            if (last.vector() - before.vector()).component_div(&sigmas).abs().max() < CONVERGED {
                break;
            }
        }
        self.linearised = count;
    }

    fn smooth(&mut self, layout: &Layout) {
        let mut smoother = Smoother::new(layout.count());
        for entry in self.entries.iter_mut().rev() {
            let Some(result) = &entry.result else { continue };
            entry.smoothed = Some(smoother.elements(&result.after));
            if let Some(update) = &result.update {
                smoother.before_update(update);
            }
            smoother.before_drift(&result.transition);
        }
    }

    fn filter(&mut self, layout: &Layout) {
        let mut before = self.start.clone();
        let mut entries = std::mem::take(&mut self.entries);
        for entry in &mut entries {
            self.process(layout, &before, entry);
            if let Some(result) = &entry.result {
                before = result.after.clone();
            }
        }
        self.entries = entries;
    }

    /// Removes the oldest entries beyond a number; returns the states after them.
    pub(crate) fn thin(&mut self, largest: usize) -> Vec<FilterState> {
        // A quarter more than needed, so that entries are moved rarely.
        let surplus = (self.entries.len() - largest + largest / 4).min(self.entries.len());
        self.start = self.state_before(surplus).clone();
        self.linearised = self.linearised.saturating_sub(surplus);
        self.entries.drain(..surplus).filter_map(|entry| Some(entry.result?.after)).collect()
    }
}
