//! The one error type of this crate.

use std::path::PathBuf;

use contract::{ContractError, OutOfRange};
use thiserror::Error;

/// Why a simulation cannot be made.
#[derive(Debug, Error)]
pub enum SimError {
    /// A parameter that is not allowed, by its path in the scenario.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// A value that the contract refuses.
    #[error(transparent)]
    Contract(ContractError),
    /// A star catalogue that cannot be used.
    #[error(transparent)]
    Catalog(#[from] crate::catalog::CatalogError),
    /// A point-spread function of the user's that cannot be used.
    #[error("psf.path {}: {problem}", path.display())]
    PsfFile {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// A docking target that cannot be used.
    #[error("target {target:?}: {problem}")]
    TargetFile {
        /// Its name, or the path of its file.
        target: String,
        /// What is wrong.
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
