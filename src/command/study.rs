//! `boresight study`: Monte Carlo over variable parameters.

use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Mutex;

use clap::{Args, Subcommand};
use files::{Failure, FileError, RunDirectory};
use pipeline::external::protocol::harmless;
use run::pipeline_choice::PipelineChoice;
use run::{Expectation, FirstFailure, FrameJobs, Options};
use serde::Serialize;
use study::{
    Campaign, CaseFile, CaseOutcome, CaseResult, Plan, RequirementVerdict, ShardManifest, Study, StudyFile,
    Workers, command_line,
};

use super::Answer;
use super::execute::{Presentation, execute};
use super::interrupt::report_interruption;
use super::options::{PipelineOptions, default_jobs, output_path};
use super::output::Output;
use super::report::{Headings, write_beside_results};
use crate::command::cluster::{Engine, check_dask, run_on_dask};
use crate::table::{LiveFigure, study_table};

#[derive(Debug, Subcommand)]
pub(super) enum StudyCommand {
    /// Run the missing cases of a study, and summarise it; with --shard, one part of it
    Run(RunArguments),
    /// Print how a study is divided into shards, and the command of each
    Plan(PlanArguments),
    /// Merge the shards of a study and summarise it; none may be missing
    Merge(MergeArguments),
    /// Run one case again and keep its run directory, frames included
    Replay(ReplayArguments),
    /// Check a study and its scenario
    Check(CheckArguments),
    /// Print the JSON Schema of study files
    Schema,
}

#[derive(Debug, Args)]
pub(super) struct RunArguments {
    /// A TOML file (docs/studies.md)
    study: PathBuf,
    /// Directory of the results; an unfinished directory of the same study is continued
    #[arg(short, long, value_name = "DIR", value_parser = output_path())]
    out: PathBuf,
    /// One shard of N, `I/N` with I from 1
    #[arg(long, value_name = "I/N")]
    shard: Option<ShardSelection>,
    /// Number of shards; default: one per 32 cases, at most 1000
    #[arg(long, value_name = "N", conflicts_with = "shard")]
    shards: Option<u64>,
    /// Executor of the shards: `local`, this process; `dask`, a Dask cluster on this machine; or
    /// `dask=ADDRESS` of a scheduler
    #[arg(long, value_name = "ENGINE", default_value = "local", conflicts_with = "shard")]
    engine: Engine,
    /// Threads, or workers of a cluster on this machine; default: all cores. The results do not depend on
    /// their number
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Write no report.html
    #[arg(long)]
    no_report: bool,
    #[command(flatten)]
    pipeline: PipelineOptions,
}

#[derive(Debug, Args)]
pub(super) struct PlanArguments {
    /// A TOML file (docs/studies.md)
    study: PathBuf,
    /// Number of shards; default: one per 32 cases, at most 1000
    #[arg(long, value_name = "N")]
    shards: Option<u64>,
    #[command(flatten)]
    pipeline: PipelineOptions,
}

#[derive(Debug, Args)]
pub(super) struct MergeArguments {
    /// File of the study
    study: PathBuf,
    /// Directory of the shards
    #[arg(short, long, value_name = "DIR", value_parser = output_path())]
    out: PathBuf,
    /// Write no report.html
    #[arg(long)]
    no_report: bool,
    #[command(flatten)]
    pipeline: PipelineOptions,
}

#[derive(Debug, Args)]
pub(super) struct ReplayArguments {
    /// File of the study
    study: PathBuf,
    /// Number of the case
    #[arg(long, value_name = "K")]
    case: u64,
    /// Reject a study whose hash differs or does not begin with these digits: its files, values or pipeline
    /// are not those of the rows
    #[arg(long, value_name = "HEX")]
    hash: Option<String>,
    /// A new or empty directory for the run; default: the next free `runs/STUDY-case-K-001`
    #[arg(short, long, value_name = "DIR", value_parser = output_path())]
    out: Option<PathBuf>,
    /// Also keep the images: fits, png or exr; docking: png, avi, mjpeg (AVI) or y4m
    #[arg(long, value_name = "FORMAT")]
    save_frames: Option<String>,
    /// Write no report.html
    #[arg(long)]
    no_report: bool,
    #[command(flatten)]
    pipeline: PipelineOptions,
}

#[derive(Debug, Args)]
pub(super) struct CheckArguments {
    /// A TOML file (docs/studies.md)
    study: PathBuf,
    #[command(flatten)]
    pipeline: PipelineOptions,
}

/// One shard of a given number of shards.
#[derive(Debug, Clone, Copy)]
struct ShardSelection {
    shard: u64,
    of: u64,
}

