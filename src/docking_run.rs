//! Simulate, process, score an approach: what the commands `run`, `render`, `process` and `score` do in the docking world.
//!
//! Fields are drawn in parallel, as video signals. They are digitised and processed one after the other, because a
//! pipeline may ask for another contrast and brightness of the digitiser, which is in force from the next field on: a
//! closed loop, which no number of threads can change.

use std::ops::Range;
use std::path::Path;

use contract::docking::{
    Digitiser, DockingOutcome, DockingPipelineFactory, DockingSetup, DockingSolution, Field, FieldTelemetry,
    NoPose,
};
use sim::docking::{DockingSimulator, DockingWorkspace, FieldExposure, FieldTruth};

use crate::failure::Failure;
use crate::files::docking::{
    FeatureRow, FieldMeasurementWriter, MotionWriter, SetupFile, outcome_as_filed, read_field_measurements,
    read_motion, report_as_filed, truth_as_filed,
};
use crate::files::{
    AviCoding, AviWriter, FieldRow, FieldSource, FieldTelemetryWriter, FileError, ImageFormat, PartialFiles,
    RunDirectory, TableReader, TableWriter, write_field,
};
use crate::flight::in_order;
use crate::run::{FirstFailure, Processed, write_score};
use crate::run_file::RunFile;
use crate::scenario::{DockingScenario, ScenarioSource};
use crate::score::docking::{DockingContext, DockingScore, DockingScorer, TrueField};

/// Which fields are made, on how many threads, and what is kept of their images.
#[derive(Debug, Clone)]
pub struct DockingFlight {
    /// The fields.
    pub fields: Range<u64>,
    /// Threads that draw fields; what is drawn does not depend on it.
    pub jobs: usize,
    /// Images to keep.
    pub images: Option<FieldImages>,
}

/// How images of fields are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldImages {
    /// One grey PNG a field.
    Png,
    /// One uncompressed AVI of whole frames, two fields each.
    Avi,
}

impl std::str::FromStr for FieldImages {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "png" => Ok(Self::Png),
            "avi" => Ok(Self::Avi),
            _ => Err(format!("`{text}` is no format of docking fields; expected png or avi")),
        }
    }
}

/// What a docking run gave.
#[derive(Debug)]
pub struct DockingRan {
    /// The score.
    pub score: DockingScore,
    /// The first failure of the pipeline, if it failed at all.
    pub first_failure: Option<FirstFailure>,
}

/// A docking scenario with its simulator, ready to fly.
pub struct PreparedDocking {
    simulator: DockingSimulator,
    run_file: RunFile<DockingScenario>,
}

impl PreparedDocking {
    /// Checks a scenario and prepares its simulator.
    ///
    /// # Errors
    /// A [`Failure`] with the place of the first value that is not allowed.
    pub fn new(source: &ScenarioSource) -> Result<Self, Failure> {
        let scenario = source.docking("docking")?;
        let simulator = source.docking_simulator(scenario)?;
        let run_file = RunFile::new(&source.name, scenario, None, None)?;
        Ok(Self { simulator, run_file })
    }

    /// Number of fields of the whole approach.
    pub fn field_count(&self) -> u64 {
        self.simulator.field_count()
    }

    /// The scenario.
    pub fn scenario(&self) -> &DockingScenario {
        &self.run_file.scenario
    }

    /// What a pipeline is told before the first field.
    pub fn setup(&self) -> DockingSetup {
        self.simulator.setup()
    }

    /// Makes fields, digitised as they are by default, and writes them as a dataset; `done` is told of each.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written.
    pub fn render(
        &self,
        directory: &RunDirectory,
        flight: &DockingFlight,
        done: impl Fn(),
    ) -> Result<(), Failure> {
        let mut dataset = FieldDataset::create(self, directory, flight)?;
        self.fly(flight, |exposure| {
            let telemetry = exposure.telemetry(Digitiser::default());
            dataset.add(&exposure.video.digitise(&telemetry.digitiser), telemetry, exposure.truth)?;
            done();
            Ok(())
        })?;
        dataset.finish()
    }

