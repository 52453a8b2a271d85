//! Steps shared by `run` and `study replay`: run, report, show.

use config::toml_file;
use far_range_views::navigation_table;
use files::{Failure, FileError, RunDirectory};
use navigate::NavigationResult;
use run::{AnyFactory, AnyMission, FrameJobs};
use view::terminal::wrapped;

use super::Answer;
use super::far_range::EstimatorName;
use super::interrupt::report_interruption;
use super::output::Output;
use super::report::{Headings, write_beside_run};
use crate::table::score_table;

/// Options for presenting a run.
pub(super) struct Presentation<'a> {
    /// Name of the run, for the progress bar.
    pub(super) name: &'a str,
    /// Report that is written into the directory; `None` for none.
    pub(super) report: Option<Headings>,
    /// Remark below the score.
    pub(super) note: Option<String>,
    /// Navigator that determines the relative orbit from the measurements of the run.
    pub(super) navigate: Option<EstimatorName>,
}

/// Makes an interrupt report the unfinished run directory.
pub(super) fn note_unfinished_run(directory: &RunDirectory) {
    let path = directory.path().display().to_string();
    report_interruption(move || {
        format!(
            "{path} contains an unfinished run, which cannot be continued: remove it, and run the command \
             again"
        )
    });
}

/// Runs a scenario into a directory, writes the report if requested, and shows the score.
pub(super) fn execute(
    prepared: &dyn AnyMission,
    frame_jobs: &FrameJobs<String>,
    factory: &AnyFactory,
    directory: &RunDirectory,
    shown: Presentation<'_>,
    output: &Output,
) -> Result<Answer, Failure> {
    output.warn(&prepared.warnings());
    let frames = frame_jobs.frames.end - frame_jobs.frames.start;
    note_unfinished_run(directory);
    let progress = output.progress(frames, &format!("{}, {}", shown.name, factory.name));
    let ran = prepared.run(directory, frame_jobs, factory, &|| {
        progress.inc(1);
        Ok(())
    });
    progress.finish_and_clear();
    let mut ran = ran?;
    output.first_failure(ran.first_failure.as_ref());
    let mut table = score_table(ran.scored.as_ref(), output.is_terminal());
    let navigated = shown.navigate.map(|navigator| navigator.navigate_run(directory.path())).transpose();
    if let Ok(Some(result)) = &navigated {
        table = format!("{}\n\n{}", table.trim_end(), navigation_table(result, output.is_terminal()));
    }
    let notes: String = shown.note.into_iter().map(|note| wrapped(&format!("\n\n{note}"))).collect();
    let text = format!("{}{notes}\n\nresults in {}", table.trim_end(), directory.path().display());
    let file = directory.score();
    let json = toml_file::read_text(&file).map_err(|source| FileError::io(&file, "read", source))?;
    if let Some(headings) = shown.report {
        write_beside_run(directory.path(), ran.scored.as_mut(), headings, output);
    }
    output.answer_json(
        &with_navigation(json.trim_end(), navigated.as_ref().ok().and_then(Option::as_ref))?,
        text,
    )?;
    let incomplete = ran.incomplete.map(|incomplete| incomplete.to_string());
    // The run is complete without its navigation, whose failure follows the score.
    let failed = navigated.err().map(|failure| format!("no relative navigation: {failure}"));
    let faults: Vec<String> = incomplete.into_iter().chain(failed).collect();
    faults.iter().for_each(|fault| output.note(format!("error: {fault}")));
    Ok(if faults.is_empty() { Answer::Yes } else { Answer::Part })
}

/// Returns the score of a run with the figures of its navigation, if there are any, under the key
/// `navigation`.
fn with_navigation(score: &str, navigation: Option<&NavigationResult>) -> Result<String, Failure> {
    let Some(navigation) = navigation else { return Ok(score.to_owned()) };
    let unwritable =
        |error: serde_json::Error| Failure::Usage(format!("the output cannot be written as JSON: {error}"));
    let mut document: serde_json::Map<String, serde_json::Value> =
        serde_json::from_str(score).map_err(unwritable)?;
    document.insert("navigation".to_owned(), serde_json::to_value(navigation).map_err(unwritable)?);
    serde_json::to_string_pretty(&document).map_err(unwritable)
}
