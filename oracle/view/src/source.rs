//! Directory whose frames are shown.
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use files::{Checksums, Failure, FileError, Row, TableReader, existing_file_beside};
use run::{AnyWorld, world_of_run, worlds};

/// A run directory or a dataset.
pub struct Source {
    /// Path of the directory.
    pub directory: PathBuf,
    /// World of the directory.
    pub world: &'static dyn AnyWorld,
    /// Name for titles: the directory's name, until the scenario's name is read from `run.toml`.
    pub name: String,
    /// True if there is a `run.toml`, from which frames can be drawn again and outcomes scored.
    pub has_run: bool,
    /// File of measurements, if there is one.
    pub measurements: Option<PathBuf>,
}

impl Source {
    /// Examines a directory.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a path that is neither a run directory nor a dataset.
    pub fn open(directory: &Path, measurements: Option<&Path>) -> Result<Self, Failure> {
        let has = |name: &str| directory.join(name).is_file();
        let run = directory.join("run.toml");
        let of_dataset = worlds().into_iter().find(|world| has(world.facts().setup_file));
        let world = if has("run.toml") {
            world_of_run(&run)?
        } else if let Some(world) = of_dataset {
            world
        } else {
            let what = if directory.is_dir() {
                "contains no run.toml, camera.toml or setup.toml"
            } else if directory.exists() {
                "is not a directory"
            } else {
                "does not exist"
            };
            return Err(Failure::Usage(format!(
                "{} {what}, expected a run directory (boresight run) or a dataset (boresight render)",
                directory.display()
            )));
        };
        if !has("telemetry.csv") {
            return Err(Failure::Usage(format!(
                "{}: telemetry.csv is missing, expected a finished run or dataset",
                directory.display()
            )));
        }
        let name = std::path::absolute(directory)
            .ok()
            .and_then(|path| Some(path.file_name()?.to_string_lossy().into_owned()))
            .unwrap_or_else(|| directory.to_string_lossy().into_owned());
        let default = || Some(directory.join("measurements.csv")).filter(|path| path.is_file());
        Ok(Self {
            directory: directory.to_owned(),
            world,
            name,
            has_run: has("run.toml"),
            measurements: measurements.map(Path::to_path_buf).or_else(default),
        })
    }

    /// Returns the path of a file in the directory, if it exists.
    pub fn file(&self, name: &str) -> Option<PathBuf> {
        Some(self.directory.join(name)).filter(|path| path.is_file())
    }

    /// Returns the path of a file beside the measurements, if it exists.
    pub fn beside_measurements(&self, name: &str) -> Option<PathBuf> {
        self.measurements.as_ref().and_then(|path| existing_file_beside(path, name))
    }

    /// Returns the requested rows of the telemetry, in the requested order.
    ///
    /// # Errors
    /// [`Failure::Usage`] that names the first number without a row, and the range of existing numbers.
    pub fn select<'a, R>(
        &self,
        unit: &str,
        rows: &'a [R],
        numbers: &[u64],
        number_of: impl Fn(&R) -> u64,
    ) -> Result<Vec<&'a R>, Failure> {
        let find = |&number: &u64| {
            rows.binary_search_by_key(&number, &number_of).ok().and_then(|place| rows.get(place)).ok_or_else(
                || {
                    let ends = rows.first().zip(rows.last());
                    let known = ends.map_or_else(String::new, |(first, last)| {
                        format!(", {} to {}", number_of(first), number_of(last))
                    });
                    Failure::Usage(format!(
                        "{}: has no {unit} {number}, expected one of its {}{known}",
                        self.directory.join("telemetry.csv").display(),
                        rows.len()
                    ))
                },
            )
        };
        numbers.iter().map(find).collect()
    }

    /// Verifies the files against their checksums.
    ///
    /// # Errors
    /// A [`FileError`] for a file that was changed.
    pub fn check(&self) -> Result<(), FileError> {
        Checksums::check(&self.directory, |name| !matches!(name, "stars.csv" | "motion.csv" | "score.json"))
    }
}

/// Reads the rows of some frames from a table, in one pass; returns no rows if there is no table.
pub fn rows_of<R: Row>(path: Option<&Path>, numbers: &[u64]) -> Result<BTreeMap<u64, Vec<R>>, FileError> {
    let mut found = BTreeMap::new();
    if let Some(path) = path {
        let mut table = TableReader::<R>::open(path)?;
        for &number in &BTreeSet::from_iter(numbers) {
            found.insert(*number, table.rows_of(*number)?);
        }
    }
    Ok(found)
}

/// Returns the failure of a frame that can be neither read nor drawn again.
pub fn not_stored(source: &Source, unit: &str, number: u64) -> Failure {
    Failure::Usage(format!(
        "{}: no image listed for {unit} {number}, expected an image, or run.toml beside the table to render \
         it again",
        source.directory.join("telemetry.csv").display()
    ))
}
