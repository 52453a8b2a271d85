//! Conversion of failures to Python exceptions.

use boresight::failure::Failure;
use boresight::files::FileError as ReadOrWrite;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::{PyErr, import_exception};

import_exception!(boresight.errors, BoresightError);
import_exception!(boresight.errors, InputError);
import_exception!(boresight.errors, FileError);

/// Converts a failure to an exception: an `InputError` if the user can correct the input, a `FileError` if
/// the system refused an operation.
pub(crate) fn raised(failure: Failure) -> PyErr {
    match &failure {
        Failure::Interrupted => PyKeyboardInterrupt::new_err(()),
        Failure::File(
            ReadOrWrite::Io { .. } | ReadOrWrite::OutputTaken { .. } | ReadOrWrite::NotReplaced { .. },
        ) => FileError::new_err(failure.to_string()),
        Failure::Renderer(_) => BoresightError::new_err(failure.to_string()),
        _ => {
            let text = failure.explain();
            InputError::new_err(text.strip_prefix("error: ").unwrap_or(&text).to_owned())
        }
    }
}

/// Converts the failure to read or write a file to an exception.
pub(crate) fn file_error(error: ReadOrWrite) -> PyErr {
    raised(error.into())
}

/// Returns the exception for an invalid argument: `what` is `value`, expected …
pub(crate) fn refused(what: &str, value: impl std::fmt::Display, expected: &str) -> PyErr {
    InputError::new_err(format!("`{what}` is {value}, expected {expected}"))
}
