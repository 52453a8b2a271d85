//! `run.toml`: enough to repeat a run.

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::docking_renderer::MitsubaRecord;
use crate::failure::Failure;
use crate::files::{FileError, WholeFile};
use crate::inject::Stage;
use crate::scenario::FarRangeScenario;
use crate::sha256::sha256_hex;
use crate::toml_file;

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

impl<S: Clone + Serialize + DeserializeOwned> RunFile<S> {
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
            hash: sha256_hex(&to_toml(scenario)?),
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
        let text = to_toml(self)?;
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
        let run_file: Self = toml_file::parse(path, &text)?;
        if sha256_hex(&to_toml(&run_file.scenario)?) == run_file.hash {
            Ok(run_file)
        } else {
            let message =
                "is not the hash of the scenario below: the file was edited after the run".to_owned();
            Err(toml_file::refuse(path, &text, "hash", message).into())
        }
    }
}

fn to_toml(value: &impl Serialize) -> Result<String, Failure> {
    toml::to_string(value).map_err(|error| Failure::Usage(format!("the scenario cannot be written: {error}")))
}
