//! Frames of a scenario for Python, with their truth.

use std::sync::Arc;

use arrow_array::RecordBatch;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyDict;

use crate::errors::{raised, refused};
use crate::frame::Frame;
use crate::prepared_scenario::PreparedScenario;
use crate::table::{Table, row};
use crate::worlds::{FrameParts, PendingFrame};

/// Frame with its telemetry and its truth. It is also a `Frame` and can be passed to a pipeline, which reads
/// only the members of `Frame`.
#[pyclass(frozen, extends = Frame, module = "boresight")]
pub(crate) struct SimulatedFrame {
    /// Telemetry that a pipeline receives beside the frame: `Telemetry`, or `FieldTelemetry` of a docking
    /// field.
    #[pyo3(get)]
    telemetry: Py<PyAny>,
    truth: RecordBatch,
    objects: Option<RecordBatch>,
    prepared: Arc<PreparedScenario>,
    expected: PyOnceLock<Py<PyArray2<f64>>>,
}

impl SimulatedFrame {
    pub(crate) fn new(
        py: Python<'_>,
        made: PendingFrame,
        prepared: &Arc<PreparedScenario>,
    ) -> PyResult<Py<Self>> {
        let FrameParts { frame, telemetry, truth, objects } = made(py)?;
        let own =
            Self { telemetry, truth, objects, prepared: Arc::clone(prepared), expected: PyOnceLock::new() };
        Py::new(py, PyClassInitializer::from(frame).add_subclass(own))
    }
}

#[pymethods]
impl SimulatedFrame {
    /// Truth of the frame, with the names of truth/frames.parquet (docking: truth/fields.parquet) as keys,
    /// units in the names.
    #[getter]
    fn truth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        row(py, self.truth.clone())
    }

    /// Truth of every object in the frame: a table with the columns of truth/objects.parquet. Far range only.
    #[getter]
    fn objects(&self) -> PyResult<Table> {
        let objects = self.objects.clone();
        let objects = objects.ok_or_else(|| {
            refused("objects", "not available for a docking field", "a frame of the far range")
        })?;
        Ok(Table::from_batch(objects))
    }

    /// Frame without noise: expected photoelectrons, including dark current and hot pixels, before
    /// saturation; float64 of shape (rows, columns). Computed on first access. Far range only.
    #[getter]
    fn expected<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (py, own, number) = (slf.py(), slf.get(), slf.as_super().get().number);
        let make = || -> PyResult<_> {
            let ([rows, columns], electrons) = py
                .detach(|| own.prepared.world.expected(number))
                .ok_or_else(|| {
                    refused("expected", "not available for a docking field", "a frame of the far range")
                })?
                .map_err(raised)?;
            Ok(PyArray1::from_vec(py, electrons).reshape([rows, columns])?.unbind())
        };
        Ok(own.expected.get_or_try_init(py, make)?.bind(py).clone())
    }
}
