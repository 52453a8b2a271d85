//! `boresight report`: one HTML file of what a directory of results holds.

mod budget;

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use self::budget::fly_budget;
use super::Answer;
use super::output::Output;
use crate::failure::Failure;
use crate::report::{Page, report_of, report_with_budget, write_page};

/// The word for the runs of every stage.
const ALL: &str = "all";

#[derive(Debug, Args)]
pub(super) struct ReportArguments {
    /// The directory of a run, of a study, or of `boresight visibility --out`
    #[arg(value_name = "DIR")]
    directory: PathBuf,
    /// The file to write, replaced if it is there; default: `report.html` in the directory
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Far range, for the error budget: `all` flies the same frames again, once a stage, and keeps what they gave in DIR/budget; or the
    /// directory of a run of the same frames with --inject STAGE, may be given for every stage
    #[arg(long, value_name = "all|DIR")]
    budget: Vec<PathBuf>,
}

pub(super) fn report(arguments: &ReportArguments, output: &Output) -> Result<Answer, Failure> {
    let path = arguments.out.clone().unwrap_or_else(|| arguments.directory.join("report.html"));
    let page = if arguments.budget.is_empty() {
        report_of(&arguments.directory)?
    } else {
        match arguments.budget.as_slice() {
            [only] if only == Path::new(ALL) => {
                report_with_budget(&arguments.directory, &fly_budget(&arguments.directory, output)?)?
            }
            several if several.iter().any(|path| path == Path::new(ALL)) => {
                return Err(Failure::Usage(
                    "--budget is `all` and a directory, expected `all` alone: it flies every stage"
                        .to_owned(),
                ));
            }
            directories => report_with_budget(&arguments.directory, directories)?,
        }
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