    /// Makes fields, has the pipeline process them and scores its answers; writes all of it; `done` is told of each field.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written or the pipeline cannot be built.
    pub fn run(
        &self,
        directory: &RunDirectory,
        flight: &DockingFlight,
        factory: &dyn DockingPipelineFactory,
        done: impl Fn(),
    ) -> Result<DockingRan, Failure> {
        let setup = self.setup();
        let mut dataset = FieldDataset::create(self, directory, flight)?;
        let mut pipeline = factory.build(&setup)?;
        let mut answers =
            Answers::create(&directory.measurements(), &directory.motion(), &directory.features())?;
        let mut scorer = DockingScorer::new(context(&self.run_file, &setup));
        let mut digitiser = Digitiser::default();
        self.fly(flight, |exposure| {
            let telemetry = exposure.telemetry(digitiser);
            let field = exposure.video.digitise(&digitiser);
            let outcome = pipeline.process(&field, &telemetry);
            // A wish that no digitiser has leaves it as it is.
            digitiser = outcome.digitiser.filter(|wish| wish.check().is_ok()).unwrap_or(digitiser);
            let answered = answers.add(field.number(), &outcome)?;
            let truth = truth_as_filed(exposure.truth);
            scorer.add(&true_field(&truth, &setup), Some(&answered)).map_err(unscorable)?;
            dataset.add(&field, telemetry, truth)?;
            done();
            Ok(())
        })?;
        dataset.finish()?;
        let first_failure = answers.finish()?;
        let score = scorer.finish();
        write_score(&directory.score(), &score)?;
        Ok(DockingRan { score, first_failure })
    }

    fn fly(
        &self,
        flight: &DockingFlight,
        take: impl FnMut(FieldExposure) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let workspace = || Ok(self.simulator.workspace()?);
        let make = |workspace: &mut DockingWorkspace, field| Ok(self.simulator.expose(workspace, field)?);
        in_order(flight.fields.clone(), flight.jobs, workspace, make, take)
    }
}

/// What a run and a rendered dataset have in common on disk: everything but answers and score.
struct FieldDataset<'a> {
    directory: &'a RunDirectory,
    telemetry: FieldTelemetryWriter,
    truth: TableWriter<FieldTruth>,
    images: Option<FieldImages>,
    video: Option<AviWriter>,
}

impl<'a> FieldDataset<'a> {
    fn create(
        prepared: &PreparedDocking,
        directory: &'a RunDirectory,
        flight: &DockingFlight,
    ) -> Result<Self, Failure> {
        prepared.run_file.write(&directory.run())?;
        let setup = prepared.setup();
        SetupFile::new(&setup, &prepared.scenario().docking).write(&directory.setup())?;
        let video = match (flight.images, setup.cameras.first()) {
            (Some(FieldImages::Avi), Some(camera)) => {
                let television = &prepared.scenario().television;
                Some(AviWriter::create(
                    &directory.video(),
                    AviCoding::Grey,
                    (camera.columns, camera.rows),
                    television.frame_rate_hz,
                )?)
            }
            _ => None,
        };
        Ok(Self {
            directory,
            telemetry: FieldTelemetryWriter::create(&directory.telemetry())?,
            truth: TableWriter::create(&directory.truth_fields())?,
            images: flight.images,
            video,
        })
    }

    fn add(&mut self, field: &Field, telemetry: FieldTelemetry, truth: FieldTruth) -> Result<(), FileError> {
        let number = field.number();
        let is_png = self.images == Some(FieldImages::Png);
        if is_png {
            write_field(&self.directory.frame(number, ImageFormat::Png), field)?;
        }
        if let Some(video) = &mut self.video {
            video.write(field)?;
        }
        self.telemetry.write(&FieldRow {
            field: number,
            file: is_png.then(|| RunDirectory::frame_name(number, ImageFormat::Png)),
            lines: field.lines(),
            telemetry,
        })?;
        self.truth.write([truth])
    }

    fn finish(self) -> Result<(), Failure> {
        self.telemetry.finish()?;
        self.truth.finish()?;
        self.video.map_or(Ok(()), AviWriter::finish)?;
        Ok(())
    }
}

/// The files of a pipeline's answers.
struct Answers {
    measurements: FieldMeasurementWriter,
    motion: MotionWriter,
    features: TableWriter<FeatureRow>,
    first_failure: Option<FirstFailure>,
}

impl Answers {
    fn create(measurements: &Path, motion: &Path, features: &Path) -> Result<Self, FileError> {
        Ok(Self {
            measurements: FieldMeasurementWriter::create(measurements)?,
            motion: MotionWriter::create(motion)?,
            features: TableWriter::create(features)?,
            first_failure: None,
        })
    }

    /// Writes an answer; what it gives back is the answer as it stands in the files.
    fn add(&mut self, field: u64, outcome: &DockingOutcome) -> Result<DockingOutcome, FileError> {
        if let DockingSolution::NoSolution(NoPose::Failed(reason)) = &outcome.solution
            && self.first_failure.is_none()
        {
            self.first_failure = Some(FirstFailure { frame: field, reason: reason.clone() });
        }
        self.measurements.write(field, outcome)?;
        if let Some(report) = &outcome.motion {
            self.motion.write(field, report)?;
        }
        self.features.write(FeatureRow::of(field, &outcome.features))?;
        let mut answered = outcome_as_filed(outcome);
        answered.motion = outcome.motion.as_ref().map(report_as_filed);
        Ok(answered)
    }

