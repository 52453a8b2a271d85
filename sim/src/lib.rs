//! The simulator: truth → scene → optics → sensor → on-board preprocessing → frame.

pub mod catalog;
mod error;
pub mod randomness;
pub mod truth;

pub use error::SimError;
