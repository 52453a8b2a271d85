//! `boresight render` and `boresight process`: datasets for somebody else's pipeline, and from somebody else's camera.

use std::path::PathBuf;

use clap::Args;
use contract::Setup;
use serde_json::json;

use super::Answer;
use super::options::{PipelineOptions, Selection};
use super::output::Output;
use crate::failure::Failure;
use crate::files::{Dataset, ImageFormat, RunDirectory, StarRow, read_stars};
use crate::run::{self, Expectation, Flight, Prepared};
use crate::star_list::star_list;

#[derive(Debug, Args)]
pub(super) struct RenderArguments {
    #[command(flatten)]
    selection: Selection,
    /// A new or empty directory for the dataset
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Format of the images
    #[arg(long, value_name = "fits|png|exr", default_value_t = ImageFormat::Fits)]
    format: ImageFormat,
    /// Write the noise-free expectation of every frame too, in electrons, to truth/expected/
    #[arg(long)]
    expected: bool,
}

pub(super) fn render(arguments: &RenderArguments, output: &Output) -> Result<Answer, Failure> {
    let source = arguments.selection.scenario()?;
    let prepared = Prepared::new(&source)?;
    let flight = Flight {
        frames: arguments.selection.frames(prepared.frame_count())?,
        jobs: arguments.selection.jobs(),
        images: Some(arguments.format),
        expectation: if arguments.expected { Expectation::Kept } else { Expectation::Dropped },
    };
    let directory = RunDirectory::create(&arguments.out)?;
    let frames = flight.frames.end - flight.frames.start;
    let progress = output.progress(frames, &source.name);
    let rendered = prepared.render(&directory, &flight, || progress.inc(1));
    progress.finish_and_clear();
    rendered?;
    let path = directory.path();
    output.answer(
        &json!({ "directory": path, "frames": frames }),
        format!(
            "{frames} frames in {0}\nfor a pipeline: camera.toml, stars.csv, telemetry.csv, frames/; the truth is apart in truth/\n\
             next: boresight process {0}, or a pipeline of your own and boresight score {0} MEASUREMENTS",
            path.display()
        ),
    )?;
    Ok(Answer::Yes)
}

#[derive(Debug, Args)]
pub(super) struct ProcessArguments {
    /// A dataset: camera.toml, telemetry.csv and the images it names; stars.csv if it has one
    directory: PathBuf,
    /// The file of measurements to write; the clusters go to `clusters.parquet` beside it. Default:
    /// `measurements.csv` in the dataset
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    pipeline: PipelineOptions,
}

pub(super) fn process(arguments: &ProcessArguments, output: &Output) -> Result<Answer, Failure> {
    let dataset = Dataset::open(&arguments.directory)?;
    let setup = setup(arguments, &dataset)?;
    let scratch = super::scratch_directory()?;
    let factory = arguments.pipeline.choice().factory(&dataset.camera().far_range, scratch.path())?;
    let measurements = arguments.out.clone().unwrap_or_else(|| arguments.directory.join("measurements.csv"));
    let clusters = measurements.with_file_name("clusters.parquet");
    let progress = output.progress(dataset.frames().len() as u64, &factory.name());
    let processed =
        run::process(&dataset, &setup, factory.as_ref(), &measurements, &clusters, || progress.inc(1));
    progress.finish_and_clear();
    let processed = processed?;
    output.first_failure(processed.first_failure.as_ref());
    let frames = processed.frames;
    output.answer(
        &json!({ "measurements": measurements, "clusters": clusters, "frames": frames }),
        format!("{frames} frames processed, answers in {}", measurements.display()),
    )?;
    Ok(Answer::Yes)
}

/// What the pipeline is told: the dataset's own star list, or the built-in catalogue to its magnitude limit.
fn setup(arguments: &ProcessArguments, dataset: &Dataset) -> Result<Setup, Failure> {
    let camera = dataset.camera();
    let file = arguments.directory.join("stars.csv");
    let stars = if file.exists() {
        read_stars(&file)?
    } else {
        let epoch = dataset.star_epoch().ok_or_else(|| {
            Failure::Usage(format!("{}: a dataset without frames", arguments.directory.display()))
        })?;
        star_list(&sim::catalog::Catalog::hipparcos2(), camera.magnitude_limit, epoch)
    };
    Ok(Setup {
        camera: camera.camera.clone(),
        camera_from_body: camera.mounting.camera_from_body(),
        bit_depth: camera.bit_depth,
        readout: camera.readout,
        stars: stars.iter().map(StarRow::listed).collect(),
    })
}
