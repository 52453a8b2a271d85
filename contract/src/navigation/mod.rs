//! Relative navigation: from lines of sight to the orbit of the chaser relative to the target.
//!
//! A [`Navigator`] receives its [`NavigationSetup`], then events in the order of their arrival (lines of
//! sight, manoeuvres), and answers for requested epochs with a [`RelativeEstimate`] or the reason why there
//! is none. All inputs are reported or assumed values with their σ, never truth.
//!
//! **Axes.** R, T, N are those of the *target*: R along its position, N along its orbital momentum, T = N ×
//! R. **Sign.** Positions, velocities and elements are those of the chaser with respect to the target: a
//! chaser behind the target has a negative T and a negative aδλ.

mod covariance6;
mod estimate;
mod event;
pub mod lines;
mod navigator;
mod setup;

pub use covariance6::Covariance6;
pub use estimate::{Answer, Disposition, NoEstimate, RelativeElements, RelativeEstimate, Use};
pub use event::{Event, LineOfSightMeasurement, ManoeuvreReport};
pub use navigator::{Mode, Navigator, NavigatorFactory};
pub use setup::{
    AngleErrors, ChaserOrbit, DifferentialDrag, LineOfSightErrors, MeanElements, NavigationSetup, PriorOrbit,
    ReportedState, SlowDisplacement, SlowError,
};
