//! `boresight process` on a docking sequence: digitised television, from files or standard input.

use std::path::{Path, PathBuf};

use clap::Args;
use contract::docking::Digitiser;
use docking::rows::SetupFile;
use docking::video::{FieldOrder, FieldSource, FrameSize, Scan, SequenceOptions};
use docking::{DockingMission, DockingRenderer, DockingScenario, FieldAnswers};
use files::{Failure, file_beside};
use run::{AnyWorld, ScenarioSource, WorldFrames as _, WorldScenario as _};
use serde_json::{Map, json};

use crate::command::Answer;
use crate::command::dataset::{ProcessArguments, check_sums};
use crate::command::interrupt::scratch_directory;
use crate::command::output::Output;

/// Returns true if datasets of a world are docking sequences.
pub(in crate::command) fn is_docking(world: &'static dyn AnyWorld) -> bool {
    world.has_scenario::<DockingScenario>()
}

/// Options for reading a sequence of docking fields.
#[derive(Debug, Args)]
#[command(next_help_heading = "Docking sequences")]
pub(in crate::command) struct SequenceArguments {
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
    pub(in crate::command) fn given(&self) -> Option<&'static str> {
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
    pub(in crate::command) fn names_cameras(&self) -> bool {
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
pub(in crate::command) fn process_sequence(
    arguments: &ProcessArguments,
    output: &Output,
) -> Result<Answer, Failure> {
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
    let scratch = scratch_directory()?;
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
        ("motion".to_owned(), json!(file_beside(&measurements, "motion.csv"))),
        ("features".to_owned(), json!(file_beside(&measurements, "features.parquet"))),
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
