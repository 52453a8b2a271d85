//! The report: one HTML file for the user, made from a directory of results.
//!
//! A page ([`Page`]) depends only on the files that were read: it contains no clock time and no other input.
//! Charts are drawn by plotly.js, which the page contains ([`Chart`]), with the numbers in a table behind
//! each chart. Pictures ([`Picture`]) show frames that the simulator renders anew, one by one. The page needs
//! no network.
//!
//! - [`study_page`]: a study; [`gate_page`]: the result of a gate. A world registers the page of its runs
//!   ([`register`]), made of [`page`], [`charts`] and [`figures`].
//! - [`read_report`]: the page of any directory of results; [`write_page`] writes it to a file.

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

pub mod charts;
pub mod figures;
mod gate;
pub mod page;
pub mod read;
mod run_files;
#[allow(clippy::indexing_slicing, reason = "indices are rows of tables that the readers have checked")]
mod study;
pub mod verdict;
mod worlds;

use std::path::{Path, PathBuf};

pub use charts::chart::Chart;
pub use gate::{FlippedFrames, gate_page};
pub use page::data_table::DataTable;
pub use page::picture::{Mark, Picture, Pixels, RowMapping, Shape, Stretch};
pub use page::{Block, Link, Page, Section};
pub use read::ResultKind;
pub use run_files::RunFiles;
pub use study::{StudyResult, study_page};

use self::figures::run_page::run_page;
pub use self::worlds::{BudgetPlan, BudgetReport, OtherReport, WorldReport, register, register_other};

use files::{AtomicFile, Checksums, Failure, ReplaceableFile, refuse_unfinished};
use run::{AnyJudgement, IncompleteRun, world_of_run};

use self::worlds::{world_report, worlds_with_budget};

/// Returns the report of a directory of results, with the error budget that is stored there.
///
/// # Errors
/// A [`Failure`] that names the file which is missing or cannot be read.
pub fn read_report(directory: &Path) -> Result<Page, Failure> {
    let page = match ResultKind::from_directory(directory)? {
        ResultKind::Run => return report_on_measurements(&RunFiles::of_directory(directory)),
        ResultKind::Study => study_page(&StudyResult::read(directory)?),
        ResultKind::Other(other) => (other.page)(directory)?,
    };
    Checksums::check(directory, |_| true)?;
    Ok(page)
}

/// Returns the report of measurements of a run or of a rendered dataset, which are scored for it unless the
/// run has written their score.
///
/// # Errors
/// A [`Failure`] that names the file which is missing or cannot be read.
pub fn report_on_measurements(files: &RunFiles) -> Result<Page, Failure> {
    page_of_run(files, None)
}

/// Returns the page of a run, made by the run's world, with a warning if the run is not complete.
fn page_of_run(files: &RunFiles, scored: Option<&mut dyn AnyJudgement>) -> Result<Page, Failure> {
    refuse_unfinished(&files.directory)?;
    let world = world_of_run(&files.path("run.toml"))?;
    let mut page = match world_report(world.code()) {
        Some(of_world) => (of_world.page)(files, scored)?,
        None => run_page(files)?,
    };
    let folder = files.measurements.parent().unwrap_or(&files.directory);
    if let Some(incomplete) = IncompleteRun::read_from_directory(folder)? {
        page.warnings.push(format!("The run is not complete: {incomplete}."));
    }
    Ok(page)
}

/// Returns the error budget of a directory of results.
///
/// # Errors
/// A [`Failure`] for a directory that is not a run, or a run of a world without an error budget.
pub fn budget_of(directory: &Path) -> Result<BudgetReport, Failure> {
    let no_budget = || {
        let worlds = worlds_with_budget().join(" and ");
        Failure::Usage(format!(
            "--budget applies only to runs of {worlds}: {} is not one",
            directory.display()
        ))
    };
    if !matches!(ResultKind::from_directory(directory)?, ResultKind::Run) {
        return Err(no_budget());
    }
    let world = world_of_run(&directory.join("run.toml"))?;
    world_report(world.code()).and_then(|report| report.budget).ok_or_else(no_budget)
}

/// Returns the report of a run with its error budget: `budget` lists directories of runs on the same frames,
/// each with the truth in place of one stage's result.
///
/// # Errors
/// Those of [`read_report`] and [`budget_of`]; a [`Failure`] for a directory in `budget` with other frames,
/// or of a run without replaced stage.
pub fn report_with_budget(directory: &Path, budget: &[PathBuf]) -> Result<Page, Failure> {
    (budget_of(directory)?.page)(directory, budget)
}

/// Returns the report of a run that has just been scored. Scoring results are read from files only if they
/// are not in `scored`; the verdicts are moved out of `scored`.
///
/// # Errors
/// Those of [`read_report`].
pub fn read_run_report(directory: &Path, scored: &mut dyn AnyJudgement) -> Result<Page, Failure> {
    page_of_run(&RunFiles::of_directory(directory), Some(scored))
}

/// Renders frames of a run anew, each with its marks; no pictures for a run of a world without a report of
/// its own, or for a run whose frames cannot be rendered again.
///
/// # Errors
/// A [`Failure`] that names the file which is missing or cannot be read.
pub fn pictures_of_run(directory: &Path, frames: &[u64]) -> Result<Vec<Picture>, Failure> {
    let world = world_of_run(&directory.join("run.toml"))?;
    let Some(of_world) = world_report(world.code()) else { return Ok(Vec::new()) };
    let (pictures, _) = (of_world.pictures)(&RunFiles::of_directory(directory), frames)?;
    Ok(pictures)
}

/// Earlier reports, which a later report replaces.
pub const REPORTS: ReplaceableFile<'static> =
    ReplaceableFile { description: "an earlier report of Boresight", matches: &is_report };

/// Returns true if a file with this beginning is a report.
fn is_report(beginning: &[u8]) -> bool {
    let named = br#"<meta name="generator" content="Boresight "#;
    beginning.starts_with(b"<!doctype html>") && beginning.windows(named.len()).any(|window| window == named)
}

/// Writes a page completely or not at all; an existing report is replaced. Returns the length of the page,
/// bytes.
///
/// # Errors
/// A [`Failure`] when the page cannot be composed, the file cannot be written, or a file other than a report
/// exists there.
pub fn write_page(page: &Page, path: &Path) -> Result<u64, Failure> {
    let html = page.html()?;
    AtomicFile::with_text(path, &html)?.replace(REPORTS)?;
    Ok(html.len() as u64)
}
