//! Evaluation of a case.

pub(crate) mod engine;
pub(crate) mod study_pipeline;

use std::path::Path;

use files::{Failure, FileError, RunDirectory};
use run::{
    AnyJudgement, Expectation, FirstFailure, FrameJobs, NavigationFigure, Options, RunResult, navigation_of,
};
use score::WARM_UP;

use crate::cases::{CaseFigure, CaseRow};
use crate::definition::{Case, Study};
use crate::evaluate::study_pipeline::StudyPipeline;

/// Result of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseResult {
    /// Row of the case.
    pub row: CaseRow,
    /// First failure of the pipeline, if there was one.
    pub first_failure: Option<FirstFailure>,
    /// True if the pipeline started, or needs no start.
    pub has_started: bool,
}

/// Simulates, processes and scores a case on this thread; writes no results. An external program finds its
/// images in `scratch`.
///
/// A case whose values do not form a scenario that can be simulated has a row with the reason.
///
/// # Errors
/// A [`Failure`] of files, a renderer, or a missing pipeline.
pub fn evaluate(
    study: &Study,
    number: u64,
    pipeline: &dyn StudyPipeline,
    scratch: &Path,
) -> Result<CaseResult, Failure> {
    let case = study.draw(number)?;
    let table = study.table();
    let mut row = CaseRow {
        case: number,
        seed: case.seed,
        has_failed: false,
        error: None,
        frames: 0,
        drawn: case.drawn.clone(),
        figures: vec![CaseFigure { value: None, count: 0, of: 0 }; table.figures.len()],
        causes: vec![0; table.causes.len()],
    };
    let (RunResult { scored, first_failure, incomplete }, navigated) =
        match study.prepare_case(case).and_then(|case| run(study, &case, pipeline, scratch)) {
            Ok(result) => result,
            Err(failure @ (Failure::Toml(_) | Failure::Simulation(_) | Failure::Contract(_))) => {
                row.error = Some(failure.to_string());
                return Ok(CaseResult { row, first_failure: None, has_started: false });
            }
            Err(failure) => return Err(failure),
        };
    for (figure, name) in row.figures.iter_mut().zip(&table.figures) {
        if let Some(found) = scored.figures().get(name) {
            *figure = CaseFigure { value: found.value, count: found.count, of: found.of };
        }
        if let Some(found) = navigated.iter().find(|found| found.name == name) {
            *figure = CaseFigure { value: found.value, count: found.count, of: found.of };
        }
    }
    for unit in scored.units().units.iter().filter(|unit| unit.group != WARM_UP) {
        row.frames += 1;
        let Some(cause) = &unit.cause else { continue };
        let name = format!("{}.{cause}", unit.verdict);
        let place = table.causes.iter().position(|cause| *cause == name);
        if let Some(count) = place.and_then(|place| row.causes.get_mut(place)) {
            *count += 1;
        }
    }
    row.has_failed = first_failure.is_some();
    Ok(CaseResult { row, first_failure, has_started: incomplete.is_none() })
}

/// Result of a case, and the figures of its navigation; none if the study does not navigate.
type Evaluated = (RunResult<Box<dyn AnyJudgement>>, Vec<NavigationFigure>);

fn run(
    study: &Study,
    case: &Case,
    pipeline: &dyn StudyPipeline,
    scratch: &Path,
) -> Result<Evaluated, Failure> {
    let factory = pipeline.factory(&case.source.scenario, scratch)?;
    let prepared = case.source.prepare(Options::default())?;
    let frames = study.frames(prepared.frame_count())?;
    let navigation = study.file.navigate.zip(navigation_of(study.scenario().world().code()));
    let Some((estimator, navigation)) = navigation else {
        return Ok((prepared.score(frames, &factory)?, Vec::new()));
    };
    // The navigation reads the files of a run.
    let directory = RunDirectory::create(&scratch.join("run"))?;
    let frame_jobs =
        FrameJobs { frames, jobs: 1, images: None, expectation: Expectation::Dropped, states_of: None };
    let result = prepared.run(&directory, &frame_jobs, &factory, &|| Ok(()))?;
    let navigated = (navigation.figures)(directory.path(), estimator.code())?;
    std::fs::remove_dir_all(directory.path())
        .map_err(|source| FileError::io(directory.path(), "remove", source))?;
    Ok((result, navigated))
}
