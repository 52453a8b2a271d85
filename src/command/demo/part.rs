//! One run of the demo: simulated, processed, scored and reported like any other run.

use std::path::{Path, PathBuf};

use files::{Failure, RunDirectory};
use run::pipeline_choice::PipelineChoice;
use run::{Expectation, FrameJobs, Options, ScenarioSource};

use crate::command::execute::note_unfinished_run;
use crate::command::options::PipelineOptions;
use crate::command::output::Output;
use crate::command::report::{Headings, write_beside_run};

/// A scenario, and the directory of its run inside of the demo's.
pub(super) struct Part {
    /// Name of the directory.
    pub(super) folder: &'static str,
    /// Scenario with the method of its pipeline.
    pub(super) source: ScenarioSource,
}

/// A finished run.
pub(super) struct FinishedPart {
    /// Directory of the run.
    pub(super) directory: PathBuf,
    /// Content of `score.json`.
    pub(super) score: String,
}

impl Part {
    /// Runs every frame of the scenario by its built-in pipeline, and writes results and report.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written.
    pub(super) fn run(&self, parent: &Path, jobs: usize, output: &Output) -> Result<FinishedPart, Failure> {
        let prepared = self.source.prepare(Options::default())?;
        let frames = 0..prepared.frame_count();
        let count = frames.end;
        let frame_jobs =
            FrameJobs { frames, jobs, images: None, expectation: Expectation::Dropped, states_of: None };
        let scratch = crate::command::scratch_directory()?;
        let choice: PipelineChoice = PipelineOptions::default().choice(&[]);
        let factory = prepared.factory(&choice, scratch.path())?;
        let directory = RunDirectory::create(&parent.join(self.folder))?;
        note_unfinished_run(&directory);
        let progress = output.progress(count, self.folder);
        let ran = prepared.run(&directory, &frame_jobs, &factory, &|| {
            progress.inc(1);
            Ok(())
        });
        progress.finish_and_clear();
        let mut ran = ran?;
        let score = ran.scored.json()?;
        // Without the feature, the page states once that it is missing.
        if cfg!(feature = "report") {
            write_beside_run(directory.path(), ran.scored.as_mut(), Headings::Subjects, output);
        }
        Ok(FinishedPart { directory: directory.path().to_owned(), score })
    }
}
