//! Frames in order, made on several threads.

use std::ops::Range;
use std::sync::{Mutex, PoisonError, mpsc};

use rayon::ThreadPoolBuilder;
use rayon::prelude::*;
use sim::{SimulatedCamera, Simulator};

use crate::failure::Failure;

/// Frames that a thread makes before the batch is handed on, at most: enough to keep threads busy.
const FRAMES_PER_JOB: u64 = 16;
/// Bytes of pixels in them, at most, though never less than one frame: few enough that memory stays flat.
const BYTES_PER_JOB: u64 = 16 << 20;

/// Frames of a batch for each thread, by the bytes that the pixels of one take.
fn frames_per_job(frame_bytes: u64) -> u64 {
    (BYTES_PER_JOB / frame_bytes.max(1)).clamp(1, FRAMES_PER_JOB)
}

/// Makes something of each of `frames` on `jobs` threads, each with a camera of its own, and hands it to `take` in
/// order. What is made does not depend on the number of threads.
///
/// # Errors
/// The first failure in the order of the frames; nothing after it is taken.
pub fn fly<T: Send>(
    simulator: &Simulator,
    frames: Range<u64>,
    jobs: usize,
    make: impl Fn(&mut SimulatedCamera<'_>, u64) -> Result<T, Failure> + Sync,
    take: impl FnMut(T) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let (columns, rows) = simulator.projection().detector();
    let frame_bytes = (columns * rows * size_of::<u16>()) as u64;
    in_order(frames, jobs, frame_bytes, || Ok(simulator.camera()?), make, take)
}

/// Makes something of each of `frames` on `jobs` threads, each with a workspace of its own, and hands it to `take` in
/// order, on the caller's thread. The pixels of one take `frame_bytes`, by which batches are sized.
///
/// # Errors
/// The first failure in the order of the frames; nothing after it is taken.
pub fn in_order<W: Send, T: Send>(
    frames: Range<u64>,
    jobs: usize,
    frame_bytes: u64,
    workspace: impl Fn() -> Result<W, Failure> + Sync + Send,
    make: impl Fn(&mut W, u64) -> Result<T, Failure> + Sync,
    mut take: impl FnMut(T) -> Result<(), Failure>,
) -> Result<(), Failure> {
    if jobs <= 1 {
        let mut workspace = workspace()?;
        return frames.into_iter().try_for_each(|frame| take(make(&mut workspace, frame)?));
    }
    let pool = ThreadPoolBuilder::new()
        .num_threads(jobs)
        .build()
        .map_err(|error| Failure::Usage(format!("{jobs} threads cannot be started: {error}")))?;
    let batch = frames_per_job(frame_bytes) * jobs as u64;
    // Kept from batch to batch: a camera has tables that it makes as it goes.
    let idle = Mutex::new(Vec::new());
    let lend = || {
        match idle.lock().unwrap_or_else(PoisonError::into_inner).pop() {
            Some(workspace) => Ok(workspace),
            None => workspace(),
        }
        .map(|workspace| Lent { idle: &idle, workspace: Some(workspace) })
    };
    let make_one = |lent: &mut Result<Lent<'_, W>, _>, frame| match lent {
        Ok(Lent { workspace: Some(workspace), .. }) => make(workspace, frame),
        _ => Err(Failure::Usage("the camera could not be made on every thread".to_owned())),
    };
    std::thread::scope(|scope| {
        // One batch is taken while the next one is made.
        let (made, waiting) = mpsc::sync_channel::<Vec<Result<T, Failure>>>(1);
        let lend = &lend;
        let make_one = &make_one;
        scope.spawn(move || {
            for start in frames.clone().step_by(batch as usize) {
                let range = start..(start + batch).min(frames.end);
                let results = pool.install(|| range.into_par_iter().map_init(lend, make_one).collect());
                if made.send(results).is_err() {
                    return; // Something failed, and nobody listens any more.
                }
            }
        });
        waiting.into_iter().flatten().try_for_each(|result| take(result?))
    })
}

/// A workspace that goes back to the idle ones when its part of a batch is done.
struct Lent<'a, W> {
    idle: &'a Mutex<Vec<W>>,
    workspace: Option<W>,
}

impl<W> Drop for Lent<'_, W> {
    fn drop(&mut self) {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).extend(self.workspace.take());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_batch_is_a_few_frames_and_one_when_frames_are_large() {
        let mb = |bytes: f64| frames_per_job((bytes * (1 << 20) as f64) as u64);
        assert_eq!([mb(0.0), mb(0.8), mb(2.0), mb(16.0), mb(500.0)], [16, 16, 8, 1, 1]);
    }
}
