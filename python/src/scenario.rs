//! Scenarios as Python objects. Every scenario object can be run: all its values have been checked.

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
use crate::prepared_scenario::PreparedScenario;
use crate::simulated_frame::SimulatedFrame;
use crate::stream::FrameStream;
use crate::worlds::PendingFrame;

/// Scenario to simulate: a built-in scenario or a TOML file, with all its values checked.
///
/// It is immutable: `with_values` and `with_seed` return another scenario.
#[pyclass(frozen, module = "boresight")]
pub(crate) struct Scenario {
    pub(crate) prepared: Arc<PreparedScenario>,
}

impl Scenario {
    /// Returns a scenario, given as an object or by its name or path.
    pub(crate) fn from_argument(given: &Bound<'_, PyAny>) -> PyResult<Arc<PreparedScenario>> {
        match given.cast::<Self>() {
            Ok(scenario) => Ok(Arc::clone(&scenario.get().prepared)),
            Err(_) => Ok(Self::load(given.py(), given)?.prepared),
        }
    }

    /// Checks the number of a frame.
    fn frame_number(&self, number: i64) -> PyResult<u64> {
        let count = self.prepared.frame_count();
        let is_frame = |number: &u64| *number < count;
        u64::try_from(number).ok().filter(is_frame).ok_or_else(|| {
            refused("number", number, &format!("a frame of the scenario, 0 to {}", count.saturating_sub(1)))
        })
    }

    /// Returns the header of a frame's FITS file as text.
    fn fits_header(&self, py: Python<'_>, number: i64) -> PyResult<String> {
        let number = self.frame_number(number)?;
        let header = py.detach(|| self.prepared.world.fits_header(number));
        let header = header
            .ok_or_else(|| refused("wcs", "not available for a docking field", "a frame of the far range"))?;
        header.map_err(raised)?.ok_or_else(|| {
            let value = "not available: no SIP polynomial follows the camera's distortion to the corners";
            refused("wcs", value, "a camera with less distortion")
        })
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

    /// Scenario of one case of a study (docs/studies.md), with the values and the seed that were drawn for
    /// the case.
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

    /// Name of the built-in scenario, or the file name without its extension.
    #[getter]
    fn name(&self) -> &str {
        &self.prepared.source.name
    }

    /// Title of the scenario, one line.
    #[getter]
    fn title(&self) -> &str {
        self.prepared.source.scenario.title()
    }

    /// World of the scenario: `far_range` or `docking`.
    #[getter]
    fn world(&self) -> &'static str {
        self.prepared.source.world().code()
    }

    /// Seed of all random draws.
    #[getter]
    fn seed(&self) -> u64 {
        self.prepared.source.scenario.seed()
    }

    /// Number of frames (docking: fields).
    #[getter]
    fn frame_count(&self) -> u64 {
        self.prepared.frame_count()
    }

    /// Returns the scenario with other values, given by their paths: `{"sensor.gain_e_per_dn": 3.0,
    /// "schedule[0].count": 100}`.
    ///
    /// Raises `InputError` for a path that does not exist, and for a value outside its range.
    fn with_values(&self, py: Python<'_>, values: &Bound<'_, PyDict>) -> PyResult<Self> {
        let mut overlay: Vec<(String, Value)> = Vec::new();
        for (path, value) in values {
            let path: String = path.extract().map_err(|_| {
                refused("values", "a dictionary with a key that is not text", "paths as keys")
            })?;
            let value = json::from_python(&path, &value)?;
            overlay.push((path, value));
        }
        Self::checked(py, with_overlay(&self.prepared.source, &overlay).map_err(raised)?)
    }

    /// Returns the scenario with another seed, 0 to 2**63 - 1: the noise changes, the sky does not.
    fn with_seed(&self, py: Python<'_>, seed: &Bound<'_, PyAny>) -> PyResult<Self> {
        let overlay = [("seed".to_owned(), json::from_python("seed", seed)?)];
        Self::checked(py, with_overlay(&self.prepared.source, &overlay).map_err(raised)?)
    }

    /// Returns the value at a path such as `sensor.gain_e_per_dn`; tables as dictionaries, None for values
    /// that the scenario leaves out.
    fn value<'py>(&self, py: Python<'py>, path: &str) -> PyResult<Bound<'py, PyAny>> {
        json::to_python(py, &value_at(&self.prepared.source, path).map_err(raised)?)
    }

    /// Returns all values of the scenario, including defaults, as a TOML file that can be run.
    fn to_toml(&self) -> PyResult<String> {
        self.prepared.source.scenario.to_toml().map_err(raised)
    }

    /// Setup that a pipeline receives before the first frame, as a dictionary: camera, mounting and star list
    /// (docking: cameras and target). The keys are those of the greeting in docs/external-pipeline.md.
    #[getter]
    fn setup<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        setup(py, &self.prepared)
    }

    /// Makes one frame, identical to the bit to that frame of a whole run.
    fn frame(&self, py: Python<'_>, number: i64) -> PyResult<Py<SimulatedFrame>> {
        let number = self.frame_number(number)?;
        let mut made = None;
        let mut take = |frame: PendingFrame| {
            made = Some(frame);
            Ok(())
        };
        py.detach(|| self.prepared.world.make(number..number + 1, 1, &mut take)).map_err(raised)?;
        let missing = || BoresightError::new_err(format!("frame {number} was not made"));
        SimulatedFrame::new(py, made.ok_or_else(missing)?, &self.prepared)
    }

    /// World coordinates of a frame as an `astropy.wcs.WCS`: the cards of the frame's FITS file, TAN-SIP,
    /// from astrometric ICRS coordinates to pixels, with aberration and distortion, made from the truth.
    ///
    /// Pixels are those of the package with `origin=0`, and of `world_to_pixel`: the centre of the first
    /// pixel is x = 0, y = 0. Far range only. Raises `ImportError` if astropy is missing, and `InputError`
    /// for a camera whose distortion no SIP polynomial follows to the corners.
    fn wcs<'py>(&self, py: Python<'py>, number: i64) -> PyResult<Bound<'py, PyAny>> {
        let astropy = py.import("boresight._astropy")?;
        let text = self.fits_header(py, number)?;
        astropy.call_method1("world_coordinates", (text,))
    }

    /// Returns an iterator over `SimulatedFrame`, in order. The frames are made ahead on `jobs` threads
    /// (default: all cores) while the caller works on earlier frames. `frames` is a `range` of step 1;
    /// default: all frames.
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

/// Setup that a pipeline receives before the first frame, as a dictionary.
pub(crate) fn setup<'py>(py: Python<'py>, prepared: &PreparedScenario) -> PyResult<Bound<'py, PyAny>> {
    let line = prepared.world.greeting().map_err(BoresightError::new_err)?;
    json::text_to_python(py, &String::from_utf8_lossy(&line))
}
