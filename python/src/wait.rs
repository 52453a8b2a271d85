//! Long-running work that Ctrl-C can end.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use boresight::failure::Failure;
use pyo3::prelude::*;

use crate::errors::{BoresightError, raised};

/// Interval at which a waiting caller checks for the end of the work and for Ctrl-C.
const CHECK_INTERVAL: Duration = Duration::from_millis(20);

/// Treatment of work whose caller was interrupted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AfterCtrlC {
    /// The work checks its flag and the caller waits for its end, so that its files are in the state of an
    /// interrupted command.
    Ends,
    /// The work writes no files and runs unobserved to its end.
    IsLeft,
}

/// Reason to end work that has not failed: Ctrl-C, or an exception like it.
#[derive(Default)]
pub(crate) struct Interruption {
    is_set: AtomicBool,
    reason: Mutex<Option<PyErr>>,
}

impl Interruption {
    /// Ends the work; the first reason is kept.
    pub(crate) fn set(&self, reason: PyErr) {
        self.reason.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(reason);
        self.is_set.store(true, Ordering::Relaxed);
    }

    /// Flag that is set when the work must end.
    pub(crate) fn flag(&self) -> &AtomicBool {
        &self.is_set
    }

    /// Takes the exception that ended the work.
    pub(crate) fn take(&self) -> Option<PyErr> {
        self.reason.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Returns an error if the work must end; also checks for Ctrl-C.
    pub(crate) fn go_on(&self) -> Result<(), Failure> {
        if self.is_set.load(Ordering::Relaxed) {
            return Err(Failure::Interrupted);
        }
        Python::attach(|py| py.check_signals()).map_err(|error| {
            self.set(error);
            Failure::Interrupted
        })
    }
}

/// Runs work on a separate thread while Python is free to do something else; `ended` is set when the work
/// must end, by Ctrl-C or by the work itself. `watch` is called at intervals; an error that it returns ends
/// the work as Ctrl-C does.
pub(crate) fn interruptibly<T: Send + 'static>(
    py: Python<'_>,
    after: AfterCtrlC,
    ended: &Arc<Interruption>,
    watch: impl Fn() -> PyResult<()>,
    work: impl FnOnce(&AtomicBool) -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    let own = Arc::clone(ended);
    let worker = std::thread::Builder::new()
        .name("boresight".to_owned())
        .spawn(move || work(own.flag()))
        .map_err(|error| BoresightError::new_err(format!("a thread cannot be started: {error}")))?;
    while !worker.is_finished() {
        py.detach(|| std::thread::sleep(CHECK_INTERVAL));
        if let Err(interrupt) = py.check_signals().and_then(|()| watch()) {
            ended.is_set.store(true, Ordering::Relaxed);
            if after == AfterCtrlC::Ends {
                // The interrupt takes precedence over the result of the work.
                let _ = py.detach(|| worker.join());
            }
            return Err(interrupt);
        }
    }
    let panicked =
        |_| BoresightError::new_err("internal error of Boresight: a thread panicked, see standard error");
    let done = py.detach(|| worker.join()).map_err(panicked)?;
    ended.take().map_or_else(|| done.map_err(raised), Err)
}
