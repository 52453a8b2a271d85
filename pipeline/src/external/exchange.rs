//! What goes to an external pipeline, and what comes back.

use std::path::Path;

use contract::Interface;
use hifitime::Epoch;

/// Writes a time as UTC in ISO 8601 with `Z`, as the caller's files have it: leap seconds are its business.
pub type WriteTime = fn(Epoch) -> String;

/// What an external pipeline of an interface is told and answers, line by line.
pub trait Protocol: Interface {
    /// Extension of the images' files.
    const EXTENSION: &'static str;

    /// The greeting line.
    ///
    /// # Errors
    /// The reason why there is none.
    fn greeting(setup: &Self::Setup) -> Result<Vec<u8>, String>;

    /// The line of an image that lies at `path`.
    ///
    /// # Errors
    /// The reason why there is none.
    fn request(
        image: &Self::Image,
        telemetry: &Self::Telemetry,
        write_time: WriteTime,
        path: &Path,
    ) -> Result<Vec<u8>, String>;

    /// The outcome that an answer to the image of a number says.
    ///
    /// # Errors
    /// Why the answer cannot be used.
    fn outcome(answer: &[u8], number: u64, setup: &Self::Setup) -> Result<Self::Outcome, String>;
}
