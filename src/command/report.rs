//! `boresight report`: one HTML file of what a directory of results holds.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use super::Answer;
use super::output::Output;
use crate::failure::Failure;
use crate::report::{Page, report_of, report_with_budget, write_page};

#[derive(Debug, Args)]
pub(super) struct ReportArguments {
    /// The directory of a run, of a study, or of `boresight visibility --out`
    #[arg(value_name = "DIR")]
    directory: PathBuf,
    /// The file to write, replaced if it is there; default: `report.html` in the directory
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Far range: the directory of a run of the same frames with --inject STAGE, for the error budget; may be given for every stage
    #[arg(long, value_name = "DIR")]
    budget: Vec<PathBuf>,
}

pub(super) fn report(arguments: &ReportArguments, output: &Output) -> Result<Answer, Failure> {
    let path = arguments.out.clone().unwrap_or_else(|| arguments.directory.join("report.html"));
    let page = if arguments.budget.is_empty() {
        report_of(&arguments.directory)?
    } else {
        report_with_budget(&arguments.directory, &arguments.budget)?
    };
    let bytes = write_page(&page, &path)?;
    output.answer(
        &json!({ "report": path, "bytes": bytes }),
        format!("{} ({:.1} MB)", path.display(), bytes as f64 / 1e6),
    )?;
    Ok(Answer::Yes)
}

/// Writes the report of results that are complete into their directory. They stand without it: why there is none is a remark.
pub(super) fn write_beside(page: Result<Page, Failure>, directory: &Path, output: &Output) {
    if let Err(failure) = page.and_then(|page| write_page(&page, &directory.join("report.html"))) {
        output.note(format!("the report was not written: {failure}"));
    }
}
