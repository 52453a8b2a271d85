//! What comes of a case.

use std::path::Path;

use files::Failure;
use indexmap::IndexMap;
use run::{FirstFailure, Options};
use score::Figure;

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
    let (figures, first_failure) = figures_of(study, &case, pipeline, scratch)?;
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
    Ok(Evaluated { row, first_failure })
}

fn figures_of(
    study: &Study,
    case: &Case,
    pipeline: &dyn StudyPipeline,
    scratch: &Path,
) -> Result<(IndexMap<String, Figure>, Option<FirstFailure>), Failure> {
    let factory = pipeline.factory(case.source.scenario.as_ref(), scratch)?;
    let prepared = case.source.prepare(Options::default())?;
    let ran = prepared.score(study.frames(prepared.frame_count())?, &factory)?;
    Ok((ran.scored.figures().clone(), ran.first_failure))
}
