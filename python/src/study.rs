//! Studies: Monte Carlo over what can vary.

use std::path::{Path, PathBuf};

use boresight::failure::Failure;
use boresight::files::arrow_of_parquet;
use boresight::pipeline_choice::PipelineChoice;
use boresight::study::{Campaign, Study, Workers};
use pyo3::prelude::*;
use tempfile::TempDir;

use crate::arguments;
use crate::errors::{BoresightError, file_error};
use crate::json::text_to_python;
use crate::table::Table;
use crate::wait::{AfterCtrlC, interruptibly};

/// What a study gave: its summary, and a row a case.
#[pyclass(frozen, module = "boresight")]
pub(crate) struct StudyResult {
    directory: PathBuf,
    cases: PathBuf,
    summary: String,
    _temporary: Option<TempDir>,
}

#[pymethods]
impl StudyResult {
    /// The directory of the study.
    #[getter]
    fn directory(&self) -> &Path {
        &self.directory
    }

    /// Figures with intervals, sensitivities, the worst cases: the dictionary of summary.json (docs/studies.md).
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        text_to_python(py, &self.summary)
    }

    /// A row a case: `case`, `seed`, `set.PATH` for what was drawn, and NAME, NAME.count, NAME.of for each figure.
    #[getter]
    fn rows(&self, py: Python<'_>) -> PyResult<Table> {
        let (schema, batches) = py.detach(|| arrow_of_parquet(&self.cases)).map_err(file_error)?;
        Ok(Table::new(schema, batches))
    }

    fn __repr__(&self) -> String {
        format!("<boresight.StudyResult in {}>", self.directory.display())
    }
}

/// Runs what is missing of a study and sums it up, as the command `boresight study run` does.
///
/// `path` is the study's file (docs/studies.md). `out` keeps the results; run again with it, only what is missing is made. Without it they
/// are in a temporary directory, gone with the object. `pipeline` is None (the built-in one) or `exec:COMMAND`.
#[pyfunction]
#[pyo3(signature = (path, *, out=None, pipeline=None, jobs=None, timeout_s=10.0))]
pub(crate) fn study(
    py: Python<'_>,
    path: PathBuf,
    out: Option<PathBuf>,
    pipeline: Option<String>,
    jobs: Option<i64>,
    timeout_s: f64,
) -> PyResult<StudyResult> {
    let jobs = arguments::jobs(jobs)?;
    let temporary = |error: std::io::Error| {
        BoresightError::new_err(format!("a temporary directory cannot be made: {error}"))
    };
    let scratch = tempfile::tempdir().map_err(temporary)?;
    let kept = if out.is_none() { Some(tempfile::tempdir().map_err(temporary)?) } else { None };
    let directory = out.or_else(|| kept.as_ref().map(|kept| kept.path().to_owned())).unwrap_or_default();
    let folder = directory.clone();
    let choice = PipelineChoice { word: pipeline, timeout_s };
    let summary = interruptibly(py, AfterCtrlC::Ends, move |ended| {
        let study = Study::read(&path)?;
        let campaign = Campaign::open(&study, &choice, &folder, None)?;
        let workers = Workers { jobs, scratch: scratch.path(), ended: Some(ended) };
        let table = campaign.run(workers, |_| ())?;
        let summary = campaign.finish(&path, &table)?;
        serde_json::to_string(&summary)
            .map_err(|error| Failure::Usage(format!("the summary cannot be written as JSON: {error}")))
    })?;
    let cases = directory.join("cases.parquet");
    Ok(StudyResult { directory, cases, summary, _temporary: kept })
}
