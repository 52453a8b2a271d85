//! Error type of this crate.

use std::path::PathBuf;

use contract::{ContractError, OutOfRange};
use thiserror::Error;

/// Reason why a simulation is impossible.
#[derive(Debug, Error)]
pub enum SimError {
    /// A parameter, given by its path in the scenario, has an invalid value.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// The contract refuses a value.
    #[error(transparent)]
    Contract(ContractError),
    /// A star catalogue cannot be used.
    #[error(transparent)]
    Catalog(#[from] crate::catalog::CatalogError),
    /// A point-spread function file of the user cannot be used.
    #[error("psf.path {}: {problem}", path.display())]
    PsfFile {
        /// Path of the file.
        path: PathBuf,
        /// Description of the problem.
        problem: String,
    },
    /// A docking target cannot be used.
    #[error("target {target:?}: {problem}")]
    TargetFile {
        /// Name of the target, or the path of its file.
        target: String,
        /// Description of the problem.
        problem: String,
    },
}

impl From<ContractError> for SimError {
    fn from(error: ContractError) -> Self {
        match error {
            ContractError::OutOfRange(error) => Self::OutOfRange(error),
            error => Self::Contract(error),
        }
    }
}
