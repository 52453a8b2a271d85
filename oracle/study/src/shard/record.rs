//! `study.json`: definition of a study with its scenario, for comparing its rows with others.
use std::path::Path;

use files::{Failure, FileError};
use scenario::run_file::FileDigests;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use toml::Table;

use crate::definition::Study;

/// Resolved definition of a study that was run, which identifies the study without any other file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudyRecord {
    /// Name of the study.
    pub name: String,
    /// `far_range` or `docking`.
    pub world: String,
    /// Seed of all draws of the study.
    pub seed: u64,
    /// Version of Boresight.
    pub version: String,
    /// Content of the study file that the rows depend on: design, distributions, sweeps, frames, number of
    /// cases; `sha256:` and the digits replace the path of each file.
    pub study: Table,
    /// SHA-256 of each file that the scenario reads, by role.
    #[serde(default, skip_serializing_if = "FileDigests::is_empty")]
    pub files: FileDigests,
    /// Scenario from which the cases are derived, with all defaults.
    pub scenario: Table,
}

impl StudyRecord {
    /// Creates the record of a study.
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
    /// [`FileError`] when the file is missing or is not a record.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let text = config::regular_file::read_text(path, 1 << 24)
            .map_err(|source| FileError::io(path, "read", source))?;
        serde_json::from_str(&text).map_err(|error| FileError::format(path, "study", error))
    }
}

/// Converts a JSON object to TOML, which has no null: keys with null are left out.
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
