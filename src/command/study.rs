//! `boresight study`: Monte Carlo over what can vary.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use clap::{Args, Subcommand};
use serde::Serialize;

use super::Answer;
use super::options::{PipelineOptions, default_jobs, format_of};
use super::output::Output;
use crate::docking_renderer::DockingRenderer;
use crate::docking_run::{DockingFlight, PreparedDocking};
use crate::docking_table::docking;
use crate::docking_writer::FieldImages;
use crate::failure::Failure;
use crate::files::RunDirectory;
use crate::pipeline_choice::PipelineChoice;
use crate::run::{Expectation, Flight, Prepared};
use crate::scenario::Scenario;
use crate::study::{
    CaseRow, CaseTable, Plan, ShardManifest, ShardStore, Study, StudyFile, StudyRecord, Summary,
    is_narrow_enough, run_cases,
};
use crate::study_engine::{Engine, run_on_dask};
use crate::study_table::{live, study_table};
use crate::table::{TableStyle, far_range};

#[derive(Debug, Subcommand)]
pub(super) enum StudyCommand {
    /// Run what is missing of a study, and sum it up; with --shard, one piece of it
    Run(RunArguments),
    /// Say how a study is cut into shards, and the command of each
    Plan(PlanArguments),
    /// Put the shards of a study together and sum it up; none may be missing
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
    /// Directory of the results; one that holds a part of the same study is gone on with
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    /// One shard of so many, `I/N` with I from 1
    #[arg(long, value_name = "I/N")]
    shard: Option<ShardOf>,
    /// Number of shards; default: one for 32 cases, at most 1000
    #[arg(long, value_name = "N", conflicts_with = "shard")]
    shards: Option<u64>,
    /// Who runs the shards: `local`, this process; `dask`, a Dask cluster on this machine; or `dask=ADDRESS` of a scheduler
    #[arg(long, value_name = "ENGINE", default_value = "local", conflicts_with = "shard")]
    engine: Engine,
    /// Threads, or workers of a cluster on this machine; default: all cores. The results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    #[command(flatten)]
    pipeline: PipelineOptions,
}

#[derive(Debug, Args)]
pub(super) struct PlanArguments {
    /// A TOML file (docs/studies.md)
    study: PathBuf,
    /// Number of shards; default: one for 32 cases, at most 1000
    #[arg(long, value_name = "N")]
    shards: Option<u64>,
    #[command(flatten)]
    pipeline: PipelineOptions,
}

#[derive(Debug, Args)]
pub(super) struct MergeArguments {
    /// The study's file
    study: PathBuf,
    /// Directory of the shards
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    pipeline: PipelineOptions,
}

#[derive(Debug, Args)]
pub(super) struct ReplayArguments {
    /// The study's file
    study: PathBuf,
    /// Number of the case
    #[arg(long, value_name = "K")]
    case: u64,
    /// A new or empty directory for the run; default: the next free `runs/STUDY-case-K-001`
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Keep the images as well: fits, png or exr; docking: png, avi, mjpeg (AVI) or y4m
    #[arg(long, value_name = "FORMAT")]
    save_frames: Option<String>,
    #[command(flatten)]
    pipeline: PipelineOptions,
}

#[derive(Debug, Args)]
pub(super) struct CheckArguments {
    /// A TOML file (docs/studies.md)
    study: PathBuf,
}

/// A shard of so many.
#[derive(Debug, Clone, Copy)]
struct ShardOf {
    shard: u64,
    of: u64,
}

impl std::str::FromStr for ShardOf {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text.split_once('/').and_then(|(shard, of)| {
            Some(Self { shard: shard.trim().parse().ok()?, of: of.trim().parse().ok()? })
        });
        parsed
            .filter(|parsed| (1..=parsed.of).contains(&parsed.shard))
            .ok_or_else(|| format!("`{text}` is no shard; expected I/N with I from 1 to N, as in 3/20"))
    }
}

