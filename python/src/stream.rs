//! Iterator over frames that are made on other threads.

use std::ops::Range;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use boresight::failure::Failure;
use pyo3::prelude::*;

use crate::errors::{BoresightError, raised};
use crate::prepared_scenario::PreparedScenario;
use crate::simulated_frame::SimulatedFrame;
use crate::worlds::PendingFrame;

/// Interval at which a waiting caller checks for Ctrl-C.
const CHECK_INTERVAL: Duration = Duration::from_millis(50);
/// Number of finished frames that wait for the caller, beside those of the batch in progress.
const WAITING: usize = 2;

/// Iterator over frames, in order. They are made on other threads, some ahead of the frame being taken.
#[pyclass(frozen, module = "boresight")]
pub(crate) struct FrameStream {
    prepared: Arc<PreparedScenario>,
    made: Mutex<Receiver<Result<PendingFrame, Failure>>>,
}

impl FrameStream {
    /// Starts the threads. They end when all frames are made or no process takes frames any more.
    pub(crate) fn start(prepared: &Arc<PreparedScenario>, frames: Range<u64>, jobs: usize) -> PyResult<Self> {
        let (send, made) = sync_channel(WAITING);
        let own = Arc::clone(prepared);
        std::thread::Builder::new()
            .name("boresight frames".to_owned())
            .spawn(move || make(&own, frames, jobs, &send))
            .map_err(|error| BoresightError::new_err(format!("a thread cannot be started: {error}")))?;
        Ok(Self { prepared: Arc::clone(prepared), made: Mutex::new(made) })
    }
}

fn make(
    prepared: &PreparedScenario,
    frames: Range<u64>,
    jobs: usize,
    send: &SyncSender<Result<PendingFrame, Failure>>,
) {
    let mut hand_over = |made: PendingFrame| send.send(Ok(made)).map_err(|_| Failure::Interrupted);
    if let Err(failure) = prepared.world.make(frames, jobs, &mut hand_over) {
        // The receiver may be gone.
        let _ = send.send(Err(failure));
    }
}

#[pymethods]
impl FrameStream {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Py<SimulatedFrame>>> {
        let next = || self.made.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(CHECK_INTERVAL);
        loop {
            match py.detach(next) {
                Ok(Ok(made)) => return SimulatedFrame::new(py, made, &self.prepared).map(Some),
                Ok(Err(failure)) => return Err(raised(failure)),
                Err(RecvTimeoutError::Timeout) => py.check_signals()?,
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
            }
        }
    }
}
