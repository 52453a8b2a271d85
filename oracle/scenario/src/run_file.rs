//! `run.toml`: enough to repeat a run.
use std::path::Path;

use files::sha256::sha256_hex;
use files::toml_file::{self, TomlError};
use files::{Failure, FileError, WholeFile};
use serde::{Deserialize, Serialize};

use crate::{DockingScenario, FarRangeScenario, Stage};

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
    /// SHA-256 of the resolved scenario as it stands below, hexadecimal.
    pub hash: String,
    /// The stage whose result was replaced by the truth; absent in an honest run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inject: Option<Stage>,
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

/// A scenario of one world as its files hold it.
///
/// Reading a scenario is the largest code of the program. These methods are not generic, so that it is compiled here, once per world, and
/// not in every crate that reads a run.
pub trait ScenarioFile: Clone {
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
}

macro_rules! scenario_file {
    ($scenario:ty) => {
        impl ScenarioFile for $scenario {
            fn parse(file: &Path, text: &str) -> Result<Self, Box<TomlError>> {
                toml_file::parse(file, text)
            }

            fn parse_run(file: &Path, text: &str) -> Result<RunFile<Self>, Box<TomlError>> {
                toml_file::parse(file, text)
            }

            fn to_toml(&self) -> Result<String, Failure> {
                to_toml(self)
            }

            fn run_to_toml(run: &RunFile<Self>) -> Result<String, Failure> {
                to_toml(run)
            }
        }
    };
}

scenario_file!(FarRangeScenario);
scenario_file!(DockingScenario);

impl<S: ScenarioFile> RunFile<S> {
    /// The file of a run that is about to start.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the scenario cannot be written as TOML.
    pub fn new(
        name: &str,
        scenario: &S,
        catalog_sha256: Option<&str>,
        inject: Option<Stage>,
    ) -> Result<Self, Failure> {
        Ok(Self {
            name: name.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            catalog_sha256: catalog_sha256.map(str::to_owned),
            hash: sha256_hex(scenario.to_toml()?),
            inject,
            mitsuba: None,
            scenario: scenario.clone(),
        })
    }

    /// Writes the file, at once or not at all.
    ///
    /// # Errors
    /// [`Failure`] when it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Failure> {
        let text = S::run_to_toml(self)?;
        Ok(WholeFile::with_text(path, &text)?.commit_new()?)
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
        if sha256_hex(run_file.scenario.to_toml()?) == run_file.hash {
            Ok(run_file)
        } else {
            let message =
                "is not the hash of the scenario below: the file was edited after the run".to_owned();
            Err(toml_file::refuse(path, &text, "hash", message).into())
        }
    }
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

fn to_toml(value: &impl Serialize) -> Result<String, Failure> {
    toml::to_string(value).map_err(|error| Failure::Usage(format!("the scenario cannot be written: {error}")))
}
