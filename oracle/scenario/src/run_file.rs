//! `run.toml`: the data needed to repeat a run.
use std::any::Any;
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::path::Path;

use config::toml_file;
use files::sha256::sha256_hex;
use files::{AtomicFile, FileError};
use serde::{Deserialize, Serialize};

use crate::Stage;

// Used by `scenario_file!`.
#[doc(hidden)]
pub use {
    config::toml_file::{TomlError, parse},
    files::Failure,
    schemars::{Schema, SchemaGenerator},
    serde_json::Value,
};

/// SHA-256 of the files that a scenario reads, hexadecimal, by their roles ([`ScenarioValues::paths`]).
pub type FileDigests = BTreeMap<String, String>;

/// Returns the digest text that replaces a file's path where only its content matters.
pub fn content(sha256: &str) -> String {
    format!("sha256:{sha256}")
}

/// Description of a run: the resolved scenario of one world with all defaults, and all other inputs of the
/// frames.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunFile<S> {
    /// Name of the scenario.
    pub name: String,
    /// Version of Boresight that made the frames.
    pub version: String,
    /// SHA-256 of the star catalogue's source, hexadecimal; absent in a world without stars.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub catalog_sha256: Option<String>,
    /// SHA-256 of the resolved scenario below, with the path of every file replaced by its digest (`sha256:`
    /// and the digits), hexadecimal: independent of the location of the files.
    pub hash: String,
    /// Stage whose result was replaced by the truth; absent if no stage was replaced.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inject: Option<Stage>,
    /// SHA-256 of the files that the scenario reads, by role.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub files: FileDigests,
    /// Settings of Mitsuba; absent for the fast renderer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mitsuba: Option<MitsubaRecord>,
    /// Scenario of the run.
    pub scenario: S,
}

/// Settings, besides the scenario, that images by Mitsuba depend on: the table `[mitsuba]` of `run.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MitsubaRecord {
    /// Version of Mitsuba.
    pub version: String,
    /// Variant of Mitsuba.
    pub variant: String,
    /// Number of rays per pixel.
    pub rays_per_px: u32,
}

/// Values of a scenario of any world. [`scenario_file!`](crate::scenario_file) implements it.
pub trait ScenarioValues: Any + Debug + Send + Sync {
    /// Returns the title of the scenario, one line.
    fn title(&self) -> &str;

    /// Returns the seed of the random draws.
    fn seed(&self) -> u64;

    /// Sets the seed of the random draws.
    fn set_seed(&mut self, seed: u64);

    /// Returns the paths of the files that the scenario reads, relative to the directory of its file, each
    /// with its role: the path of its key, as in `psf.path`. The default is a scenario that reads no files.
    fn paths(&mut self) -> Vec<(&'static str, &mut String)> {
        Vec::new()
    }

    /// Returns the scenario as TOML, including defaults.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a value that TOML cannot express.
    fn to_toml(&self) -> Result<String, Failure>;

    /// Returns all values of the scenario, including defaults.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the values cannot be written as JSON.
    fn to_json(&self) -> Result<Value, Failure>;

    /// Returns a boxed copy.
    fn boxed(&self) -> Box<dyn ScenarioValues>;
}

/// A scenario of one world in the form of its files. [`scenario_file!`](crate::scenario_file) implements it.
///
/// Reading a scenario is the largest code of the program. These methods are not generic, so that the code is
/// compiled in the crate of the type, once per world, and not in every crate that reads a run.
pub trait ScenarioFile: ScenarioValues + Clone {
    /// Code of the world: the key `world` of its files.
    const WORLD: &'static str;
    /// Commented scenario as a starting point for the user.
    const STARTING_POINT: &'static str;

    /// Parses the text of a scenario, which was read from `file`.
    ///
    /// # Errors
    /// A [`TomlError`] with the location of the first mistake.
    fn parse(file: &Path, text: &str) -> Result<Self, Box<TomlError>>;

    /// Parses the text of a `run.toml`, which was read from `file`.
    ///
    /// # Errors
    /// A [`TomlError`] with the location of the first mistake.
    fn parse_run(file: &Path, text: &str) -> Result<RunFile<Self>, Box<TomlError>>;

    /// Returns the text of a `run.toml`.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a value that TOML cannot express.
    fn run_to_toml(run: &RunFile<Self>) -> Result<String, Failure>;

    /// Returns the JSON Schema of the scenario's files.
    fn schema(generator: SchemaGenerator) -> Schema;

    /// Returns the JSON Schema of the scenario's files as a part of another schema.
    fn subschema(generator: &mut SchemaGenerator) -> Schema;
}

