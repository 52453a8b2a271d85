//! The one error type of this crate.

use thiserror::Error;

/// Why a pipeline's configuration is refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PipelineError {
    /// A parameter outside its range.
    #[error("{field} is {value}, expected {expected}")]
    Parameter {
        /// Path of the parameter in the configuration, with its unit.
        field: &'static str,
        /// The value met.
        value: String,
        /// What is allowed.
        expected: &'static str,
    },
    /// A value that the contract refuses.
    #[error(transparent)]
    Contract(#[from] contract::ContractError),
}

/// Checks that `value` is finite and satisfies `holds`.
///
/// # Errors
/// [`PipelineError::Parameter`] with the field and what was expected.
pub(crate) fn require(
    field: &'static str,
    value: f64,
    expected: &'static str,
    holds: impl Fn(f64) -> bool,
) -> Result<(), PipelineError> {
    if value.is_finite() && holds(value) {
        Ok(())
    } else {
        Err(PipelineError::Parameter { field, value: value.to_string(), expected })
    }
}
