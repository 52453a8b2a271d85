//! Simulation, processing and scoring: the command `run`, with access to its directory.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use boresight::docking::DockingScenario;
use boresight::failure::Failure;
use boresight::files::{Checksums, RunDirectory, read_parquet_table};
use boresight::pipeline_choice::PipelineChoice;
use boresight::read_csv_table;
use boresight::run::{Expectation, FirstFailure, FrameJobs, ScenarioSource};
use pipeline::external::DEFAULT_MEMORY_MB;
use pyo3::prelude::*;
use tempfile::TempDir;

use crate::arrow::batch;
use crate::errors::{BoresightError, FileError, file_error, raised, refused};
use crate::prepared_scenario::PreparedScenario;
use crate::progress::Progress;
use crate::python_pipeline::PythonPipeline;
use crate::scenario::Scenario;
use crate::table::Table;
use crate::wait::Interruption;
use crate::worlds::factory;
use crate::{arguments, json};

/// Maximum size of a score.json that is read, bytes.
const MAX_SCORE_BYTES: u64 = 1 << 26;

/// Result of a run: score, truth and measurements.
///
/// A view of the run's directory (docs/formats.md). Without `out` the directory is temporary and is deleted
/// with the object.
#[pyclass(frozen, module = "boresight")]
pub(crate) struct Run {
    path: PathBuf,
    is_docking: bool,
    first_failure: Option<FirstFailure>,
    _temporary: Option<TempDir>,
}

impl Run {
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    fn parquet(&self, py: Python<'_>, name: &str) -> PyResult<Table> {
        let path = self.path.join(name);
        Table::from_parts(py.detach(|| read_parquet_table(&path)).map_err(file_error)?)
    }

    fn csv(&self, py: Python<'_>, name: &str) -> PyResult<Table> {
        let path = self.path.join(name);
        let columns = py.detach(|| read_csv_table(&path)).map_err(file_error)?;
        batch(columns).map(Table::from_batch)
    }

    fn check_world(&self, what: &str, is_docking: bool) -> PyResult<()> {
        if self.is_docking == is_docking {
            return Ok(());
        }
        let (of, expected) = if is_docking {
            ("the far range", "a docking run")
        } else {
            ("docking", "a run of the far range")
        };
        Err(refused(what, format!("not available for a run of {of}"), expected))
    }
}

#[pymethods]
impl Run {
    /// Opens the directory of a run, written by the command or with `out`.
    #[staticmethod]
    fn load(directory: PathBuf) -> PyResult<Self> {
        let file = directory.join("run.toml");
        if !file.is_file() {
            return Err(FileError::new_err(format!(
                "{}: run.toml is missing, expected the directory of a run",
                directory.display()
            )));
        }
        let source = ScenarioSource::read(&file.to_string_lossy()).map_err(raised)?;
        Checksums::check(&directory, |_| true).map_err(file_error)?;
        let is_docking = source.world().has_scenario::<DockingScenario>();
        Ok(Self { path: directory, is_docking, first_failure: None, _temporary: None })
    }

    /// Directory of the run.
    #[getter]
    fn directory(&self) -> &Path {
        &self.path
    }

    /// Score as a dictionary: score.json, described in docs/score.md. Rates are 0 to 1; each figure has its
    /// count and its 95 % interval.
    #[getter]
    fn score<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let path = self.path.join("score.json");
        let text = config::regular_file::read_text(&path, MAX_SCORE_BYTES);
        let text = text.map_err(|error| FileError::new_err(format!("{}: {error}", path.display())))?;
        json::text_to_score(py, &text)
    }

    /// First failure of the pipeline, (frame, reason); None if the pipeline never failed or the run was
    /// loaded.
    #[getter]
    fn first_failure(&self) -> Option<(u64, &str)> {
        self.first_failure.as_ref().map(|failure| (failure.frame, failure.reason.as_str()))
    }

    /// Truth of each frame: truth/frames.parquet (docking: truth/fields.parquet).
    #[getter]
    fn truth_frames(&self, py: Python<'_>) -> PyResult<Table> {
        self.parquet(py, if self.is_docking { "truth/fields.parquet" } else { "truth/frames.parquet" })
    }

    /// Truth of each object in each frame: truth/objects.parquet. Far range only.
    #[getter]
    fn truth_objects(&self, py: Python<'_>) -> PyResult<Table> {
        self.check_world("truth_objects", false)?;
        self.parquet(py, "truth/objects.parquet")
    }

    /// Outcomes of the pipeline: measurements.csv.
    #[getter]
    fn measurements(&self, py: Python<'_>) -> PyResult<Table> {
        self.csv(py, "measurements.csv")
    }

    /// Telemetry of each frame, the data that a pipeline receives beside the pixels: telemetry.csv.
    #[getter]
    fn telemetry(&self, py: Python<'_>) -> PyResult<Table> {
        self.csv(py, "telemetry.csv")
    }

    /// Label that the pipeline assigned to each cluster: clusters.parquet. Far range only.
    #[getter]
    fn clusters(&self, py: Python<'_>) -> PyResult<Table> {
        self.check_world("clusters", false)?;
        self.parquet(py, "clusters.parquet")
    }

    /// Report of the pipeline at the end of each portion: motion.csv. Docking only.
    #[getter]
    fn motion(&self, py: Python<'_>) -> PyResult<Table> {
        self.check_world("motion", true)?;
        self.csv(py, "motion.csv")
    }

    fn __repr__(&self) -> String {
        format!("<boresight.Run in {}>", self.path.display())
    }
}

