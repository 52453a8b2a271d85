//! Steps shared by `run` and `study replay`: run, report, show.

use files::{Failure, FileError, RunDirectory, toml_file};
use run::{AnyFactory, AnyMission, FrameJobs};

use super::Answer;
use super::interrupt::report_interruption;
use super::output::Output;
use super::report::write_beside_run;
use crate::table::score_table;

/// Options for presenting a run.
pub(super) struct Presentation<'a> {
    /// Name of the run, for the progress bar.
    pub(super) name: &'a str,
    /// True if the report is written into the directory.
    pub(super) has_report: bool,
    /// Remark below the score.
    pub(super) note: Option<String>,
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
    let table = score_table(ran.scored.as_ref(), output.is_terminal());
    let notes: String = shown.note.into_iter().map(|note| format!("\n\n{note}")).collect();
    let text = format!("{}{notes}\n\nresults in {}", table.trim_end(), directory.path().display());
    let file = directory.score();
    let json = toml_file::read_text(&file).map_err(|source| FileError::io(&file, "read", source))?;
    if shown.has_report {
        write_beside_run(directory.path(), ran.scored.as_mut(), output);
    }
    output.answer_json(json.trim_end(), text)?;
    Ok(match ran.incomplete {
        None => Answer::Yes,
        Some(incomplete) => {
            output.note(format!("error: {incomplete}"));
            Answer::Part
        }
    })
}
