//! Files of a result: `navigation.csv` and `navigation.json`.

use std::io::Write;
use std::path::Path;

use files::{AtomicFile, Failure, FileError, FileLocation, write_csv};
use serde::{Deserialize, Serialize};

use crate::row::NavigationRow;
use crate::score::NavigationScore;

/// Name of the table of estimates.
pub const TABLE_FILE: &str = "navigation.csv";

/// Name of the file of figures.
pub const FIGURES_FILE: &str = "navigation.json";

/// Largest file of figures that is read.
const MAX_BYTES: u64 = 1 << 24;

/// Result of a navigator on a campaign.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NavigationResult {
    /// Name of the scenario.
    pub scenario: String,
    /// Hash of the run's scenario.
    pub hash: String,
    /// Name of the navigator.
    pub estimator: String,
    /// File of the lines of sight; absent: `measurements.csv` of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measurements_file: Option<String>,
    /// Interval of the estimation times, s.
    pub every_s: f64,
    /// Number of lines of sight.
    pub lines_of_sight: u64,
    /// Number of reported manoeuvres.
    pub manoeuvres: u64,
    /// Figures.
    pub score: NavigationScore,
    /// Estimate and truth at each time; only in `navigation.csv`.
    #[serde(skip)]
    pub rows: Vec<NavigationRow>,
}

impl NavigationResult {
    /// Reads `navigation.json` of a directory; the rows are empty.
    ///
    /// # Errors
    /// [`FileError`] for a file that cannot be read, or is not such a result.
    pub fn read_figures(directory: &Path) -> Result<Self, FileError> {
        let path = directory.join(FIGURES_FILE);
        let text = config::regular_file::read_text(&path, MAX_BYTES).map_err(|source| FileError::Io {
            path: path.clone(),
            doing: "read",
            source,
        })?;
        serde_json::from_str(&text).map_err(|error| FileError::Value {
            path,
            place: FileLocation::Line(error.line() as u64),
            field: "JSON".to_owned(),
            value: error.to_string(),
            expected: "the figures of a navigator".to_owned(),
        })
    }

    /// Checks that the estimates in `directory` are of the run with this hash.
    ///
    /// # Errors
    /// [`FileError::Value`] with both hashes.
    pub fn check_run(&self, directory: &Path, hash: &str) -> Result<(), FileError> {
        if self.hash == hash {
            return Ok(());
        }
        let path = directory.join(FIGURES_FILE);
        let expected = format!("{hash}, the hash of the run: estimates of this run");
        Err(FileError::value(&path, FileLocation::Whole, "hash", &self.hash, expected))
    }

    /// Writes `navigation.csv` and `navigation.json` into a directory, which is created if necessary.
    ///
    /// # Errors
    /// [`FileError::OutputTaken`] if one of them exists; [`FileError::Io`] if it cannot be written.
    pub fn write(&self, directory: &Path) -> Result<(), Failure> {
        std::fs::create_dir_all(directory).map_err(|source| FileError::Io {
            path: directory.to_owned(),
            doing: "create",
            source,
        })?;
        let text = serde_json::to_string_pretty(self)
            .map_err(|error| Failure::Usage(format!("the figures cannot be written as JSON: {error}")))?;
        let path = directory.join(FIGURES_FILE);
        let figures = AtomicFile::create_new(&path)?;
        let written = figures.file().write_all((text + "\n").as_bytes());
        written.map_err(|source| FileError::Io { path, doing: "write", source })?;
        write_csv(&directory.join(TABLE_FILE), &self.rows)?;
        Ok(figures.commit_new()?)
    }
}
