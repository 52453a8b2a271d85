//! Progress of long calls, displayed by `boresight._progress` in Python.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use pyo3::prelude::*;

/// Shortest interval between two updates of the display.
const UPDATE_INTERVAL: Duration = Duration::from_millis(100);

/// Counter of finished units, which any thread may increment.
#[derive(Debug, Clone, Default)]
pub(crate) struct ProgressCounter(Arc<AtomicU64>);

impl ProgressCounter {
    /// Adds a finished unit.
    pub(crate) fn increment(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}

/// Display of a call's progress.
pub(crate) struct Progress {
    counter: ProgressCounter,
    /// Bar of Python; `None` if nothing is displayed.
    bar: Option<Py<PyAny>>,
    updated: Mutex<Instant>,
}

impl Progress {
    /// Creates the display of a call whose argument `progress` is `given`. `total` is the number of `unit`s,
    /// `name` the title.
    pub(crate) fn new(
        py: Python<'_>,
        given: Option<&Bound<'_, PyAny>>,
        total: u64,
        unit: &str,
        name: &str,
    ) -> PyResult<Self> {
        let module = py.import("boresight._progress")?;
        let bar = module.call_method1("progress_bar", (given, total, unit, name))?;
        let bar = (!bar.is_none()).then(|| bar.unbind());
        Ok(Self { counter: ProgressCounter::default(), bar, updated: Mutex::new(Instant::now()) })
    }

    /// Returns the counter of finished units.
    pub(crate) fn counter(&self) -> ProgressCounter {
        self.counter.clone()
    }

    /// Updates the display if the last update is older than the interval.
    pub(crate) fn update(&self) -> PyResult<()> {
        let Some(bar) = &self.bar else { return Ok(()) };
        {
            let mut updated = self.updated.lock().unwrap_or_else(PoisonError::into_inner);
            if updated.elapsed() < UPDATE_INTERVAL {
                return Ok(());
            }
            *updated = Instant::now();
        }
        Python::attach(|py| self.show(py, bar))
    }

    /// Displays the final number and closes the display.
    pub(crate) fn finish(&self, py: Python<'_>) -> PyResult<()> {
        let Some(bar) = &self.bar else { return Ok(()) };
        self.show(py, bar)?;
        bar.call_method0(py, "close").map(drop)
    }

    /// Closes the display of a call that has failed; its error takes precedence over one of the display.
    pub(crate) fn abandon(&self, py: Python<'_>) {
        if let Some(bar) = &self.bar {
            let _ = bar.call_method0(py, "close");
        }
    }

    fn show(&self, py: Python<'_>, bar: &Py<PyAny>) -> PyResult<()> {
        bar.call_method1(py, "show", (self.counter.0.load(Ordering::Relaxed),)).map(drop)
    }
}
