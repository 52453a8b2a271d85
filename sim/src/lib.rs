//! The simulator: truth → scene → optics → sensor → on-board preprocessing → frame.
//!
//! [`Simulator::expose`] makes one frame with its telemetry, its truth and its noise-free expectation. Every random
//! draw has an address (seed, frame, effect, place), so frame 7000 alone is the frame 7000 of the whole run.

pub mod catalog;
mod draw;
mod error;
mod expose;
pub mod onboard;
pub mod optics;
pub mod randomness;
pub mod scene;
pub mod sensor;
pub mod truth;

pub use error::SimError;
pub use expose::{Exposure, Simulation, Simulator};
