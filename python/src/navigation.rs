//! Relative navigation on a run, and navigators written in Python. Their exceptions become answers that carry
//! their message, like the faults of an external program, and their answers are parsed by the same code.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use boresight::files::format_utc;
use boresight::flight_dynamics::Epoch;
use boresight::navigate::{
    Campaign, KnowledgeConfig, MeasurementSource, NavigatorChoice, TABLE_FILE, navigate_with,
};
use boresight::read_csv_table;
use contract::ContractError;
use contract::navigation::lines::{EstimatesLine, Line, SetupLine};
use contract::navigation::{Answer, Event, Mode, NavigationSetup, Navigator, NavigatorFactory, NoEstimate};
use pipeline::external::DEFAULT_MEMORY_MB;
use pyo3::prelude::*;
use tempfile::TempDir;

use crate::arguments;
use crate::arrow::batch;
use crate::errors::{BoresightError, file_error, raised, refused};
use crate::json::text_to_python;
use crate::python_pipeline::{is_class, name, reason};
use crate::run::Run;
use crate::table::Table;
use crate::wait::Interruption;

/// Result of a navigation: figures, and an estimate at each time.
///
/// A view of its directory. Without `out` the directory is temporary and is deleted with the object.
#[pyclass(frozen, module = "boresight")]
pub(crate) struct Navigation {
    directory: PathBuf,
    json: String,
    _temporary: Option<TempDir>,
}

#[pymethods]
impl Navigation {
    /// Directory of navigation.csv and navigation.json.
    #[getter]
    fn directory(&self) -> &Path {
        &self.directory
    }

    /// Figures as a dictionary: navigation.json, described in docs/score.md.
    #[getter]
    fn figures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        text_to_python(py, &self.json)
    }

    /// Estimate, error and σ at each time: navigation.csv.
    #[getter]
    fn estimates(&self, py: Python<'_>) -> PyResult<Table> {
        let path = self.directory.join(TABLE_FILE);
        batch(py.detach(|| read_csv_table(&path)).map_err(file_error)?).map(Table::from_batch)
    }

    fn __repr__(&self) -> String {
        format!("<boresight.Navigation in {}>", self.directory.display())
    }
}

/// Determines the relative orbit from the lines of sight of a far-range run, and compares it with the truth,
/// as the command `boresight navigate` does and with the same numbers.
///
/// `run`: a `Run` or its directory. `every_s`: interval of the estimates, s. `prior`: False for a navigation
/// without a prior. `out`: directory for navigation.csv and navigation.json, which must not exist there.
/// `timeout_s`: longest time that an `exec:` navigator may take for a request, s.
///
/// `navigator` is `batch`, `sequential`, `exec:COMMAND`, a function of (setup, events, times), which receives
/// all events, or a class that is instantiated with the setup and whose instances are callables of (events,
/// times): the events since the previous call, and the times of the requested estimates. A class with the
/// attribute `mode = "sequential"` is called for each time in turn. Setup and events are dictionaries with
/// the keys of docs/navigation.md. The answer is a list with an entry for each time: a dictionary with the
/// keys of that page, or the reason for no estimate as text. An exception becomes the reason of all times of
/// the call, with its message; only an exception that is no `Exception` (Ctrl-C) ends the navigation.
#[pyfunction]
#[pyo3(signature = (run, *, navigator=None, every_s=600.0, prior=true, out=None, timeout_s=60.0))]
pub(crate) fn navigate(
    py: Python<'_>,
    run: &Bound<'_, PyAny>,
    navigator: Option<&Bound<'_, PyAny>>,
    every_s: f64,
    prior: bool,
    out: Option<PathBuf>,
    timeout_s: f64,
) -> PyResult<Navigation> {
    let run_directory = match run.cast::<Run>() {
        Ok(run) => run.get().path().to_owned(),
        Err(_) => PathBuf::from(arguments::word("run", run)?),
    };
    let ended = Arc::new(Interruption::default());
    let given = match navigator {
        Some(given) if given.extract::<String>().is_err() => Ok(PythonNavigatorFactory::new(given, &ended)?),
        word => {
            let word = word.map(|word| word.extract()).transpose()?;
            Err(NavigatorChoice {
                word: word.unwrap_or_else(|| "batch".to_owned()),
                timeout_s,
                memory_mb: DEFAULT_MEMORY_MB,
                sandbox: None,
            })
        }
    };
    let mut knowledge = KnowledgeConfig::default();
    if !prior {
        knowledge.prior_sigma_m = None;
    }
    let temporary = |error: std::io::Error| {
        BoresightError::new_err(format!("a temporary directory cannot be made: {error}"))
    };
    let scratch = tempfile::tempdir().map_err(temporary)?;
    let kept = if out.is_none() { Some(tempfile::tempdir().map_err(temporary)?) } else { None };
    let directory = out.or_else(|| kept.as_ref().map(|kept| kept.path().to_owned())).unwrap_or_default();
    let result = py.detach(|| {
        let campaign = Campaign::open(&run_directory, &knowledge, &MeasurementSource::default())?;
        let result = match &given {
            Ok(python) => navigate_with(&campaign, python, &python.name, every_s)?,
            Err(choice) => {
                let factory = choice.factory(&campaign, scratch.path())?;
                navigate_with(&campaign, factory.as_ref(), &choice.word, every_s)?
            }
        };
        ended.go_on()?;
        result.write(&directory)?;
        Ok(result)
    });
    if let Some(interrupt) = ended.take() {
        return Err(interrupt);
    }
    let json = serde_json::to_string(&result.map_err(raised)?)
        .map_err(|error| BoresightError::new_err(error.to_string()))?;
    Ok(Navigation { directory, json, _temporary: kept })
}

