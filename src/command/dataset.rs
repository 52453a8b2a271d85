//! `boresight render` and `boresight process`: datasets for somebody else's pipeline, and from somebody else's camera.

use std::path::{Path, PathBuf};

use clap::Args;
use contract::Setup;
use contract::docking::Digitiser;
use files::docking::SetupFile;
use files::{
    Checksums, Dataset, Failure, FieldOrder, FieldSource, FileError, FrameSize, ImageFormat, RunDirectory,
    Scan, SequenceOptions, StarRow, read_stars,
};
use run::docking::answers::FieldAnswers;
use run::docking::dataset::FieldImages;
use run::docking::renderer::DockingRenderer;
use run::far_range::answers::FrameAnswers;
use run::far_range::star_list::star_list;
use run::{Expectation, Flight, Prepared, PreparedDocking, World as _};
use scenario::{Scenario, ScenarioSource};
use serde_json::json;

use super::Answer;
use super::options::{PipelineOptions, RendererOptions, Selection, format_of};
use super::output::Output;

#[derive(Debug, Args)]
pub(super) struct RenderArguments {
    #[command(flatten)]
    selection: Selection,
    /// A new or empty directory for the dataset. Docking with --format y4m: `-` writes the video alone to standard output
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    /// Format of the images: fits (the default), png or exr; docking: png (the default), avi (uncompressed), mjpeg (AVI) or
    /// y4m
    #[arg(long, value_name = "FORMAT")]
    format: Option<String>,
    /// Write the noise-free expectation of every frame too, in electrons, to truth/expected/
    #[arg(long)]
    expected: bool,
    #[command(flatten)]
    renderer: RendererOptions,
}

pub(super) fn render(arguments: &RenderArguments, output: &Output) -> Result<Answer, Failure> {
    let source = arguments.selection.scenario()?;
    match source.scenario {
        Scenario::FarRange(_) => render_far_range(arguments, &source, output),
        Scenario::Docking(_) => render_docking(arguments, &source, output),
    }
}

