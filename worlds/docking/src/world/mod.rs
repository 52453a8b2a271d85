//! Docking: the approach to a target, imaged by a television camera.
//!
//! Fields are drawn in parallel, as video signals. They are digitised sequentially, because a pipeline may
//! request another contrast and brightness of the digitiser, which take effect from the next field on.

pub(crate) mod answers;
mod dataset;
mod mission;
mod picture;
pub(crate) mod renderer;

use crate::rows::FieldTruthRow;
pub use mission::{DockingMission, simulator};

use std::fmt::Debug;
use std::path::Path;

use contract::docking::{Digitiser, Docking, DockingOutcome, DockingSetup, Field, FieldTelemetry};
use contract::{Camera, PipelineFactory};
use files::{Failure, RunDirectory, TableReader};
use indexmap::IndexMap;
use pipeline::docking::{DockingConfig, DockingFactory};
use run::RowsByNumber;
use run::any_world::{Options, ScenarioSource};
use run::check::{FieldOfView, size};
use run::frame_jobs::{Expectation, FrameJobs, process_in_order};
use run::world::{self, OpenDataset, World, refuse_attitude, unscorable};
use scenario::AttitudeChoice;
use scenario::run_file::RunFile;
use score::{Figure, FigureSpec, UnitTable};
use serde_json::{Value, json};
use sim::docking::{CameraConfig, DockingWorkspace, FieldExposure, FieldTruth};
use sim::optics::Projection;

use self::answers::{FieldAnswers, answer_as_filed};
use self::dataset::{FieldDataset, FieldImages};
use self::renderer::DockingRenderer;
use crate::rows::{
    FieldRow, SetupFile, read_field_measurements, read_field_telemetry, read_motion, truth_as_filed,
};
use crate::scenario::DockingScenario;
use crate::scoring::{DockingContext, DockingScore, DockingScorer, GrossError, MissCause, TrueField, names};
use crate::video::{FieldSource, SequenceOptions, Y4mWriter, write_field};

impl World for DockingMission {
    const STARTING_POINT: &'static str = crate::STARTING_POINT;
    const SETUP_FILE: &'static str = "setup.toml";
    /// An approach is one sequence; its groups are ranges.
    const ARE_GROUPS_APART: bool = false;
    const TRUTH_FILE: &'static str = "truth/fields.parquet";
    const EVIDENCE_FILE: Option<&'static str> = Some("motion.csv");
    const HEADLINE: &'static str = names::SUCCESS_RATE;
    const IMAGES: FieldImages = FieldImages::Png;
    const PICTURES: &'static str = "png";

    type Scenario = DockingScenario;
    type Config = DockingConfig;
    type Interface = Docking;
    type Images = FieldImages;
    type Exposure = FieldExposure;
    type Workspace<'a> = DockingWorkspace;
    type Truth = FieldTruth;
    /// Settings of the digitiser.
    type State = Digitiser;
    type Dataset<'a> = FieldDataset<'a>;
    type Answers = FieldAnswers;
    type Scorer<'a> = Scorer;
    type Judgement = DockingJudgement;

    fn prepare(source: &ScenarioSource, _: &DockingScenario, options: Options) -> Result<Self, Failure> {
        refuse_attitude(options.attitude)?;
        match options.inject {
            Some(stage) => Err(Failure::Usage(format!(
                "--inject {stage} does not apply to the world {}, which has no stages to replace",
                Self::CODE
            ))),
            None => Self::new(source, DockingRenderer::new(options.renderer)?),
        }
    }

    fn run_file(&self) -> &RunFile<DockingScenario> {
        &self.run_file
    }

    fn summary(&self) -> (Value, String) {
        let (name, fields, target) = (&self.run_file.name, self.frame_count(), &self.setup.target);
        let (seconds, cameras) =
            (fields as f64 / self.simulator.field_rate_hz(), self.scenario().cameras.len());
        let camera = |camera: &CameraConfig| {
            let Ok(projection) = Projection::new(&camera.camera) else { return (Value::Null, String::new()) };
            let view = FieldOfView::from_projection(&projection);
            let text = format!("\ncamera {}: {}", camera.name, view.text());
            (
                json!({ "name": camera.name, "field_deg": view.field_deg, "pixel_arcsec": view.pixel_arcsec }),
                text,
            )
        };
        let (views, lines): (Vec<Value>, Vec<String>) = self.scenario().cameras.iter().map(camera).unzip();
        let bytes = (self.exposure_bytes() / size_of::<f32>()) as u64;
        let document = json!({
            "scenario": name,
            "ok": true,
            "world": Self::CODE,
            "views": views,
            "field_bytes": bytes,
            "frames": fields,
            "duration_s": seconds,
            "target": target.name,
            "marks": target.marks.len(),
            "cameras": cameras,
        });
        let text = format!(
            "{name}: {fields} fields in {seconds:.0} s, target {} with {} marks, {cameras} cameras, no mistake found{}\n\
             {fields} fields of {} each, uncompressed {} in total",
            target.name,
            target.marks.len(),
            lines.concat(),
            size(bytes),
            size(bytes.saturating_mul(fields)),
        );
        (document, text)
    }

