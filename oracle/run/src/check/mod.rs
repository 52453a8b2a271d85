//! Results of a scenario check in addition to its errors.

mod derived_quantities;
pub(crate) mod unit_mistakes;

pub use derived_quantities::{FieldOfView, size};
