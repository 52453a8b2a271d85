//! Files of a run, or of a dataset that a pipeline processed, from which a page is made.

use std::path::{Path, PathBuf};

use files::{Failure, existing_file_beside};

/// Directory of a run or of a rendered dataset, and the measurements to report.
#[derive(Debug, Clone)]
pub struct RunFiles {
    /// Directory with `run.toml` and `truth/`.
    pub directory: PathBuf,
    /// File of measurements.
    pub measurements: PathBuf,
}

impl RunFiles {
    /// Returns the files of a directory with its own measurements.
    pub fn of_directory(directory: &Path) -> Self {
        Self { directory: directory.to_owned(), measurements: directory.join("measurements.csv") }
    }

    /// Returns the path of a file of the directory.
    pub fn path(&self, name: &str) -> PathBuf {
        self.directory.join(name)
    }

    /// Returns the path of a file that belongs to the measurements ([`files::file_beside`]), if it exists.
    pub fn beside(&self, name: &str) -> Option<PathBuf> {
        existing_file_beside(&self.measurements, name)
    }

    /// Returns the path of the score that the run wrote. `None` for measurements of another file and for a
    /// dataset, which are scored for the report.
    pub fn score(&self) -> Option<PathBuf> {
        let own = self.measurements == self.path("measurements.csv");
        Some(self.path("score.json")).filter(|path| own && path.is_file())
    }

    /// Refuses a directory that lacks a file of a run, or measurements that do not exist.
    ///
    /// # Errors
    /// [`Failure::Usage`] that names the missing file, and how it is made.
    pub fn check(&self, names: &[&str]) -> Result<(), Failure> {
        for name in names {
            if !self.path(name).is_file() {
                return Err(crate::read::missing(&self.directory, name));
            }
        }
        if self.measurements.is_file() {
            return Ok(());
        }
        Err(Failure::Usage(format!(
            "{}: is missing, expected the measurements of a pipeline; `boresight process {}` makes those of the \
             built-in one, and --measurements names those of another",
            self.measurements.display(),
            self.directory.display()
        )))
    }
}
