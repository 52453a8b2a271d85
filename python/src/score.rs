//! Score of measurements from any source.

use std::path::{Path, PathBuf};

use boresight::failure::Failure;
use boresight::files::{Checksums, existing_file_beside};
use boresight::run::world_of_run;
use boresight::scenario::AttitudeChoice;
use boresight::toml_file::read_text;
use pyo3::prelude::*;

use crate::arguments;
use crate::errors::{BoresightError, FileError, raised, refused};
use crate::json::text_to_score;
use crate::run::Run;

/// Scores measurements against the truth, as the command `boresight score` does.
///
/// `truth` is a `Run`, or the directory of a run or of a rendered dataset. `measurements` is a file or a
/// table: a table of boresight, polars, pandas or pyarrow, or a dictionary of columns. Its columns are those
/// of measurements.csv (docs/formats.md); `frame`, `status`, `x_px`, `y_px` are enough (docking: `field`,
/// `status`, `d1_m` ... `phi3_deg`). A frame of the truth without a row is a miss. If `measurements` is a
/// file, `clusters.parquet` (docking: `motion.csv`) beside it is read too, as evidence for the causes of
/// misses. `attitude`, `telemetry` or `true`, selects the attitude that converts centroids without a line of
/// sight to one. Returns the dictionary of score.json.
#[pyfunction]
#[pyo3(signature = (truth, measurements, *, attitude=None))]
pub(crate) fn score<'py>(
    py: Python<'py>,
    truth: &Bound<'py, PyAny>,
    measurements: &Bound<'py, PyAny>,
    attitude: Option<&str>,
) -> PyResult<Bound<'py, PyAny>> {
    let attitude = attitude.map(attitude_choice).transpose()?;
    let directory = match truth.cast::<Run>() {
        Ok(run) => run.get().path().to_owned(),
        Err(_) => PathBuf::from(arguments::word("truth", truth)?),
    };
    if let Ok(path) = measurements.extract::<PathBuf>() {
        let scored = py.detach(|| score_json(&directory, &path, attitude));
        return text_to_score(py, &scored.map_err(raised)?);
    }
    let text: String =
        py.import("boresight._values")?.call_method1("csv_text", (measurements,))?.extract()?;
    let temporary = |error: std::io::Error| {
        BoresightError::new_err(format!("a temporary file cannot be written: {error}"))
    };
    let folder = tempfile::tempdir().map_err(temporary)?;
    let path = folder.path().join("measurements.csv");
    std::fs::write(&path, text).map_err(temporary)?;
    let scored = py.detach(|| score_json(&directory, &path, attitude));
    let scored = scored.map_err(|failure| {
        // A table has no file: line numbers in the message count its rows, below the column names.
        let told = failure.to_string().replace(&path.display().to_string(), "measurements");
        match raised(failure) {
            error if error.is_instance_of::<FileError>(py) => FileError::new_err(told),
            _ => crate::errors::InputError::new_err(told),
        }
    });
    text_to_score(py, &scored?)
}

/// Parses the name of an attitude, as the command does.
fn attitude_choice(word: &str) -> PyResult<AttitudeChoice> {
    match word {
        "telemetry" => Ok(AttitudeChoice::Telemetry),
        "true" => Ok(AttitudeChoice::True),
        other => Err(refused("attitude", format!("`{other}`"), "`telemetry` or `true`")),
    }
}

/// Scores a file of measurements and returns the score as JSON.
fn score_json(
    directory: &Path,
    measurements: &Path,
    attitude: Option<AttitudeChoice>,
) -> Result<String, Failure> {
    let run_file = directory.join("run.toml");
    let unreadable = |error| {
        Failure::Usage(format!(
            "{}: cannot read: {error}, expected the directory of a run",
            run_file.display()
        ))
    };
    read_text(&run_file).map_err(unreadable)?;
    let world = world_of_run(&run_file)?;
    let neighbouring_file = || existing_file_beside(measurements, world.facts().evidence_file?);
    let json = world.score(directory, measurements, neighbouring_file().as_deref(), attitude)?.json()?;
    Checksums::check(directory, |_| true)?;
    Ok(json)
}
