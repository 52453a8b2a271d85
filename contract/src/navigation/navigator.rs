//! Traits that a navigator implements.

use hifitime::Epoch;
use serde::{Deserialize, Serialize};

use super::{Answer, Disposition, Event, NavigationSetup};
use crate::ContractError;

/// Estimation of the relative orbit under test.
///
/// A navigator is built afresh for each sequence of events. It receives events in the order of their arrival;
/// their times may be out of order, repeated, or have gaps of days. It must answer every requested epoch, and
/// no answer may contain NaN: see [`crate::conformance::navigation`].
///
/// ```
/// use boresight_contract::ContractError;
/// use boresight_contract::navigation::{
///     Answer, Event, Mode, NavigationSetup, Navigator, NavigatorFactory, NoEstimate,
/// };
/// use hifitime::Epoch;
///
/// /// Counts the events and never has an estimate.
/// struct Counter(usize);
///
/// impl Navigator for Counter {
///     fn receive(&mut self, _: &Event) {
///         self.0 += 1;
///     }
///
///     fn estimates(&mut self, epochs: &[Epoch]) -> Vec<Answer> {
///         let reason = NoEstimate::Failed(format!("{} events, and no estimator", self.0));
///         vec![Err(reason); epochs.len()]
///     }
/// }
///
/// struct CounterFactory;
///
/// impl NavigatorFactory for CounterFactory {
///     fn name(&self) -> String {
///         "counter".to_owned()
///     }
///
///     fn mode(&self) -> Mode {
///         Mode::Batch
///     }
///
///     fn build(&self, setup: &NavigationSetup) -> Result<Box<dyn Navigator>, ContractError> {
///         setup.check()?;
///         Ok(Box::new(Counter(0)))
///     }
/// }
///
/// // The conformance checks find that it has no estimate from a sound campaign.
/// let violations = boresight_contract::conformance::navigation::check(&CounterFactory).unwrap_err();
/// assert!(violations.iter().any(|violation| violation.broken.contains("no estimator")));
/// ```
pub trait Navigator: Send {
    /// Receives one event. An event that cannot be used is recorded in [`Navigator::dispositions`].
    fn receive(&mut self, event: &Event);

    /// Answers each epoch, in order, from all events received so far. Epochs may be before the first and
    /// after the last event. Answers do not influence later answers.
    fn estimates(&mut self, epochs: &[Epoch]) -> Vec<Answer>;

    /// Returns the use of each measurement received so far, in the order of arrival; empty if the navigator
    /// does not report it.
    fn dispositions(&mut self) -> Vec<Disposition> {
        Vec::new()
    }
}

/// Mode of a navigator, which determines how it is driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// All events are received before the first epoch is answered; each answer depends on all events.
    Batch,
    /// Each epoch is answered once the events that arrived until then are received; answers for epochs in the
    /// past are not expected to be better than at that time.
    Sequential,
}

/// Builds navigators, one per sequence of events.
pub trait NavigatorFactory: Sync {
    /// Returns the name for tables and logs.
    fn name(&self) -> String;

    /// Returns the mode of its navigators; for a program, that of its greeting, which follows the first
    /// [`NavigatorFactory::build`].
    fn mode(&self) -> Mode;

    /// Builds a fresh navigator that has received no event.
    ///
    /// # Errors
    /// [`ContractError::OutOfRange`] for a setup with a value outside its range;
    /// [`ContractError::CannotBuild`] if the navigator's own configuration does not allow it.
    fn build(&self, setup: &NavigationSetup) -> Result<Box<dyn Navigator>, ContractError>;
}
