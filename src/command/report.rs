//! `boresight report`, and the reports that other commands write beside their results.

#[cfg(feature = "report")]
mod budget;
#[cfg(feature = "report")]
mod pages;
#[cfg(not(feature = "report"))]
#[path = "report/no_pages.rs"]
mod pages;
use std::path::PathBuf;

use clap::Args;
use files::Failure;
use serde_json::json;

use super::Answer;
use super::options::output_path;
use super::output::Output;

pub use pages::write_page_of;
pub(super) use pages::{write_beside_results, write_beside_run, write_gate};

/// Headings of the report of a run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Headings {
    /// Subjects.
    #[default]
    Subjects,
    /// Figures and tables of the paper that the run reproduces, with their subjects.
    OfPaper,
}

#[derive(Debug, Args)]
pub(super) struct ReportArguments {
    /// Directory of a run, of a processed dataset, of a study, or of `boresight visibility --out`
    #[arg(value_name = "DIR")]
    directory: PathBuf,
    /// Measurements of any pipeline on the frames of the directory, CSV; default: `measurements.csv` in the
    /// directory
    #[arg(long, value_name = "FILE", requires = "out", conflicts_with = "budget")]
    measurements: Option<PathBuf>,
    /// File to write, replaced if it exists; default: `report.html` in the directory
    #[arg(short, long, value_name = "FILE", value_parser = output_path())]
    out: Option<PathBuf>,
    /// Far range, for the error budget: `all` runs the same frames again, once per stage, and keeps the
    /// results in DIR/budget; or the directory of a run of the same frames with --inject STAGE, may be given
    /// for every stage
    #[arg(long, value_name = "all|DIR")]
    budget: Vec<PathBuf>,
}

/// Rejects the option `--report` in a build that cannot write reports, and a path that holds anything other
/// than a report. Checked before minutes are spent on a report that could not be written.
///
/// # Errors
/// [`Failure::Usage`] that names the missing feature; a [`Failure`] that names the file.
pub(super) fn check_option(report: Option<&PathBuf>) -> Result<(), Failure> {
    report.map_or(Ok(()), |path| pages::check_path(path))
}

pub(super) fn report(arguments: &ReportArguments, output: &Output) -> Result<Answer, Failure> {
    let path = arguments.out.clone().unwrap_or_else(|| arguments.directory.join("report.html"));
    check_option(Some(&path))?;
    let bytes = match &arguments.measurements {
        Some(file) => pages::write_report_on_measurements(&arguments.directory, file, &path)?,
        None => pages::write_report(&arguments.directory, &arguments.budget, &path, output)?,
    };
    output.answer(
        &json!({ "report": path, "bytes": bytes }),
        format!("{} ({:.1} MB)", path.display(), bytes as f64 / 1e6),
    )?;
    Ok(Answer::Yes)
}
