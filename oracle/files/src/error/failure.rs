//! Why a command gives no answer.

use thiserror::Error;

use crate::FileError;
use crate::toml_file::TomlError;

/// Bad input or usage: whatever keeps a command from giving an answer.
#[derive(Debug, Error)]
pub enum Failure {
    /// A mistake in a TOML file, with its place.
    #[error(transparent)]
    Toml(Box<TomlError>),
    /// A file that cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// An image that an external renderer did not produce.
    #[error(transparent)]
    Renderer(Box<dyn std::error::Error + Send + Sync>),
    /// A simulation that cannot be made.
    #[error(transparent)]
    Simulation(#[from] sim::SimError),
    /// A value that the contract does not allow, or a pipeline that cannot be built.
    #[error(transparent)]
    Contract(#[from] contract::ContractError),
    /// A pipeline that never began its work.
    #[error(transparent)]
    NotStarted(#[from] contract::FailedStarts),
    /// Whoever asked for the answer does not want it any more.
    #[error("interrupted")]
    Interrupted,
    /// Anything else, in words.
    #[error("{0}")]
    Usage(String),
}

impl Failure {
    /// Exit status of a command that fails.
    pub const EXIT_STATUS: u8 = 2;

    /// The message for a person, with the lines of the file around the mistake where there is one.
    pub fn explain(&self) -> String {
        match self {
            Self::Toml(error) | Self::File(FileError::Toml(error)) => error.explain(),
            _ => format!("error: {self}"),
        }
    }
}

impl From<Box<TomlError>> for Failure {
    fn from(error: Box<TomlError>) -> Self {
        Self::Toml(error)
    }
}

impl From<contract::OutOfRange> for Failure {
    fn from(error: contract::OutOfRange) -> Self {
        Self::Contract(error.into())
    }
}
