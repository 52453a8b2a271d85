//! What `run` and `study replay` do alike in every world: run, report, show.

use std::path::Path;

use contract::PipelineFactory;
use files::{Failure, RunDirectory};
use run::{Flight, Prepared, PreparedDocking, Scored, World};
use scenario::is_argon;
use score::ARGON_TABLE_2;
use serde::Serialize;

use super::Answer;
use super::output::Output;
use super::report::{write_beside_far_range_run, write_beside_results};
use crate::table::{TableStyle, docking, far_range};

/// A world as the command shows it.
pub(super) trait Shown: World<Scored: Scored<Score: Serialize>> {
    /// The score as a table.
    fn table(&self, scored: &Self::Scored, output: &Output) -> String;

    /// Writes the report into the directory of a run that has just been scored.
    fn write_report(directory: &Path, scored: &mut Self::Scored, output: &Output);
}

impl Shown for Prepared {
    fn table(&self, scored: &Self::Scored, output: &Output) -> String {
        let style = TableStyle {
            styled: output.is_terminal(),
            reference: is_argon(self.scenario()).then_some(&ARGON_TABLE_2),
            ..TableStyle::default()
        };
        far_range(&scored.score, style)
    }

    fn write_report(directory: &Path, scored: &mut Self::Scored, output: &Output) {
        write_beside_far_range_run(directory, std::mem::take(&mut scored.verdicts), output);
    }
}

impl Shown for PreparedDocking {
    fn table(&self, scored: &Self::Scored, output: &Output) -> String {
        docking(&scored.score, output.is_terminal())
    }

    fn write_report(directory: &Path, _: &mut Self::Scored, output: &Output) {
        write_beside_results(directory, output);
    }
}

/// Runs a world into a directory, writes the report unless it is not wanted, and shows the score, with a `note` below.
pub(super) fn fly<W: Shown>(
    world: &W,
    flight: &Flight<W::Images>,
    factory: &dyn PipelineFactory<W::Interface>,
    directory: &RunDirectory,
    (name, has_report, note): (&str, bool, Option<String>),
    output: &Output,
) -> Result<Answer, Failure> {
    let frames = flight.frames.end - flight.frames.start;
    let progress = output.progress(frames, &format!("{name}, {}", factory.name()));
    let ran = world.run(directory, flight, factory, || {
        progress.inc(1);
        Ok(())
    });
    progress.finish_and_clear();
    let mut ran = ran?;
    output.first_failure(ran.first_failure.as_ref());
    if has_report {
        W::write_report(directory.path(), &mut ran.scored, output);
    }
    let table = world.table(&ran.scored, output);
    let notes: String = note.into_iter().map(|note| format!("\n\n{note}")).collect();
    let text = format!("{}{notes}\n\nresults in {}", table.trim_end(), directory.path().display());
    output.answer(ran.scored.score(), text)?;
    Ok(Answer::Yes)
}
