//! Whether answers are of the frames that they are to be scored with, as far as records tell.

use std::path::Path;

use files::{ColumnValues, Failure, FileError, FileLocation, ParquetFile, read_origins};
use hifitime::Epoch;
use indexmap::IndexMap;
use scenario::AttitudeChoice;
use scenario::identity::{first_difference, split};
use scenario::run_file::RunFile;
use sim::truth::clock;
use toml::{Table, Value};

use crate::any_world::source::world_of_run;
use crate::any_world::{AnyJudgement, AnyScenario, AnyWorld};

/// How far a time in a table of answers may be off, s: half of a millisecond is rounded away by whoever writes three decimals.
const TIME_TOLERANCE_S: f64 = 1e-3;
/// Rows that are read at a time.
const ROWS: usize = 8192;

impl dyn AnyWorld {
    /// Scores answers with the truth of `directory`, if they are of its frames as far as records tell; centroids with `attitude` in the place
    /// of what the scenario says.
    ///
    /// # Errors
    /// [`Failure::Usage`] for answers that are of other frames; those of [`AnyWorld::score_files`].
    pub fn score(
        &self,
        directory: &Path,
        measurements: &Path,
        evidence: Option<&Path>,
        attitude: Option<AttitudeChoice>,
    ) -> Result<Box<dyn AnyJudgement>, Failure> {
        for file in [Some(measurements), evidence].into_iter().flatten() {
            check_record_beside(self, directory, file)?;
        }
        check_origins(self, directory, measurements)?;
        self.score_files(directory, measurements, evidence, attitude)
    }
}

/// Refuses answers that lie beside the `run.toml` of other frames than those of `directory`. The parameters of the pipeline may differ.
///
/// # Errors
/// [`Failure::Usage`] with what differs first and both its values; a [`Failure`] for a `run.toml` that cannot be read.
fn check_record_beside(world: &dyn AnyWorld, directory: &Path, answers: &Path) -> Result<(), Failure> {
    let [truth, record] =
        [directory, answers.parent().unwrap_or(Path::new(""))].map(|folder| folder.join("run.toml"));
    let canonical = |path: &Path| path.canonicalize().ok();
    if !record.is_file() || canonical(&record) == canonical(&truth) {
        return Ok(());
    }
    let other = world_of_run(&record)?;
    let refuse = |field: &str, found: &str, expected: &str| {
        Failure::Usage(format!(
            "{}: {} are of another run: `{field}` is `{found}`, expected `{expected}`, as in {}",
            record.display(),
            answers.file_name().unwrap_or_default().display(),
            truth.display()
        ))
    };
    if other.code() != world.code() {
        return Err(refuse("world", other.code(), world.code()));
    }
    let runs = [world.read_run(&record)?, world.read_run(&truth)?];
    let [found, expected] = runs.map(|run| frames(world, &run).map(Value::Table));
    match first_difference(&found?, &expected?) {
        Some((field, found, expected)) => Err(refuse(field.trim_start_matches('.'), &found, &expected)),
        None => Ok(()),
    }
}

/// All that the frames of a run depend on.
fn frames(world: &dyn AnyWorld, run: &RunFile<Box<dyn AnyScenario>>) -> Result<Table, Failure> {
    let text = run.scenario.to_toml()?;
    let unreadable = |error| Failure::Usage(format!("the scenario cannot be read again: {error}"));
    let mut scenario = split(world.code(), text.parse().map_err(unreadable)?, &run.files)?.scenario;
    // How a run is scored is no property of its frames.
    scenario.remove("score");
    let optional = [
        ("catalog_sha256", run.catalog_sha256.clone()),
        ("inject", run.inject.map(|stage| stage.to_string())),
        ("renderer", run.mitsuba.as_ref().map(|_| "mitsuba".to_owned())),
    ];
    let mut table = Table::from_iter([
        ("seed".to_owned(), Value::String(run.scenario.seed().to_string())),
        ("scenario".to_owned(), Value::Table(scenario)),
    ]);
    for (key, value) in optional {
        table.insert(key.to_owned(), Value::String(value.unwrap_or_else(|| "none".to_owned())));
    }
    Ok(table)
}

/// Refuses rows of answers whose time or configuration is not that of the dataset `directory`.
///
/// # Errors
/// A [`Failure`] with line and column of the first one, or for a file that cannot be read.
fn check_origins(world: &dyn AnyWorld, directory: &Path, answers: &Path) -> Result<(), Failure> {
    let origins = read_origins(answers, world.image())?;
    if origins.is_empty() {
        return Ok(());
    }
    let hash = world.read_run(&directory.join("run.toml"))?.hash;
    let times = times(world, &directory.join(world.truth_file()))?;
    for origin in origins {
        let refuse = |column: &str, found: &str, expected: &str| {
            FileError::value(answers, FileLocation::Line(origin.line), column, found, expected)
        };
        if let Some(configuration) = origin.configuration.as_ref().filter(|found| **found != hash) {
            let expected = format!("{hash}, the hash of {}", directory.join("run.toml").display());
            return Err(refuse("configuration", configuration, &expected).into());
        }
        if let Some((found, expected)) = origin.time.zip(times.get(&origin.frame))
            && (found - *expected).to_seconds().abs() > TIME_TOLERANCE_S
        {
            let [found, expected] = [found, *expected].map(files::format_utc);
            let expected = format!("{expected} within a millisecond, as in {}", world.truth_file());
            return Err(refuse("time_utc", &found, &expected).into());
        }
    }
    Ok(())
}

/// The times of the frames of a truth table, by their numbers.
fn times(world: &dyn AnyWorld, truth: &Path) -> Result<IndexMap<u64, Epoch>, Failure> {
    let mut times = IndexMap::new();
    for batch in ParquetFile::open(truth)?.batches(&[world.image(), "time_utc"], ROWS)? {
        let batch = batch?;
        let [numbers, epochs] = batch.as_slice() else { continue };
        if let (ColumnValues::UInt64(numbers), ColumnValues::Timestamp(epochs)) =
            (numbers.values(), epochs.values())
        {
            let epochs = epochs.iter().map(|epoch| epoch.map(|epoch| clock::from_unix_ns(epoch.0)));
            times.extend(numbers.iter().zip(epochs).filter_map(|(number, epoch)| number.zip(epoch)));
        }
    }
    Ok(times)
}
