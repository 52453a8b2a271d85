//! The files of docking: answers, evidence, truth, and what a pipeline knows before the first field.

mod covariance;
mod measurements;
mod motion;

pub use measurements::{FieldMeasurementWriter, read_field_measurements};
pub use motion::{MotionWriter, read_motion};
