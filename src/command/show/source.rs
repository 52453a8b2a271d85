//! The directory that frames are shown of.
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use files::{Checksums, Failure, FileError, Row, TableReader};
use run::{AnyWorld, world_of_run, worlds};

/// A run directory or a dataset.
pub(super) struct Source {
    /// The directory.
    pub(super) directory: PathBuf,
    /// Its world.
    pub(super) world: &'static dyn AnyWorld,
    /// Name for titles: that of the directory, until `run.toml` tells the scenario's.
    pub(super) name: String,
    /// Whether there is a `run.toml`: frames can be drawn again, and answers be judged.
    pub(super) has_run: bool,
    /// The answers, where there are any.
    pub(super) measurements: Option<PathBuf>,
}

impl Source {
    /// Looks into a directory.
    ///
    /// # Errors
    /// [`Failure::Usage`] for what is neither a run directory nor a dataset.
    pub(super) fn open(directory: &Path, measurements: Option<&Path>) -> Result<Self, Failure> {
        let has = |name: &str| directory.join(name).is_file();
        let run = directory.join("run.toml");
        let of_dataset = worlds().into_iter().find(|world| has(world.setup_file()));
        let world = if has("run.toml") {
            world_of_run(&run)?
        } else if let Some(world) = of_dataset {
            world
        } else {
            let what = if directory.is_dir() {
                "holds neither run.toml nor camera.toml nor setup.toml"
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
                "{}: telemetry.csv is missing, expected a run or dataset that is finished",
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

    /// A file of the directory, if it is there.
    pub(super) fn file(&self, name: &str) -> Option<PathBuf> {
        Some(self.directory.join(name)).filter(|path| path.is_file())
    }

    /// A file beside the answers, if it is there.
    pub(super) fn beside_measurements(&self, name: &str) -> Option<PathBuf> {
        self.measurements.as_ref().map(|path| path.with_file_name(name)).filter(|path| path.is_file())
    }

    /// The rows of the telemetry that are asked for, in the order asked for.
    ///
    /// # Errors
    /// [`Failure::Usage`] that names the first number without a row, and those that have one.
    pub(super) fn select<'a, R>(
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
                        "{}: there is no {unit} {number}, expected one of its {}{known}",
                        self.directory.join("telemetry.csv").display(),
                        rows.len()
                    ))
                },
            )
        };
        numbers.iter().map(find).collect()
    }

    /// Holds the files that were read against their checksums.
    ///
    /// # Errors
    /// A [`FileError`] for a file that was changed.
    pub(super) fn check(&self) -> Result<(), FileError> {
        Checksums::check(&self.directory, |name| !matches!(name, "stars.csv" | "motion.csv" | "score.json"))
    }
}

/// The rows of some frames of a table, in one pass; none where there is no table.
pub(super) fn rows_of<R: Row>(
    path: Option<&Path>,
    numbers: &[u64],
) -> Result<BTreeMap<u64, Vec<R>>, FileError> {
    let mut found = BTreeMap::new();
    if let Some(path) = path {
        let mut table = TableReader::<R>::open(path)?;
        for &number in &BTreeSet::from_iter(numbers) {
            found.insert(*number, table.rows_of(*number)?);
        }
    }
    Ok(found)
}