fn render_far_range(
    arguments: &RenderArguments,
    source: &ScenarioSource,
    output: &Output,
) -> Result<Answer, Failure> {
    arguments.renderer.check_far_range()?;
    refuse_stream(Some(&arguments.out))?;
    let format = format_of("--format", arguments.format.as_deref())?.unwrap_or(ImageFormat::Fits);
    let prepared = Prepared::new(source)?;
    let flight = Flight {
        frames: arguments.selection.frames(prepared.frame_count())?,
        jobs: arguments.selection.jobs(),
        images: Some(format),
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

fn render_docking(
    arguments: &RenderArguments,
    source: &ScenarioSource,
    output: &Output,
) -> Result<Answer, Failure> {
    if arguments.expected {
        return Err(Failure::Usage(
            "--expected is given, expected with a far-range scenario alone".to_owned(),
        ));
    }
    let images = format_of("--format", arguments.format.as_deref())?.unwrap_or(FieldImages::Png);
    let prepared = PreparedDocking::new(source, arguments.renderer.renderer()?)?;
    let fields = arguments.selection.frames(prepared.frame_count())?;
    let count = fields.end - fields.start;
    let jobs = arguments.renderer.jobs(&arguments.selection);
    let flight = Flight { frames: fields, jobs, images: Some(images), expectation: Expectation::Dropped };
    if arguments.out == Path::new("-") {
        return stream_docking(&prepared, &flight, images, output);
    }
    check_size(&prepared, &flight)?;
    // While nothing has been written.
    prepared.probe(flight.frames.start)?;
    let directory = RunDirectory::create(&arguments.out)?;
    let progress = output.progress(count, &source.name);
    let rendered = prepared.render(&directory, &flight, || progress.inc(1));
    progress.finish_and_clear();
    rendered?;
    let path = directory.path().display();
    let kept = images.place();
    output.answer(
        &json!({ "directory": directory.path(), "frames": count }),
        format!(
            "{count} fields in {path}\nfor a pipeline: setup.toml, telemetry.csv, {kept}; the truth is apart in truth/\n\
             next: boresight process {path}, or a pipeline of your own and boresight score {path} MEASUREMENTS"
        ),
    )?;
    Ok(Answer::Yes)
}

/// Refuses standard output, to which the far range writes nothing.
fn refuse_stream(out: Option<&Path>) -> Result<(), Failure> {
    if out == Some(Path::new("-")) {
        let message = "--out is -, expected the name of a place: only docking writes to standard output (`./-` is a file)";
        return Err(Failure::Usage(message.to_owned()));
    }
    Ok(())
}

/// The video alone, for another program to read as it comes.
fn stream_docking(
    prepared: &PreparedDocking,
    flight: &Flight<FieldImages>,
    images: FieldImages,
    output: &Output,
) -> Result<Answer, Failure> {
    if images != FieldImages::Y4m {
        let message = "--out is -, expected with --format y4m alone: no other format is a stream";
        return Err(Failure::Usage(message.to_owned()));
    }
    output.check_free("--out -")?;
    prepared.stream(flight.frames.clone(), flight.jobs)?;
    Ok(Answer::Yes)
}

/// Refuses more fields than one file of video holds, before hours of work.
pub(super) fn check_size(prepared: &PreparedDocking, flight: &Flight<FieldImages>) -> Result<(), Failure> {
    let count = flight.frames.end - flight.frames.start;
    match flight.images.and_then(|images| images.most_fields(prepared.setup())) {
        Some(most) if count > most => Err(Failure::Usage(format!(
            "{count} fields are more than the {most} of an uncompressed AVI of 4 GB; expected fewer (--frames), or mjpeg, \
             png or y4m"
        ))),
        _ => Ok(()),
    }
}

#[derive(Debug, Args)]
pub(super) struct ProcessArguments {
    /// A dataset: camera.toml, telemetry.csv and the images it names; stars.csv if it has one. Docking: a dataset with
    /// setup.toml, a folder of images, an AVI or Y4M file, or `-` for Y4M (with --raw: raw frames) on standard input
    #[arg(value_name = "DIR|FILE|-")]
    directory: PathBuf,
    #[command(flatten)]
    sequence: SequenceArguments,
    /// The file of measurements to write; what else there is goes beside it (clusters.parquet; docking: motion.csv,
    /// features.parquet). Default: `measurements.csv` in the dataset, of a video in the current directory. Docking: `-` writes
    /// the measurements to standard output, each as it comes, and nothing beside
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
    let is_told = arguments.sequence.scenario.is_some() || arguments.sequence.setup.is_some();
    if is_told || is_stream || !path.is_dir() || path.join("setup.toml").is_file() {
        return process_sequence(arguments, output);
    }
    if !path.join("camera.toml").exists() {
        return Err(Failure::Usage(format!(
            "{}: expected camera.toml (far range) or setup.toml (docking) in it, or --scenario SCENARIO for a folder of docking \
             images",
            path.display()
        )));
    }
    refuse_stream(arguments.out.as_deref())?;
    let dataset = Dataset::open(&arguments.directory)?;
    let setup = setup(arguments, &dataset)?;
    check_sums(path)?;
    let scratch = super::scratch_directory()?;
    let factory = arguments.pipeline.choice().factory(&dataset.camera().far_range, scratch.path())?;
    let measurements = arguments.out.clone().unwrap_or_else(|| arguments.directory.join("measurements.csv"));
    let clusters = measurements.with_file_name("clusters.parquet");
    let images = dataset.frames().iter().map(|frame| Ok((dataset.read(frame)?, *frame.telemetry())));
    let progress = output.progress(dataset.frames().len() as u64, &factory.name());
    let processed =
        run::process::<_, FrameAnswers>(images, &setup, factory.as_ref(), &measurements, || progress.inc(1));
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

/// How a sequence of docking fields is to be read.
#[derive(Debug, Args)]
#[command(next_help_heading = "Docking sequences")]
struct SequenceArguments {
    /// The docking scenario whose cameras, target and pipeline these are; default: `setup.toml` in the folder, or beside the
    /// video
    #[arg(long, value_name = "SCENARIO")]
    scenario: Option<String>,
    /// A file `setup.toml` that names them, in the place of a scenario
    #[arg(long, value_name = "FILE", conflicts_with = "scenario")]
    setup: Option<PathBuf>,
    /// Which of its cameras took the images, from 0
    /// [default: 0]
    #[arg(long, value_name = "N")]
    camera: Option<usize>,
    /// Which field of a whole frame is first in time, whatever a header says [default: top]
    #[arg(long, value_name = "top|bottom")]
    field_order: Option<FieldOrder>,
    /// Frames are progressive: of one moment, not two fields
    #[arg(long, conflicts_with = "field_order")]
    progressive: bool,
    /// Whole frames a second; default: what the file says, 25 where it says nothing
    #[arg(long, value_name = "HZ")]
    frame_rate_hz: Option<f64>,
    /// Raw grey frames of 8 bits and this size, without headers
    #[arg(long, value_name = "COLUMNSxROWS")]
    raw: Option<FrameSize>,
}

impl SequenceArguments {
    /// What a sequence does not say of itself: as the options have it, or as it is by default.
    fn options(&self) -> SequenceOptions {
        let order = self.field_order.unwrap_or(FieldOrder::Top);
        SequenceOptions {
            scan: if self.progressive { Scan::Progressive } else { Scan::Interlaced(order) },
            camera: self.camera.unwrap_or(0),
            frame_rate_hz: self.frame_rate_hz,
            raw: self.raw,
            digitiser: Digitiser::default(),
        }
    }

    /// Refuses an option that a folder with `telemetry.csv` would pass over.
    fn check_free(&self, table: &Path) -> Result<(), Failure> {
        let given = [
            ("--camera", self.camera.is_some()),
            ("--field-order", self.field_order.is_some()),
            ("--progressive", self.progressive),
            ("--frame-rate-hz", self.frame_rate_hz.is_some()),
            ("--raw", self.raw.is_some()),
        ];
        match given.into_iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) if table.is_file() => Err(Failure::Usage(format!(
                "{option} is given, expected without {}, which tells camera, lines and time of every field",
                table.display()
            ))),
            _ => Ok(()),
        }
    }
}

/// Docking: digitised television, from files or standard input.
fn process_sequence(arguments: &ProcessArguments, output: &Output) -> Result<Answer, Failure> {
    let (path, sequence) = (&arguments.directory, &arguments.sequence);
    sequence.check_free(&path.join("telemetry.csv"))?;
    let setup_file = setup_file(path, sequence);
    let (setup, config) = match (&sequence.scenario, &setup_file) {
        (Some(word), _) => {
            let prepared = PreparedDocking::new(&ScenarioSource::read(word)?, DockingRenderer::Fast)?;
            (prepared.setup().clone(), prepared.scenario().docking.clone())
        }
        (None, Some(file)) => {
            let file = SetupFile::read(file)?;
            (file.setup(), file.docking)
        }
        (None, None) => {
            let name = if path == Path::new("-") { "standard input".into() } else { path.to_string_lossy() };
            return Err(Failure::Usage(format!(
                "{name}: cameras and target are not known, expected --scenario SCENARIO or --setup FILE"
            )));
        }
    };
    let scratch = super::scratch_directory()?;
    let factory = arguments.pipeline.choice().docking_factory(&config, scratch.path())?;
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
    output.answer(
        &json!({
            "measurements": measurements,
            "motion": measurements.with_file_name("motion.csv"),
            "features": measurements.with_file_name("features.parquet"),
            "frames": fields,
        }),
        format!("{fields} fields processed, answers in {}", measurements.display()),
    )?;
    Ok(Answer::Yes)
}

/// Holds what a pipeline is given against the checksums of a dataset, where it is one that has them.
fn check_sums(folder: &Path) -> Result<(), FileError> {
    const GIVEN: [&str; 4] = ["camera.toml", "setup.toml", "stars.csv", "telemetry.csv"];
    Checksums::check(folder, |name| GIVEN.contains(&name))
}

/// The file that tells cameras and target: the one asked for, or `setup.toml` in a folder or beside a video.
fn setup_file(path: &Path, sequence: &SequenceArguments) -> Option<PathBuf> {
    let beside = || if path.is_dir() { path.join("setup.toml") } else { path.with_file_name("setup.toml") };
    sequence.setup.clone().or_else(|| Some(beside()).filter(|file| path != Path::new("-") && file.is_file()))
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
        zero_suppression_dn: camera.zero_suppression_dn,
        stars: stars.iter().map(StarRow::listed).collect(),
    })
}
