//! Frames and telemetry for Python: pixels as numpy arrays over the buffer that the simulator filled.

use std::sync::Arc;

use arrow_array::RecordBatch;
use boresight::files::{Row, format_utc};
use contract::docking::{Field, FieldTelemetry as DockingTelemetry};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyDict;
use sim::Exposure;
use sim::docking::FieldTruth;
use sim::truth::{FrameTruth, ObjectTruth};

use crate::arrow::batch;
use crate::errors::{raised, refused};
use crate::ready::{Ready, World};
use crate::table::{Table, row};

/// An image as it arrives on the ground: what a pipeline sees.
#[pyclass(frozen, subclass, module = "boresight")]
pub(crate) struct Frame {
    /// Number of the frame (docking: of the field) in its scenario.
    #[pyo3(get)]
    number: u64,
    /// Bits of the converter: full scale is 2**bit_depth - 1.
    #[pyo3(get)]
    bit_depth: u8,
    /// Digital numbers, uint16 of shape (rows, columns); `pixels[y, x]`, the centre of the first pixel is x = 0, y = 0.
    #[pyo3(get)]
    pixels: Py<PyArray2<u16>>,
    /// The regions that were transmitted, each (x, y, columns, rows); all other pixels are 0 and mean nothing. None: the whole image was.
    #[pyo3(get)]
    windows: Option<Vec<(usize, usize, usize, usize)>>,
    /// Docking: which rows of the camera these are, `all`, `even` or `odd`: row k of the image is the camera's row k, 2k or 2k + 1. None
    /// in the far range.
    #[pyo3(get)]
    lines: Option<&'static str>,
}

impl Frame {
    /// A frame whose pixels go over to Python as they lie in memory.
    pub(crate) fn of(py: Python<'_>, frame: contract::Frame) -> PyResult<Self> {
        let (rows, columns) = (frame.rows(), frame.columns());
        let windows = frame.windows();
        let windows = windows.map(|all| all.iter().map(|w| (w.x, w.y, w.columns, w.rows)).collect());
        let (number, bit_depth) = (frame.number(), frame.bit_depth());
        let pixels = PyArray1::from_vec(py, frame.into_dn()).reshape([rows, columns])?.unbind();
        Ok(Self { number, bit_depth, pixels, windows, lines: None })
    }

    /// A docking field, likewise.
    pub(crate) fn of_field(py: Python<'_>, field: Field) -> PyResult<Self> {
        let lines = Some(field.lines().code());
        Ok(Self { lines, ..Self::of(py, field.into_image())? })
    }
}

#[pymethods]
impl Frame {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (rows, columns): (usize, usize) = self.pixels.bind(py).getattr("shape")?.extract()?;
        Ok(format!("<boresight.Frame {}: {columns} x {rows} pixels, {} bits>", self.number, self.bit_depth))
    }
}

/// What the spacecraft tells about a frame besides its pixels: measured, not the truth.
#[pyclass(frozen, get_all, module = "boresight")]
pub(crate) struct Telemetry {
    /// Middle of the exposure, UTC, ISO 8601 with nanoseconds.
    time_utc: String,
    /// Exposure time, s.
    exposure_s: f64,
    /// Attitude of the spacecraft's body, (w, x, y, z), Hamilton, v_sc = q v_j2000 q*.
    q_sc_j2000: (f64, f64, f64, f64),
    /// Velocity about the Earth, km/s, along the axes of ICRS; None when it is not known. The Earth's own is not in it.
    v_orbital_j2000_km_s: Option<(f64, f64, f64)>,
}

impl Telemetry {
    pub(crate) fn of(telemetry: &contract::Telemetry) -> Self {
        let [w, x, y, z] = telemetry.body_from_icrs.wxyz();
        Self {
            time_utc: format_utc(telemetry.time),
            exposure_s: telemetry.exposure_s,
            q_sc_j2000: (w, x, y, z),
            v_orbital_j2000_km_s: telemetry.velocity_km_s.map(|v| (v.x, v.y, v.z)),
        }
    }
}

#[pymethods]
impl Telemetry {
    fn __repr__(&self) -> String {
        format!("<boresight.Telemetry {}, {} s>", self.time_utc, self.exposure_s)
    }
}