/// Makes frames, processes them with a pipeline, and scores its outcomes, as the command `boresight run` does
/// and with the same numbers.
///
/// `scenario`: a scenario, the name of a built-in scenario, or the path of a TOML file. `frames`: a `range`
/// of step 1; default: all frames (docking: fields). `jobs`: threads that make frames, 1 to 1024; default:
/// all cores. The results do not depend on `jobs`. `out`: a new or empty directory that keeps the run.
/// `timeout_s`: longest time that an `exec:` pipeline may take for a frame, s.
///
/// `pipeline` is None (the built-in pipeline), `exec:COMMAND`, a callable of (frame, telemetry), or a class
/// that is instantiated with the setup and whose instances are such callables. A callable returns
/// `Detection`, `NoSolution`, None (no target) or a dictionary with the keys of docs/external-pipeline.md; in
/// docking `Pose`, `RangeOnly`, `NoSolution` or None. An exception that it raises becomes the outcome of the
/// frame, with its message; only an exception that is no `Exception` (Ctrl-C) ends the run.
///
/// `progress`: None shows a bar in a notebook (with tqdm or ipywidgets) and on a terminal; True shows it on
/// standard error elsewhere too, False nowhere; a function of (done, total) is called instead.
#[pyfunction]
#[pyo3(signature = (
    scenario, *, frames=None, pipeline=None, jobs=None, out=None, timeout_s=10.0, progress=None
))]
#[allow(clippy::too_many_arguments, reason = "keyword arguments of Python")]
pub(crate) fn run(
    py: Python<'_>,
    scenario: &Bound<'_, PyAny>,
    frames: Option<&Bound<'_, PyAny>>,
    pipeline: Option<&Bound<'_, PyAny>>,
    jobs: Option<i64>,
    out: Option<PathBuf>,
    timeout_s: f64,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Run> {
    let prepared = Scenario::from_argument(scenario)?;
    let frames = arguments::frames(frames, prepared.frame_count())?;
    let jobs = arguments::jobs(jobs)?;
    let ended = Arc::new(Interruption::default());
    let temporary = |error: std::io::Error| {
        BoresightError::new_err(format!("a temporary directory cannot be made: {error}"))
    };
    let scratch = tempfile::tempdir().map_err(temporary)?;
    let asked = pipeline_argument(pipeline, timeout_s, &prepared, &ended)?;
    let image = prepared.source.world().image();
    let count = frames.end - frames.start;
    let progress = Progress::new(py, progress, count, &format!("{image}s"), &prepared.source.name)?;
    let counter = progress.counter();
    let frame_done = || {
        counter.increment();
        progress.update().map_err(|error| {
            ended.set(error);
            Failure::Interrupted
        })?;
        ended.go_on()
    };
    let run = || {
        // The pipeline is created first, before anything is written.
        let world = &prepared.world;
        let factory = match asked {
            PipelineArgument::Word(choice) => world.factory(&choice, scratch.path())?,
            PipelineArgument::Python(pipeline) => factory(prepared.source.world(), pipeline)?,
        };
        let (directory, temporary) = create_directory(out.as_deref())?;
        let frame_jobs =
            FrameJobs { frames, jobs, images: None, expectation: Expectation::Dropped, states_of: None };
        let ran = world.run(&directory, &frame_jobs, &factory, &frame_done)?;
        match ran.incomplete {
            None => Ok((directory, temporary, ran.first_failure)),
            Some(incomplete) => Err(Failure::Usage(incomplete.to_string())),
        }
    };
    let ran: Result<_, Failure> = py.detach(run);
    let ran = ended.take().map_or_else(|| ran.map_err(raised), Err);
    let (directory, temporary, first_failure) = ran.inspect_err(|_| progress.abandon(py))?;
    progress.finish(py)?;
    let is_docking = prepared.source.world().has_scenario::<DockingScenario>();
    Ok(Run { path: directory.path().to_owned(), is_docking, first_failure, _temporary: temporary })
}

/// Requested pipeline.
enum PipelineArgument {
    Word(PipelineChoice),
    Python(PythonPipeline),
}

/// Reads the argument `pipeline` of a run.
fn pipeline_argument(
    pipeline: Option<&Bound<'_, PyAny>>,
    timeout_s: f64,
    prepared: &PreparedScenario,
    ended: &Arc<Interruption>,
) -> PyResult<PipelineArgument> {
    match pipeline {
        Some(given) if given.extract::<String>().is_err() => {
            Ok(PipelineArgument::Python(PythonPipeline::new(given, prepared, ended)?))
        }
        word => {
            let word = word.map(|word| word.extract()).transpose()?;
            let choice = PipelineChoice { word, timeout_s, memory_mb: DEFAULT_MEMORY_MB, sandbox: None };
            Ok(PipelineArgument::Word(choice))
        }
    }
}

/// Creates the directory of a run; without `out` inside a temporary directory, which is returned too.
fn create_directory(out: Option<&Path>) -> Result<(RunDirectory, Option<TempDir>), Failure> {
    if let Some(out) = out {
        return Ok((RunDirectory::create(out)?, None));
    }
    let temporary = tempfile::Builder::new().prefix("boresight-run-").tempdir();
    let temporary = temporary
        .map_err(|error| Failure::Usage(format!("a temporary directory cannot be made: {error}")))?;
    Ok((RunDirectory::create(temporary.path())?, Some(temporary)))
}
