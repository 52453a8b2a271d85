//! Execution of the cases of a shard on the threads of this machine.
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

/// Resources with which the cases of a campaign are run.
#[derive(Debug, Clone, Copy)]
pub struct Workers<'a> {
    /// Number of threads; the rows do not depend on it.
    pub jobs: usize,
    /// Directory below which each case has a separate directory for the images of an external program.
    pub scratch: &'a Path,
    /// External flag that ends the campaign: no further case is begun once it is set.
    pub ended: Option<&'a AtomicBool>,
}

/// Evaluates cases on `jobs` threads, one case per thread. `done` is called with each case, in no particular
/// order, and may end the evaluation. The rows are in order, and depend neither on the number of threads nor
/// on `done`. An external program finds its images in a separate directory per case below `scratch`.
///
/// # Errors
/// The error of `done`; the failure of the first case, in order, that has one; [`Failure::Interrupted`] for
/// cases that were not complete when the campaign was ended.
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
        // A result computed while the campaign was being ended is discarded.
        go_on()?;
        if let Err(failure) = done(&evaluated) {
            refused.get_or_init(|| failure);
        }
        Ok(evaluated.row)
    };
    let rows: Vec<Result<CaseRow, Failure>> = pool.install(|| cases.into_par_iter().map(one).collect());
    refused.into_inner().map_or_else(|| rows.into_iter().collect(), Err)
}