    fn config(scenario: &DockingScenario) -> &DockingConfig {
        &scenario.docking
    }

    fn built_in(config: &DockingConfig) -> Result<Box<dyn PipelineFactory<Docking> + Send>, Failure> {
        let factory = DockingFactory::new(config.clone());
        Ok(Box::new(factory.map_err(|error| Failure::Usage(error.to_string()))?))
    }

    /// Writes a PNG, which contains only the pixels.
    fn write_image(field: &Field, _: &FieldTelemetry, path: &Path) -> Result<(), String> {
        write_field(path, field).map_err(|error| error.to_string())
    }

    fn check_frame_jobs(&self, frame_jobs: &FrameJobs<FieldImages>) -> Result<(), Failure> {
        if frame_jobs.expectation == Expectation::Kept {
            let message = "--expected requires a far-range scenario";
            return Err(Failure::Usage(message.to_owned()));
        }
        let count = frame_jobs.frames.end - frame_jobs.frames.start;
        if let Some(most) = frame_jobs.images.and_then(|images| images.max_fields(&self.setup))
            && count > most
        {
            return Err(Failure::Usage(format!(
                "{count} fields exceed the {most} that fit into an uncompressed AVI of 4 GB; select fewer \
                 with --frames, or write mjpeg, png or y4m"
            )));
        }
        self.probe(frame_jobs.frames.start)
    }

    fn files_for_pipelines(images: FieldImages) -> String {
        format!("setup.toml, telemetry.csv, {}", images.file_pattern())
    }

    fn check_stream(&self, frame_jobs: &FrameJobs<FieldImages>) -> Result<(), Failure> {
        if frame_jobs.images == Some(FieldImages::Y4m) {
            return Ok(());
        }
        let message = "--out - requires --format y4m: no other format can be streamed";
        Err(Failure::Usage(message.to_owned()))
    }

    /// Writes fields, digitised with the default settings, as Y4M.
    fn stream(&self, frame_jobs: &FrameJobs<FieldImages>) -> Result<(), Failure> {
        self.check_stream(frame_jobs)?;
        let size = self.setup.cameras.first().map_or((0, 0), |camera| (camera.columns, camera.rows));
        let rate_hz = self.scenario().television.frame_rate_hz;
        let mut video = Y4mWriter::standard_output(size, rate_hz)?;
        if let Some(camera) = self.setup.cameras.first() {
            video = video.with_pixel_size(camera.pixel_width_um, camera.pixel_height_um);
        }
        let make = |workspace: &mut DockingWorkspace, field| {
            Ok(self.expose(workspace, field, &Digitiser::default())?.video.digitise(&Digitiser::default()))
        };
        let (fields, bytes) = (frame_jobs.frames.clone(), self.exposure_bytes() as u64);
        process_in_order(
            fields,
            frame_jobs.jobs,
            bytes,
            || self.workspace(),
            make,
            |field| Ok(video.write(&field)?),
        )?;
        Ok(video.finish()?)
    }

    fn open(directory: &Path) -> Result<OpenDataset<Self>, Failure> {
        let file = SetupFile::read(&directory.join(Self::SETUP_FILE))?;
        let setup = file.setup();
        let images = FieldSource::open(directory, &setup, &SequenceOptions::INTERLACED)?;
        let images = Box::new(images.map(|field| Ok(field?)));
        Ok(OpenDataset { setup, config: file.docking, count: None, images })
    }

    fn telemetry_rows(directory: &Path, add: &mut dyn FnMut(&dyn Debug)) -> Result<(), Failure> {
        for FieldRow { field, lines, mut telemetry, .. } in
            read_field_telemetry(&directory.join("telemetry.csv"))?
        {
            // The digitiser settings depend on the requests of the pipeline and are excluded.
            telemetry.digitiser = Digitiser::default();
            add(&(field, lines, telemetry));
        }
        Ok(())
    }

    fn figures() -> Vec<FigureSpec> {
        crate::scoring::figures()
    }

    fn causes() -> Vec<(&'static str, &'static str)> {
        let missed = MissCause::CODES.map(|cause| ("missed", cause));
        missed.into_iter().chain(GrossError::ALL.map(|gross| ("wrong", gross.code()))).collect()
    }

    fn frame_count(&self) -> u64 {
        self.simulator.field_count()
    }

    fn setup(&self) -> &DockingSetup {
        &self.setup
    }

    /// A video signal is stored as f32; a progressive field is a complete frame.
    fn exposure_bytes(&self) -> usize {
        let frame = |camera: &Camera| camera.columns * camera.rows * size_of::<f32>();
        self.setup.cameras.first().map_or(0, frame) / self.scenario().television.interlace.lines(0).step()
    }

