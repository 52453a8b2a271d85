//! Page of the demo: the main figures of its runs, some of their frames, and links to their reports.

use std::path::{Path, PathBuf};

use files::Failure;
use report::page::data_table::DataTable;
use report::verdict::Verdict;
use report::{Page, Section, write_page};
use serde_json::json;

use super::{DemoResults, NEXT};
use crate::command::output::Output;

/// Writes the page into the directory of the demo and returns its path.
///
/// # Errors
/// A [`Failure`] when a frame cannot be drawn or the page cannot be written.
pub(super) fn write(results: &DemoResults, directory: &Path, _: &Output) -> Result<Option<PathBuf>, Failure> {
    let path = directory.join("index.html");
    let page = Page {
        title: "Two rendezvous: simulated, measured, scored".to_owned(),
        kind: "Demo of Boresight",
        version: env!("CARGO_PKG_VERSION").to_owned(),
        lead: vec![
            "Boresight has drawn the images of a camera that approaches another spacecraft, has measured the \
             spacecraft in each image, and has compared every measurement with the truth. All figures and \
             pictures of this page come from these runs."
                .to_owned(),
        ],
        warnings: Vec::new(),
        verdict: Verdict::new([results.far_range.findings(), results.docking.findings()].concat()),
        facts: results.far_range.facts().into_iter().chain(results.docking.facts()).collect(),
        sections: vec![results.far_range.section()?, results.docking.section()?, next_steps()],
        names_paper: false,
        data: json!({
            "far_range": results.far_range.document(),
            "docking": results.docking.document(),
        }),
    };
    write_page(&page, &path)?;
    Ok(Some(path))
}

/// Returns the section on the commands to try next.
fn next_steps() -> Section {
    let mut table = DataTable::new(["command", "result"]).wordy();
    for (command, purpose) in NEXT {
        table.push([command, purpose]);
    }
    Section::new("next", "Next").table(table)
}
