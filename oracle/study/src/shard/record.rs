//! `study.json`: what a study is of, with its scenario, for whoever compares its rows with others.
use std::path::Path;

use files::{Failure, FileError};
use scenario::run_file::FileDigests;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use toml::Table;

use crate::definition::Study;

/// A study that was run: resolved, so that nothing else is needed to tell what it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudyRecord {
    /// Name of the study.
    pub name: String,
    /// `far_range` or `docking`.
    pub world: String,
    /// Seed of all its draws.
    pub seed: u64,
    /// Version of Boresight.
    pub version: String,
    /// What its rows depend on of its file: design, laws, sweeps, frames, number of cases; `sha256:` and the digits in the place of the path
    /// of a file.
    pub study: Table,
    /// The files that the scenario reads: SHA-256 by role.
    #[serde(default, skip_serializing_if = "FileDigests::is_empty")]
    pub files: FileDigests,
    /// The scenario that its cases begin from, with all defaults.
    pub scenario: Table,
}

impl StudyRecord {
    /// The record of a study.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the study cannot be written.
    pub fn new(study: &Study) -> Result<Self, Failure> {
        let file = serde_json::to_value(study.identity()).map_err(unwritable)?;
        let mut definition = table(file)?;
        for key in ["title", "seed", "scenario", "record"] {
            definition.remove(key);
        }
        Ok(Self {
            name: study.name.clone(),
            world: study.scenario().world().code().to_owned(),
            seed: study.file.seed,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            study: definition,
            files: study.files()?,
            scenario: table(study.scenario().to_json()?)?,
        })
    }

    /// Reads a record.
    ///
    /// # Errors
    /// [`FileError`] when it is not there or is none.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let text = sim::regular_file::read_text(path, 1 << 24)
            .map_err(|source| FileError::io(path, "read", source))?;
        serde_json::from_str(&text).map_err(|error| FileError::format(path, "study", error))
    }
}

/// A JSON object as TOML, which has no null: what is absent is left out.
fn table(value: Value) -> Result<Table, Failure> {
    fn without_nulls(value: Value) -> Value {
        match value {
            Value::Object(entries) => entries
                .into_iter()
                .filter(|(_, value)| !value.is_null())
                .map(|(key, value)| (key, without_nulls(value)))
                .collect(),
            Value::Array(values) => values.into_iter().map(without_nulls).collect(),
            other => other,
        }
    }
    Table::try_from(without_nulls(value)).map_err(unwritable)
}

fn unwritable(error: impl std::fmt::Display) -> Failure {
    Failure::Usage(format!("the study cannot be written: {error}"))
}
