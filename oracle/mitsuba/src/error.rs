//! Why Mitsuba gives no image.
use std::io;

use files::{Failure, FileError};
use thiserror::Error;

use super::{VARIANT, VERSION};

/// Why Mitsuba gives no image.
#[derive(Debug, Error)]
pub enum MitsubaError {
    /// There is no Mitsuba.
    #[error(
        "Mitsuba is not there: neither `mitsuba` nor `uvx` is on the PATH. Get it with `pip install \
         mitsuba=={VERSION}`, or name its command with --mitsuba or in BORESIGHT_MITSUBA"
    )]
    Missing,
    /// A command that was asked for and is not one.
    #[error("{origin} is `{text}`, expected a command, as `/opt/venv/bin/mitsuba`")]
    NoCommand {
        /// Where it comes from: `--mitsuba` or `BORESIGHT_MITSUBA`.
        origin: &'static str,
        /// The text.
        text: String,
    },
    /// A command that does not start.
    #[error("`{command}`, the command of Mitsuba, cannot be started: {source}")]
    Start {
        /// The command.
        command: String,
        /// The system's reason.
        source: io::Error,
    },
    /// Another version, or another program.
    #[error("`{command}` is {found}, expected Mitsuba {VERSION}: `pip install mitsuba=={VERSION}`")]
    WrongVersion {
        /// The command.
        command: String,
        /// What it says it is.
        found: String,
    },
    /// A Mitsuba without the variant.
    #[error("`{command}` has no variant {VARIANT}; the one of `pip install mitsuba=={VERSION}` has it")]
    VariantMissing {
        /// The command.
        command: String,
    },
    /// It took too long, and was ended with all its processes.
    #[error("Mitsuba was ended after {limit_s} s while it was {doing}; its last words: {words}")]
    TimeLimit {
        /// The limit.
        limit_s: f64,
        /// What it did.
        doing: String,
        /// The end of what it wrote.
        words: String,
    },
    /// It refused the scene.
    #[error("Mitsuba refused the scene while {doing}: {words}")]
    Scene {
        /// What it did.
        doing: String,
        /// The end of what it wrote.
        words: String,
    },
    /// It failed in any other way.
    #[error("Mitsuba ended with {status} while {doing}; its last words: {words}")]
    Failed {
        /// How it ended.
        status: String,
        /// What it did.
        doing: String,
        /// The end of what it wrote.
        words: String,
    },
    /// It says that it is done, and the image is not one of the scene.
    #[error("Mitsuba's image of the layer {layer} {problem}")]
    Image {
        /// Which kind of light.
        layer: &'static str,
        /// What is wrong.
        problem: String,
    },
    /// A scene that cannot be told to Mitsuba.
    #[error(transparent)]
    Simulation(#[from] sim::SimError),
    /// A file that cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
}

impl From<MitsubaError> for Failure {
    fn from(error: MitsubaError) -> Self {
        Self::Renderer(Box::new(error))
    }
}
