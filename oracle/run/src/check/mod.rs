//! Results of a scenario check in addition to its errors.

pub(crate) mod derived;
pub(crate) mod slips;