impl FromStr for ShardSelection {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text.split_once('/').and_then(|(shard, of)| {
            Some(Self { shard: shard.trim().parse().ok()?, of: of.trim().parse().ok()? })
        });
        parsed
            .filter(|parsed| (1..=parsed.of).contains(&parsed.shard))
            .ok_or_else(|| format!("shard is `{text}`, expected I/N with I from 1 to N, as in 3/20"))
    }
}

pub(super) fn study(command: &StudyCommand, output: &Output) -> Result<Answer, Failure> {
    match command {
        StudyCommand::Run(arguments) => {
            let answer = run(arguments, output)?;
            if arguments.shard.is_none() && !arguments.no_report {
                write_beside_results(&arguments.out, output);
            }
            Ok(answer)
        }
        StudyCommand::Plan(arguments) => plan(arguments, output),
        StudyCommand::Merge(arguments) => {
            let answer = merge(arguments, output)?;
            if !arguments.no_report {
                write_beside_results(&arguments.out, output);
            }
            Ok(answer)
        }
        StudyCommand::Replay(arguments) => replay(arguments, output),
        StudyCommand::Check(arguments) => check(arguments, output),
        StudyCommand::Schema => {
            let schema = schemars::schema_for!(StudyFile);
            let text = serde_json::to_string_pretty(&schema).unwrap_or_default();
            output.answer(&schema, text)?;
            Ok(Answer::Yes)
        }
    }
}

fn run(arguments: &RunArguments, output: &Output) -> Result<Answer, Failure> {
    let study = Study::read(&arguments.study)?;
    let choice = arguments.pipeline.choice(&[&study.scenario_file(), &arguments.study, &arguments.out]);
    if arguments.shard.is_some() && study.file.stop.until.is_some() {
        return Err(Failure::Usage(format!(
            "--shard applies only to a study with a fixed number of cases: `{}` stops by a figure \
             (stop.until), which one shard cannot determine",
            study.name
        )));
    }
    if let Engine::Dask(_) = &arguments.engine {
        refuse_until(&study)?;
        check_dask()?;
    }
    check_pipeline(&choice, &study)?;
    let shards = arguments.shard.map(|shard| shard.of).or(arguments.shards);
    let campaign = Campaign::open(&study, &choice, &arguments.out, shards)?;
    let jobs = arguments.jobs.map_or_else(default_jobs, usize::from);
    let plan = campaign.store().plan();
    if let Engine::Dask(address) = &arguments.engine {
        let planned = planned(&study, plan, &arguments.study, &choice)?;
        let progress = output.progress_of(plan.cases, "cases", &study.name);
        let done = |shard: u64| {
            let cases = plan.cases_of(shard);
            progress.inc(cases.end - cases.start);
        };
        let ran = run_on_dask(&to_json(&planned)?, &arguments.out, address.as_deref(), jobs, done);
        progress.finish_and_clear();
        ran?;
        return finish(&campaign, &arguments.study, &campaign.merge()?, output);
    }
    let store = campaign.store().clone();
    report_interruption(move || {
        let (finished, plan, folder) = (store.finished_cases(), store.plan(), store.folder().display());
        format!(
            "{finished} of {} cases are stored in {folder}; the same command continues from there",
            plan.cases
        )
    });
    let cases = arguments.shard.map_or(0..plan.cases, |shard| plan.cases_of(shard.shard));
    let progress = output.progress_of(cases.end - cases.start, "cases", &study.name);
    let until = study.file.stop.until.as_ref().map(|until| until.figure.clone());
    let live = Mutex::new(LiveFigure::new(&study, until.unwrap_or_else(|| study.worst_by())));
    let failure = Mutex::new(None);
    let done = |case: CaseOutcome<'_>| {
        progress.inc(1);
        if let Some(text) = lock(&live).add(case.row()) {
            progress.set_message(harmless(&format!("{}, {text}", study.name)));
        }
        if let CaseOutcome::Run(CaseResult { row, first_failure: Some(first), .. }) = case {
            let mut known = lock(&failure);
            if known.as_ref().is_none_or(|(case, _)| row.case < *case) {
                *known = Some((row.case, first.clone()));
            }
        }
    };
    let scratch = super::scratch_directory()?;
    let workers = Workers { jobs, scratch: scratch.path(), ended: None };
    let answer = match arguments.shard {
        Some(shard) => {
            let made = campaign.shard(shard.shard, workers, done);
            progress.finish_and_clear();
            shard_made(&campaign, &made?.1, output)?;
            Answer::Yes
        }
        None => {
            let cases = campaign.run(workers, done);
            progress.finish_and_clear();
            finish(&campaign, &arguments.study, &cases?, output)?
        }
    };
    if let Some((case, FirstFailure { frame, reason })) = lock(&failure).as_ref() {
        output.note(format!("the pipeline failed, first in case {case} at frame {frame}: {reason}"));
    }
    Ok(answer)
}

