//! Selection of frames, and their production in order on several threads.
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError, mpsc};

use files::Failure;

/// Frames to make, number of threads, and the images to keep.
#[derive(Debug, Clone)]
pub struct FrameJobs<F> {
    /// Range of frames.
    pub frames: Range<u64>,
    /// Number of threads that make frames; the frames do not depend on it.
    pub jobs: usize,
    /// Format of the images to keep; `None` keeps none.
    pub images: Option<F>,
    /// Treatment of the noise-free expectation of every frame, in a world that has one.
    pub expectation: Expectation,
    /// Directory of the run whose frames are rendered again, with its states; `None` for all others.
    pub states_of: Option<PathBuf>,
}

impl<F> FrameJobs<F> {
    /// Refuses to keep the noise-free expectation in a world that has none.
    ///
    /// # Errors
    /// [`Failure::Usage`] if it is requested.
    pub fn refuse_expectation(&self, world: &str) -> Result<(), Failure> {
        match self.expectation {
            Expectation::Kept => {
                let message = format!(
                    "--expected requires a world with noise-free images, which {world} does not have"
                );
                Err(Failure::Usage(message))
            }
            Expectation::Dropped => Ok(()),
        }
    }
}

/// Treatment of the noise-free expectation of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Expectation {
    /// Written to `truth/expected/` with the truth, electrons, EXR.
    Kept,
    /// Discarded.
    Dropped,
}

/// Maximum number of frames per thread that are made but not yet taken: enough to keep the threads busy.
const FRAMES_PER_JOB: u64 = 32;
/// Maximum size of the pixels of these frames, bytes, but never fewer than two frames: small enough that
/// memory use stays constant.
const BYTES_PER_JOB: u64 = 32 << 20;

/// Returns the number of frames per thread that may be in progress or wait to be taken, from the size of the
/// pixels of a frame, bytes.
fn frames_per_job(frame_bytes: u64) -> u64 {
    (BYTES_PER_JOB / frame_bytes.max(1)).clamp(2, FRAMES_PER_JOB)
}

/// Calls `make` for each of `frames` on `jobs` threads, each with a separate workspace, and passes the
/// results to `take` in order, on the caller's thread. The pixels of one result need `frame_bytes`, which
/// determines how many results may wait.
///
/// Threads wait only if `take` is that many frames behind.
///
/// # Errors
/// The first failure in the order of the frames; no later result is taken.
pub fn process_in_order<W, T: Send>(
    frames: Range<u64>,
    jobs: usize,
    frame_bytes: u64,
    workspace: impl Fn() -> Result<W, Failure> + Sync,
    make: impl Fn(&mut W, u64) -> Result<T, Failure> + Sync,
    mut take: impl FnMut(T) -> Result<(), Failure>,
) -> Result<(), Failure> {
    if jobs <= 1 {
        let mut workspace = workspace()?;
        return frames.into_iter().try_for_each(|frame| take(make(&mut workspace, frame)?));
    }
    let ahead = frames_per_job(frame_bytes).saturating_mul(jobs as u64);
    let queue =
        Queue { progress: Mutex::new(Progress { left: frames.clone(), ahead }), moved: Condvar::new() };
    let work = |made: mpsc::Sender<(u64, Result<T, Failure>)>| {
        let _end = QueueCloser(&queue);
        let mut opened = None;
        let mut make_frame = |frame| match &mut opened {
            Some(opened) => make(opened, frame),
            None => make(opened.insert(workspace()?), frame),
        };
        while let Some(frame) = queue.next() {
            if made.send((frame, make_frame(frame))).is_err() {
                return; // Something failed, and nobody listens any more.
            }
        }
    };
    std::thread::scope(|scope| {
        let _end = QueueCloser(&queue);
        let (made, waiting) = mpsc::channel();
        for _ in frames.clone().take(jobs) {
            let (made, work) = (made.clone(), &work);
            std::thread::Builder::new()
                .spawn_scoped(scope, move || work(made))
                .map_err(|error| Failure::Usage(format!("{jobs} threads cannot be started: {error}")))?;
        }
        drop(made);
        let mut early = BTreeMap::new();
        for frame in frames {
            let result = loop {
                if let Some(result) = early.remove(&frame) {
                    break result;
                }
                // All threads have ended without this frame: one of them has panicked, and the scope
                // propagates the panic.
                let Ok((number, result)) = waiting.recv() else { return Ok(()) };
                early.insert(number, result);
            };
            take(result?)?;
            queue.frame_taken();
        }
        Ok(())
    })
}

/// Queue of frames from which threads take the next frame.
struct Queue {
    progress: Mutex<Progress>,
    /// Notified when another frame may be begun, or when no frame is left.
    moved: Condvar,
}