    fn workspace(&self) -> Result<DockingWorkspace, Failure> {
        Ok(self.simulator.workspace()?)
    }

    fn expose(
        &self,
        workspace: &mut DockingWorkspace,
        field: u64,
        _: &Digitiser,
    ) -> Result<FieldExposure, Failure> {
        self.renderer.expose(&self.simulator, &self.setup, workspace, field)
    }

    fn receive(exposure: FieldExposure, digitiser: &Digitiser) -> (Field, FieldTelemetry, FieldTruth) {
        (exposure.video.digitise(digitiser), exposure.telemetry(*digitiser), exposure.truth)
    }

    /// Ignores settings that the digitiser does not support.
    fn advance(&self, digitiser: Digitiser, _: u64, outcome: &DockingOutcome) -> Digitiser {
        outcome.digitiser.filter(|wish| wish.check().is_ok()).unwrap_or(digitiser)
    }

    fn dataset<'a>(
        &'a self,
        directory: &'a RunDirectory,
        frame_jobs: &FrameJobs<FieldImages>,
    ) -> Result<FieldDataset<'a>, Failure> {
        FieldDataset::create(&self.run_file, &self.setup, directory, frame_jobs.images)
    }

    fn scorer(&self) -> Scorer {
        Scorer::new(&self.run_file, &self.setup)
    }

    fn score_files(
        directory: &Path,
        measurements: &Path,
        motion: Option<&Path>,
        attitude: Option<AttitudeChoice>,
    ) -> Result<DockingJudgement, Failure> {
        refuse_attitude(attitude)?;
        let run_file = RunFile::<DockingScenario>::read(&directory.join("run.toml"))?;
        let setup = SetupFile::read(&directory.join("setup.toml"))?.setup();
        let mut scorer = Scorer::new(&run_file, &setup);
        let truth = directory.join(Self::TRUTH_FILE);
        let truths = TableReader::<FieldTruthRow>::open(&truth)?;
        let mut answers =
            RowsByNumber::new(read_field_measurements(measurements)?, measurements, "field", &truth);
        let reports = motion.map(read_motion).transpose()?.unwrap_or_default();
        let mut reports = RowsByNumber::new(reports, motion.unwrap_or(measurements), "field", &truth);
        for field in truths {
            let (number, rows) = field?;
            let (outcome, report) = (answers.take(number)?, reports.take(number)?);
            for row in rows {
                let truth = scorer.true_field(&FieldTruth::from(row));
                let judged = scorer.scorer.add_with_report(&truth, outcome.as_ref(), report.as_ref());
                judged.map_err(unscorable)?;
            }
        }
        answers.end()?;
        reports.end()?;
        Ok(world::Scorer::finish(scorer))
    }
}

/// Scores the fields of a run.
pub struct Scorer {
    scorer: DockingScorer,
    marks: usize,
    cameras: Vec<Camera>,
}

impl Scorer {
    fn new(run_file: &RunFile<DockingScenario>, setup: &DockingSetup) -> Self {
        Self {
            scorer: DockingScorer::new(context(run_file, setup)),
            marks: setup.target.marks.len(),
            cameras: setup.cameras.clone(),
        }
    }

    fn true_field(&self, truth: &FieldTruth) -> TrueField {
        let rows = self.cameras.get(truth.camera).map_or(0, |camera| camera.rows);
        TrueField::new(truth, self.marks, rows)
    }
}

impl world::Scorer<DockingMission> for Scorer {
    /// Truth and outcome are scored with the precision of their files, so that a run and its files have
    /// bit-identical scores.
    fn add(
        &mut self,
        truth: &FieldTruth,
        _: &FieldTelemetry,
        outcome: &DockingOutcome,
    ) -> Result<(), Failure> {
        let truth = self.true_field(&truth_as_filed(truth.clone()));
        self.scorer.add(&truth, Some(&answer_as_filed(outcome))).map_err(unscorable)
    }

    fn finish(self) -> DockingJudgement {
        DockingJudgement { score: self.scorer.score(), scorer: self.scorer }
    }
}

/// Score of a docking run, with the scored fields.
pub struct DockingJudgement {
    /// Score of the run.
    pub score: DockingScore,
    scorer: DockingScorer,
}

impl world::Judgement for DockingJudgement {
    type Score = DockingScore;

    fn score(&self) -> &DockingScore {
        &self.score
    }

    fn figures(&self) -> &IndexMap<String, Figure> {
        &self.score.figures
    }

    fn units(&self) -> UnitTable {
        self.scorer.units()
    }
}

fn context(run_file: &RunFile<DockingScenario>, setup: &DockingSetup) -> DockingContext {
    DockingContext {
        scenario: run_file.name.clone(),
        seed: run_file.scenario.seed,
        version: run_file.version.clone(),
        renderer: run_file.mitsuba.as_ref().map_or("fast", |_| "mitsuba").to_owned(),
        warm_up_frames: run_file.scenario.score.warm_up_frames,
        setup: setup.clone(),
    }
}