fn to_json(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string(value)
        .map_err(|error| Failure::Usage(format!("the plan cannot be written as JSON: {error}")))
}

/// Locks a value, even if a thread panicked while holding the lock: the value cannot be half written.
fn lock<T>(known: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    known.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

fn shard_made(campaign: &Campaign<'_>, manifest: &ShardManifest, output: &Output) -> Result<(), Failure> {
    let text = format!(
        "shard {} of {}: cases {} to {} in {}",
        manifest.shard,
        manifest.of,
        manifest.first_case,
        manifest.first_case + manifest.rows - 1,
        campaign.store().path(manifest.shard).display()
    );
    output.answer(manifest, text)
}

fn finish(
    campaign: &Campaign<'_>,
    path: &Path,
    cases: &CaseFile,
    output: &Output,
) -> Result<Answer, Failure> {
    let summary = campaign.finish(path, cases)?;
    let text = study_table(&summary, output.is_terminal());
    let folder = campaign.store().folder().display();
    output.answer(&summary, format!("{text}\nrows and summary in {folder}: cases.parquet, summary.json"))?;
    Ok(match summary.verdict() {
        None | Some(RequirementVerdict::Met) => Answer::Yes,
        Some(RequirementVerdict::NotMet | RequirementVerdict::NotDecided) => Answer::No,
    })
}

/// Plan of a study, with the command of each shard.
#[derive(Serialize)]
struct PlanDocument {
    #[serde(flatten)]
    plan: Plan,
    pieces: Vec<ShardDocument>,
    /// Directory to which relative paths in the commands refer.
    directory: PathBuf,
    /// Absolute paths of the files that the commands read: the study, its scenario, the files that cases
    /// read, and files among the words of a program's command.
    files: Vec<PathBuf>,
}

#[derive(Serialize)]
struct ShardDocument {
    shard: u64,
    first_case: u64,
    cases: u64,
    /// Words of the command, without the program and `--out DIR`.
    arguments: Vec<String>,
}

fn plan(arguments: &PlanArguments, output: &Output) -> Result<Answer, Failure> {
    let study = Study::read(&arguments.study)?;
    refuse_until(&study)?;
    let choice = arguments.pipeline.choice(&[]);
    check_pipeline(&choice, &study)?;
    let plan = Plan::new(&study, study.hash_with(&choice), arguments.shards)?;
    let planned = planned(&study, &plan, &arguments.study, &choice)?;
    let command = |verb: &str| {
        let mut words = ["boresight", "study", verb].map(str::to_owned).to_vec();
        words.push(arguments.study.display().to_string());
        words.extend(choice.arguments(study.scenario().world().code()));
        command_line(&words)
    };
    let text = format!(
        "{}: {} cases in {shards} shards of about {}\n{} --out DIR --shard I/{shards}, for I from 1 to {shards}\n{} --out DIR",
        study.name,
        plan.cases,
        plan.cases.div_ceil(plan.shards),
        command("run"),
        command("merge"),
        shards = plan.shards,
    );
    output.answer(&planned, text)?;
    Ok(Answer::Yes)
}

/// Rejects a study whose end cannot be determined from a single shard.
fn refuse_until(study: &Study) -> Result<(), Failure> {
    match study.file.stop.until {
        None => Ok(()),
        Some(_) => Err(Failure::Usage(format!(
            "`{}` stops by a figure (stop.until), expected a study with a fixed number of cases: one shard \
             cannot determine the figure",
            study.name
        ))),
    }
}

/// Rejects a pipeline that is not available for the study's scenario, or that cannot run on its cameras.
fn check_pipeline(choice: &PipelineChoice, study: &Study) -> Result<(), Failure> {
    let (scenario, world) = (study.scenario(), study.scenario().world());
    world.check_choice(scenario, choice)?;
    if choice.is_built_in(world.code()) {
        study.check_built_in_pipeline()?;
    }
    Ok(())
}

fn planned(
    study: &Study,
    plan: &Plan,
    path: &Path,
    choice: &PipelineChoice,
) -> Result<PlanDocument, Failure> {
    let path =
        std::path::absolute(path).map_err(|error| Failure::Usage(format!("{}: {error}", path.display())))?;
    let piece = |shard: u64| {
        let cases = plan.cases_of(shard);
        let mut arguments = ["study", "run"].map(str::to_owned).to_vec();
        arguments.extend([
            path.display().to_string(),
            "--shard".to_owned(),
            format!("{shard}/{}", plan.shards),
        ]);
        arguments.extend(choice.arguments(study.scenario().world().code()));
        ShardDocument { shard, first_case: cases.start, cases: cases.end - cases.start, arguments }
    };
    let absolute =
        |file: &Path| std::path::absolute(file).map_err(|error| FileError::io(file, "find", error));
    let program = choice.files(study.scenario().world().code());
    let mut files: Vec<PathBuf> =
        study.files_read().iter().chain(&program).map(|file| absolute(file)).collect::<Result<_, _>>()?;
    files.sort();
    files.dedup();
    Ok(PlanDocument {
        pieces: (1..=plan.shards).map(piece).collect(),
        plan: plan.clone(),
        directory: absolute(Path::new("."))?,
        files,
    })
}

fn merge(arguments: &MergeArguments, output: &Output) -> Result<Answer, Failure> {
    let study = Study::read(&arguments.study)?;
    let choice = arguments.pipeline.choice(&[]);
    let campaign = Campaign::reopen(&study, &choice, &arguments.out)?;
    finish(&campaign, &arguments.study, &campaign.merge()?, output)
}

fn replay(arguments: &ReplayArguments, output: &Output) -> Result<Answer, Failure> {
    let study = Study::read(&arguments.study)?;
    if arguments.case >= study.cases() {
        return Err(Failure::Usage(format!(
            "--case is {}, expected a case of the study, which has {} (0 to {})",
            arguments.case,
            study.cases(),
            study.cases() - 1
        )));
    }
    let runs = Path::new(super::run::RUNS);
    let out = arguments.out.as_deref().unwrap_or(runs);
    let choice = arguments.pipeline.choice(&[&study.scenario_file(), &arguments.study, runs, out]);
    let hash = study.hash_with(&choice);
    if let Some(expected) = arguments.hash.as_ref().filter(|expected| !hash.starts_with(*expected)) {
        return Err(Failure::Usage(format!(
            "--hash is {expected}, but the hash of the study is {hash}: the case would differ from its row, \
             because the study, a file that it reads, the pipeline or Boresight was changed"
        )));
    }
    let case = study.case(arguments.case)?;
    if let Some(word) = &arguments.save_frames {
        let checked = case.source.world().check_images(word);
        checked.map_err(|error| Failure::Usage(format!("--save-frames: {error}")))?;
    }
    let scratch = super::scratch_directory()?;
    let name = format!("{}-case-{}", study.name, case.number);
    let prepared = case.source.prepare(Options::default())?;
    let factory = prepared.factory(&choice, scratch.path())?;
    let frame_jobs = FrameJobs {
        frames: study.frames(prepared.frame_count())?,
        jobs: default_jobs(),
        images: arguments.save_frames.clone(),
        expectation: Expectation::Dropped,
        states_of: None,
    };
    prepared.check_frame_jobs(&frame_jobs)?;
    let directory = match &arguments.out {
        Some(path) => RunDirectory::create(path)?,
        None => RunDirectory::create_numbered(Path::new(super::run::RUNS), &name)?,
    };
    let shown = Presentation {
        name: &name,
        report: (!arguments.no_report).then_some(Headings::Subjects),
        note: None,
        navigate: None,
    };
    execute(prepared.as_ref(), &frame_jobs, &factory, &directory, shown, output)
}

fn check(arguments: &CheckArguments, output: &Output) -> Result<Answer, Failure> {
    let study = Study::read(&arguments.study)?;
    let choice = arguments.pipeline.choice(&[]);
    check_pipeline(&choice, &study)?;
    let extremes = study.extremes();
    let progress = output.progress_of(extremes.len() as u64, "cases", &study.name);
    for case in &extremes {
        study.case(*case)?.source.prepare(Options::default())?;
        progress.inc(1);
    }
    progress.finish_and_clear();
    check_answer(&choice, &study)?;
    let document = serde_json::json!({
        "study": study.name, "title": study.file.title, "cases": study.cases(), "hash": study.hash(),
        "parameters": study.drawn_columns().keys().collect::<Vec<_>>(), "figures": study.figures(), "checked_cases": extremes,
    });
    let text = format!(
        "{}: {} cases of {} parameters, {} figures; {} cases at the limits of the design can be run",
        study.name,
        study.cases(),
        study.drawn_columns().len(),
        study.figures().len(),
        extremes.len()
    );
    output.answer(&document, text)?;
    Ok(Answer::Yes)
}

/// Requests a program's outcome for the first frame of the first case; rejects a program that is missing or
/// does not implement the protocol.
fn check_answer(choice: &PipelineChoice, study: &Study) -> Result<(), Failure> {
    if choice.is_built_in(study.scenario().world().code()) {
        return Ok(());
    }
    let scratch = super::scratch_directory()?;
    let prepared = study.case(0)?.source.prepare(Options::default())?;
    let factory = prepared.factory(choice, scratch.path())?;
    let first = study.frames(prepared.frame_count())?.start;
    match prepared.score(first..first + 1, &factory)?.first_failure {
        None => Ok(()),
        Some(FirstFailure { frame, reason }) => {
            Err(Failure::Usage(format!("the pipeline failed at frame {frame} of case 0: {reason}")))
        }
    }
}