/// Progress of the frames.
struct Progress {
    /// Frames that no thread has begun.
    left: Range<u64>,
    /// Number of frames that may be begun before another result is taken.
    ahead: u64,
}

impl Queue {
    /// Waits until a frame may be begun and returns it; `None` when none is left.
    fn next(&self) -> Option<u64> {
        let mut progress = self.progress();
        while !progress.left.is_empty() && progress.ahead == 0 {
            progress = self.moved.wait(progress).unwrap_or_else(PoisonError::into_inner);
        }
        let frame = progress.left.next()?;
        progress.ahead -= 1;
        Some(frame)
    }

    /// Permits one more frame to be begun.
    fn frame_taken(&self) {
        self.progress().ahead += 1;
        self.moved.notify_one();
    }

    fn progress(&self) -> MutexGuard<'_, Progress> {
        self.progress.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Empties the queue when it is dropped: after a failure or a panic, no thread waits for frames that will not
/// come.
struct QueueCloser<'a>(&'a Queue);

impl Drop for QueueCloser<'_> {
    fn drop(&mut self) {
        let mut progress = self.0.progress();
        progress.left.start = progress.left.end;
        self.0.moved.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_frames_may_wait_and_fewer_when_they_are_large() {
        let mb = |bytes: f64| frames_per_job((bytes * (1 << 20) as f64) as u64);
        assert_eq!([mb(0.0), mb(0.8), mb(2.0), mb(16.0), mb(500.0)], [32, 32, 16, 2, 2]);
    }

    /// Makes frame numbers, each after a different delay.
    fn numbers(
        frames: Range<u64>,
        jobs: usize,
        frame_bytes: u64,
        make: impl Fn(u64) -> Result<u64, Failure> + Sync,
        take: impl FnMut(u64) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let make = |made: &mut u64, frame| {
            *made += 1;
            std::thread::sleep(std::time::Duration::from_micros(frame * 7919 % 300));
            make(frame)
        };
        process_in_order(frames, jobs, frame_bytes, || Ok(0), make, take)
    }

    fn failure(text: &str) -> Failure {
        Failure::Usage(text.to_owned())
    }

    #[test]
    fn frames_are_taken_in_order_on_any_number_of_threads() {
        for jobs in [1, 2, 7] {
            for frames in [0..0, 5..6, 3..200] {
                let mut taken = Vec::new();
                let take = |frame| {
                    taken.push(frame);
                    Ok(())
                };
                numbers(frames.clone(), jobs, 0, Ok, take).unwrap();
                assert!(taken.into_iter().eq(frames), "{jobs} threads");
            }
        }
    }

    #[test]
    fn no_more_frames_are_made_ahead_than_may_wait() {
        use std::sync::atomic::{AtomicU64, Ordering};
        let begun = AtomicU64::new(0);
        let make = |frame| {
            begun.fetch_add(1, Ordering::SeqCst);
            Ok(frame)
        };
        // Two frames of 16 MB per thread.
        let take = |frame| {
            std::thread::sleep(std::time::Duration::from_millis(1));
            let begun = begun.load(Ordering::SeqCst);
            assert!(begun <= frame + 6, "{begun} begun, {frame} taken");
            Ok(())
        };
        numbers(0..60, 3, 16 << 20, make, take).unwrap();
        assert_eq!(begun.load(Ordering::SeqCst), 60);
    }

    #[test]
    fn processing_ends_at_the_first_failure() {
        for jobs in [1, 3] {
            let mut taken = 0;
            let make =
                |frame: u64| if frame % 50 == 49 { Err(failure(&frame.to_string())) } else { Ok(frame) };
            let take = |_| {
                taken += 1;
                Ok(())
            };
            let error = numbers(0..1000, jobs, 0, make, take).unwrap_err().to_string();
            assert_eq!((error.as_str(), taken), ("49", 49));
            let take = |frame| if frame == 20 { Err(failure("taken")) } else { Ok(()) };
            assert_eq!(numbers(0..1000, jobs, 0, make, take).unwrap_err().to_string(), "taken");
        }
    }

    #[test]
    fn a_workspace_that_cannot_be_made_is_reported() {
        for jobs in [1, 3] {
            let make = |(): &mut (), frame| Ok(frame);
            let error =
                process_in_order(0..100, jobs, 0, || Err(failure("no camera")), make, |_: u64| Ok(()));
            assert_eq!(error.unwrap_err().to_string(), "no camera");
        }
    }

    #[test]
    fn a_panic_is_passed_on_and_no_thread_waits_for_its_frame() {
        for jobs in [1, 3] {
            let run = || {
                numbers(
                    0..1000,
                    jobs,
                    0,
                    |frame| if frame == 70 { panic!("70") } else { Ok(frame) },
                    |_| Ok(()),
                )
            };
            assert!(std::panic::catch_unwind(run).is_err());
        }
    }
}
