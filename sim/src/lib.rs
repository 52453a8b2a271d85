//! The simulator: truth → scene → optics → sensor → on-board preprocessing → frame.

pub mod catalog;
pub mod draw;
mod error;
pub mod onboard;
pub mod optics;
pub mod randomness;
pub mod sensor;
pub mod truth;

pub use error::SimError;
