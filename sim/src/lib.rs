//! Simulator: truth → scene → optics → sensor → on-board preprocessing → frame.
//!
//! [`SimulatedCamera::expose`] makes one frame with its telemetry and its truth. Every random draw has an
//! address (seed, case, frame, effect, index), so frame 7000 made separately equals frame 7000 of the whole
//! run.

pub mod catalog;
mod constants;
pub mod docking;
pub mod draw;
mod error;
mod expose;
mod foreground;
mod limit;
pub mod memo;
pub mod mitsuba;
pub mod onboard;
pub mod optics;
mod painter;
mod pixel_factors;
pub mod scene;
mod scene_state;
mod scene_view;
pub mod sensor;
mod simd_kernel;
mod simulator;
mod smooth_field;
mod switch;
pub mod television;
pub mod truth;
pub mod vector;

pub use error::SimError;
pub use expose::{Exposure, PixelSelection, SimulatedCamera};
pub use simulator::{Simulation, Simulator};
