//! `boresight run`: simulate, process, score.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::Args;
use contract::PipelineFactory;
use files::{Failure, RunDirectory};
use run::{Expectation, Flight, Prepared, PreparedDocking, World as _};
use scenario::{Scenario, ScenarioSource, Stage, World};

use super::Answer;
use super::dataset::check_size;
use super::fly::{Shown, fly};
use super::options::{PipelineOptions, RendererOptions, Selection, format_of, place};
use super::output::Output;

/// Where numbered run directories go when `--out` is not given.
pub(super) const RUNS: &str = "runs";

#[derive(Debug, Args)]
pub(super) struct RunArguments {
    #[command(flatten)]
    selection: Selection,
    /// A new or empty directory for the results; default: the next free `runs/SCENARIO-001`
    #[arg(short, long, value_name = "DIR", value_parser = place())]
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
    let jobs = arguments.selection.jobs();
    let flight = arguments.flight(prepared.frame_count(), jobs)?;
    let scratch = super::scratch_directory()?;
    let factory = arguments.pipeline.choice().factory(&prepared.scenario().far_range, scratch.path())?;
    arguments.fly(&prepared, &flight, factory.as_ref(), source, output)
}

fn run_docking(
    arguments: &RunArguments,
    source: &ScenarioSource,
    output: &Output,
) -> Result<Answer, Failure> {
    if let Some(stage) = arguments.inject {
        return Err(Failure::Usage(format!("--inject is {stage}, expected with a far-range scenario alone")));
    }
    let prepared = PreparedDocking::new(source, arguments.renderer.renderer()?)?;
    let jobs = arguments.renderer.jobs(&arguments.selection);
    let flight = arguments.flight(prepared.frame_count(), jobs)?;
    check_size(&prepared, &flight)?;
    let scratch = super::scratch_directory()?;
    let factory =
        arguments.pipeline.choice().docking_factory(&prepared.scenario().docking, scratch.path())?;
    // While nothing has been written.
    prepared.probe(flight.frames.start)?;
    arguments.fly(&prepared, &flight, factory.as_ref(), source, output)
}

impl RunArguments {
    /// The frames asked for, of so many.
    fn flight<F: FromStr<Err = String>>(&self, frame_count: u64, jobs: usize) -> Result<Flight<F>, Failure> {
        Ok(Flight {
            frames: self.selection.frames(frame_count)?,
            jobs,
            images: format_of("--save-frames", self.save_frames.as_deref())?,
            expectation: Expectation::Dropped,
        })
    }

    fn fly<W: Shown>(
        &self,
        world: &W,
        flight: &Flight<W::Images>,
        factory: &dyn PipelineFactory<W::Interface>,
        source: &ScenarioSource,
        output: &Output,
    ) -> Result<Answer, Failure> {
        let directory = match &self.out {
            Some(path) => RunDirectory::create(path)?,
            None => RunDirectory::create_numbered(Path::new(RUNS), &source.name)?,
        };
        let note = self
            .inject
            .map(|stage| format!("the truth was injected for {stage}: this is no result of the pipeline"));
        fly(world, flight, factory, &directory, (&source.name, !self.no_report, note), output)
    }
}