pub(super) fn study(command: &StudyCommand, output: &Output) -> Result<Answer, Failure> {
    match command {
        StudyCommand::Run(arguments) => run(arguments, output),
        StudyCommand::Plan(arguments) => plan(arguments, output),
        StudyCommand::Merge(arguments) => merge(arguments, output),
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
    let choice = arguments.pipeline.choice();
    let hash = study.hash_with(&choice);
    let shards = match arguments.shard {
        Some(shard) => Some(shard.of),
        None => arguments.shards.or_else(|| ShardStore::planned_shards(&arguments.out)),
    };
    if arguments.shard.is_some() && study.file.stop.until.is_some() {
        return Err(Failure::Usage(format!(
            "--shard is given, expected with a study of a fixed number of cases: `{}` stops by a figure (stop.until), which no shard \
             knows alone",
            study.name
        )));
    }
    let store = ShardStore::open(&arguments.out, Plan::new(&study, hash.clone(), shards)?)?;
    let jobs = arguments.jobs.map_or_else(default_jobs, usize::from);
    let empty = study.table();
    if let Engine::Dask(address) = &arguments.engine {
        let planned = planned(&study, store.plan(), &arguments.study, &choice)?;
        let progress = output.progress_of(store.plan().cases, "cases", &study.name);
        let done = |shard: u64| {
            let cases = store.plan().cases_of(shard);
            progress.inc(cases.end - cases.start);
        };
        let ran = run_on_dask(&to_json(&planned)?, &arguments.out, address.as_deref(), jobs, done);
        progress.finish_and_clear();
        ran?;
        return merged(&study, &store, &hash, &arguments.study, output);
    }
    let scratch = super::scratch_directory()?;
    let todo: Vec<u64> = match arguments.shard {
        Some(shard) => vec![shard.shard],
        None => (1..=store.plan().shards).collect(),
    };
    let cases: u64 = todo.iter().map(|shard| store.plan().cases_of(*shard)).map(|r| r.end - r.start).sum();
    let progress = output.progress_of(cases, "cases", &study.name);

    let figure =
        study.file.stop.until.as_ref().map_or_else(|| study.worst_by(), |until| until.figure.clone());
    let known = Mutex::new(empty.clone());
    let mut manifests = Vec::new();
    for shard in todo {
        let made = match store.read(shard, &empty) {
            Some((table, manifest)) => {
                progress.inc(table.rows.len() as u64);
                lock(&known).rows.extend(table.rows);
                manifest
            }
            None => {
                store.clear(shard)?;
                let done = |row: &CaseRow| {
                    progress.inc(1);
                    let mut known = lock(&known);
                    known.rows.push(row.clone());
                    progress.set_message(format!(
                        "{}, {}",
                        study.name,
                        live(&known, &figure, study.file.seed)
                    ));
                };
                let cases = store.plan().cases_of(shard);
                let rows = run_cases(&study, cases, &choice, jobs, scratch.path(), done)?;
                store.write(shard, &empty.with_rows(rows))?
            }
        };
        manifests.push(made);
        let mut known = lock(&known);
        known.rows.sort_by_key(|row| row.case);
        if is_narrow_enough(&study, &known) {
            break;
        }
    }
    progress.finish_and_clear();
    if arguments.shard.is_some() {
        return shard_made(&store, &manifests, output);
    }
    let table = known.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    finish(&study, &store, &hash, &arguments.study, &table, output)
}

fn to_json(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string(value)
        .map_err(|error| Failure::Usage(format!("the plan cannot be written as JSON: {error}")))
}

/// A thread that panicked while it held the rows cannot have left half a row in them.
fn lock(table: &Mutex<CaseTable>) -> std::sync::MutexGuard<'_, CaseTable> {
    table.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

fn shard_made(store: &ShardStore, manifests: &[ShardManifest], output: &Output) -> Result<Answer, Failure> {
    for manifest in manifests {
        let path = store.path(manifest.shard);
        let text = format!(
            "shard {} of {}: cases {} to {} in {}",
            manifest.shard,
            manifest.of,
            manifest.first_case,
            manifest.first_case + manifest.rows - 1,
            path.display()
        );
        output.answer(manifest, text)?;
    }
    Ok(Answer::Yes)
}

fn finish(
    study: &Study,
    store: &ShardStore,
    hash: &str,
    path: &Path,
    table: &CaseTable,
    output: &Output,
) -> Result<Answer, Failure> {
    let summary = Summary::new(study, hash, &path.display().to_string(), table);
    store.write_record(&StudyRecord::new(study)?)?;
    let cases = store.write_cases(table)?;
    let written = store.write_summary(&summary)?;
    let text = study_table(&summary, output.is_terminal());
    output
        .answer(&summary, format!("{text}\nrows in {}, summary in {}", cases.display(), written.display()))?;
    Ok(Answer::Yes)
}

/// The plan of a study, with what makes each shard.
#[derive(Serialize)]
struct Planned {
    #[serde(flatten)]
    plan: Plan,
    pieces: Vec<Piece>,
}

#[derive(Serialize)]
struct Piece {
    shard: u64,
    first_case: u64,
    cases: u64,
    /// Words of the command, without the program and `--out DIR`.
    arguments: Vec<String>,
}

fn plan(arguments: &PlanArguments, output: &Output) -> Result<Answer, Failure> {
    let study = Study::read(&arguments.study)?;
    let choice = arguments.pipeline.choice();
    let plan = Plan::new(&study, study.hash_with(&choice), arguments.shards)?;
    let planned = planned(&study, &plan, &arguments.study, &choice)?;
    let path = arguments.study.display();
    let text = format!(
        "{}: {} cases in {shards} shards of about {}\nboresight study run {path} --out DIR --shard I/{shards}, for I from 1 to {shards}\n\
         boresight study merge {path} --out DIR",
        study.name,
        plan.cases,
        plan.cases.div_ceil(plan.shards),
        shards = plan.shards,
    );
    output.answer(&planned, text)?;
    Ok(Answer::Yes)
}

fn planned(study: &Study, plan: &Plan, path: &Path, choice: &PipelineChoice) -> Result<Planned, Failure> {
    if study.file.stop.until.is_some() {
        return Err(Failure::Usage(format!(
            "`{}` stops by a figure (stop.until), expected a study of a fixed number of cases: no shard knows the figure alone",
            study.name
        )));
    }
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let piece = |shard: u64| {
        let cases = plan.cases_of(shard);
        let mut arguments = ["study", "run"].map(str::to_owned).to_vec();
        arguments.extend([
            path.display().to_string(),
            "--shard".to_owned(),
            format!("{shard}/{}", plan.shards),
        ]);
        if let Some(word) = &choice.word {
            let timeout = choice.timeout_s.to_string();
            arguments.extend(["--pipeline", word, "--timeout-s", &timeout].map(str::to_owned));
        }
        Piece { shard, first_case: cases.start, cases: cases.end - cases.start, arguments }
    };
    Ok(Planned { pieces: (1..=plan.shards).map(piece).collect(), plan: plan.clone() })
}

fn merge(arguments: &MergeArguments, output: &Output) -> Result<Answer, Failure> {
    let study = Study::read(&arguments.study)?;
    let hash = study.hash_with(&arguments.pipeline.choice());
    let Some(shards) = ShardStore::planned_shards(&arguments.out) else {
        return Err(Failure::Usage(format!(
            "{}: there is no plan.json that can be read, expected the directory of a study's shards",
            arguments.out.display()
        )));
    };
    let store = ShardStore::open(&arguments.out, Plan::new(&study, hash.clone(), Some(shards))?)?;
    merged(&study, &store, &hash, &arguments.study, output)
}

/// Puts the shards together; none may be missing, none be another study's.
fn merged(
    study: &Study,
    store: &ShardStore,
    hash: &str,
    path: &Path,
    output: &Output,
) -> Result<Answer, Failure> {
    store.check_foreign()?;
    let empty = study.table();
    let mut table = empty.clone();
    let mut missing = Vec::new();
    for shard in 1..=store.plan().shards {
        match store.read(shard, &empty) {
            Some((rows, _)) => table.rows.extend(rows.rows),
            None => missing.push(shard.to_string()),
        }
    }
    if !missing.is_empty() {
        return Err(Failure::Usage(format!(
            "shards {} of {} are missing or were damaged; `boresight study run` makes them",
            missing.join(", "),
            store.plan().shards
        )));
    }
    finish(study, store, hash, path, &table, output)
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
    let case = study.case(arguments.case)?;
    let scratch = super::scratch_directory()?;
    let choice = arguments.pipeline.choice();
    let name = format!("{}-case-{}", study.name, case.number);
    let directory = || match &arguments.out {
        Some(path) => RunDirectory::create(path),
        None => RunDirectory::create_numbered(Path::new(super::run::RUNS), &name),
    };
    let jobs = default_jobs();
    match &case.source.scenario {
        Scenario::FarRange(_) => {
            let prepared = Prepared::new(&case.source)?;
            let flight = Flight {
                frames: study.frames(prepared.frame_count())?,
                jobs,
                images: format_of("--save-frames", arguments.save_frames.as_deref())?,
                expectation: Expectation::Dropped,
            };
            let factory = choice.factory(&prepared.scenario().far_range, scratch.path())?;
            let directory = directory()?;
            let ran = prepared.run(&directory, &flight, factory.as_ref(), || ())?;
            output.first_failure(ran.first_failure.as_ref());
            let style = TableStyle { styled: output.is_terminal(), ..TableStyle::default() };
            let text = far_range(&ran.scored.score, style);
            output.answer(&ran.scored.score, format!("{text}\nresults in {}", directory.path().display()))?;
        }
        Scenario::Docking(_) => {
            let prepared = PreparedDocking::new(&case.source, DockingRenderer::Fast)?;
            let images: Option<FieldImages> = format_of("--save-frames", arguments.save_frames.as_deref())?;
            let fields = study.frames(prepared.field_count())?;
            let factory = choice.docking_factory(&prepared.scenario().docking, scratch.path())?;
            let directory = directory()?;
            let flight = DockingFlight { fields, jobs, images };
            let ran = prepared.run(&directory, &flight, factory.as_ref(), || ())?;
            output.first_failure(ran.first_failure.as_ref());
            let text = docking(&ran.score, output.is_terminal());
            output.answer(&ran.score, format!("{text}\nresults in {}", directory.path().display()))?;
        }
    }
    Ok(Answer::Yes)
}

fn check(arguments: &CheckArguments, output: &Output) -> Result<Answer, Failure> {
    let study = Study::read(&arguments.study)?;
    let document = serde_json::json!({
        "study": study.name, "title": study.file.title, "cases": study.cases(), "hash": study.hash(),
        "parameters": study.drawn_columns().keys().collect::<Vec<_>>(), "figures": study.figures(),
    });
    let text = format!(
        "{}: {} cases of {} parameters, {} figures",
        study.name,
        study.cases(),
        study.drawn_columns().len(),
        study.figures().len()
    );
    output.answer(&document, text)?;
    Ok(Answer::Yes)
}
