//! Reasons why Mitsuba provides no image.
use std::io;

use files::{Failure, FileError};
use thiserror::Error;

use super::{VARIANT, VERSION};

/// Reason why Mitsuba provides no image.
#[derive(Debug, Error)]
pub enum MitsubaError {
    /// Mitsuba is not installed.
    #[error(
        "Mitsuba is not installed: neither `mitsuba` nor `uvx` is on the PATH. Install it with `pip install \
         mitsuba=={VERSION}`, or give its command with --mitsuba or in BORESIGHT_MITSUBA"
    )]
    Missing,
    /// The requested command is not a valid command line.
    #[error("{origin} is `{text}`, expected a command such as `/opt/venv/bin/mitsuba`")]
    NoCommand {
        /// Origin of the text: `--mitsuba` or `BORESIGHT_MITSUBA`.
        origin: &'static str,
        /// The invalid text.
        text: String,
    },
    /// The command cannot be started.
    #[error("Mitsuba cannot be started with `{command}`: {source}")]
    Start {
        /// Command line that was to be started.
        command: String,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The command starts another version, or another program.
    #[error("`{command}` is {found}, expected Mitsuba {VERSION}: `pip install mitsuba=={VERSION}`")]
    WrongVersion {
        /// Command line of the program that was found.
        command: String,
        /// Version or program that was found.
        found: String,
    },
    /// Mitsuba lacks the variant.
    #[error("`{command}` lacks the variant {VARIANT}; `pip install mitsuba=={VERSION}` provides it")]
    VariantMissing {
        /// Command line of Mitsuba.
        command: String,
    },
    /// Mitsuba exceeded the time limit and was killed with all its processes.
    #[error("Mitsuba exceeded the time limit of {limit_s} s while {doing}; last output: {words}")]
    TimeLimit {
        /// Time limit, s.
        limit_s: f64,
        /// Step during which the limit was exceeded.
        doing: String,
        /// Last lines of Mitsuba's output.
        words: String,
    },
    /// Mitsuba refused the scene.
    #[error("Mitsuba refused the scene while {doing}: {words}")]
    Scene {
        /// Step during which the scene was refused.
        doing: String,
        /// Last lines of Mitsuba's output.
        words: String,
    },
    /// Mitsuba failed for any other reason.
    #[error("Mitsuba ended with {status} while {doing}; last output: {words}")]
    Failed {
        /// Exit status of Mitsuba.
        status: String,
        /// Step during which Mitsuba failed.
        doing: String,
        /// Last lines of Mitsuba's output.
        words: String,
    },
    /// Mitsuba reports success, but its image does not fit the scene.
    #[error("Mitsuba's image of the layer {layer} {problem}")]
    Image {
        /// Name of the light layer.
        layer: &'static str,
        /// Description of the fault.
        problem: String,
    },
    /// The scene cannot be described to Mitsuba.
    #[error(transparent)]
    Simulation(#[from] sim::SimError),
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
}

impl From<MitsubaError> for Failure {
    fn from(error: MitsubaError) -> Self {
        Self::Renderer(Box::new(error))
    }
}
