//! Which pipeline runs: the built-in one, or somebody else's program.

use std::path::Path;
use std::sync::Arc;

use contract::PipelineFactory;
use contract::docking::{DockingPipelineFactory, Field};
use pipeline::docking::{DockingConfig, DockingFactory};
use pipeline::external::{ExternalDockingFactory, ExternalFactory};
use pipeline::far_range::{FarRangeConfig, FarRangeFactory};

use crate::failure::Failure;
use crate::files::{FrameHeader, ImageFormat, format_utc, write_field, write_frame};
use crate::scenario::World;
use crate::toml_file;

const EXEC: &str = "exec:";

/// A pipeline by the word of the command line: the name of a world's built-in one, or `exec:COMMAND`.
#[derive(Debug, Clone, PartialEq)]
pub struct PipelineChoice {
    /// The word; none: the built-in pipeline of the scenario's world.
    pub word: Option<String>,
    /// Longest time that a program may take for a frame, s.
    pub timeout_s: f64,
}

impl PipelineChoice {
    /// Whether it is the built-in one of a world.
    pub fn is_built_in(&self, world: World) -> bool {
        self.word.as_deref().is_none_or(|word| word == world.code())
    }

    /// The factory of a far-range pipeline. A program finds the images of its frames in `scratch`.
    ///
    /// # Errors
    /// A [`Failure`] for a word that names no pipeline of that world, a command that is none, or a limit outside its range.
    pub fn factory(
        &self,
        far_range: &FarRangeConfig,
        scratch: &Path,
    ) -> Result<Box<dyn PipelineFactory>, Failure> {
        let Some(command) = self.command(World::FarRange)? else {
            let factory = FarRangeFactory::new(far_range.clone());
            return Ok(Box::new(factory.map_err(|error| Failure::Usage(error.to_string()))?));
        };
        let mut factory =
            ExternalFactory::new(command, scratch.to_path_buf(), Arc::new(write_image), format_utc);
        factory.timeout_s = self.timeout_s;
        // Now, while nothing has been written for it.
        factory.check()?;
        Ok(Box::new(factory))
    }

    /// The factory of a docking pipeline. A program finds the images of its fields in `scratch`.
    ///
    /// # Errors
    /// As [`PipelineChoice::factory`].
    pub fn docking_factory(
        &self,
        docking: &DockingConfig,
        scratch: &Path,
    ) -> Result<Box<dyn DockingPipelineFactory>, Failure> {
        let Some(command) = self.command(World::Docking)? else {
            let factory = DockingFactory::new(docking.clone());
            return Ok(Box::new(factory.map_err(|error| Failure::Usage(error.to_string()))?));
        };
        let mut factory =
            ExternalDockingFactory::new(command, scratch.to_path_buf(), Arc::new(write_field_image));
        factory.timeout_s = self.timeout_s;
        factory.check()?;
        Ok(Box::new(factory))
    }

    /// The command of a program; `None` for the world's built-in pipeline.
    fn command(&self, world: World) -> Result<Option<&str>, Failure> {
        let Some(word) = self.word.as_deref().filter(|word| *word != world.code()) else { return Ok(None) };
        if let Some(command) = word.strip_prefix(EXEC) {
            return Ok(Some(command));
        }
        let built_in = world.code();
        if World::ALL.iter().any(|other| other.code() == word) {
            return Err(Failure::Usage(format!(
                "the pipeline `{word}` is of another world; expected `{built_in}` or `exec:COMMAND`"
            )));
        }
        let hint = toml_file::nearest(word, [built_in, EXEC])
            .map_or(String::new(), |name| format!("; did you mean `{name}`?"));
        Err(Failure::Usage(format!(
            "there is no pipeline `{word}`; expected `{built_in}` or `exec:COMMAND`{hint}"
        )))
    }
}

/// Writes a field for a program: PNG, which tells nothing but the pixels.
fn write_field_image(field: &Field, path: &Path) -> Result<(), String> {
    write_field(path, field).map_err(|error| error.to_string())
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
