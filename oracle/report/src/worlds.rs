//! Registry of worlds with a specific report. The report of any other world shows only figures and verdicts.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{PoisonError, RwLock};

use files::Failure;
use run::AnyJudgement;
use scenario::Stage;

use crate::RunFiles;
use crate::page::Page;
use crate::page::picture::RenderedPictures;

/// World-specific parts of a report.
#[derive(Clone, Copy)]
pub struct WorldReport {
    /// Code of the world.
    pub code: &'static str,
    /// Makes the page of a run and verifies the checksums of the files that it read. For a run of this
    /// process, the page uses the run's verdicts, which it may move out.
    pub page: fn(&RunFiles, Option<&mut dyn AnyJudgement>) -> Result<Page, Failure>,
    /// Renders frames of a run anew.
    pub pictures: fn(&RunFiles, &[u64]) -> Result<RenderedPictures, Failure>,
    /// Error budget of a run; `None` for a world without stages that can be replaced.
    pub budget: Option<BudgetReport>,
}

/// Error budget of the runs of a world: the same frames are run again, once per stage, with the truth in
/// place of the stage's result.
#[derive(Clone, Copy)]
pub struct BudgetReport {
    /// Returns what can be replaced in a run directory.
    pub plan: fn(&Path) -> Result<BudgetPlan, Failure>,
    /// Makes the page of a run directory with its error budget, from the directories of the runs with a
    /// replaced stage.
    pub page: fn(&Path, &[PathBuf]) -> Result<Page, Failure>,
}

/// Report of other results than runs, studies and gates.
#[derive(Clone, Copy)]
pub struct OtherReport {
    /// File by which a directory of these results is recognised.
    pub file: &'static str,
    /// Name of the results in messages, with its article.
    pub results: &'static str,
    /// Makes the page of a directory.
    pub page: fn(&Path) -> Result<Page, Failure>,
}

/// Registered reports of other results, in order.
static OTHERS: RwLock<Vec<OtherReport>> = RwLock::new(Vec::new());

/// Registers a report of other results for the rest of the process.
pub fn register_other(report: OtherReport) {
    let mut registered = OTHERS.write().unwrap_or_else(PoisonError::into_inner);
    if registered.iter().all(|known| known.file != report.file) {
        registered.push(report);
    }
}

/// Returns the registered reports of other results.
pub(crate) fn other_reports() -> Vec<OtherReport> {
    OTHERS.read().unwrap_or_else(PoisonError::into_inner).clone()
}

/// Frames of a run and the stages of its pipeline whose result can be replaced by the truth.
#[derive(Debug, Clone, PartialEq)]
pub struct BudgetPlan {
    /// Frames.
    pub frames: Range<u64>,
    /// Stages, in the order of the pipeline.
    pub stages: Vec<Stage>,
}

/// Registered reports, in order.
static REPORTS: RwLock<Vec<WorldReport>> = RwLock::new(Vec::new());

/// Registers the report of a world for the rest of the process. A report of a world that has one already is
/// left as it is.
pub fn register(report: WorldReport) {
    let mut registered = REPORTS.write().unwrap_or_else(PoisonError::into_inner);
    if registered.iter().all(|known| known.code != report.code) {
        registered.push(report);
    }
}

/// Returns the codes of the worlds whose runs have an error budget.
pub(crate) fn worlds_with_budget() -> Vec<&'static str> {
    let registered = REPORTS.read().unwrap_or_else(PoisonError::into_inner);
    registered.iter().filter(|report| report.budget.is_some()).map(|report| report.code).collect()
}

/// Returns the world-specific parts of a report, by the code of the world; `None` for a world without any.
pub(crate) fn world_report(code: &str) -> Option<WorldReport> {
    let registered = REPORTS.read().unwrap_or_else(PoisonError::into_inner);
    registered.iter().find(|report| report.code == code).copied()
}
