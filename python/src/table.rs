//! Tables for Python: Arrow data, exported through the C data interface, so that polars, pandas and pyarrow
//! read them and none is required.

use arrow_array::cast::AsArray;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::types::{Float64Type, TimestampNanosecondType, UInt32Type, UInt64Type};
use arrow_array::{Array, ArrayRef, RecordBatch, RecordBatchIterator};
use arrow_schema::ffi::FFI_ArrowSchema;
use arrow_schema::{ArrowError, DataType, SchemaRef};
use boresight::files::LoadedTable;
use numpy::PyArray1;
use pyo3::exceptions::{PyIndexError, PyKeyError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict, PyList, PySlice};

use crate::arrow::{batch, schema};
use crate::errors::BoresightError;

/// Table with named columns, units in the names, as described in docs/formats.md.
///
/// `polars.DataFrame(table)`, `pyarrow.table(table)` and `pandas.DataFrame.from_arrow(table)` import it
/// through the Arrow C data interface without a copy. Without these libraries `table["x_px"]` is a numpy
/// array.
#[pyclass(frozen, module = "boresight")]
pub(crate) struct Table {
    schema: SchemaRef,
    batches: Vec<RecordBatch>,
}

impl Table {
    /// Creates a table from a table read from a file.
    pub(crate) fn from_parts(table: LoadedTable) -> PyResult<Self> {
        let schema = schema(&table.header);
        let batches = table.parts.into_iter().map(batch).collect::<PyResult<_>>()?;
        Ok(Self { schema, batches })
    }

    pub(crate) fn from_batch(batch: RecordBatch) -> Self {
        Self { schema: batch.schema(), batches: vec![batch] }
    }

    fn rows(&self) -> usize {
        self.batches.iter().map(RecordBatch::num_rows).sum()
    }

    /// Returns the rows of a slice as a table.
    fn slice(&self, slice: &Bound<'_, PySlice>) -> PyResult<Self> {
        let span = slice.indices(self.rows() as isize)?;
        if span.step != 1 {
            let message = format!("the step of the slice is {}, expected 1", span.step);
            return Err(PyValueError::new_err(message));
        }
        let (mut skipped, mut missing) = (span.start as usize, span.slicelength);
        let mut batches = Vec::new();
        for batch in &self.batches {
            let first = skipped.min(batch.num_rows());
            let count = missing.min(batch.num_rows() - first);
            batches.push(batch.slice(first, count));
            (skipped, missing) = (skipped - first, missing - count);
        }
        Ok(Self { schema: SchemaRef::clone(&self.schema), batches })
    }

    /// Returns the row of an index, which counts from the end if it is negative.
    fn row_at(&self, index: isize) -> PyResult<RecordBatch> {
        let count = self.rows();
        let row = if index < 0 { count.checked_add_signed(index) } else { usize::try_from(index).ok() };
        let mut rest = row.unwrap_or(count);
        for batch in &self.batches {
            if rest < batch.num_rows() {
                return Ok(batch.slice(rest, 1));
            }
            rest -= batch.num_rows();
        }
        Err(PyIndexError::new_err(format!("row {index} of a table of {count} rows")))
    }

    fn column<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyAny>> {
        let arrays: Vec<&ArrayRef> = self.batches.iter().map(|batch| batch.column(index)).collect();
        let has_null = arrays.iter().any(|array| array.null_count() > 0);
        match self.schema.field(index).data_type() {
            DataType::UInt64 if !has_null => {
                let values = arrays.iter().flat_map(|array| array.as_primitive::<UInt64Type>().values());
                Ok(PyArray1::from_vec(py, values.copied().collect()).into_any())
            }
            DataType::UInt32 if !has_null => {
                let values = arrays.iter().flat_map(|array| array.as_primitive::<UInt32Type>().values());
                Ok(PyArray1::from_vec(py, values.copied().collect()).into_any())
            }
            DataType::Boolean if !has_null => {
                let values = arrays.iter().flat_map(|array| array.as_boolean().values());
                Ok(PyArray1::from_vec(py, values.collect()).into_any())
            }
            DataType::Timestamp(..) => {
                let values =
                    arrays.iter().flat_map(|array| array.as_primitive::<TimestampNanosecondType>().values());
                PyArray1::from_vec(py, values.copied().collect()).call_method1("view", ("datetime64[ns]",))
            }
            DataType::Utf8 => {
                let texts = arrays.iter().flat_map(|array| array.as_string::<i32>().iter());
                Ok(PyList::new(py, texts.collect::<Vec<_>>())?.into_any())
            }
            _ => {
                let numbers = arrays.iter().flat_map(|array| floats(array));
                Ok(PyArray1::from_vec(py, numbers.collect()).into_any())
            }
        }
    }
}

