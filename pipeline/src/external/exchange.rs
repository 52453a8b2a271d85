//! Interface for the lines sent to an external pipeline and received from it.

use std::path::Path;

use contract::Interface;
use hifitime::Epoch;

/// Function that writes a time as UTC in ISO 8601 with `Z`, as in the caller's files. The caller is
/// responsible for leap seconds.
pub type WriteTime = fn(Epoch) -> String;

/// Lines sent to an external pipeline of an interface, and its answers.
pub trait Protocol: Interface {
    /// Extension of the image files.
    const EXTENSION: &'static str;

    /// Returns the greeting line.
    ///
    /// # Errors
    /// The reason why there is none.
    fn greeting(setup: &Self::Setup) -> Result<Vec<u8>, String>;

    /// Returns the line for an image stored at `path`.
    ///
    /// # Errors
    /// The reason why there is none.
    fn request(
        image: &Self::Image,
        telemetry: &Self::Telemetry,
        write_time: WriteTime,
        path: &Path,
    ) -> Result<Vec<u8>, String>;

    /// Returns the outcome stated by an answer to image `number`.
    ///
    /// # Errors
    /// The reason why the answer cannot be used.
    fn outcome(answer: &[u8], number: u64, setup: &Self::Setup) -> Result<Self::Outcome, String>;
}
