//! `boresight render` and `boresight process`: datasets for external pipelines, and from external cameras.

use std::cell::OnceCell;
use std::path::{Path, PathBuf};

use clap::Args;
use contract::docking::Digitiser;
use docking::DockingMission;
use docking::DockingRenderer;
use docking::DockingScenario;
use docking::FieldAnswers;
use docking::rows::SetupFile;
use docking::video::{FieldOrder, FieldSource, FrameSize, Scan, SequenceOptions};
use files::{Checksums, Failure, FileError, RunDirectory};
use indicatif::ProgressBar;
use run::any_world::ProcessingOrder;
use run::{AnyWorld, Expectation, FrameJobs, Options, ScenarioSource, World as _, worlds};
use serde_json::{Map, Value, json};

use super::Answer;
use super::execute::note_unfinished_run;
use super::options::{PipelineOptions, RendererOptions, Selection};
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
    #[command(flatten)]
    renderer: RendererOptions,
}

pub(super) fn render(arguments: &RenderArguments, output: &Output) -> Result<Answer, Failure> {
    let source = arguments.selection.scenario()?;
    let world = source.world();
    if let Some(word) = &arguments.format {
        world.check_images(word).map_err(|error| Failure::Usage(format!("--format: {error}")))?;
    }
    let prepared =
        source.prepare(Options { renderer: arguments.renderer.renderer()?, ..Options::default() })?;
    let frame_jobs = FrameJobs {
        frames: arguments.selection.frames(prepared.frame_count())?,
        jobs: arguments.renderer.jobs(&arguments.selection),
        images: arguments.format.clone(),
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
    output.warn(&prepared.warnings());
    let directory = RunDirectory::create(&arguments.out)?;
    note_unfinished_run(&directory);
    let frames = frame_jobs.frames.end - frame_jobs.frames.start;
    let progress = output.progress(frames, &source.name);
    let rendered = prepared.render(&directory, &frame_jobs, &|| progress.inc(1));
    progress.finish_and_clear();
    let files = rendered?;
    let path = directory.path();
    output.answer(
        &json!({ "directory": path, "frames": frames }),
        format!(
            "{frames} {1}s in {0}\n\
             for a pipeline: {files}; the truth is separate in truth/\n\
             next: boresight process {0}, or your own pipeline and boresight score {0} MEASUREMENTS",
            path.display(),
            world.image(),
        ),
    )?;
    Ok(Answer::Yes)
}

#[derive(Debug, Args)]
pub(super) struct ProcessArguments {
    /// A dataset: camera.toml, telemetry.csv, the images listed there, and optionally stars.csv. Docking: a
    /// dataset with setup.toml, a folder of images, an AVI or Y4M file, or `-` for Y4M (with --raw: raw
    /// frames) on standard input
    #[arg(value_name = "DIR|FILE|-")]
    directory: PathBuf,
    #[command(flatten)]
    sequence: SequenceArguments,
    /// File to write the measurements to; other results are written beside it (clusters.parquet; docking:
    /// motion.csv, features.parquet). Default: `measurements.csv` in the dataset; for a video, in the current
    /// directory. Docking: `-` writes only the measurements, to standard output, one after the other
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    pipeline: PipelineOptions,
}

pub(super) fn process(arguments: &ProcessArguments, output: &Output) -> Result<Answer, Failure> {
    let path = &arguments.directory;
    let is_stream = path == Path::new("-");
    if !is_stream && let Err(source) = path.metadata() {
        return Err(FileError::Io { path: path.clone(), doing: "open", source }.into());
    }
    let sequence = &arguments.sequence;
    let dataset = worlds().into_iter().find(|world| !is_stream && path.join(world.setup_file()).exists());
    let is_docking = dataset.is_none_or(|world| world.has_scenario::<DockingScenario>());
    let is_plain = sequence.given().is_none() && arguments.out.as_deref() != Some(Path::new("-"));
    match dataset {
        Some(world) if is_plain => process_dataset(world, arguments, output),
        Some(_) if !is_docking && !sequence.names_cameras() => Err(Failure::Usage(match sequence.given() {
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
    let files = processed.files.iter().map(|file| {
        (file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default(), json!(file))
    });
    // The measurements may have any name.
    let files = [("measurements".to_owned(), json!(measurements))].into_iter().chain(files.skip(1));
    let summary = processed.summary.iter().map(|summary| (summary.key.to_owned(), json!(summary.counts)));
    let document: Map<String, Value> =
        files.chain([("frames".to_owned(), json!(frames))]).chain(summary).collect();
    let mut text = format!("{frames} {}s processed, outcomes in {}", world.image(), measurements.display());
    if let Some(summary) = &processed.summary {
        text.push('\n');
        text.push_str(&summary.text);
    }
    output.answer(&document, text)?;
    Ok(Answer::Yes)
}

/// Options for reading a sequence of docking fields.
#[derive(Debug, Args)]
#[command(next_help_heading = "Docking sequences")]
struct SequenceArguments {
    /// Docking scenario that defines cameras, target and pipeline; default: `setup.toml` in the folder, or
    /// beside the video
    #[arg(long, value_name = "SCENARIO")]
    scenario: Option<String>,
    /// File `setup.toml` that defines cameras, target and pipeline, instead of a scenario
    #[arg(long, value_name = "FILE", conflicts_with = "scenario")]
    setup: Option<PathBuf>,
    /// Index of the camera that took the images, from 0 [default: 0]
    #[arg(long, value_name = "N")]
    camera: Option<usize>,
    /// Field of a whole frame that is first in time, regardless of any header [default: top]
    #[arg(long, value_name = "top|bottom")]
    field_order: Option<FieldOrder>,
    /// Frames are progressive: taken at one time, without two fields
    #[arg(long, conflicts_with = "field_order")]
    progressive: bool,
    /// Whole frames per second; default: the rate stated in the file, or 25 if it states none
    #[arg(long, value_name = "HZ")]
    frame_rate_hz: Option<f64>,
    /// Raw grey frames of 8 bits and this size, without headers
    #[arg(long, value_name = "COLUMNSxROWS")]
    raw: Option<FrameSize>,
}

impl SequenceArguments {
    /// Returns the first given option that identifies the input as a docking sequence.
    fn given(&self) -> Option<&'static str> {
        let given_options = [("--scenario", self.scenario.is_some()), ("--setup", self.setup.is_some())];
        self.given_of_fields()
            .or_else(|| given_options.into_iter().find_map(|(option, is_given)| is_given.then_some(option)))
    }

    /// Returns the first given option that specifies a property of fields that `telemetry.csv` contains.
    fn given_of_fields(&self) -> Option<&'static str> {
        let all = [
            ("--camera", self.camera.is_some()),
            ("--field-order", self.field_order.is_some()),
            ("--progressive", self.progressive),
            ("--frame-rate-hz", self.frame_rate_hz.is_some()),
            ("--raw", self.raw.is_some()),
        ];
        all.into_iter().find_map(|(option, is_given)| is_given.then_some(option))
    }

    /// Returns true if an option specifies cameras and target.
    fn names_cameras(&self) -> bool {
        self.scenario.is_some() || self.setup.is_some()
    }

    /// Returns the properties that a sequence does not state itself: from the options, or their defaults.
    fn options(&self) -> SequenceOptions {
        let order = self.field_order.unwrap_or(FieldOrder::Top);
        SequenceOptions {
            scan: if self.progressive { Scan::Progressive } else { Scan::Interlaced(order) },
            scan_is_stated: self.progressive || self.field_order.is_some(),
            camera: self.camera.unwrap_or(0),
            frame_rate_hz: self.frame_rate_hz,
            raw: self.raw,
            digitiser: Digitiser::default(),
        }
    }

    /// Rejects an option that would be ignored for a directory with `telemetry.csv`.
    fn check_free(&self, table: &Path) -> Result<(), Failure> {
        match self.given_of_fields() {
            Some(option) if table.is_file() => Err(Failure::Usage(format!(
                "{option} conflicts with {}, which states camera, lines and time of every field",
                table.display()
            ))),
            _ => Ok(()),
        }
    }
}

/// Processes a docking sequence: digitised television, from files or standard input.
fn process_sequence(arguments: &ProcessArguments, output: &Output) -> Result<Answer, Failure> {
    let (path, sequence) = (&arguments.directory, &arguments.sequence);
    sequence.check_free(&path.join("telemetry.csv"))?;
    let setup_file = setup_file(path, sequence);
    let (setup, config) = match (&sequence.scenario, &setup_file) {
        (Some(word), _) => {
            let prepared = DockingMission::new(&ScenarioSource::read(word)?, DockingRenderer::Fast)?;
            (prepared.setup().clone(), prepared.scenario().docking.clone())
        }
        (None, Some(file)) => {
            let file = SetupFile::read(file)?;
            (file.setup(), file.docking)
        }
        (None, None) => {
            let name = if path == Path::new("-") { "standard input".into() } else { path.to_string_lossy() };
            return Err(Failure::Usage(format!(
                "{name}: cameras and target are undefined; give --scenario SCENARIO or --setup FILE"
            )));
        }
    };
    let scratch = super::scratch_directory()?;
    let factory = arguments.pipeline.choice(&[path]).factory::<DockingMission>(&config, scratch.path())?;
    let fields = FieldSource::open(path, &setup, &sequence.options())?;
    let of_setup = setup_file.as_deref().filter(|_| sequence.scenario.is_none()).and_then(Path::parent);
    for folder in [of_setup, Some(path.as_path()).filter(|path| path.is_dir())].into_iter().flatten() {
        check_sums(folder)?;
    }
    if arguments.out.as_deref() == Some(Path::new("-")) {
        output.check_free("--out -")?;
        let fields = fields.map(|field| Ok(field?));
        let processed = run::process_into(fields, &setup, factory.as_ref(), FieldAnswers::stream()?, || ())?;
        output.first_failure(processed.first_failure.as_ref());
        return Ok(Answer::Yes);
    }
    let place = if path.is_dir() { path.as_path() } else { Path::new("") };
    let measurements = arguments.out.clone().unwrap_or_else(|| place.join("measurements.csv"));
    let progress = output.counter(&factory.name());
    let fields = fields.map(|field| Ok(field?));
    let processed =
        run::process::<_, FieldAnswers>(fields, &setup, factory.as_ref(), &measurements, || progress.inc(1));
    progress.finish_and_clear();
    let processed = processed?;
    output.first_failure(processed.first_failure.as_ref());
    let fields = processed.frames;
    let mut document = Map::from_iter([
        ("measurements".to_owned(), json!(measurements)),
        ("motion".to_owned(), json!(measurements.with_file_name("motion.csv"))),
        ("features".to_owned(), json!(measurements.with_file_name("features.parquet"))),
        ("frames".to_owned(), json!(fields)),
    ]);
    let mut text = format!("{fields} fields processed, outcomes in {}", measurements.display());
    if let Some(summary) = &processed.summary {
        document.insert(summary.key.to_owned(), json!(summary.counts));
        text.push('\n');
        text.push_str(&summary.text);
    }
    output.answer(&document, text)?;
    Ok(Answer::Yes)
}

/// Verifies the pipeline's input files against the checksums of a dataset, if it has checksums.
fn check_sums(folder: &Path) -> Result<(), FileError> {
    const GIVEN: [&str; 4] = ["camera.toml", "setup.toml", "stars.csv", "telemetry.csv"];
    Checksums::check(folder, |name| GIVEN.contains(&name))
}

/// Returns the file that defines cameras and target: the requested file, or `setup.toml` in a directory or
/// beside a video.
fn setup_file(path: &Path, sequence: &SequenceArguments) -> Option<PathBuf> {
    let neighbouring_file =
        || if path.is_dir() { path.join("setup.toml") } else { path.with_file_name("setup.toml") };
    sequence
        .setup
        .clone()
        .or_else(|| Some(neighbouring_file()).filter(|file| path != Path::new("-") && file.is_file()))
}
