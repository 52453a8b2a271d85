//! Which pipeline runs: the built-in one, or somebody else's program.

use std::path::Path;
use std::sync::Arc;

use contract::PipelineFactory;
use pipeline::external::ExternalFactory;
use pipeline::far_range::{FarRangeConfig, FarRangeFactory};

use crate::failure::Failure;
use crate::files::{FrameHeader, ImageFormat, format_utc, write_frame};
use crate::toml_file;

const FAR_RANGE: &str = "far_range";
const EXEC: &str = "exec:";

/// A pipeline by the word of the command line: `far_range`, or `exec:COMMAND`.
#[derive(Debug, Clone, PartialEq)]
pub struct PipelineChoice {
    /// The word.
    pub word: String,
    /// Longest time that a program may take for a frame, s.
    pub timeout_s: f64,
}

impl PipelineChoice {
    /// Whether it is the built-in one.
    pub fn is_built_in(&self) -> bool {
        self.word == FAR_RANGE
    }

    /// The factory. A program finds the images of its frames in `scratch`.
    ///
    /// # Errors
    /// A [`Failure`] for a word that names no pipeline, a command that is none, or a limit outside its range.
    pub fn factory(
        &self,
        far_range: &FarRangeConfig,
        scratch: &Path,
    ) -> Result<Box<dyn PipelineFactory>, Failure> {
        if let Some(command) = self.word.strip_prefix(EXEC) {
            let mut factory =
                ExternalFactory::new(command, scratch.to_path_buf(), Arc::new(write_image), format_utc);
            factory.timeout_s = self.timeout_s;
            // Now, while nothing has been written for it.
            factory.check()?;
            return Ok(Box::new(factory));
        }
        if self.word == FAR_RANGE {
            return Ok(Box::new(
                FarRangeFactory::new(far_range.clone()).map_err(|error| Failure::Usage(error.to_string()))?,
            ));
        }
        let hint = toml_file::nearest(&self.word, [FAR_RANGE, EXEC])
            .map_or(String::new(), |name| format!("; did you mean `{name}`?"));
        Err(Failure::Usage(format!(
            "there is no pipeline `{}`; expected `far_range` or `exec:COMMAND`{hint}",
            self.word
        )))
    }
}

/// Writes a frame for a program: FITS with no more in its header than telemetry says.
fn write_image(frame: &contract::Frame, telemetry: &contract::Telemetry, path: &Path) -> Result<(), String> {
    let header = FrameHeader {
        time: telemetry.time,
        exposure_s: telemetry.exposure_s,
        gain_e_per_dn: None,
        seed: 0,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        configuration_hash: String::new(),
        observer_velocity_km_s: None,
        wcs: None,
    };
    write_frame(path, ImageFormat::Fits, frame, &header).map_err(|error| error.to_string())
}
