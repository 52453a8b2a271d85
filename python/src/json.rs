//! Conversion of values between Python and Rust through JSON; numbers keep every bit in both directions.

use pyo3::prelude::*;
use serde::Serialize;
use serde_json::Value;

use crate::errors::{BoresightError, refused};

/// Converts a value to Python: dictionaries, lists, numbers, text.
pub(crate) fn to_python<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).map_err(|error| BoresightError::new_err(error.to_string()))?;
    text_to_python(py, &text)
}

/// Converts JSON text to a Python value.
pub(crate) fn text_to_python<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (text,))
}

/// Converts the JSON text of a score to a `boresight.Score`.
pub(crate) fn text_to_score<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    let score = text_to_python(py, text)?;
    py.import("boresight.scores")?.call_method1("Score", (score,))
}

/// Converts a Python value, including numpy numbers and arrays; `what` is the name of the argument that
/// contains it.
pub(crate) fn from_python(what: &str, value: &Bound<'_, PyAny>) -> PyResult<Value> {
    let text: String =
        value.py().import("boresight._values")?.call_method1("to_json", (what, value))?.extract()?;
    serde_json::from_str(&text).map_err(|error| refused(what, text, &format!("a value ({error})")))
}
