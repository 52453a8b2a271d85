//! State shared by the threads of a monitor: reports of all frames, the latest pictures, and the pending
//! requests of the page.

pub(crate) mod painter;
pub mod picture;
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use axum::body::Bytes;
use files::Failure;
use serde::Serialize;
use serde_json::Value;
use tokio::sync::{oneshot, watch};

use crate::report::{FrameReport, Phase};

/// Number of frames that are processed beyond the last requested frame.
const FRAMES_AHEAD: u64 = 120;
/// Maximum size of the kept pictures, bytes: about 290 far-range frames, about 580 fields.
const PICTURE_BYTES: usize = 128 << 20;
/// Maximum number of pictures that wait to be drawn, for all clients together.
const MAX_WAITING: usize = 64;
/// Approximate maximum number of points of the history in the phase chart.
const HISTORY_POINTS: usize = 1500;

/// One monitored run. Frames are processed in order. `goal` moves ahead of the clients, so an idle page
/// causes no processing.
#[derive(Debug)]
pub struct Session {
    frames: Range<u64>,
    state: Mutex<State>,
    /// Signals the threads: the goal has moved, a picture is to be drawn, or the session is closed.
    changed: Condvar,
    /// End of the processed frames, published to waiting clients.
    processed: watch::Sender<u64>,
}

#[derive(Debug)]
struct State {
    entries: Vec<FrameEntry>,
    pictures: VecDeque<(u64, Bytes)>,
    picture_bytes: usize,
    orders: VecDeque<PictureOrder>,
    goal: u64,
    failure: Option<String>,
    is_closed: bool,
}

/// Stored data of a frame.
#[derive(Debug)]
struct FrameEntry {
    report: Bytes,
    phase: Phase,
    settings: Value,
}

/// A request to draw a picture.
#[derive(Debug)]
pub struct PictureOrder {
    /// Number of the frame.
    pub frame: u64,
    /// Settings with which the frame was received ([`Session::publish`]).
    pub settings: Value,
    pub(crate) answer: oneshot::Sender<Bytes>,
}

/// Progress of the run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Progress {
    pub(crate) from: u64,
    pub(crate) to: u64,
    /// End (exclusive) of the processed frames, which start at `from`.
    pub(crate) processed: u64,
    pub(crate) failure: Option<String>,
}

/// Points of the phase chart: frame, range, range rate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct History {
    measured: Vec<(u64, f64, f64)>,
    truth: Vec<(u64, f64, f64)>,
}

/// Answer to a request for a picture.
#[derive(Debug)]
pub(crate) enum PictureAnswer {
    Ready(Bytes),
    Ordered(oneshot::Receiver<Bytes>),
    /// The frame is not processed yet.
    NotYet,
    /// Too many pictures are waiting to be drawn.
    Busy,
}

impl Session {
    pub(crate) fn new(frames: Range<u64>) -> Self {
        let state = State {
            entries: Vec::new(),
            pictures: VecDeque::new(),
            picture_bytes: 0,
            orders: VecDeque::new(),
            goal: frames.start.saturating_add(FRAMES_AHEAD),
            failure: None,
            is_closed: false,
        };
        let processed = watch::Sender::new(frames.start);
        Self { frames, state: Mutex::new(state), changed: Condvar::new(), processed }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // The state is consistent even after a panic in another thread: each change is one assignment or one
        // push.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn contains(&self, frame: u64) -> bool {
        self.frames.contains(&frame)
    }

    /// Waits until `frame` is at or below the goal.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the monitor is closed.
    pub fn wait_for_goal(&self, frame: u64) -> Result<(), Failure> {
        let mut state = self.state();
        while frame > state.goal && !state.is_closed {
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        if state.is_closed { Err(Failure::Usage("the monitor is closed".to_owned())) } else { Ok(()) }
    }

    /// Adds the next frame. `settings` are those with which it was received, so that its picture can be drawn
    /// again.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the report cannot be written as JSON.
    pub fn publish(
        &self,
        report: &FrameReport,
        settings: Value,
        picture: Option<Bytes>,
    ) -> Result<(), Failure> {
        let json = serde_json::to_vec(report)
            .map_err(|error| Failure::Usage(format!("a frame cannot be written as JSON: {error}")))?;
        let mut state = self.state();
        state.entries.push(FrameEntry { report: json.into(), phase: report.phase, settings });
        if let Some(picture) = picture {
            state.keep(report.frame, picture);
        }
        self.processed.send_replace(self.frames.start + state.entries.len() as u64);
        Ok(())
    }

    /// Ends the sequence before its last frame, for the given reason.
    pub(crate) fn fail(&self, reason: String) {
        self.state().failure = Some(reason);
        self.processed.send_modify(|_| ());
    }

    /// Requests the processing of frames up to this one and `FRAMES_AHEAD` more.
    pub(crate) fn request(&self, frame: u64) {
        let mut state = self.state();
        let goal = frame.saturating_add(FRAMES_AHEAD);
        if goal > state.goal {
            state.goal = goal;
            self.changed.notify_all();
        }
    }

    /// Returns the report of a frame, or `None` if the frame is not yet processed.
    pub(crate) fn report(&self, frame: u64) -> Option<Bytes> {
        let index = usize::try_from(frame.checked_sub(self.frames.start)?).ok()?;
        self.state().entries.get(index).map(|entry| entry.report.clone())
    }

    /// Returns a stored picture, or orders one to be drawn.
    pub(crate) fn picture(&self, frame: u64) -> PictureAnswer {
        let mut state = self.state();
        if let Some((_, picture)) = state.pictures.iter().rev().find(|(kept, _)| *kept == frame) {
            return PictureAnswer::Ready(picture.clone());
        }
        let index = frame.checked_sub(self.frames.start).and_then(|index| usize::try_from(index).ok());
        let Some(settings) = index.and_then(|i| state.entries.get(i)).map(|entry| entry.settings.clone())
        else {
            return PictureAnswer::NotYet;
        };
        // Orders of clients that have disconnected make room.
        state.orders.retain(|order| !order.answer.is_closed());
        if state.orders.len() >= MAX_WAITING || state.is_closed {
            return PictureAnswer::Busy;
        }
        let (answer, promise) = oneshot::channel();
        state.orders.push_back(PictureOrder { frame, settings, answer });
        self.changed.notify_all();
        PictureAnswer::Ordered(promise)
    }

    /// Waits for the next picture to be drawn and returns its order; `None` when the session is closed.
    pub(crate) fn next_order(&self) -> Option<PictureOrder> {
        let mut state = self.state();
        loop {
            if state.is_closed {
                return None;
            }
            match state.orders.pop_front() {
                Some(order) if order.answer.is_closed() => {}
                Some(order) => return Some(order),
                None => state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner),
            }
        }
    }