/// Converts numbers to floating point, NaN for missing values.
fn floats(array: &ArrayRef) -> Vec<f64> {
    match array.data_type() {
        DataType::Float64 => {
            array.as_primitive::<Float64Type>().iter().map(|value| value.unwrap_or(f64::NAN)).collect()
        }
        DataType::UInt64 => {
            let values = array.as_primitive::<UInt64Type>().iter();
            values.map(|value| value.map_or(f64::NAN, |value| value as f64)).collect()
        }
        DataType::UInt32 => {
            let values = array.as_primitive::<UInt32Type>().iter();
            values.map(|value| value.map_or(f64::NAN, f64::from)).collect()
        }
        // No table of this crate has another type.
        _ => vec![f64::NAN; array.len()],
    }
}

#[pymethods]
impl Table {
    /// Names of the columns, in order.
    #[getter]
    fn column_names(&self) -> Vec<&str> {
        self.schema.fields().iter().map(|field| field.name().as_str()).collect()
    }

    /// Number of rows.
    #[getter]
    fn num_rows(&self) -> usize {
        self.rows()
    }

    fn __len__(&self) -> usize {
        self.rows()
    }

    /// Returns a column by its name: numbers and truth values as a numpy array (NaN for missing values),
    /// times as `datetime64[ns]` (UTC), text as a list (None for missing values). A slice (`table[:2]`) is a
    /// table of these rows, an index (`table[-1]`) a row as a dictionary.
    fn __getitem__<'py>(&self, py: Python<'py>, key: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        if let Ok(slice) = key.cast::<PySlice>() {
            return Ok(self.slice(slice)?.into_pyobject(py)?.into_any());
        }
        if let Ok(index) = key.extract::<isize>() {
            return Ok(row(py, self.row_at(index)?)?.into_any());
        }
        let name: String = key.extract().map_err(|_| {
            PyTypeError::new_err("expected the name of a column, the index of a row or a slice of rows")
        })?;
        let index = self.schema.index_of(&name).map_err(|_| {
            let known = self.column_names().join(", ");
            PyKeyError::new_err(format!("no column `{name}`; available columns: {known}"))
        })?;
        self.column(py, index)
    }

    /// Returns a column of times as `astropy.time.Time`, UTC, with nanoseconds. Raises `ImportError` if
    /// astropy is missing, and `InputError` for a column of other values.
    #[pyo3(signature = (column="time_utc"))]
    fn time<'py>(slf: &Bound<'py, Self>, column: &str) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("boresight._astropy")?.call_method1("time_of_table", (slf, column))
    }

    /// Returns all columns by name, in the form of `table[name]`.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        for (index, field) in self.schema.fields().iter().enumerate() {
            columns.set_item(field.name(), self.column(py, index)?)?;
        }
        Ok(columns)
    }

    /// Arrow C data interface: exports the table as a stream.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // A producer need not honour the requested schema.
        drop(requested_schema);
        let batches: Vec<Result<RecordBatch, ArrowError>> = self.batches.iter().cloned().map(Ok).collect();
        let reader = RecordBatchIterator::new(batches, SchemaRef::clone(&self.schema));
        PyCapsule::new_with_value(py, FFI_ArrowArrayStream::new(Box::new(reader)), c"arrow_array_stream")
    }

    /// Arrow C data interface: exports names and types of the columns.
    fn __arrow_c_schema__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        let schema = FFI_ArrowSchema::try_from(self.schema.as_ref())
            .map_err(|error| BoresightError::new_err(error.to_string()))?;
        PyCapsule::new_with_value(py, schema, c"arrow_schema")
    }

    fn __repr__(&self) -> String {
        format!("<boresight.Table of {} rows: {}>", self.rows(), self.column_names().join(", "))
    }
}

/// Returns the single row of a batch as a dictionary by column; missing values are None.
pub(crate) fn row<'py>(py: Python<'py>, batch: RecordBatch) -> PyResult<Bound<'py, PyDict>> {
    let cells = PyDict::new(py);
    let nulls: Vec<bool> = batch.columns().iter().map(|column| column.is_null(0)).collect();
    let names: Vec<String> = batch.schema_ref().fields().iter().map(|field| field.name().clone()).collect();
    let table = Table::from_batch(batch);
    for (index, (name, is_null)) in names.into_iter().zip(nulls).enumerate() {
        if is_null {
            cells.set_item(name, py.None())?;
            continue;
        }
        let column = table.column(py, index)?;
        let is_time = matches!(table.schema.field(index).data_type(), DataType::Timestamp(..));
        // Numbers become Python numbers; a time stays a numpy value, which has nanosecond resolution.
        let values =
            if is_time { column } else { py.import("builtins")?.call_method1("list", (plain(&column)?,))? };
        cells.set_item(name, values.get_item(0)?)?;
    }
    Ok(cells)
}

/// Converts a numpy array to a list of Python numbers.
fn plain<'py>(column: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    if column.hasattr("tolist")? { column.call_method0("tolist") } else { Ok(column.clone()) }
}
