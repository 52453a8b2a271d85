//! Runs of an error budget: the frames of a run are run again, once per stage, with the truth instead of the
//! stage's result.
use std::path::{Path, PathBuf};

use config::toml_file;
use files::{AtomicFile, Failure, FileError, ReplaceableFile, RunDirectory};
use report::{BudgetPlan, budget_of};
use run::pipeline_choice::PipelineChoice;
use run::{Expectation, FrameJobs, Options, ScenarioSource};
use scenario::Stage;

use crate::command::interrupt::clean_up_when_interrupted;
use crate::command::options::default_jobs;
use crate::command::output::Output;
use crate::command::scratch_directory::ScratchDirectory;

/// Runs the missing stages of the error budget of a run, and returns the directories. Of each stage,
/// `run.toml` and `score.json` are kept in `budget/STAGE`: the frames are those of the run, whose truth is
/// already stored.
pub(super) fn run_budget(directory: &Path, output: &Output) -> Result<Vec<PathBuf>, Failure> {
    let BudgetPlan { frames, stages } = (budget_of(directory)?.plan)(directory)?;
    let source = ScenarioSource::read(&directory.join("run.toml").to_string_lossy())?;
    let mut kept = Vec::new();
    for stage in stages {
        let folder = directory.join("budget").join(stage.to_string());
        if !folder.join("score.json").is_file() {
            run_stage(&source, stage, frames.clone(), &folder, output)?;
        }
        kept.push(folder);
    }
    Ok(kept)
}

fn run_stage(
    source: &ScenarioSource,
    stage: Stage,
    frames: std::ops::Range<u64>,
    folder: &Path,
    output: &Output,
) -> Result<(), Failure> {
    let create =
        |path: &Path, source| Failure::from(FileError::Io { path: path.to_owned(), doing: "create", source });
    std::fs::create_dir_all(folder).map_err(|error| create(folder, error))?;
    // Created beside the results that are kept: the truth of a long run may exceed the capacity of a
    // directory for temporary files.
    clean_up_when_interrupted();
    let scratch = ScratchDirectory::create(folder)?;
    let prepared = source.prepare(Options { inject: Some(stage), ..Options::default() })?;
    let choice = PipelineChoice { word: None, timeout_s: 0.0, memory_mb: 0, sandbox: None };
    let factory = prepared.factory(&choice, scratch.path())?;
    let run = RunDirectory::create(&scratch.path().join("run"))?;
    let progress = output.progress(frames.end - frames.start, &format!("{}, true {stage}", source.name));
    let frame_jobs = FrameJobs {
        frames,
        jobs: default_jobs(),
        images: None,
        expectation: Expectation::Dropped,
        states_of: None,
    };
    let ran = prepared.run(&run, &frame_jobs, &factory, &|| {
        progress.inc(1);
        Ok(())
    });
    progress.finish_and_clear();
    output.first_failure(ran?.first_failure.as_ref());
    // The score is written last: if it exists, the stage is complete.
    for name in ["run.toml", "score.json"] {
        let path = run.path().join(name);
        let text = toml_file::read_text(&path).map_err(|source| FileError::Io {
            path: path.clone(),
            doing: "read",
            source,
        })?;
        // From a stage that was not completed.
        let earlier = ReplaceableFile {
            description: "a file of an earlier budget run",
            matches: &|beginning| beginning.starts_with(b"name = "),
        };
        AtomicFile::with_text(&folder.join(name), &text)?.replace(earlier)?;
    }
    Ok(())
}
