//! `boresight demo`: three real runs of two small scenarios, with a summary on the terminal and a page that
//! leads to their reports.

mod browser;
mod docking;
mod far_range;
#[cfg(feature = "report")]
mod page;
#[cfg(not(feature = "report"))]
#[path = "no_page.rs"]
mod page;
mod part;

use std::path::{Path, PathBuf};

use clap::Args;
use files::{Failure, create_empty_directory, create_numbered_directory};
use indexmap::IndexMap;
use score::Figure;
use serde_json::json;
use view::terminal::percent;

use self::docking::DockingResults;
use self::far_range::FarRangeResults;
use super::Answer;
use super::options::{default_jobs, output_path};
use super::output::Output;
use super::run::RUNS;

#[derive(Debug, Args)]
pub(super) struct DemoArguments {
    /// A new or empty directory for the results; default: the next free `runs/demo-001`
    #[arg(short, long, value_name = "DIR", value_parser = output_path())]
    out: Option<PathBuf>,
    /// Do not open the page in a browser. Without this option it is opened if standard output is a terminal
    #[arg(long)]
    no_open: bool,
    /// Threads that make frames; default: all cores. The results do not depend on the number of threads
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
}

/// Results of all runs of the demo.
struct DemoResults {
    far_range: FarRangeResults,
    docking: DockingResults,
}

/// Commands to try next, each with its purpose.
const NEXT: [(&str, &str); 3] = [
    ("boresight sky --ra 83.6 --dec -5.4 --camera uasc-far-range -o orion.png", "a picture of Orion"),
    ("boresight reproduce argon", "the table of the 2012 paper, in a minute"),
    ("boresight scenario new my.toml", "your own; then boresight run my.toml"),
];

pub(super) fn demo(arguments: &DemoArguments, output: &Output) -> Result<Answer, Failure> {
    let directory = match &arguments.out {
        Some(path) => create_empty_directory(path).map(|()| path.clone())?,
        None => create_numbered_directory(Path::new(RUNS), "demo")?,
    };
    let jobs = arguments.jobs.map_or_else(default_jobs, usize::from);
    let far_range = FarRangeResults::run(&directory, jobs, output)?;
    let docking = DockingResults::run(&directory, jobs, output)?;
    let results = DemoResults { far_range, docking };
    let page = page::write(&results, &directory, output)?;
    // Opened before the summary, which names the page.
    let wants_browser = !arguments.no_open && output.is_terminal();
    let is_open = wants_browser && page.as_deref().is_some_and(browser::open);
    let document = json!({
        "directory": directory,
        "page": page,
        "far_range": results.far_range.document(),
        "docking": results.docking.document(),
        "next": NEXT.map(|(command, _)| command),
    });
    output.answer(&document, results.text(&directory, page.as_deref(), is_open))?;
    Ok(Answer::Yes)
}

impl DemoResults {
    /// Returns the summary for a terminal.
    fn text(&self, directory: &Path, page: Option<&Path>, is_open: bool) -> String {
        let mut text = format!("{}\n{}\n", self.far_range.text(), self.docking.text());
        text += &match page {
            Some(page) if is_open => format!("pictures and reports, in your browser: {}\n", page.display()),
            Some(page) => format!("pictures and reports, for a browser: {}\n", page.display()),
            None => format!("results in {}\n", directory.display()),
        };
        text += "\nnext:\n";
        let width = NEXT.map(|(command, _)| command.len()).into_iter().max().unwrap_or(0);
        for (command, purpose) in NEXT {
            text += &format!("  {command:width$}  {purpose}\n");
        }
        text.trim_end().to_owned()
    }
}

/// Returns the value of a figure; `None` if it is undefined or absent.
fn value(figures: &IndexMap<String, Figure>, name: &str) -> Option<f64> {
    figures.get(name)?.value
}

/// Returns the square root of the sum of squares of two figures; `None` if one of them is undefined.
fn root_sum_square(figures: &IndexMap<String, Figure>, names: [&str; 2]) -> Option<f64> {
    let [first, second] = names.map(|name| value(figures, name));
    Some(libm::hypot(first?, second?))
}

/// Formats a rate in percent, and an undefined one as a dash.
fn percent_or_dash(rate: Option<f64>) -> String {
    rate.map_or_else(|| "–".to_owned(), |rate| format!("{} %", percent(rate)))
}
