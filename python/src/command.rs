//! The command `boresight` itself.

use std::ffi::OsString;
use std::io::Write;

use pyo3::prelude::*;

/// Runs the command `boresight` with the words that follow its name, and gives its exit status: 0 done, 1 the answer is no, 2 usage or
/// bad input. Python hears of no signal meanwhile: `python -m boresight` leaves them to the system.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| {
        let status = boresight::command::run_words(std::iter::once(OsString::from("boresight")).chain(words));
        // Rust does it at the end of a program of its own. Nobody can be told that the stream is closed.
        let _ = std::io::stdout().flush();
        status
    })
}