/// What is known of a docking field besides its pixels.
#[pyclass(frozen, get_all, module = "boresight")]
pub(crate) struct FieldTelemetry {
    /// Middle of the field's exposure, s since the beginning of the sequence.
    time_s: f64,
    /// Which of the setup's cameras took it, from 0.
    camera: usize,
    /// Contrast of the digitiser, 0.1 to 20.
    contrast: f64,
    /// Brightness of the digitiser, -10 to 10, in units of full scale.
    brightness: f64,
}

impl FieldTelemetry {
    pub(crate) fn of(telemetry: &DockingTelemetry) -> Self {
        let DockingTelemetry { time_s, camera, digitiser } = *telemetry;
        Self { time_s, camera, contrast: digitiser.contrast, brightness: digitiser.brightness }
    }
}

#[pymethods]
impl FieldTelemetry {
    fn __repr__(&self) -> String {
        format!("<boresight.FieldTelemetry {} s, camera {}>", self.time_s, self.camera)
    }
}

/// A frame with its telemetry and its truth. As a `Frame` it can be given to a pipeline, which looks at no more than a `Frame` has.
#[pyclass(frozen, extends = Frame, module = "boresight")]
pub(crate) struct SimulatedFrame {
    /// What a pipeline is told beside the frame: `Telemetry`, or `FieldTelemetry` of a docking field.
    #[pyo3(get)]
    telemetry: Py<PyAny>,
    truth: RecordBatch,
    objects: Option<RecordBatch>,
    ready: Arc<Ready>,
    expected: PyOnceLock<Py<PyArray2<f64>>>,
}

impl SimulatedFrame {
    /// A frame of the far range.
    pub(crate) fn of(py: Python<'_>, exposure: Exposure, ready: &Arc<Ready>) -> PyResult<Py<Self>> {
        let own = Self {
            telemetry: Py::new(py, Telemetry::of(&exposure.telemetry))?.into_any(),
            truth: batch(FrameTruth::columns(&[exposure.truth]))?,
            objects: Some(batch(ObjectTruth::columns(&exposure.objects))?),
            ready: Arc::clone(ready),
            expected: PyOnceLock::new(),
        };
        Py::new(py, PyClassInitializer::from(Frame::of(py, exposure.frame)?).add_subclass(own))
    }

    /// A docking field.
    pub(crate) fn of_field(
        py: Python<'_>,
        field: Field,
        telemetry: &DockingTelemetry,
        truth: FieldTruth,
        ready: &Arc<Ready>,
    ) -> PyResult<Py<Self>> {
        let own = Self {
            telemetry: Py::new(py, FieldTelemetry::of(telemetry))?.into_any(),
            truth: batch(FieldTruth::columns(&[truth]))?,
            objects: None,
            ready: Arc::clone(ready),
            expected: PyOnceLock::new(),
        };
        Py::new(py, PyClassInitializer::from(Frame::of_field(py, field)?).add_subclass(own))
    }
}

#[pymethods]
impl SimulatedFrame {
    /// The truth about the frame, by the names of truth/frames.parquet (docking: truth/fields.parquet), units in the names.
    #[getter]
    fn truth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        row(py, self.truth.clone())
    }

    /// The truth about every object in the frame: a table with the columns of truth/objects.parquet. Far range alone.
    #[getter]
    fn objects(&self) -> PyResult<Table> {
        let objects = self.objects.clone();
        let objects = objects
            .ok_or_else(|| refused("objects", "asked of a docking field", "a frame of the far range"))?;
        Ok(Table::of_batch(objects))
    }

    /// The frame without noise: expected photoelectrons, dark current and hot pixels included, before saturation; float64 of shape
    /// (rows, columns). Made when it is first asked for. Far range alone.
    #[getter]
    fn expected<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (py, own, number) = (slf.py(), slf.get(), slf.as_super().get().number);
        let make = || {
            let World::FarRange(prepared) = &own.ready.world else {
                return Err(refused("expected", "asked of a docking field", "a frame of the far range"));
            };
            let electrons = py.detach(|| {
                let mut camera = prepared.simulator().camera()?;
                camera.expose(number)?;
                let image = camera.expected();
                Ok((image.size(), image.iter().collect::<Vec<f64>>()))
            });
            let ((columns, rows), electrons) =
                electrons.map_err(|error: sim::SimError| raised(error.into()))?;
            Ok(PyArray1::from_vec(py, electrons).reshape([rows, columns])?.unbind())
        };
        Ok(own.expected.get_or_try_init(py, make)?.bind(py).clone())
    }
}
