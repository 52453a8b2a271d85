//! The one error type of this crate.

use thiserror::Error;

/// Why a simulation cannot be made.
#[derive(Debug, Error)]
pub enum SimError {
    /// A parameter outside its range.
    #[error("{field} is {value}, expected {expected}")]
    Parameter {
        /// Path of the parameter in the scenario, with its unit.
        field: &'static str,
        /// The value met.
        value: String,
        /// What is allowed.
        expected: &'static str,
    },
    /// A value that the contract refuses.
    #[error(transparent)]
    Contract(#[from] contract::ContractError),
    /// A star catalogue that cannot be used.
    #[error(transparent)]
    Catalog(#[from] crate::catalog::CatalogError),
}

/// Checks that `value` is finite and satisfies `holds`.
///
/// # Errors
/// [`SimError::Parameter`] with the field and what was expected.
pub(crate) fn require(
    field: &'static str,
    value: f64,
    expected: &'static str,
    holds: impl Fn(f64) -> bool,
) -> Result<(), SimError> {
    if value.is_finite() && holds(value) {
        Ok(())
    } else {
        Err(SimError::Parameter { field, value: value.to_string(), expected })
    }
}
