//! Covariances of answers against their errors.

pub(crate) mod consistency;
pub(crate) mod image_state;
pub(crate) mod normalised_error;
