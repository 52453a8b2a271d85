//! `boresight render` and `boresight process`: datasets for external pipelines, and from external cameras.

use std::cell::OnceCell;
use std::path::{Path, PathBuf};

use clap::Args;
use files::{Checksums, Failure, FileError, RunDirectory, file_beside};
use indicatif::ProgressBar;
use labels::{LabelCounts, LabelFormats};
use run::any_world::ProcessingOrder;
use run::{AnyWorld, Expectation, FrameJobs, Options, worlds};
use serde_json::{Map, json};

use super::Answer;
use super::docking::{RendererOptions, SequenceArguments, is_docking, process_sequence};
use super::execute::note_unfinished_run;
use super::options::{PipelineOptions, Selection};
use super::output::Output;

#[derive(Debug, Args)]
pub(super) struct RenderArguments {
    #[command(flatten)]
    selection: Selection,
    /// A new or empty directory for the dataset. Docking with --format y4m: `-` writes only the video, to
    /// standard output
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    /// Format of the images: fits (the default), png or exr; docking: png (the default), avi (uncompressed),
    /// mjpeg (AVI) or y4m
    #[arg(long, value_name = "FORMAT")]
    format: Option<String>,
    /// Also write the noise-free expected image of every frame, in electrons, to truth/expected/
    #[arg(long)]
    expected: bool,
    /// Also write labels for machine learning to truth/labels/: one or more of coco, speed, bop, yolo,
    /// separated by commas; the images are then PNG
    #[arg(long, value_name = "FORMATS")]
    labels: Option<LabelFormats>,
    #[command(flatten)]
    renderer: RendererOptions,
}

impl RenderArguments {
    /// Returns the format of the images as the user named it. Labels name PNG files.
    ///
    /// # Errors
    /// [`Failure::Usage`] for labels of other images, or of images without files.
    fn images(&self) -> Result<Option<String>, Failure> {
        let Some(labels) = &self.labels else { return Ok(self.format.clone()) };
        if self.out == Path::new("-") {
            let message = format!("--labels {labels} with --out -, expected a directory for the labels");
            return Err(Failure::Usage(message));
        }
        match self.format.as_deref() {
            None | Some(LABELLED_IMAGES) => Ok(Some(LABELLED_IMAGES.to_owned())),
            Some(format) => Err(Failure::Usage(format!(
                "--format is `{format}`, expected {LABELLED_IMAGES} with --labels {labels}: labels name an image \
                 file per frame, of a kind that readers of labels open"
            ))),
        }
    }
}

/// Format of images with labels.
const LABELLED_IMAGES: &str = "png";

pub(super) fn render(arguments: &RenderArguments, output: &Output) -> Result<Answer, Failure> {
    let source = arguments.selection.scenario()?;
    let world = source.world();
    let images = arguments.images()?;
    if let Some(word) = &images {
        world.check_images(word).map_err(|error| Failure::Usage(format!("--format: {error}")))?;
    }
    let prepared =
        source.prepare(Options { renderer: arguments.renderer.renderer()?, ..Options::default() })?;
    let frame_jobs = FrameJobs {
        frames: arguments.selection.frames(prepared.frame_count())?,
        jobs: arguments.renderer.jobs(&arguments.selection),
        images,
        expectation: if arguments.expected { Expectation::Kept } else { Expectation::Dropped },
        states_of: source.directory_of_run().map(Path::to_path_buf),
    };
    if arguments.out == Path::new("-") {
        // Only the video is written, for another program that reads it during production.
        prepared.check_stream(&frame_jobs)?;
        output.check_free("--out -")?;
        prepared.stream(&frame_jobs)?;
        return Ok(Answer::Yes);
    }
    prepared.check_frame_jobs(&frame_jobs)?;
    let label_note = match &arguments.labels {
        Some(formats) => prepared.check_labels(formats)?,
        None => None,
    };
    output.warn(&prepared.warnings());
    output.warn(&Vec::from_iter(label_note));
    let directory = RunDirectory::create(&arguments.out)?;
    note_unfinished_run(&directory);
    let frames = frame_jobs.frames.end - frame_jobs.frames.start;
    // Each frame is drawn and, if requested, labelled.
    let passes = if arguments.labels.is_some() { 2 } else { 1 };
    let progress = output.progress(passes * frames, &source.name);
    let done = || progress.inc(1);
    let rendered = prepared.render(&directory, &frame_jobs, arguments.labels.as_ref(), &done);
    progress.finish_and_clear();
    let (files, counts) = rendered?;
    let path = directory.path();
    let mut document = json!({ "directory": path, "frames": frames });
    if let (Some(document), Some(counts)) = (document.as_object_mut(), counts) {
        document.insert("labels".to_owned(), json!({ "objects": counts.objects, "points": counts.points }));
    }
    output.answer(
        &document,
        format!(
            "{frames} {1}s in {0}\n\
             for a pipeline: {files}; the truth is separate in truth/\n{2}\
             next: boresight process {0}, or your own pipeline and boresight score {0} MEASUREMENTS",
            path.display(),
            world.image(),
            counts.map_or_else(String::new, describe_labels),
        ),
    )?;
    Ok(Answer::Yes)
}