/// Navigators from a function, or from a class.
struct PythonNavigatorFactory {
    name: String,
    given: Py<PyAny>,
    is_class: bool,
    mode: Mode,
    /// Function that converts the return value to a line of the protocol.
    line: Py<PyAny>,
    ended: Arc<Interruption>,
}

impl PythonNavigatorFactory {
    fn new(given: &Bound<'_, PyAny>, ended: &Arc<Interruption>) -> PyResult<Self> {
        if !given.is_callable() {
            let expected = "None, `batch`, `sequential`, `exec:COMMAND`, a function of (setup, events, \
                            times), or a class whose instances are callables of (events, times)";
            return Err(refused("navigator", format!("of type {}", given.get_type().name()?), expected));
        }
        let is_class = is_class(given);
        let mode = match given.getattr("mode") {
            Ok(word) if is_class => match word.extract::<String>()?.as_str() {
                "batch" => Mode::Batch,
                "sequential" => Mode::Sequential,
                other => {
                    return Err(refused("mode", format!("`{other}`"), "`batch` or `sequential`"));
                }
            },
            _ => Mode::Batch,
        };
        let line = given.py().import("boresight._values")?.getattr("estimates_line")?.unbind();
        let (name, given, ended) = (name(given), given.clone().unbind(), Arc::clone(ended));
        Ok(Self { name, given, is_class, mode, line, ended })
    }
}

impl NavigatorFactory for PythonNavigatorFactory {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn mode(&self) -> Mode {
        self.mode
    }

    fn build(&self, setup: &NavigationSetup) -> Result<Box<dyn Navigator>, ContractError> {
        let cannot_build =
            |reason: String| ContractError::CannotBuild { pipeline: self.name.clone(), reason };
        let text = serde_json::to_string(&SetupLine::new(setup, &format_utc))
            .map_err(|error| cannot_build(error.to_string()))?;
        Python::attach(|py| {
            let setup = text_to_python(py, &text).map_err(|error| cannot_build(error.to_string()))?;
            let (callable, setup) = if self.is_class {
                let made = self.given.call1(py, (setup,));
                (made.map_err(|error| cannot_build(reason(py, error, &self.ended)))?, None)
            } else {
                (self.given.clone_ref(py), Some(setup.unbind()))
            };
            let navigator = PythonNavigator {
                callable,
                setup,
                line: self.line.clone_ref(py),
                pending: Mutex::new(Vec::new()),
                ended: Arc::clone(&self.ended),
            };
            Ok(Box::new(navigator) as Box<dyn Navigator>)
        })
    }
}

/// Callable that navigates one campaign.
struct PythonNavigator {
    callable: Py<PyAny>,
    /// Setup, for a function.
    setup: Option<Py<PyAny>>,
    line: Py<PyAny>,
    /// Events since the previous call as JSON.
    pending: Mutex<Vec<String>>,
    ended: Arc<Interruption>,
}

impl Navigator for PythonNavigator {
    fn receive(&mut self, event: &Event) {
        let pending = self.pending.get_mut().unwrap_or_else(PoisonError::into_inner);
        // A line consists of finite numbers and texts, which are always JSON.
        pending.extend(serde_json::to_string(&Line::from_event(event, &format_utc)));
    }

    fn estimates(&mut self, epochs: &[Epoch]) -> Vec<Answer> {
        self.answers(epochs).unwrap_or_else(|reason| vec![Err(NoEstimate::Failed(reason)); epochs.len()])
    }
}

impl PythonNavigator {
    fn answers(&mut self, epochs: &[Epoch]) -> Result<Vec<Answer>, String> {
        self.ended.go_on().map_err(|_| "the navigation was interrupted".to_owned())?;
        let pending = self.pending.get_mut().unwrap_or_else(PoisonError::into_inner);
        let events = format!("[{}]", std::mem::take(pending).join(","));
        let times: Vec<String> = epochs.iter().map(|epoch| format_utc(*epoch)).collect();
        let line: String = Python::attach(|py| {
            let call = || {
                let events = text_to_python(py, &events)?;
                match &self.setup {
                    Some(setup) => self.callable.call1(py, (setup.clone_ref(py), events, times)),
                    None => self.callable.call1(py, (events, times)),
                }
            };
            let answer = call().map_err(|error| reason(py, error, &self.ended))?;
            let line = self.line.call1(py, (answer,)).and_then(|line| line.extract(py));
            line.map_err(|error| error.to_string())
        })?;
        let parsed: EstimatesLine =
            serde_json::from_str(&line).map_err(|error| format!("its answer cannot be read: {error}"))?;
        parsed.answers(epochs).map_err(|error| format!("its {error}"))
    }
}
