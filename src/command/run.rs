//! `boresight run`: simulate, process, score.

use std::path::{Path, PathBuf};

use clap::Args;
use files::{Failure, RunDirectory};
use run::{Expectation, FrameJobs, Options};
use scenario::Stage;

use super::Answer;
use super::docking::RendererOptions;
use super::execute::{Presentation, execute};
use super::far_range::EstimatorName;
use super::options::{AttitudeOption, PipelineOptions, Selection, output_path};
use super::output::Output;
use super::report::Headings;

/// Parent directory of numbered run directories if `--out` is not given.
pub(super) const RUNS: &str = "runs";

#[derive(Debug, Args)]
pub(super) struct RunArguments {
    #[command(flatten)]
    selection: Selection,
    /// A new or empty directory for the results; default: the next free `runs/SCENARIO-001`
    #[arg(short, long, value_name = "DIR", value_parser = output_path())]
    out: Option<PathBuf>,
    #[command(flatten)]
    pipeline: PipelineOptions,
    /// Draw a secret seed instead of the scenario's: the program cannot know or make its frames beforehand.
    /// The seed is in the run's `run.toml`, which the sandbox hides from the program
    #[arg(long, requires = "sandbox", conflicts_with = "seed")]
    blind: bool,
    #[command(flatten)]
    attitude: AttitudeOption,
    /// Replace the result of this stage of the built-in pipeline by the truth, to measure the stage's
    /// contribution to the error
    #[arg(long, value_name = "STAGE")]
    inject: Option<Stage>,
    /// Also keep the images: fits, png or exr (about 1 MB per frame); docking: png, avi, mjpeg (AVI) or y4m
    #[arg(long, value_name = "FORMAT")]
    save_frames: Option<String>,
    /// Far range: then determine the relative orbit, as `boresight navigate` does with its defaults; the
    /// report then has its errors
    #[arg(
        long,
        value_name = "NAVIGATOR",
        value_enum,
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "batch"
    )]
    navigate: Option<EstimatorName>,
    /// Write no report.html
    #[arg(long)]
    no_report: bool,
    #[command(flatten)]
    renderer: RendererOptions,
    /// Remark below the score.
    #[arg(skip)]
    note: Option<String>,
    /// Headings of the report.
    #[arg(skip)]
    headings: Headings,
}

impl RunArguments {
    /// Returns the arguments of a run that reproduces a paper: with the built-in pipeline, the scenario's own
    /// seed, and the paper's figures in the headings of the report. `note` is printed below the score.
    pub(super) fn for_paper(
        selection: Selection,
        out: Option<PathBuf>,
        no_report: bool,
        note: Option<&str>,
    ) -> Self {
        Self {
            selection,
            out,
            pipeline: PipelineOptions::default(),
            blind: false,
            attitude: AttitudeOption::default(),
            inject: None,
            save_frames: None,
            navigate: None,
            no_report,
            renderer: RendererOptions::default(),
            note: note.map(str::to_owned),
            headings: Headings::OfPaper,
        }
    }
}

pub(super) fn run(arguments: &RunArguments, output: &Output) -> Result<Answer, Failure> {
    let mut source = arguments.selection.scenario()?;
    if arguments.blind {
        source.scenario.set_seed(secret_seed()?);
    }
    let out = arguments.out.as_deref().unwrap_or(Path::new(RUNS));
    let hidden = [Path::new(&arguments.selection.scenario), Path::new(RUNS), out];
    let (world, choice) = (source.world(), arguments.pipeline.choice(&hidden));
    if let Some(word) = &arguments.save_frames {
        world.check_images(word).map_err(|error| Failure::Usage(format!("--save-frames: {error}")))?;
    }
    if let Some(stage) = arguments.inject
        && !choice.is_built_in(world.code())
    {
        return Err(Failure::Usage(format!(
            "--inject is {stage}, which applies only to the built-in pipeline `{}`: other pipelines have no \
             such stage",
            world.code()
        )));
    }
    if arguments.navigate.is_some() {
        EstimatorName::check_world(world)?;
    }
    let options = Options {
        inject: arguments.inject,
        attitude: arguments.attitude.choice,
        renderer: arguments.renderer.renderer()?,
    };
    let prepared = source.prepare(options)?;
    let frame_jobs = FrameJobs {
        frames: arguments.selection.frames(prepared.frame_count())?,
        jobs: arguments.renderer.jobs(&arguments.selection),
        images: arguments.save_frames.clone(),
        expectation: Expectation::Dropped,
        states_of: None,
    };
    let scratch = super::scratch_directory()?;
    let factory = prepared.factory(&choice, scratch.path())?;
    prepared.check_frame_jobs(&frame_jobs)?;
    let directory = match &arguments.out {
        Some(path) => RunDirectory::create(path)?,
        None => RunDirectory::create_numbered(Path::new(RUNS), &source.name)?,
    };
    let note = arguments
        .inject
        .map(|stage| format!("the truth replaced {stage}: this is not a result of the whole pipeline"))
        .or_else(|| arguments.note.clone());
    let shown = Presentation {
        name: &source.name,
        report: (!arguments.no_report).then_some(arguments.headings),
        note,
        navigate: arguments.navigate,
    };
    execute(prepared.as_ref(), &frame_jobs, &factory, &directory, shown, output)
}

/// Draws a seed that nobody knows: 63 bits, the range of seeds in files.
///
/// # Errors
/// [`Failure::Usage`] if the operating system gives no random numbers.
fn secret_seed() -> Result<u64, Failure> {
    let bits = getrandom::u64()
        .map_err(|error| Failure::Usage(format!("--blind: the system gives no random numbers: {error}")))?;
    Ok(bits >> 1)
}
