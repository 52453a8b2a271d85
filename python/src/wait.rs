//! Long work that Ctrl-C can end.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
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

/// Why work is to end although all is well with it: Ctrl-C, or an exception like it.
#[derive(Default)]
pub(crate) struct Interruption {
    is_set: AtomicBool,
    reason: Mutex<Option<PyErr>>,
}

impl Interruption {
    /// Ends the work; the first reason counts.
    pub(crate) fn set(&self, reason: PyErr) {
        self.reason.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(reason);
        self.is_set.store(true, Ordering::Relaxed);
    }

    /// Set when the work is not wanted any more.
    pub(crate) fn flag(&self) -> &AtomicBool {
        &self.is_set
    }

    /// The exception that ended the work.
    pub(crate) fn take(&self) -> Option<PyErr> {
        self.reason.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Whether the work may go on; hears of Ctrl-C.
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

/// Does work on a thread of its own, Python free to do something else; `ended` is set when it is not wanted any more, by Ctrl-C or by the
/// work itself.
pub(crate) fn interruptibly<T: Send + 'static>(
    py: Python<'_>,
    after: AfterCtrlC,
    ended: &Arc<Interruption>,
    work: impl FnOnce(&AtomicBool) -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    let own = Arc::clone(ended);
    let worker = std::thread::Builder::new()
        .name("boresight".to_owned())
        .spawn(move || work(own.flag()))
        .map_err(|error| BoresightError::new_err(format!("a thread cannot be started: {error}")))?;
    while !worker.is_finished() {
        py.detach(|| std::thread::sleep(LOOK));
        if let Err(interrupt) = py.check_signals() {
            ended.is_set.store(true, Ordering::Relaxed);
            if after == AfterCtrlC::Ends {
                // What it has to say is less than the interrupt.
                let _ = py.detach(|| worker.join());
            }
            return Err(interrupt);
        }
    }
    let panicked = |_| BoresightError::new_err("a fault of Boresight: the work panicked, see standard error");
    let done = py.detach(|| worker.join()).map_err(panicked)?;
    ended.take().map_or_else(|| done.map_err(raised), Err)
}
