//! Failures with their location: of a file, and of a command.

pub mod failure;
pub(crate) mod file_error;

pub use failure::Failure;
pub use file_error::{FileError, FileLocation, create_new, open_regular};
