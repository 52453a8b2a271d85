//! Pages of the crate `report`, written to files.

use std::path::{Path, PathBuf};

use files::Failure;
use gate::GateReport;
use report::{
    FlippedFrames, Page, REPORTS, RunFiles, gate_page, read_report, read_run_report, report_on_measurements,
    report_with_budget, write_page,
};
use run::AnyJudgement;

use super::Headings;
use super::budget::run_budget;
use crate::command::output::Output;

/// Value of `--budget` that runs every stage.
const ALL: &str = "all";

/// Writes the report of a directory of results to `path` and returns its size, bytes.
///
/// # Errors
/// A [`Failure`] for a directory without results, an error budget that does not belong to it, or a file that
/// cannot be written.
pub(super) fn write_report(
    directory: &Path,
    budget: &[PathBuf],
    path: &Path,
    output: &Output,
) -> Result<u64, Failure> {
    let page = match budget {
        [] => read_report(directory)?,
        [only] if only == Path::new(ALL) => report_with_budget(directory, &run_budget(directory, output)?)?,
        several if several.iter().any(|path| path == Path::new(ALL)) => {
            return Err(Failure::Usage(
                "--budget is `all` and a directory, expected only `all`, which runs every stage".to_owned(),
            ));
        }
        directories => report_with_budget(directory, directories)?,
    };
    write_page(&page, path)
}

/// Writes the report of measurements of a run or of a rendered dataset to `path`, and returns its size,
/// bytes.
///
/// # Errors
/// A [`Failure`] for measurements that do not belong to the directory, or a file that cannot be written.
pub(super) fn write_report_on_measurements(
    directory: &Path,
    measurements: &Path,
    path: &Path,
) -> Result<u64, Failure> {
    let files = RunFiles { directory: directory.to_owned(), measurements: measurements.to_owned() };
    write_page(&report_on_measurements(&files)?, path)
}

/// Writes the report of a directory of results to `path`, for the Python package. An earlier report is
/// replaced.
///
/// # Errors
/// A [`Failure`] for a directory without results, or a file that cannot be written.
pub fn write_page_of(directory: &Path, measurements: Option<&Path>, path: &Path) -> Result<(), Failure> {
    check_path(path)?;
    match measurements {
        Some(measurements) => write_report_on_measurements(directory, measurements, path)?,
        None => write_page(&read_report(directory)?, path)?,
    };
    Ok(())
}

/// Writes the report of a run that has just been scored into its directory.
pub(in crate::command) fn write_beside_run(
    directory: &Path,
    scored: &mut dyn AnyJudgement,
    headings: Headings,
    output: &Output,
) {
    let names_paper = headings == Headings::OfPaper;
    let page = read_run_report(directory, scored).map(|page| Page { names_paper, ..page });
    write_beside(page, directory, output);
}

/// Writes the report of a directory of complete results into it.
pub(in crate::command) fn write_beside_results(directory: &Path, output: &Output) {
    write_beside(read_report(directory), directory, output);
}

/// Writes the report of a gate to `path`, with the frames of `result` whose verdicts changed.
///
/// # Errors
/// A [`Failure`] when a frame cannot be drawn or the file cannot be written.
pub(in crate::command) fn write_gate(report: &GateReport, result: &Path, path: &Path) -> Result<(), Failure> {
    let flipped = FlippedFrames::render(report, result)?;
    write_page(&gate_page(report, flipped), path).map(|_| ())
}

/// Rejects a path that holds anything other than an earlier report.
///
/// # Errors
/// A [`Failure`] that names the path.
pub(super) fn check_path(path: &Path) -> Result<(), Failure> {
    Ok(REPORTS.check(path)?)
}

/// Writes `report.html` into a directory whose results are complete without it: a failure only prints a
/// remark.
fn write_beside(page: Result<Page, Failure>, directory: &Path, output: &Output) {
    if let Err(failure) = page.and_then(|page| write_page(&page, &directory.join("report.html"))) {
        output.note(format!("the report was not written: {failure}"));
    }
}