    /// Sends a picture to the client that ordered it, and stores it.
    pub(crate) fn deliver(&self, order: PictureOrder, picture: Bytes) {
        self.state().keep(order.frame, picture.clone());
        // If the client has disconnected, the stored picture remains for the next request.
        let _ = order.answer.send(picture);
    }

    pub(crate) fn progress(&self) -> Progress {
        let state = self.state();
        Progress {
            from: self.frames.start,
            to: self.frames.end,
            processed: self.frames.start + state.entries.len() as u64,
            failure: state.failure.clone(),
        }
    }

    /// Returns a receiver that is notified of every processed frame, and of the end.
    pub(crate) fn subscribe(&self) -> watch::Receiver<u64> {
        self.processed.subscribe()
    }

    /// Returns range and range rate of the frames processed so far, thinned.
    pub(crate) fn history(&self) -> History {
        let state = self.state();
        let step = state.entries.len().div_ceil(HISTORY_POINTS).max(1);
        let points = || (self.frames.start..).zip(&state.entries).step_by(step);
        History {
            measured: points()
                .filter_map(|(frame, entry)| entry.phase.measured.map(|[range, rate]| (frame, range, rate)))
                .collect(),
            truth: points()
                .map(|(frame, entry)| (frame, entry.phase.truth[0], entry.phase.truth[1]))
                .collect(),
        }
    }

    /// Closes the session and wakes all waiting threads.
    pub(crate) fn close(&self) {
        let mut state = self.state();
        state.is_closed = true;
        // Dropping the orders notifies their clients.
        state.orders.clear();
        self.changed.notify_all();
        self.processed.send_modify(|_| ());
    }

    pub(crate) fn is_closed(&self) -> bool {
        self.state().is_closed
    }
}

impl State {
    /// Stores a picture, and discards the oldest ones beyond `PICTURE_BYTES`.
    fn keep(&mut self, frame: u64, picture: Bytes) {
        if self.pictures.iter().any(|(kept, _)| *kept == frame) {
            return;
        }
        self.picture_bytes += picture.len();
        self.pictures.push_back((frame, picture));
        while self.picture_bytes > PICTURE_BYTES {
            let Some((_, oldest)) = self.pictures.pop_front() else { break };
            self.picture_bytes -= oldest.len();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::ImageLayout;

    fn report(frame: u64) -> FrameReport {
        FrameReport {
            frame,
            time_utc: String::new(),
            elapsed_s: 0.0,
            group: String::new(),
            image: ImageLayout { columns: 1, rows: 1, first_row: 0, row_step: 1, camera_rows: 1 },
            status: "measured".to_owned(),
            parameters: Vec::new(),
            facts: Vec::new(),
            overlay: Vec::new(),
            truth_overlay: Vec::new(),
            phase: Phase { measured: Some([frame as f64, 0.0]), truth: [frame as f64, 0.0] },
            ground: None,
            model: Value::Null,
        }
    }

    #[test]
    fn the_number_of_pictures_is_bounded_and_the_oldest_is_dropped() {
        let session = Session::new(0..10);
        let large = Bytes::from(vec![0; PICTURE_BYTES / 3]);
        for frame in 0..4 {
            session.publish(&report(frame), Value::Null, Some(large.clone())).unwrap();
        }
        assert!(matches!(session.picture(0), PictureAnswer::Ordered(_)));
        assert!(matches!(session.picture(3), PictureAnswer::Ready(_)));
        assert!(matches!(session.picture(4), PictureAnswer::NotYet));
    }

    #[test]
    fn orders_are_bounded_and_those_of_clients_that_left_make_room() {
        let session = Session::new(0..2);
        session.publish(&report(0), Value::Null, None).unwrap();
        let promises: Vec<_> = (0..MAX_WAITING).map(|_| session.picture(0)).collect();
        assert!(matches!(session.picture(0), PictureAnswer::Busy));
        drop(promises);
        assert!(matches!(session.picture(0), PictureAnswer::Ordered(_)));
    }

    #[test]
    fn processing_stops_soon_after_the_last_requested_frame() {
        let session = Session::new(100..9000);
        session.wait_for_goal(100 + FRAMES_AHEAD).unwrap();
        assert_eq!(session.state().goal, 100 + FRAMES_AHEAD);
        session.request(500);
        session.wait_for_goal(500 + FRAMES_AHEAD).unwrap();
        session.request(200);
        assert_eq!(session.state().goal, 500 + FRAMES_AHEAD);
        session.close();
        assert!(session.wait_for_goal(8999).is_err() && session.next_order().is_none());
    }
}
