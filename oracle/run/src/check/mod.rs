//! Results of a scenario check in addition to its errors.

pub(crate) mod derived_quantities;
pub(crate) mod unit_mistakes;
