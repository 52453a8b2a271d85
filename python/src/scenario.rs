//! Scenarios as objects. A scenario that exists can be run: all its values were checked.

use std::path::PathBuf;
use std::sync::Arc;

use boresight::run::ScenarioSource;
use boresight::scenario::BUILT_IN;
use boresight::study::{Study, value_at, with_overlay};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::Value;

use crate::arguments;
use crate::errors::{BoresightError, raised, refused};
use crate::json;
use crate::prepared::PreparedScenario;
use crate::simulated_frame::SimulatedFrame;
use crate::stream::FrameStream;
use crate::worlds::PendingFrame;

/// What to simulate: a built-in scenario or a TOML file, with all its values checked.
///
/// It does not change: `with_values` and `with_seed` give another one.
#[pyclass(frozen, module = "boresight")]
pub(crate) struct Scenario {
    pub(crate) prepared: Arc<PreparedScenario>,
}

impl Scenario {
    /// A scenario, of an object or of the word that names one.
    pub(crate) fn from_argument(given: &Bound<'_, PyAny>) -> PyResult<Arc<PreparedScenario>> {
        match given.cast::<Self>() {
            Ok(scenario) => Ok(Arc::clone(&scenario.get().prepared)),
            Err(_) => Ok(Self::load(given.py(), given)?.prepared),
        }
    }

    fn checked(py: Python<'_>, source: ScenarioSource) -> PyResult<Self> {
        let prepared = py.detach(|| PreparedScenario::new(source)).map_err(raised)?;
        Ok(Self { prepared: Arc::new(prepared) })
    }
}

#[pymethods]
impl Scenario {
    /// Reads a built-in scenario by its name, a TOML file, or the `run.toml` of a run to be repeated.
    ///
    /// Raises `InputError` with line and column of the first mistake.
    #[staticmethod]
    fn load(py: Python<'_>, scenario: &Bound<'_, PyAny>) -> PyResult<Self> {
        let word = arguments::word("scenario", scenario)?;
        Self::checked(py, ScenarioSource::read(&word).map_err(raised)?)
    }

    /// The scenario of a case of a study (docs/studies.md), with the values and the seed that were drawn for it.
    ///
    /// `study` is the study's file. Raises `InputError` for a case that the study does not have.
    #[staticmethod]
    fn from_case(py: Python<'_>, study: PathBuf, case: i64) -> PyResult<Self> {
        let study = Study::read(&study).map_err(raised)?;
        let number = u64::try_from(case).ok().filter(|number| *number < study.cases());
        let expected = || refused("case", case, &format!("a case of the study, 0 to {}", study.cases() - 1));
        let case = study.case(number.ok_or_else(expected)?).map_err(raised)?;
        Self::checked(py, case.source)
    }

    /// Names of the built-in scenarios.
    #[staticmethod]
    fn builtin_names() -> Vec<&'static str> {
        BUILT_IN.iter().map(|built_in| built_in.name).collect()
    }

    /// Name: that of the built-in one, or the file's without its extension.
    #[getter]
    fn name(&self) -> &str {
        &self.prepared.source.name
    }

    /// What it is, in one line.
    #[getter]
    fn title(&self) -> &str {
        self.prepared.source.scenario.title()
    }

    /// `far_range` or `docking`.
    #[getter]
    fn world(&self) -> &'static str {
        self.prepared.source.world().code()
    }

    /// Seed of every random draw.
    #[getter]
    fn seed(&self) -> u64 {
        self.prepared.source.scenario.seed()
    }

    /// Number of its frames (docking: fields).
    #[getter]
    fn frame_count(&self) -> u64 {
        self.prepared.frame_count()
    }

    /// The same scenario with other values, by their paths: `{"sensor.gain_e_per_dn": 3.0, "schedule[0].count": 100}`.
    ///
    /// Raises `InputError` for a path that there is not, and for a value outside its range.
    fn with_values(&self, py: Python<'_>, values: &Bound<'_, PyDict>) -> PyResult<Self> {
        let mut overlay: Vec<(String, Value)> = Vec::new();
        for (path, value) in values {
            let path: String = path
                .extract()
                .map_err(|_| refused("values", "a dictionary with a key that is no text", "paths as keys"))?;
            let value = json::from_python(&path, &value)?;
            overlay.push((path, value));
        }
        Self::checked(py, with_overlay(&self.prepared.source, &overlay).map_err(raised)?)
    }

    /// The same scenario with another seed, 0 to 2**63 - 1: other noise, the same sky.
    fn with_seed(&self, py: Python<'_>, seed: &Bound<'_, PyAny>) -> PyResult<Self> {
        let overlay = [("seed".to_owned(), json::from_python("seed", seed)?)];
        Self::checked(py, with_overlay(&self.prepared.source, &overlay).map_err(raised)?)
    }

    /// The value at a path, as in `sensor.gain_e_per_dn`; tables as dictionaries, None for what the scenario leaves out.
    fn value<'py>(&self, py: Python<'py>, path: &str) -> PyResult<Bound<'py, PyAny>> {
        json::to_python(py, &value_at(&self.prepared.source, path).map_err(raised)?)
    }

    /// All its values with all defaults, as a TOML file that can be run.
    fn to_toml(&self) -> PyResult<String> {
        self.prepared.source.scenario.to_toml().map_err(raised)
    }

    /// What a pipeline is told before the first frame, a dictionary: camera, mounting and star list (docking: cameras and target). Its keys
    /// are those of the greeting in docs/external-pipeline.md.
    #[getter]
    fn setup<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        setup(py, &self.prepared)
    }

    /// Makes one frame: the same bits as in a whole run.
    fn frame(&self, py: Python<'_>, number: i64) -> PyResult<Py<SimulatedFrame>> {
        let count = self.prepared.frame_count();
        let expected = || {
            refused("number", number, &format!("a frame of the scenario, 0 to {}", count.saturating_sub(1)))
        };
        let number = u64::try_from(number).ok().filter(|number| *number < count).ok_or_else(expected)?;
        let mut made = None;
        let mut take = |frame: PendingFrame| {
            made = Some(frame);
            Ok(())
        };
        py.detach(|| self.prepared.world.make(number..number + 1, 1, &mut take)).map_err(raised)?;
        SimulatedFrame::new(py, made.ok_or_else(expected)?, &self.prepared)
    }

    /// Makes frames, in order, on `jobs` threads (default: all cores) while the caller works on those before: an iterator over
    /// `SimulatedFrame`. `frames` is a `range` of step 1; all frames without one.
    #[pyo3(signature = (frames=None, *, jobs=None))]
    fn frames(&self, frames: Option<&Bound<'_, PyAny>>, jobs: Option<i64>) -> PyResult<FrameStream> {
        let frames = arguments::frames(frames, self.prepared.frame_count())?;
        FrameStream::start(&self.prepared, frames, arguments::jobs(jobs)?)
    }

    fn __repr__(&self) -> String {
        let image = self.prepared.source.world().image();
        format!("<boresight.Scenario {}: {} {image}s, seed {}>", self.name(), self.frame_count(), self.seed())
    }
}

/// What a pipeline is told before the first frame, as a dictionary.
pub(crate) fn setup<'py>(py: Python<'py>, prepared: &PreparedScenario) -> PyResult<Bound<'py, PyAny>> {
    let line = prepared.world.greeting().map_err(BoresightError::new_err)?;
    json::text_to_python(py, &String::from_utf8_lossy(&line))
}
