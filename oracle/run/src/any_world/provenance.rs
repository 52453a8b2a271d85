//! Check that outcomes belong to the frames that they are scored with, as far as records show.

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

/// Tolerance of a time in a table of outcomes, s: a tool that writes three decimals rounds by up to half a
/// millisecond.
const TIME_TOLERANCE_S: f64 = 1e-3;
/// Number of rows read at a time.
const ROWS: usize = 8192;

impl dyn AnyWorld {
    /// Scores outcomes with the truth of `directory`, after a check that they belong to its frames as far as
    /// records show. Centroids are scored with `attitude` instead of the attitude that the scenario names.
    ///
    /// # Errors
    /// [`Failure::Usage`] for outcomes of other frames; those of [`AnyWorld::score_files`].
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

/// Refuses outcomes beside a `run.toml` that describes other frames than those of `directory`. The parameters
/// of the pipeline may differ.
///
/// # Errors
/// [`Failure::Usage`] with the first difference and both values; a [`Failure`] for a `run.toml` that cannot
/// be read.
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
            "{}: {} belongs to another run: `{field}` is `{found}`, expected `{expected}`, as in {}",
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

/// Returns all values that the frames of a run depend on.
fn frames(world: &dyn AnyWorld, run: &RunFile<AnyScenario>) -> Result<Table, Failure> {
    let text = run.scenario.to_toml()?;
    let unreadable = |error| Failure::Usage(format!("the scenario cannot be read again: {error}"));
    let mut scenario = split(world.code(), text.parse().map_err(unreadable)?, &run.files)?.scenario;
    // The scoring of a run does not affect its frames.
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

/// Refuses rows of outcomes whose time or configuration differs from that of the dataset `directory`.
///
/// # Errors
/// A [`Failure`] with line and column of the first difference, or for a file that cannot be read.
fn check_origins(world: &dyn AnyWorld, directory: &Path, answers: &Path) -> Result<(), Failure> {
    let origins = read_origins(answers, world.image())?;
    if origins.is_empty() {
        return Ok(());
    }
    let hash = world.read_run(&directory.join("run.toml"))?.hash;
    let times = times(world, &directory.join(world.facts().truth_file))?;
    for origin in origins {
        let refuse = |column: &str, found: &str, expected: &str| {
            FileError::value(answers, FileLocation::Line(origin.line), column, found, expected)
        };
        if let Some(configuration) = origin.configuration.as_ref().filter(|found| **found != hash) {
            let expected = format!("{hash}, the hash in {}", directory.join("run.toml").display());
            return Err(refuse("configuration", configuration, &expected).into());
        }
        if let Some((found, expected)) = origin.time.zip(times.get(&origin.frame))
            && (found - *expected).to_seconds().abs() > TIME_TOLERANCE_S
        {
            let [found, expected] = [found, *expected].map(files::format_utc);
            let expected = format!("{expected} within a millisecond, as in {}", world.facts().truth_file);
            return Err(refuse("time_utc", &found, &expected).into());
        }
    }
    Ok(())
}

/// Returns the times of the frames of a truth table, by frame number.
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
