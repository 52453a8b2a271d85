//! The one error type of this crate.

use contract::{ContractError, OutOfRange};
use thiserror::Error;

/// Why a pipeline's configuration is refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PipelineError {
    /// A parameter that is not allowed, by its path in the configuration.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// A value that the contract refuses.
    #[error(transparent)]
    Contract(#[from] ContractError),
}
