//! Frames and telemetry for Python; pixels are numpy arrays over the buffer that the simulator filled.

use boresight::files::format_utc;
use contract::docking::{Field, FieldTelemetry as DockingTelemetry};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;

/// Image as received on the ground: the input of a pipeline.
#[pyclass(frozen, subclass, module = "boresight")]
pub(crate) struct Frame {
    /// Number of the frame (docking: of the field) in the scenario.
    #[pyo3(get)]
    pub(crate) number: u64,
    /// Bits of the converter: full scale is 2**bit_depth - 1.
    #[pyo3(get)]
    bit_depth: u8,
    /// Digital numbers, uint16 of shape (rows, columns): `pixels[y, x]`; the centre of the first pixel is at
    /// x = 0, y = 0.
    #[pyo3(get)]
    pixels: Py<PyArray2<u16>>,
    /// Transmitted regions, each (x, y, columns, rows); all other pixels are 0 and carry no information. None
    /// if the whole image was transmitted.
    #[pyo3(get)]
    windows: Option<Vec<(usize, usize, usize, usize)>>,
    /// Docking: camera rows in the image, `all`, `even` or `odd`: row k of the image is row k, 2k or 2k + 1
    /// of the camera. None in the far range.
    #[pyo3(get)]
    lines: Option<&'static str>,
}

impl Frame {
    /// Converts a frame; Python receives the pixel buffer without a copy.
    pub(crate) fn from_contract(py: Python<'_>, frame: contract::Frame) -> PyResult<Self> {
        let (rows, columns) = (frame.rows(), frame.columns());
        let windows = frame.windows();
        let windows = windows.map(|all| all.iter().map(|w| (w.x, w.y, w.columns, w.rows)).collect());
        let (number, bit_depth) = (frame.number(), frame.bit_depth());
        let pixels = PyArray1::from_vec(py, frame.into_dn()).reshape([rows, columns])?.unbind();
        Ok(Self { number, bit_depth, pixels, windows, lines: None })
    }

    /// Converts a docking field; Python receives the pixel buffer without a copy.
    pub(crate) fn from_field(py: Python<'_>, field: Field) -> PyResult<Self> {
        let lines = Some(field.lines().code());
        Ok(Self { lines, ..Self::from_contract(py, field.into_image())? })
    }
}

#[pymethods]
impl Frame {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (rows, columns): (usize, usize) = self.pixels.bind(py).getattr("shape")?.extract()?;
        Ok(format!("<boresight.Frame {}: {columns} x {rows} pixels, {} bits>", self.number, self.bit_depth))
    }
}

/// Telemetry of a frame: values measured by the spacecraft, not the truth.
#[pyclass(frozen, get_all, module = "boresight")]
pub(crate) struct Telemetry {
    /// Middle of the exposure, UTC, ISO 8601 with nanoseconds.
    time_utc: String,
    /// Exposure time, s.
    exposure_s: f64,
    /// Attitude of the spacecraft's body, a Hamilton quaternion (w, x, y, z): v_sc = q v_j2000 q*.
    q_sc_j2000: (f64, f64, f64, f64),
    /// Velocity about the Earth, km/s, along the axes of ICRS; None if unknown. It excludes the velocity of
    /// the Earth.
    v_orbital_j2000_km_s: Option<(f64, f64, f64)>,
}

impl Telemetry {
    pub(crate) fn from_contract(telemetry: &contract::Telemetry) -> Self {
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
    /// Middle of the exposure as `astropy.time.Time`, UTC. Raises `ImportError` if astropy is missing.
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let astropy = py.import("boresight._astropy")?;
        astropy.call_method1("time_of_text", (&self.time_utc, "Telemetry.time"))
    }

    fn __repr__(&self) -> String {
        format!("<boresight.Telemetry {}, {} s>", self.time_utc, self.exposure_s)
    }
}

/// Telemetry of a docking field: the data beside its pixels.
#[pyclass(frozen, get_all, module = "boresight")]
pub(crate) struct FieldTelemetry {
    /// Middle of the field's exposure, s since the start of the sequence.
    time_s: f64,
    /// Index of the camera that took the field, in the setup's list of cameras, from 0.
    camera: usize,
    /// Contrast of the digitiser, 0.1 to 20.
    contrast: f64,
    /// Brightness of the digitiser, -10 to 10, in units of full scale.
    brightness: f64,
}

impl FieldTelemetry {
    pub(crate) fn from_contract(telemetry: &DockingTelemetry) -> Self {
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
