//! Reasons why a command gives no result.

use thiserror::Error;

use crate::FileError;
use config::toml_file::TomlError;

/// Bad input or usage: any reason that keeps a command from giving a result.
#[derive(Debug, Error)]
pub enum Failure {
    /// A mistake in a TOML file, with its location.
    #[error(transparent)]
    Toml(Box<TomlError>),
    /// A file that cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A failure of an external renderer to produce an image.
    #[error(transparent)]
    Renderer(Box<dyn std::error::Error + Send + Sync>),
    /// A simulation that cannot be set up.
    #[error(transparent)]
    Simulation(#[from] sim::SimError),
    /// A value that the contract does not allow, or a pipeline that cannot be built.
    #[error(transparent)]
    Contract(#[from] contract::ContractError),
    /// A pipeline that never started.
    #[error(transparent)]
    NotStarted(#[from] contract::FailedStarts),
    /// A fault of the machine that kept an image from a pipeline.
    #[error(transparent)]
    Machine(#[from] contract::MachineFault),
    /// The request was cancelled.
    #[error("interrupted")]
    Interrupted,
    /// Any other failure, as text.
    #[error("{0}")]
    Usage(String),
}

impl Failure {
    /// Exit status of a command that fails.
    pub const EXIT_STATUS: u8 = 2;

    /// Returns the message for the user, with the lines of the file around the mistake if there is one.
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
