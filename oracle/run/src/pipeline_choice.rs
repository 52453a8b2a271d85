//! Which pipeline runs: the built-in one, or somebody else's program.
use std::path::Path;
use std::sync::Arc;

use contract::docking::{Docking, Field, FieldTelemetry};
use contract::{FarRange, PipelineFactory};
use files::{Failure, FrameHeader, ImageFormat, format_utc, toml_file, write_field, write_frame};
use pipeline::docking::{DockingConfig, DockingFactory};
use pipeline::external::ExternalFactory;
use pipeline::far_range::{FarRangeConfig, FarRangeFactory};
use scenario::{Scenario, World};
use sha2::{Digest, Sha256};

const EXEC: &str = "exec:";
/// A larger file among a program's words counts by its name alone.
const MOST_BYTES: u64 = 1 << 30;

/// A pipeline by the word of the command line: the name of a world's built-in one, or `exec:COMMAND`.
#[derive(Debug, Clone, PartialEq)]
pub struct PipelineChoice {
    /// The word; none: the built-in pipeline of the scenario's world.
    pub word: Option<String>,
    /// Longest time that a program may take for a frame, s.
    pub timeout_s: f64,
    /// Most memory of a program, and of each process that it starts, MB (10⁶ bytes).
    pub memory_mb: u64,
}

impl PipelineChoice {
    /// Whether it is the built-in one of a world.
    pub fn is_built_in(&self, world: World) -> bool {
        self.word.as_deref().is_none_or(|word| word == world.code())
    }

    /// Refuses a choice that the world of a scenario does not have, or a program that is not there.
    ///
    /// # Errors
    /// As [`PipelineChoice::factory`].
    pub fn check(&self, scenario: &Scenario) -> Result<(), Failure> {
        let nowhere = Path::new("");
        match scenario {
            Scenario::FarRange(scenario) => self.factory(&scenario.far_range, nowhere).map(drop),
            Scenario::Docking(scenario) => self.docking_factory(&scenario.docking, nowhere).map(drop),
        }
    }

    /// Words of a command line that choose it; none for the built-in one of a world.
    pub fn arguments(&self, world: World) -> Vec<String> {
        match &self.word {
            Some(word) if !self.is_built_in(world) => {
                let (timeout_s, memory_mb) = (self.timeout_s.to_string(), self.memory_mb.to_string());
                ["--pipeline", word, "--timeout-s", &timeout_s, "--memory-mb", &memory_mb]
                    .map(str::to_owned)
                    .to_vec()
            }
            _ => Vec::new(),
        }
    }

    /// SHA-256 of what a program's answers depend on, as far as it can be known: its words, the files among them, its limits of time and memory;
    /// none for the built-in pipeline of a world, whose parameters are the scenario's.
    pub fn hash(&self, world: World) -> Option<[u8; 32]> {
        let word = self.word.as_ref().filter(|_| !self.is_built_in(world))?;
        let mut hash = Sha256::new();
        let mut part = |bytes: &[u8]| {
            hash.update((bytes.len() as u64).to_le_bytes());
            hash.update(bytes);
        };
        part(word.as_bytes());
        part(&self.timeout_s.to_bits().to_le_bytes());
        part(&self.memory_mb.to_le_bytes());
        for file in shlex::split(word.strip_prefix(EXEC).unwrap_or(word)).into_iter().flatten() {
            // A word that names no file is a program of the search path, or an option.
            if let Ok(bytes) = sim::regular_file::read(Path::new(&file), MOST_BYTES) {
                part(&bytes);
            }
        }
        Some(hash.finalize().into())
    }

    /// The factory of a far-range pipeline. A program finds the images of its frames in `scratch`.
    ///
    /// # Errors
    /// A [`Failure`] for a word that names no pipeline of that world, a command that is none, or a limit outside its range.
    pub fn factory(
        &self,
        far_range: &FarRangeConfig,
        scratch: &Path,
    ) -> Result<Box<dyn PipelineFactory<FarRange>>, Failure> {
        let Some(command) = self.command(World::FarRange)? else {
            let factory = FarRangeFactory::new(far_range.clone());
            return Ok(Box::new(factory.map_err(|error| Failure::Usage(error.to_string()))?));
        };
        let mut factory =
            ExternalFactory::new(command, scratch.to_path_buf(), Arc::new(write_image), format_utc);
        factory.timeout_s = self.timeout_s;
        factory.memory_mb = self.memory_mb;
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
    ) -> Result<Box<dyn PipelineFactory<Docking>>, Failure> {
        let Some(command) = self.command(World::Docking)? else {
            let factory = DockingFactory::new(docking.clone());
            return Ok(Box::new(factory.map_err(|error| Failure::Usage(error.to_string()))?));
        };
        let mut factory = ExternalFactory::<Docking>::new(
            command,
            scratch.to_path_buf(),
            Arc::new(write_field_image),
            format_utc,
        );
        factory.timeout_s = self.timeout_s;
        factory.memory_mb = self.memory_mb;
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
fn write_field_image(field: &Field, _: &FieldTelemetry, path: &Path) -> Result<(), String> {
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
