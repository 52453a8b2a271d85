//! `run.toml`: enough to repeat a run.
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::path::Path;

use files::sha256::sha256_hex;
use files::toml_file;
use files::{AtomicFile, FileError};
use serde::{Deserialize, Serialize};

use crate::{FarRangeScenario, Stage};

// For `scenario_file!`.
#[doc(hidden)]
pub use {
    files::Failure,
    files::toml_file::{TomlError, parse},
    schemars::{Schema, SchemaGenerator},
    serde_json::Value,
};

/// SHA-256 of the files that a scenario reads, hexadecimal, by their roles ([`ScenarioFile::paths`]).
pub type FileDigests = BTreeMap<String, String>;

/// What stands for a file where only its content matters.
pub fn content(sha256: &str) -> String {
    format!("sha256:{sha256}")
}

/// What was run: the resolved scenario of one world with all defaults, and what else the frames depend on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunFile<S = FarRangeScenario> {
    /// Name of the scenario.
    pub name: String,
    /// Version of Boresight that made the frames.
    pub version: String,
    /// SHA-256 of the star catalogue's source, hexadecimal; absent in a world without stars.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub catalog_sha256: Option<String>,
    /// SHA-256 of the resolved scenario as it stands below, the path of every file replaced by its content (`sha256:` and the digits),
    /// hexadecimal: the same wherever the files lie.
    pub hash: String,
    /// The stage whose result was replaced by the truth; absent in an honest run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inject: Option<Stage>,
    /// The files that the scenario reads: SHA-256 by role.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub files: FileDigests,
    /// How the scene was drawn, where the fast renderer did not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mitsuba: Option<MitsubaRecord>,
    /// The scenario.
    pub scenario: S,
}

/// What images by Mitsuba depend on besides the scenario: the table `[mitsuba]` of `run.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MitsubaRecord {
    /// Its version.
    pub version: String,
    /// Its variant.
    pub variant: String,
    /// Rays a pixel.
    pub rays_per_px: u32,
}

/// A scenario of one world as its files hold it. [`scenario_file!`](crate::scenario_file) implements it.
///
/// Reading a scenario is the largest code of the program. These methods are not generic, so that it is compiled where the type is, once per
/// world, and not in every crate that reads a run.
pub trait ScenarioFile: Clone + Debug + Send + Sync + 'static {
    /// The word of its world: the key `world` of its files.
    const WORLD: &'static str;

    /// Reads the text of a scenario, which came from `file`.
    ///
    /// # Errors
    /// A [`TomlError`] with the place of the first mistake.
    fn parse(file: &Path, text: &str) -> Result<Self, Box<TomlError>>;

    /// Reads the text of a `run.toml`, which came from `file`.
    ///
    /// # Errors
    /// A [`TomlError`] with the place of the first mistake.
    fn parse_run(file: &Path, text: &str) -> Result<RunFile<Self>, Box<TomlError>>;

    /// The scenario as TOML, all defaults written out.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a value that TOML does not have.
    fn to_toml(&self) -> Result<String, Failure>;

    /// The text of a `run.toml`.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a value that TOML does not have.
    fn run_to_toml(run: &RunFile<Self>) -> Result<String, Failure>;

    /// All its values, defaults included.
    ///
    /// # Errors
    /// [`Failure::Usage`] when they cannot be written as JSON.
    fn to_json(&self) -> Result<Value, Failure>;

    /// The JSON Schema of its files.
    fn schema(generator: SchemaGenerator) -> Schema;

    /// The same as a part of another schema.
    fn subschema(generator: &mut SchemaGenerator) -> Schema;

    /// What it is, in one line.
    fn title(&self) -> &str;

    /// Seed of its random draws.
    fn seed(&self) -> u64;

    /// Gives it another seed.
    fn set_seed(&mut self, seed: u64);

    /// The paths of the files that it reads, which start from the folder of its file, each under its role: the place of its key, as in
    /// `psf.path`. The default is a scenario that reads none.
    fn paths(&mut self) -> Vec<(&'static str, &mut String)> {
        Vec::new()
    }
}

/// Implements [`ScenarioFile`](crate::run_file::ScenarioFile) for a type with serde's traits, `JsonSchema` and fields `title` and
/// `seed`: `scenario_file!(MyScenario, "my_world")`. Of a scenario that reads files, a method gives their paths:
/// `scenario_file!(MyScenario, "my_world", paths_of_files)`.
#[macro_export]
macro_rules! scenario_file {
    ($scenario:ty, $world:literal $(, $paths:ident)?) => {
        impl $crate::run_file::ScenarioFile for $scenario {
            const WORLD: &'static str = $world;

            fn parse(file: &::std::path::Path, text: &str) -> Result<Self, Box<$crate::run_file::TomlError>> {
                $crate::run_file::parse(file, text)
            }

            fn parse_run(
                file: &::std::path::Path,
                text: &str,
            ) -> Result<$crate::run_file::RunFile<Self>, Box<$crate::run_file::TomlError>> {
                $crate::run_file::parse(file, text)
            }

            fn to_toml(&self) -> Result<String, $crate::run_file::Failure> {
                $crate::run_file::to_toml(self)
            }

            fn run_to_toml(
                run: &$crate::run_file::RunFile<Self>,
            ) -> Result<String, $crate::run_file::Failure> {
                $crate::run_file::to_toml(run)
            }

            fn to_json(&self) -> Result<$crate::run_file::Value, $crate::run_file::Failure> {
                $crate::run_file::to_json(self)
            }

            fn schema(generator: $crate::run_file::SchemaGenerator) -> $crate::run_file::Schema {
                generator.into_root_schema_for::<Self>()
            }

            fn subschema(generator: &mut $crate::run_file::SchemaGenerator) -> $crate::run_file::Schema {
                generator.subschema_for::<Self>()
            }

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
        }
    };
}

impl<S> RunFile<S> {
    /// The same run with its scenario in another form.
    pub fn map<T>(self, form: impl FnOnce(S) -> T) -> RunFile<T> {
        let Self { name, version, catalog_sha256, hash, inject, files, mitsuba, scenario } = self;
        RunFile { name, version, catalog_sha256, hash, inject, files, mitsuba, scenario: form(scenario) }
    }
}

impl<S: ScenarioFile> RunFile<S> {
    /// The file of a run that is about to start.
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

    /// The scenario with the content of every file in the place of its path: equal for runs of the same files, wherever they lie.
    pub fn identity(&self) -> S {
        with_contents(&self.scenario, &self.files)
    }

    /// Writes the file, at once or not at all.
    ///
    /// # Errors
    /// [`Failure`] when it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Failure> {
        let text = S::run_to_toml(self)?;
        Ok(AtomicFile::with_text(path, &text)?.commit_new()?)
    }

    /// Reads the file.
    ///
    /// # Errors
    /// [`Failure`] with the place of the first mistake, or when the scenario is no longer the one that was run.
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

/// A scenario with the content of every file of `files` in the place of its path.
fn with_contents<S: ScenarioFile>(scenario: &S, files: &FileDigests) -> S {
    let mut scenario = scenario.clone();
    for (role, path) in scenario.paths() {
        if let Some(sha256) = files.get(role) {
            *path = content(sha256);
        }
    }
    scenario
}

/// Whether a version is this one or one before it: what a later one writes may mean something else.
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
