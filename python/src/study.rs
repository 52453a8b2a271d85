//! Studies: Monte Carlo campaigns over varied parameters.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};

use boresight::failure::Failure;
use boresight::files::read_parquet_table;
use boresight::pipeline_choice::PipelineChoice;
use boresight::run::FirstFailure;
use boresight::study::{Campaign, CaseOutcome, CaseResult, Study, StudyPipeline, Workers};
use pipeline::external::DEFAULT_MEMORY_MB;
use pyo3::prelude::*;
use tempfile::TempDir;

use crate::arguments;
use crate::errors::{BoresightError, file_error, raised};
use crate::json::text_to_python;
use crate::progress::{Progress, ProgressCounter};
use crate::study_pipeline::PythonStudyPipeline;
use crate::table::Table;
use crate::wait::{AfterCtrlC, Interruption, interruptibly};

/// Result of a study: its summary, and one row per case.
#[pyclass(frozen, module = "boresight")]
pub(crate) struct StudyResult {
    directory: PathBuf,
    cases: PathBuf,
    summary: String,
    first_failure: Option<(u64, FirstFailure)>,
    _temporary: Option<TempDir>,
}

impl StudyResult {
    /// Returns the directory of the study.
    pub(crate) fn path(&self) -> &Path {
        &self.directory
    }
}

#[pymethods]
impl StudyResult {
    /// Directory of the study.
    #[getter]
    fn directory(&self) -> &Path {
        &self.directory
    }

    /// Figures with intervals, sensitivities and the worst cases: the dictionary of summary.json
    /// (docs/studies.md).
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        text_to_python(py, &self.summary)
    }

    /// First failure of the pipeline among the cases run by this call, (case, frame, reason); None if the
    /// pipeline never failed.
    #[getter]
    fn first_failure(&self) -> Option<(u64, u64, &str)> {
        self.first_failure.as_ref().map(|(case, failure)| (*case, failure.frame, failure.reason.as_str()))
    }

    /// Table with one row per case: `case`, `seed`, `set.PATH` for each drawn value, and NAME, NAME.count,
    /// NAME.of for each figure.
    #[getter]
    fn rows(&self, py: Python<'_>) -> PyResult<Table> {
        Table::from_parts(py.detach(|| read_parquet_table(&self.cases)).map_err(file_error)?)
    }

    fn __repr__(&self) -> String {
        format!("<boresight.StudyResult in {}>", self.directory.display())
    }
}

/// Runs the missing cases of a study and summarises it, as the command `boresight study run` does.
///
/// `path` is the study's file (docs/studies.md). `out` is a directory that keeps the results; a later call
/// with this directory runs only the missing cases. Without `out` the results are in a temporary directory,
/// deleted with the object. `jobs`: threads that make frames, 1 to 1024; default: all cores. `timeout_s`:
/// longest time that an `exec:` pipeline may take for a frame, s.
///
/// `pipeline` is None (the built-in pipeline), `exec:COMMAND`, a callable of (frame, telemetry), or a class
/// of such callables, as in `run`. Cases run in parallel and call the pipeline one at a time. A class is
/// instantiated for every case, with the case's setup; a function is called for frames of several cases in
/// turn, and must keep no state. An exception that it raises becomes the outcome of the frame.
///
/// `progress`: None shows a bar in a notebook (with tqdm or ipywidgets) and on a terminal; True shows it on
/// standard error elsewhere too, False nowhere; a function of (done, total) is called instead.
#[pyfunction]
#[pyo3(signature = (path, *, out=None, pipeline=None, jobs=None, timeout_s=10.0, progress=None))]
pub(crate) fn study(
    py: Python<'_>,
    path: PathBuf,
    out: Option<PathBuf>,
    pipeline: Option<&Bound<'_, PyAny>>,
    jobs: Option<i64>,
    timeout_s: f64,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<StudyResult> {
    let jobs = arguments::jobs(jobs)?;
    let ended = Arc::new(Interruption::default());
    let pipeline: Box<dyn StudyPipeline + Send> = match pipeline {
        Some(given) if given.extract::<String>().is_err() => {
            Box::new(PythonStudyPipeline::new(given, &ended)?)
        }
        word => Box::new(PipelineChoice {
            word: word.map(|word| word.extract()).transpose()?,
            timeout_s,
            memory_mb: DEFAULT_MEMORY_MB,
            sandbox: None,
        }),
    };
    let temporary = |error: std::io::Error| {
        BoresightError::new_err(format!("a temporary directory cannot be made: {error}"))
    };
    let scratch = tempfile::tempdir().map_err(temporary)?;
    let kept = if out.is_none() { Some(tempfile::tempdir().map_err(temporary)?) } else { None };
    let directory = out.or_else(|| kept.as_ref().map(|kept| kept.path().to_owned())).unwrap_or_default();
    let folder = directory.clone();
    let study = Study::read(&path).map_err(raised)?;
    let progress = Progress::new(py, progress, study.cases(), "cases", &study.name)?;
    let counter = progress.counter();
    let work = move |ended: &AtomicBool| {
        let campaign = Campaign::open(&study, pipeline.as_ref(), &folder, None)?;
        let workers = Workers { jobs, scratch: scratch.path(), ended: Some(ended) };
        run_campaign(&campaign, &path, workers, &counter)
    };
    let done = interruptibly(py, AfterCtrlC::Ends, &ended, || progress.update(), work);
    let (summary, first_failure) = done.inspect_err(|_| progress.abandon(py))?;
    progress.finish(py)?;
    let cases = directory.join("cases.parquet");
    Ok(StudyResult { directory, cases, summary, first_failure, _temporary: kept })
}

/// Runs the missing cases; returns the summary as JSON, and the first failure of the pipeline with its case.
fn run_campaign(
    campaign: &Campaign<'_>,
    path: &Path,
    workers: Workers<'_>,
    counter: &ProgressCounter,
) -> Result<(String, Option<(u64, FirstFailure)>), Failure> {
    let first_failure: Mutex<Option<(u64, FirstFailure)>> = Mutex::new(None);
    let cases = campaign.run(workers, |case| {
        counter.increment();
        if let CaseOutcome::Run(CaseResult { row, first_failure: Some(failure), .. }) = case {
            let mut first = first_failure.lock().unwrap_or_else(PoisonError::into_inner);
            if first.as_ref().is_none_or(|(case, _)| row.case < *case) {
                *first = Some((row.case, failure.clone()));
            }
        }
    })?;
    let summary = campaign.finish(path, &cases)?;
    let summary = serde_json::to_string(&summary)
        .map_err(|error| Failure::Usage(format!("the summary cannot be written as JSON: {error}")))?;
    Ok((summary, first_failure.into_inner().unwrap_or_else(PoisonError::into_inner)))
}
