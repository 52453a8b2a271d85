//! Simulator: truth → scene → optics → sensor → on-board preprocessing → frame.
//!
//! [`SimulatedCamera::expose`] makes one frame with its telemetry and its truth. Every random draw has an
//! address (seed, case, frame, effect, index), so frame 7000 made separately equals frame 7000 of the whole
//! run.

pub mod docking;
mod expose;
mod foreground;
mod frame_readout;
mod limit;
mod object_descriptions;
mod scene_painter;
mod scene_state;
mod scene_view;
mod simulator;
mod target_view;

pub use expose::{Exposure, SimulatedCamera};
pub use frame_readout::PixelSelection;
pub use optics;
pub use render::{draw, mitsuba, vector};
pub use scene;
pub use sensor::{self, onboard, television};
pub use simulator::{Simulation, Simulator};
pub use target_view::{PointImage, TargetView};
pub use truth::{self, SimError, catalog, memo};
