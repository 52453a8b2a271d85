//! Frames made on threads, taken one by one in Python.

use std::ops::Range;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use boresight::failure::Failure;
use boresight::flight::in_order;
use boresight::run::{PreparedDocking, World as Simulated};
use contract::docking::{Digitiser, Field, FieldTelemetry};
use pyo3::prelude::*;
use sim::Exposure;
use sim::docking::FieldTruth;

use crate::errors::{BoresightError, raised};
use crate::frame::SimulatedFrame;
use crate::ready::{Ready, World};

/// How often a waiting caller looks whether somebody pressed Ctrl-C.
const LOOK: Duration = Duration::from_millis(50);
/// Frames that wait for the caller beside those of the batch being made.
const WAITING: usize = 2;

/// A frame that was made.
enum Made {
    FarRange(Box<Exposure>),
    Docking(Box<(Field, FieldTelemetry, FieldTruth)>),
}

/// Frames in order, an iterator. They are made on other threads, some ahead of the one that is taken.
#[pyclass(frozen, module = "boresight")]
pub(crate) struct FrameStream {
    ready: Arc<Ready>,
    made: Mutex<Receiver<Result<Made, Failure>>>,
}

impl FrameStream {
    /// Starts the threads. They end when all is made, or nobody takes frames any more.
    pub(crate) fn start(ready: &Arc<Ready>, frames: Range<u64>, jobs: usize) -> PyResult<Self> {
        let (send, made) = sync_channel(WAITING);
        let own = Arc::clone(ready);
        std::thread::Builder::new()
            .name("boresight frames".to_owned())
            .spawn(move || make(&own, frames, jobs, &send))
            .map_err(|error| BoresightError::new_err(format!("a thread cannot be started: {error}")))?;
        Ok(Self { ready: Arc::clone(ready), made: Mutex::new(made) })
    }
}

fn make(ready: &Ready, frames: Range<u64>, jobs: usize, send: &SyncSender<Result<Made, Failure>>) {
    let hand_over = |made: Made| send.send(Ok(made)).map_err(|_| Failure::Interrupted);
    let done = match &ready.world {
        World::FarRange(prepared) => {
            expose(prepared.as_ref(), frames, jobs, |exposure| hand_over(Made::FarRange(Box::new(exposure))))
        }
        World::Docking(prepared) => expose(prepared.as_ref(), frames, jobs, |exposure| {
            hand_over(Made::Docking(Box::new(PreparedDocking::receive(exposure, &Digitiser::default()))))
        }),
    };
    if let Err(failure) = done {
        // Nobody may be there to hear it.
        let _ = send.send(Err(failure));
    }
}

/// Exposes frames on threads and hands them on, in order.
fn expose<W: Simulated>(
    world: &W,
    frames: Range<u64>,
    jobs: usize,
    take: impl FnMut(W::Exposure) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let make = |workspace: &mut W::Workspace<'_>, frame| world.expose(workspace, frame);
    in_order(frames, jobs, world.exposure_bytes() as u64, || world.workspace(), make, take)
}

#[pymethods]
impl FrameStream {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Py<SimulatedFrame>>> {
        let next = || self.made.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(LOOK);
        loop {
            match py.detach(next) {
                Ok(Ok(Made::FarRange(exposure))) => {
                    return SimulatedFrame::of(py, *exposure, &self.ready).map(Some);
                }
                Ok(Ok(Made::Docking(made))) => {
                    let (field, telemetry, truth) = *made;
                    return SimulatedFrame::of_field(py, field, &telemetry, truth, &self.ready).map(Some);
                }
                Ok(Err(failure)) => return Err(raised(failure)),
                Err(RecvTimeoutError::Timeout) => py.check_signals()?,
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
            }
        }
    }
}
