//! Values between Python and Rust, as JSON: numbers keep every bit both ways.

use pyo3::prelude::*;
use serde::Serialize;
use serde_json::Value;

use crate::errors::{BoresightError, refused};

/// A value as Python has it: dictionaries, lists, numbers, text.
pub(crate) fn to_python<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).map_err(|error| BoresightError::new_err(error.to_string()))?;
    text_to_python(py, &text)
}

/// A JSON text as Python has it.
pub(crate) fn text_to_python<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (text,))
}

/// A value of Python, numpy's numbers and arrays included; `what` is the argument that it belongs to.
pub(crate) fn from_python(what: &str, value: &Bound<'_, PyAny>) -> PyResult<Value> {
    let text: String =
        value.py().import("boresight._values")?.call_method1("to_json", (what, value))?.extract()?;
    serde_json::from_str(&text).map_err(|error| refused(what, text, &format!("a value ({error})")))
}
