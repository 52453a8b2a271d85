//! The command `boresight`.

use std::ffi::OsString;
use std::io::Write;

use pyo3::prelude::*;

/// Runs the command `boresight` with the arguments that follow its name, and returns the exit status: 0
/// success, 1 negative result, 2 usage error or invalid input. Python receives no signals during the call:
/// `python -m boresight` leaves them to the system.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| {
        let status = boresight::command::run_words(std::iter::once(OsString::from("boresight")).chain(words));
        // A Rust program flushes on exit by itself; a library does not. The failure of a closed stream cannot
        // be reported anywhere.
        let _ = std::io::stdout().flush();
        status
    })
}
