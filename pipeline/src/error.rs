//! Error type of this crate.

use contract::{ContractError, OutOfRange};
use thiserror::Error;

/// Reason why a pipeline's configuration is refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PipelineError {
    /// Parameter outside its range, with its path in the configuration.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// Value refused by the contract.
    #[error(transparent)]
    Contract(#[from] ContractError),
}
