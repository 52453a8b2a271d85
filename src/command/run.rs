//! `boresight run`: simulate, process, score.

use std::path::{Path, PathBuf};

use clap::Args;
use files::{Failure, RunDirectory};
use run::docking_run::{DockingFlight, PreparedDocking};
use run::docking_writer::FieldImages;
use run::{Expectation, Flight, Prepared};
use scenario::{Scenario, ScenarioSource, Stage, World, is_argon};
use score::ARGON_TABLE_2;

use super::Answer;
use super::dataset::check_size;
use super::options::{PipelineOptions, RendererOptions, Selection, format_of};
use super::output::Output;
use super::report::{write_beside_far_range_run, write_beside_results};
use crate::table::docking;
use crate::table::{TableStyle, far_range};

/// Where numbered run directories go when `--out` is not given.
pub(super) const RUNS: &str = "runs";

#[derive(Debug, Args)]
pub(super) struct RunArguments {
    #[command(flatten)]
    selection: Selection,
    /// A new or empty directory for the results; default: the next free `runs/SCENARIO-001`
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    pipeline: PipelineOptions,
    /// Give the built-in pipeline the truth in the place of this stage's result, to see what the stage costs
    #[arg(long, value_name = "STAGE")]
    inject: Option<Stage>,
    /// Keep the images as well: fits, png or exr (about 1 MB a frame); docking: png, avi, mjpeg (AVI) or y4m
    #[arg(long, value_name = "FORMAT")]
    save_frames: Option<String>,
    /// Write no report.html
    #[arg(long)]
    no_report: bool,
    #[command(flatten)]
    renderer: RendererOptions,
}

impl RunArguments {
    /// What the bare command means: `run argon`.
    pub(super) fn argon() -> Self {
        Self {
            selection: Selection::of("argon"),
            out: None,
            pipeline: PipelineOptions::default(),
            inject: None,
            save_frames: None,
            no_report: false,
            renderer: RendererOptions::default(),
        }
    }
}

pub(super) fn run(arguments: &RunArguments, output: &Output) -> Result<Answer, Failure> {
    let source = arguments.selection.scenario()?;
    match source.scenario {
        Scenario::FarRange(_) => run_far_range(arguments, &source, output),
        Scenario::Docking(_) => run_docking(arguments, &source, output),
    }
}

fn run_far_range(
    arguments: &RunArguments,
    source: &ScenarioSource,
    output: &Output,
) -> Result<Answer, Failure> {
    arguments.renderer.check_far_range()?;
    if let Some(stage) = arguments.inject
        && !arguments.pipeline.choice().is_built_in(World::FarRange)
    {
        return Err(Failure::Usage(format!(
            "--inject is {stage}, expected with the built-in pipeline `far_range` alone: another one has no place to put the \
             truth in"
        )));
    }
    let prepared = Prepared::with_truth_for(source, arguments.inject)?;
    let flight = Flight {
        frames: arguments.selection.frames(prepared.frame_count())?,
        jobs: arguments.selection.jobs(),
        images: format_of("--save-frames", arguments.save_frames.as_deref())?,
        expectation: Expectation::Dropped,
    };
    let choice = arguments.pipeline.choice();
    let scratch = super::scratch_directory()?;
    let factory = choice.factory(&prepared.scenario().far_range, scratch.path())?;
    let directory = match &arguments.out {
        Some(path) => RunDirectory::create(path)?,
        None => RunDirectory::create_numbered(Path::new(RUNS), &source.name)?,
    };
    let frames = flight.frames.end - flight.frames.start;
    let progress = output.progress(frames, &format!("{}, {}", source.name, factory.name()));
    let scored = prepared.run(&directory, &flight, factory.as_ref(), || {
        progress.inc(1);
        Ok(())
    });
    progress.finish_and_clear();
    let ran = scored?;
    output.first_failure(ran.first_failure.as_ref());
    let score = ran.scored.score;
    if !arguments.no_report {
        write_beside_far_range_run(directory.path(), ran.scored.verdicts, output);
    }

    let style = TableStyle {
        styled: output.is_terminal(),
        reference: is_argon(prepared.scenario()).then_some(&ARGON_TABLE_2),
        ..TableStyle::default()
    };
    let mut text = far_range(&score, style);
    if let Some(stage) = arguments.inject {
        text += &format!("\n\nthe truth was injected for {stage}: this is no result of the pipeline");
    }
    output.answer(&score, format!("{text}\n\nresults in {}", directory.path().display()))?;
    Ok(Answer::Yes)
}

fn run_docking(
    arguments: &RunArguments,
    source: &ScenarioSource,
    output: &Output,
) -> Result<Answer, Failure> {
    if let Some(stage) = arguments.inject {
        return Err(Failure::Usage(format!("--inject is {stage}, expected with a far-range scenario alone")));
    }
    let images: Option<FieldImages> = format_of("--save-frames", arguments.save_frames.as_deref())?;
    let prepared = PreparedDocking::new(source, arguments.renderer.renderer()?)?;
    let fields = arguments.selection.frames(prepared.field_count())?;
    let jobs = arguments.renderer.jobs(&arguments.selection);
    let flight = DockingFlight { fields, jobs, images };
    check_size(&prepared, &flight)?;
    let scratch = super::scratch_directory()?;
    let choice = arguments.pipeline.choice();
    let factory = choice.docking_factory(&prepared.scenario().docking, scratch.path())?;
    // While nothing has been written.
    prepared.probe(flight.fields.start)?;
    let directory = match &arguments.out {
        Some(path) => RunDirectory::create(path)?,
        None => RunDirectory::create_numbered(Path::new(RUNS), &source.name)?,
    };
    let fields = flight.fields.end - flight.fields.start;
    let progress = output.progress(fields, &format!("{}, {}", source.name, factory.name()));
    let ran = prepared.run(&directory, &flight, factory.as_ref(), || {
        progress.inc(1);
        Ok(())
    });
    progress.finish_and_clear();
    let ran = ran?;
    output.first_failure(ran.first_failure.as_ref());
    if !arguments.no_report {
        write_beside_results(directory.path(), output);
    }
    let text = docking(&ran.score, output.is_terminal());
    output.answer(&ran.score, format!("{text}\nresults in {}", directory.path().display()))?;
    Ok(Answer::Yes)
}
