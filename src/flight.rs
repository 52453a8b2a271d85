//! Frames in order, made on several threads.

use std::ops::Range;
use std::sync::mpsc;

use rayon::ThreadPoolBuilder;
use rayon::prelude::*;
use sim::{Exposure, Simulator};

use crate::failure::Failure;

/// Frames that a thread makes before the batch is handed on: enough to keep threads busy, few enough that memory
/// stays flat (a frame of 752 × 580 takes about 1 MB).
const FRAMES_PER_JOB: u64 = 8;

/// Makes the exposures of `frames` on `jobs` threads and hands them to `take` in order. What is made does not
/// depend on the number of threads.
///
/// # Errors
/// The first failure of `take`; no frame is made after it.
pub fn fly(
    simulator: &Simulator,
    frames: Range<u64>,
    jobs: usize,
    mut take: impl FnMut(Exposure) -> Result<(), Failure>,
) -> Result<(), Failure> {
    if jobs <= 1 {
        let mut camera = simulator.camera();
        return frames.into_iter().try_for_each(|frame| take(camera.expose(frame)));
    }
    let pool = ThreadPoolBuilder::new()
        .num_threads(jobs)
        .build()
        .map_err(|error| Failure::Usage(format!("{jobs} threads cannot be started: {error}")))?;
    let batch = FRAMES_PER_JOB * jobs as u64;
    // One batch is taken while the next one is made.
    let (made, waiting) = mpsc::sync_channel::<Vec<Exposure>>(1);
    std::thread::scope(|scope| {
        scope.spawn(move || {
            for start in frames.clone().step_by(batch as usize) {
                let range = start..(start + batch).min(frames.end);
                let exposures = pool.install(|| {
                    range.into_par_iter().map_init(|| simulator.camera(), |camera, frame| camera.expose(frame)).collect()
                });
                if made.send(exposures).is_err() {
                    return; // `take` failed and nobody listens any more.
                }
            }
        });
        waiting.into_iter().flatten().try_for_each(take)
    })
}
