//! Consistency of stated covariances with the errors of measurements.

pub(crate) mod consistency;
pub(crate) mod image_state;