/// Returns a line about the labels that were written.
fn describe_labels(LabelCounts { objects, points }: LabelCounts) -> String {
    let points = match points {
        0 => String::new(),
        points => format!(", {points} of them smaller than a pixel, with the pixel of their position"),
    };
    format!("labels of {objects} objects in truth/labels/{points}\n")
}

#[derive(Debug, Args)]
pub(super) struct ProcessArguments {
    /// A dataset: camera.toml, telemetry.csv, the images listed there, and optionally stars.csv. Docking: a
    /// dataset with setup.toml, a folder of images, an AVI or Y4M file, or `-` for Y4M (with --raw: raw
    /// frames) on standard input
    #[arg(value_name = "DIR|FILE|-")]
    pub(super) directory: PathBuf,
    #[command(flatten)]
    pub(super) sequence: SequenceArguments,
    /// File to write the measurements to. Other results are written beside it: clusters.parquet (docking:
    /// motion.csv, features.parquet) beside measurements.csv, NAME.clusters.parquet beside NAME.csv. Default:
    /// `measurements.csv` in the dataset; for a video, in the current directory. Docking: `-` writes only the
    /// measurements, to standard output, one after the other
    #[arg(short, long, value_name = "FILE")]
    pub(super) out: Option<PathBuf>,
    #[command(flatten)]
    pub(super) pipeline: PipelineOptions,
}

pub(super) fn process(arguments: &ProcessArguments, output: &Output) -> Result<Answer, Failure> {
    let path = &arguments.directory;
    let is_stream = path == Path::new("-");
    if !is_stream && let Err(source) = path.metadata() {
        return Err(FileError::Io { path: path.clone(), doing: "open", source }.into());
    }
    let sequence = &arguments.sequence;
    let dataset =
        worlds().into_iter().find(|world| !is_stream && path.join(world.facts().setup_file).exists());
    let is_sequence = dataset.is_none_or(is_docking);
    let is_plain = sequence.given().is_none() && arguments.out.as_deref() != Some(Path::new("-"));
    match dataset {
        Some(world) if is_plain => process_dataset(world, arguments, output),
        Some(_) if !is_sequence && !sequence.names_cameras() => Err(Failure::Usage(match sequence.given() {
            Some(option) => format!("{option} applies only to docking"),
            None => "--out is -, expected a path: only docking writes to standard output (a file named - is \
                ./-)"
                .to_owned(),
        })),
        None if !is_stream && path.is_dir() && !sequence.names_cameras() => Err(Failure::Usage(format!(
            "{}: neither camera.toml (far range) nor setup.toml (docking) in it; for a folder of docking \
             images give --scenario SCENARIO",
            path.display()
        ))),
        _ => process_sequence(arguments, output),
    }
}

/// Processes a dataset of any world.
fn process_dataset(
    world: &dyn AnyWorld,
    arguments: &ProcessArguments,
    output: &Output,
) -> Result<Answer, Failure> {
    let path = &arguments.directory;
    check_sums(path)?;
    let scratch = super::scratch_directory()?;
    let measurements = arguments.out.clone().unwrap_or_else(|| path.join("measurements.csv"));
    let progress = OnceCell::new();
    let processed = world.process(&ProcessingOrder {
        directory: path,
        measurements: &measurements,
        choice: &arguments.pipeline.choice(&[path]),
        scratch: scratch.path(),
        begin: &|name, count| {
            progress.get_or_init(|| {
                count.map_or_else(|| output.counter(name), |count| output.progress(count, name))
            });
        },
        done: &|| progress.get().into_iter().for_each(|progress| progress.inc(1)),
    });
    progress.get().into_iter().for_each(ProgressBar::finish_and_clear);
    let processed = processed?;
    output.first_failure(processed.first_failure.as_ref());
    let frames = processed.frames;
    let mut document = Map::new();
    document.insert("measurements".to_owned(), json!(measurements));
    for name in processed.beside {
        // The key is the name without its extension: `clusters`.
        let key = name.split_once('.').map_or(*name, |(stem, _)| stem);
        document.insert(key.to_owned(), json!(file_beside(&measurements, name)));
    }
    document.insert("frames".to_owned(), json!(frames));
    if let Some(summary) = &processed.summary {
        document.insert(summary.key.to_owned(), json!(summary.counts));
    }
    let mut text = format!("{frames} {}s processed, outcomes in {}", world.image(), measurements.display());
    if let Some(summary) = &processed.summary {
        text.push('\n');
        text.push_str(&summary.text);
    }
    output.answer(&document, text)?;
    Ok(Answer::Yes)
}

/// Verifies the pipeline's input files against the checksums of a dataset, if it has checksums.
pub(super) fn check_sums(folder: &Path) -> Result<(), FileError> {
    const GIVEN: [&str; 4] = ["camera.toml", "setup.toml", "stars.csv", "telemetry.csv"];
    Checksums::check(folder, |name| GIVEN.contains(&name))
}
