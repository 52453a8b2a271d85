//! What comes of a case.

use std::path::Path;

use files::Failure;
use run::{AnyJudgement, FirstFailure, Options, RunResult};

use super::cases::{CaseFigure, CaseRow};
use super::definition::{Case, Study};
use super::tried::StudyPipeline;

/// What came of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluated {
    /// Its row.
    pub row: CaseRow,
    /// The first failure of the pipeline, if it failed at all.
    pub first_failure: Option<FirstFailure>,
    /// Whether the pipeline started, if it has to be started at all.
    pub has_started: bool,
}

/// Simulates, processes and scores a case on this thread; nothing is written. A program finds its images in `scratch`.
///
/// # Errors
/// A [`Failure`] when the values drawn make no scenario that can be simulated, named with the case, or the pipeline cannot be built.
pub fn evaluate(
    study: &Study,
    number: u64,
    pipeline: &dyn StudyPipeline,
    scratch: &Path,
) -> Result<Evaluated, Failure> {
    let case = study.case(number)?;
    let RunResult { scored, first_failure, not_flown } = run(study, &case, pipeline, scratch)?;
    let figures = scored.figures();
    let figure = |name: &String| {
        figures.get(name).map_or(CaseFigure { value: None, count: 0, of: 0 }, |figure| CaseFigure {
            value: figure.value,
            count: figure.count,
            of: figure.of,
        })
    };
    let figures = study.figures().iter().map(figure).collect();
    let has_failed = first_failure.is_some();
    let row = CaseRow { case: number, seed: case.seed, has_failed, drawn: case.drawn, figures };
    Ok(Evaluated { row, first_failure, has_started: not_flown.is_none() })
}

fn run(
    study: &Study,
    case: &Case,
    pipeline: &dyn StudyPipeline,
    scratch: &Path,
) -> Result<RunResult<Box<dyn AnyJudgement>>, Failure> {
    let factory = pipeline.factory(case.source.scenario.as_ref(), scratch)?;
    let prepared = case.source.prepare(Options::default())?;
    prepared.score(study.frames(prepared.frame_count())?, &factory)
}