/// Implements [`ScenarioFile`](crate::run_file::ScenarioFile) for a type with serde's traits, `JsonSchema`
/// and fields `title` and `seed`: `scenario_file!(MyScenario, "my_world", STARTING_POINT)`, where the last is
/// a commented scenario. For a scenario that reads files, a method returns their paths:
/// `scenario_file!(MyScenario, "my_world", STARTING_POINT, paths_of_files)`.
#[macro_export]
macro_rules! scenario_file {
    ($scenario:ty, $world:literal, $start:expr $(, $paths:ident)?) => {
        impl $crate::run_file::ScenarioValues for $scenario {
            fn title(&self) -> &str {
                &self.title
            }

            fn seed(&self) -> u64 {
                self.seed
            }

            fn set_seed(&mut self, seed: u64) {
                self.seed = seed;
            }

            $(fn paths(&mut self) -> Vec<(&'static str, &mut String)> {
                self.$paths()
            })?

            fn to_toml(&self) -> Result<String, $crate::run_file::Failure> {
                $crate::run_file::to_toml(self)
            }

            fn to_json(&self) -> Result<$crate::run_file::Value, $crate::run_file::Failure> {
                $crate::run_file::to_json(self)
            }

            fn boxed(&self) -> Box<dyn $crate::run_file::ScenarioValues> {
                Box::new(self.clone())
            }
        }

        impl $crate::run_file::ScenarioFile for $scenario {
            const WORLD: &'static str = $world;
            const STARTING_POINT: &'static str = $start;

            fn parse(file: &::std::path::Path, text: &str) -> Result<Self, Box<$crate::run_file::TomlError>> {
                $crate::run_file::parse(file, text)
            }

            fn parse_run(
                file: &::std::path::Path,
                text: &str,
            ) -> Result<$crate::run_file::RunFile<Self>, Box<$crate::run_file::TomlError>> {
                $crate::run_file::parse(file, text)
            }

            fn run_to_toml(
                run: &$crate::run_file::RunFile<Self>,
            ) -> Result<String, $crate::run_file::Failure> {
                $crate::run_file::to_toml(run)
            }

            fn schema(generator: $crate::run_file::SchemaGenerator) -> $crate::run_file::Schema {
                generator.into_root_schema_for::<Self>()
            }

            fn subschema(generator: &mut $crate::run_file::SchemaGenerator) -> $crate::run_file::Schema {
                generator.subschema_for::<Self>()
            }
        }
    };
}

impl<S> RunFile<S> {
    /// Converts the scenario of a run to another form.
    pub fn map<T>(self, form: impl FnOnce(S) -> T) -> RunFile<T> {
        let Self { name, version, catalog_sha256, hash, inject, files, mitsuba, scenario } = self;
        RunFile { name, version, catalog_sha256, hash, inject, files, mitsuba, scenario: form(scenario) }
    }
}

impl<S: ScenarioFile> RunFile<S> {
    /// Creates the file of a run that is about to start.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the scenario cannot be written as TOML.
    pub fn new(
        name: &str,
        scenario: &S,
        files: FileDigests,
        catalog_sha256: Option<&str>,
        inject: Option<Stage>,
    ) -> Result<Self, Failure> {
        Ok(Self {
            name: name.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            catalog_sha256: catalog_sha256.map(str::to_owned),
            hash: sha256_hex(with_contents(scenario, &files).to_toml()?),
            inject,
            files,
            mitsuba: None,
            scenario: scenario.clone(),
        })
    }

    /// Returns the scenario with the path of every file replaced by the digest of its content: equal for runs
    /// with the same files, regardless of their location.
    pub fn identity(&self) -> S {
        with_contents(&self.scenario, &self.files)
    }

    /// Writes the file completely or not at all.
    ///
    /// # Errors
    /// [`Failure`] when the file cannot be written, or could not be read again: TOML has no integers above
    /// 2⁶³ − 1, and its writer does not refuse them.
    pub fn write(&self, path: &Path) -> Result<(), Failure> {
        let text = S::run_to_toml(self)?;
        S::parse_run(path, &text).map_err(|error| {
            Failure::Usage(format!("{}: could not be read again: {error}", path.display()))
        })?;
        Ok(AtomicFile::with_text(path, &text)?.commit_new()?)
    }

    /// Reads the file.
    ///
    /// # Errors
    /// [`Failure`] with the location of the first mistake, or when the scenario is no longer the one that was
    /// run.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let text = toml_file::read_text(path).map_err(|source| FileError::Io {
            path: path.to_owned(),
            doing: "read",
            source,
        })?;
        let run_file = S::parse_run(path, &text)?;
        if !is_known(&run_file.version) {
            let version = env!("CARGO_PKG_VERSION");
            let message =
                format!("is `{}`, expected a version of Boresight, {version} or earlier", run_file.version);
            return Err(toml_file::refuse(path, &text, "version", message).into());
        }
        if sha256_hex(run_file.identity().to_toml()?) == run_file.hash {
            Ok(run_file)
        } else {
            let message =
                "is not the hash of the scenario below: the file was edited after the run".to_owned();
            Err(toml_file::refuse(path, &text, "hash", message).into())
        }
    }
}

/// Returns a scenario with the path of every file in `files` replaced by the digest of its content.
fn with_contents<S: ScenarioFile>(scenario: &S, files: &FileDigests) -> S {
    let mut scenario = scenario.clone();
    for (role, path) in scenario.paths() {
        if let Some(sha256) = files.get(role) {
            *path = content(sha256);
        }
    }
    scenario
}

/// Returns true if a version is this version or an earlier one; the files of a later version may have another
/// meaning.
fn is_known(version: &str) -> bool {
    let numbers = |text: &str| -> Option<[u64; 3]> {
        let parts: Result<Vec<u64>, _> = text.split('.').map(str::parse).collect();
        parts.ok()?.try_into().ok()
    };
    numbers(version)
        .is_some_and(|version| numbers(env!("CARGO_PKG_VERSION")).is_some_and(|own| version <= own))
}

#[doc(hidden)]
pub fn to_toml(value: &impl Serialize) -> Result<String, Failure> {
    toml::to_string(value).map_err(|error| Failure::Usage(format!("the scenario cannot be written: {error}")))
}

#[doc(hidden)]
pub fn to_json(value: &impl Serialize) -> Result<Value, Failure> {
    serde_json::to_value(value)
        .map_err(|error| Failure::Usage(format!("the scenario cannot be written as JSON: {error}")))
}