    fn finish(self) -> Result<Option<FirstFailure>, FileError> {
        self.measurements.finish()?;
        self.motion.finish()?;
        self.features.finish()?;
        Ok(self.first_failure)
    }
}

/// Has a pipeline process a sequence of fields, and writes its answers to `measurements`, with `motion.csv` and
/// `features.parquet` beside it. What the pipeline asks of the digitiser cannot be had of fields that are digitised.
///
/// # Errors
/// A [`Failure`] when a field cannot be read or a file not be written.
pub fn process_fields(
    fields: FieldSource,
    setup: &DockingSetup,
    factory: &dyn DockingPipelineFactory,
    measurements: &Path,
    done: impl Fn(),
) -> Result<Processed, Failure> {
    let motion = measurements.with_file_name("motion.csv");
    let features = measurements.with_file_name("features.parquet");
    // Under other names until all is done, so that a run that fails leaves nothing in the way of the next one.
    let partial = PartialFiles::of(&[measurements, &motion, &features])?;
    let mut pipeline = factory.build(setup)?;
    let mut answers = Answers::create(partial.path(0), partial.path(1), partial.path(2))?;
    let mut frames = 0;
    for field in fields {
        let (field, telemetry) = field?;
        answers.add(field.number(), &pipeline.process(&field, &telemetry))?;
        frames += 1;
        done();
    }
    let first_failure = answers.finish()?;
    partial.complete()?;
    Ok(Processed { frames, first_failure })
}

/// Scores measurements, somebody's or our own, against the truth in `directory`; `motion` holds what is said at the end of
/// portions, where anything is.
///
/// # Errors
/// A [`Failure`] for a file that cannot be read, or a row of a field that the truth does not have.
pub fn score_docking(
    directory: &Path,
    measurements: &Path,
    motion: Option<&Path>,
) -> Result<DockingScore, Failure> {
    let run_file = RunFile::<DockingScenario>::read(&directory.join("run.toml"))?;
    let setup = SetupFile::read(&directory.join("setup.toml"))?.setup();
    let mut scorer = DockingScorer::new(context(&run_file, &setup));
    let truths = TableReader::<FieldTruth>::open(&directory.join("truth/fields.parquet"))?;
    let mut answers = read_field_measurements(measurements)?.into_iter().peekable();
    let mut reports = motion.map(read_motion).transpose()?.unwrap_or_default().into_iter().peekable();
    let foreign = |path: &Path, field: u64| {
        Failure::Usage(format!(
            "{}: `field` is `{field}`, expected a field of {}",
            path.display(),
            directory.join("truth/fields.parquet").display()
        ))
    };
    // A report of a field that has no answer of its own is one of a pipeline that measured nothing in it.
    let reported = |report| DockingOutcome {
        motion: Some(report),
        ..DockingOutcome::none(NoPose::Failed("no row in the measurements".to_owned()))
    };
    for truth in truths {
        let (number, rows) = truth?;
        let mut outcome = answers.next_if(|(answered, _)| *answered == number).map(|(_, outcome)| outcome);
        if let Some((_, report)) = reports.next_if(|(reported, _)| *reported == number) {
            outcome = Some(match outcome {
                Some(outcome) => DockingOutcome { motion: Some(report), ..outcome },
                None => reported(report),
            });
        }
        for truth in &rows {
            scorer.add(&true_field(truth, &setup), outcome.as_ref()).map_err(unscorable)?;
        }
        if let Some((earlier, _)) = answers.peek().filter(|(earlier, _)| *earlier <= number) {
            return Err(foreign(measurements, *earlier));
        }
        if let (Some((earlier, _)), Some(path)) =
            (reports.peek().filter(|(earlier, _)| *earlier <= number), motion)
        {
            return Err(foreign(path, *earlier));
        }
    }
    match (answers.next(), reports.next(), motion) {
        (Some((field, _)), _, _) => Err(foreign(measurements, field)),
        (None, Some((field, _)), Some(path)) => Err(foreign(path, field)),
        _ => Ok(scorer.finish()),
    }
}

fn true_field(truth: &FieldTruth, setup: &DockingSetup) -> TrueField {
    let rows = setup.cameras.get(truth.camera).map_or(0, |camera| camera.rows);
    TrueField::new(truth, setup.target.marks.len(), rows)
}

fn context(run_file: &RunFile<DockingScenario>, setup: &DockingSetup) -> DockingContext {
    DockingContext {
        scenario: run_file.name.clone(),
        seed: run_file.scenario.seed,
        version: run_file.version.clone(),
        setup: setup.clone(),
    }
}

fn unscorable(error: crate::score::ScoreError) -> Failure {
    Failure::Usage(format!("the truth cannot be scored: {error}"))
}
