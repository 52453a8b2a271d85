//! Long work that Ctrl-C can end.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use boresight::failure::Failure;
use pyo3::prelude::*;

use crate::errors::{BoresightError, raised};

/// How often a waiting caller looks whether the work is done, or somebody pressed Ctrl-C.
const LOOK: Duration = Duration::from_millis(20);

/// Whether work goes on when its caller has gone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AfterCtrlC {
    /// It looks at its flag, and is waited for: what it writes is then as it is after a command that was ended.
    Ends,
    /// It writes nothing and goes on unseen to its end.
    IsLeft,
}

/// Does work on a thread of its own, Python free to do something else; its flag is set when it is not wanted any more.
pub(crate) fn interruptibly<T: Send + 'static>(
    py: Python<'_>,
    after: AfterCtrlC,
    work: impl FnOnce(&AtomicBool) -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    let ended = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&ended);
    let worker = std::thread::Builder::new()
        .name("boresight".to_owned())
        .spawn(move || work(&flag))
        .map_err(|error| BoresightError::new_err(format!("a thread cannot be started: {error}")))?;
    while !worker.is_finished() {
        py.detach(|| std::thread::sleep(LOOK));
        if let Err(interrupt) = py.check_signals() {
            ended.store(true, Ordering::Relaxed);
            if after == AfterCtrlC::Ends {
                // What it has to say is less than the interrupt.
                let _ = py.detach(|| worker.join());
            }
            return Err(interrupt);
        }
    }
    let panicked = |_| BoresightError::new_err("a fault of Boresight: the work panicked, see standard error");
    py.detach(|| worker.join()).map_err(panicked)?.map_err(raised)
}
