//! The simulator: truth → scene → optics → sensor → on-board preprocessing → frame.
//!
//! [`SimulatedCamera::expose`] makes one frame with its telemetry and its truth. Every random draw has an address
//! (seed, case, frame, effect, place), so frame 7000 alone is the frame 7000 of the whole run.

#[cfg(test)]
extern crate self as boresight_sim;

pub mod catalog;
mod constants;
pub mod docking;
pub mod draw;
mod error;
mod expose;
mod lanes;
pub mod mitsuba;
mod moment;
pub mod onboard;
pub mod optics;
mod painter;
mod pixel_factors;
pub mod randomness;
pub mod regular_file;
pub mod scene;
pub mod sensor;
mod simulator;
mod smooth_field;
pub mod television;
pub mod truth;
pub mod vector;
mod view;
mod widest;

pub use error::SimError;
pub use expose::{Drawing, Exposure, SimulatedCamera};
pub use simulator::{Simulation, Simulator};
