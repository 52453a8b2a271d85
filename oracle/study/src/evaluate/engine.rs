//! Runs the cases of a shard on the threads of this machine.
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use files::Failure;
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;

use super::study_pipeline::StudyPipeline;
use crate::cases::CaseRow;
use crate::definition::Study;
use crate::evaluate::{CaseResult, evaluate};

/// How the cases of a campaign are run.
#[derive(Debug, Clone, Copy)]
pub struct Workers<'a> {
    /// Threads; the rows do not depend on it.
    pub jobs: usize,
    /// A program finds its images in folders of its own below this one.
    pub scratch: &'a Path,
    /// Set from outside, it ends the campaign: no other case is begun.
    pub ended: Option<&'a AtomicBool>,
}

/// Evaluates cases on `jobs` threads, a case a thread; `done` is told of each, in no order, and may end them all. The rows are in order,
/// and depend on neither. A program finds its images in folders of its own below `scratch`.
///
/// # Errors
/// That of `done`; the failure of the first case, in order, that has one; [`Failure::Interrupted`] of those that were not done when it
/// was ended.
pub(crate) fn run_cases(
    study: &Study,
    cases: Vec<u64>,
    pipeline: &dyn StudyPipeline,
    Workers { jobs, scratch, ended }: Workers<'_>,
    done: impl Fn(&CaseResult) -> Result<(), Failure> + Sync,
) -> Result<Vec<CaseRow>, Failure> {
    let pool = ThreadPoolBuilder::new()
        .num_threads(jobs)
        .build()
        .map_err(|error| Failure::Usage(format!("{jobs} threads cannot be started: {error}")))?;
    let refused = OnceLock::new();
    let is_ended = || ended.is_some_and(|ended| ended.load(Ordering::Relaxed)) || refused.get().is_some();
    let go_on = || if is_ended() { Err(Failure::Interrupted) } else { Ok(()) };
    let one = |case: u64| {
        go_on()?;
        let own = tempfile::tempdir_in(scratch)
            .map_err(|error| Failure::Usage(format!("a temporary directory cannot be made: {error}")))?;
        let evaluated = evaluate(study, case, pipeline, own.path())?;
        // What a pipeline answered while it was ended is no result.
        go_on()?;
        if let Err(failure) = done(&evaluated) {
            refused.get_or_init(|| failure);
        }
        Ok(evaluated.row)
    };
    let rows: Vec<Result<CaseRow, Failure>> = pool.install(|| cases.into_par_iter().map(one).collect());
    refused.into_inner().map_or_else(|| rows.into_iter().collect(), Err)
}
