//! Simulate, process, score an approach: what the commands `run`, `render`, `process` and `score` do in the docking world.
//!
//! Fields are drawn in parallel, as video signals. They are digitised and processed one after the other, because a
//! pipeline may ask for another contrast and brightness of the digitiser, which is in force from the next field on: a
//! closed loop, which no number of threads can change.

use std::ops::Range;
use std::path::Path;

use contract::docking::{Digitiser, Docking, DockingOutcome, DockingSetup, Field, FieldTelemetry};
use contract::{Camera, PipelineFactory};
use files::docking::{SetupFile, read_field_measurements, read_motion, truth_as_filed};
use files::{Failure, FieldSource, PartialFiles, RunDirectory, TableReader, Y4mWriter};
use scenario::run_file::RunFile;
use scenario::{DockingScenario, ScenarioSource};
use score::docking::{DockingContext, DockingScore, DockingScorer, TrueField};
use sim::docking::{DockingSimulator, DockingWorkspace, FieldExposure, FieldTruth};

use crate::docking_renderer::DockingRenderer;
use crate::docking_writer::{Answers, FieldDataset, FieldImages, answer_as_filed};
use crate::far_range_run::{FirstFailure, Processed, write_score};
use crate::flight::in_order;

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

/// What a docking run gave.
#[derive(Debug)]
pub struct DockingRan {
    /// The score.
    pub score: DockingScore,
    /// The first failure of the pipeline, if it failed at all.
    pub first_failure: Option<FirstFailure>,
}

/// A field of a run, and what the pipeline said about it.
#[derive(Debug)]
pub struct ProcessedField {
    /// The field, as it was digitised.
    pub field: Field,
    /// What the pipeline was told of it.
    pub telemetry: FieldTelemetry,
    /// The pipeline's answer.
    pub outcome: DockingOutcome,
    /// The truth about it.
    pub truth: FieldTruth,
}

/// A docking scenario with its simulator, ready to fly.
pub struct PreparedDocking {
    simulator: DockingSimulator,
    setup: DockingSetup,
    renderer: DockingRenderer,
    run_file: RunFile<DockingScenario>,
}

impl PreparedDocking {
    /// Checks a scenario and prepares its simulator.
    ///
    /// # Errors
    /// A [`Failure`] with the place of the first value that is not allowed.
    pub fn new(source: &ScenarioSource, renderer: DockingRenderer) -> Result<Self, Failure> {
        let scenario = source.docking("docking")?;
        let simulator = source.docking_simulator(scenario)?;
        let mut run_file = RunFile::new(&source.name, scenario, None, None)?;
        run_file.mitsuba = renderer.record().cloned();
        Ok(Self { setup: simulator.setup(), simulator, renderer, run_file })
    }

    /// Number of fields of the whole approach.
    pub fn field_count(&self) -> u64 {
        self.simulator.field_count()
    }

    /// What makes its fields, as the fast renderer draws them.
    pub fn simulator(&self) -> &DockingSimulator {
        &self.simulator
    }

    /// The scenario.
    pub fn scenario(&self) -> &DockingScenario {
        &self.run_file.scenario
    }

    /// Who draws the scene.
    pub fn renderer(&self) -> &DockingRenderer {
        &self.renderer
    }

    /// What a pipeline is told before the first field.
    pub fn setup(&self) -> &DockingSetup {
        &self.setup
    }

    /// Draws a field and forgets it: before anything is written, it shows whether the renderer can.
    ///
    /// # Errors
    /// A [`Failure`] when there is no such field, or the renderer gives no image.
    pub fn probe(&self, field: u64) -> Result<(), Failure> {
        let mut workspace = self.simulator.workspace()?;
        self.renderer.expose(&self.simulator, &self.setup, &mut workspace, field)?;
        Ok(())
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
        let mut dataset = FieldDataset::create(&self.run_file, &self.setup, directory, flight.images)?;
        self.fly(flight, |exposure| {
            let telemetry = exposure.telemetry(Digitiser::default());
            dataset.add(&exposure.video.digitise(&telemetry.digitiser), telemetry, exposure.truth)?;
            done();
            Ok(())
        })?;
        dataset.finish()?;
        Ok(directory.seal()?)
    }

    /// Makes fields, digitised as they are by default, and writes them to standard output as Y4M; `done` is told of each.
    ///
    /// # Errors
    /// A [`Failure`] when standard output cannot be written.
    pub fn stream(&self, flight: &DockingFlight, done: impl Fn()) -> Result<(), Failure> {
        let size = self.setup.cameras.first().map_or((0, 0), |camera| (camera.columns, camera.rows));
        let rate_hz = self.scenario().television.frame_rate_hz;
        let mut video = Y4mWriter::standard_output(size, rate_hz)?;
        self.fly(flight, |exposure| {
            video.write(&exposure.video.digitise(&Digitiser::default()))?;
            done();
            Ok(())
        })?;
        Ok(video.finish()?)
    }

    /// Makes fields, has the pipeline process them and scores its answers; writes all of it, as long as `go_on`, asked after each
    /// field, does not fail.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written or the pipeline cannot be built; what `go_on` says.
    pub fn run(
        &self,
        directory: &RunDirectory,
        flight: &DockingFlight,
        factory: &dyn PipelineFactory<Docking>,
        go_on: impl Fn() -> Result<(), Failure>,
    ) -> Result<DockingRan, Failure> {
        let setup = &self.setup;
        let mut dataset = FieldDataset::create(&self.run_file, setup, directory, flight.images)?;
        let mut answers =
            Answers::create(&directory.measurements(), &directory.motion(), &directory.features())?;
        let mut scorer = DockingScorer::new(context(&self.run_file, setup));
        self.follow(flight, factory, |processed| {
            let ProcessedField { field, telemetry, outcome, truth } = processed;
            let answered = answers.add(field.number(), &outcome)?;
            // The file gets the truth itself, and the score what comes back from the file.
            let filed = truth_as_filed(truth.clone());
            scorer.add(&true_field(&filed, setup), Some(&answered)).map_err(unscorable)?;
            dataset.add(&field, telemetry, truth)?;
            go_on()
        })?;
        dataset.finish()?;
        let first_failure = answers.finish()?;
        let score = scorer.finish();
        write_score(&directory.score(), &score)?;
        directory.seal()?;
        Ok(DockingRan { score, first_failure })
    }

    /// Makes fields, has a fresh pipeline process them, and hands each with its answer to `take`, in order, on the caller's
    /// thread. Nothing is written.
    ///
    /// # Errors
    /// A [`Failure`] when the pipeline cannot be built, and the first one of `take`.
    pub fn follow(
        &self,
        flight: &DockingFlight,
        factory: &dyn PipelineFactory<Docking>,
        mut take: impl FnMut(ProcessedField) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let mut pipeline = factory.build(&self.setup)?;
        let mut digitiser = Digitiser::default();
        self.fly(flight, |exposure| {
            let telemetry = exposure.telemetry(digitiser);
            let field = exposure.video.digitise(&digitiser);
            let outcome = pipeline.process(&field, &telemetry);
            // A wish that no digitiser has leaves it as it is.
            digitiser = outcome.digitiser.filter(|wish| wish.check().is_ok()).unwrap_or(digitiser);
            take(ProcessedField { field, telemetry, outcome, truth: exposure.truth })
        })
    }

    /// Makes fields on this thread, has the pipeline process them and judges its answers; nothing is written. What is given back beside
    /// the judgement is the first failure of the pipeline, if it failed at all.
    ///
    /// # Errors
    /// A [`Failure`] when the pipeline cannot be built.
    pub fn score(
        &self,
        fields: Range<u64>,
        factory: &dyn PipelineFactory<Docking>,
    ) -> Result<(DockingScorer, Option<FirstFailure>), Failure> {
        let mut pipeline = factory.build(&self.setup)?;
        let mut first_failure = None;
        let mut scorer = DockingScorer::new(context(&self.run_file, &self.setup));
        let mut workspace = self.simulator.workspace()?;
        let mut digitiser = Digitiser::default();
        for number in fields {
            let exposure = self.renderer.expose(&self.simulator, &self.setup, &mut workspace, number)?;
            let outcome =
                pipeline.process(&exposure.video.digitise(&digitiser), &exposure.telemetry(digitiser));
            first_failure = first_failure.or_else(|| FirstFailure::of_field(number, &outcome));
            digitiser = outcome.digitiser.filter(|wish| wish.check().is_ok()).unwrap_or(digitiser);
            // What the files of a run would give back, so that both have the same score to the bit.
            let truth = true_field(&truth_as_filed(exposure.truth), &self.setup);
            scorer.add(&truth, Some(&answer_as_filed(&outcome))).map_err(unscorable)?;
        }
        Ok((scorer, first_failure))
    }

    fn fly(
        &self,
        flight: &DockingFlight,
        take: impl FnMut(FieldExposure) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let workspace = || Ok(self.simulator.workspace()?);
        let make = |workspace: &mut DockingWorkspace, field| {
            self.renderer.expose(&self.simulator, &self.setup, workspace, field)
        };
        // A video signal is kept as f32; a progressive field is a whole frame.
        let frame = |camera: &Camera| camera.columns * camera.rows * size_of::<f32>();
        let bytes = self.setup.cameras.first().map_or(0, frame)
            / self.scenario().television.interlace.lines(0).step();
        in_order(flight.fields.clone(), flight.jobs, bytes as u64, workspace, make, take)
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
    factory: &dyn PipelineFactory<Docking>,
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

/// Has a pipeline process a sequence of fields, and writes its measurements to standard output, each as soon as it is there.
///
/// # Errors
/// A [`Failure`] when a field cannot be read or standard output not be written.
pub fn stream_fields(
    fields: FieldSource,
    setup: &DockingSetup,
    factory: &dyn PipelineFactory<Docking>,
) -> Result<Processed, Failure> {
    let mut pipeline = factory.build(setup)?;
    let mut answers = Answers::stream()?;
    let mut frames = 0;
    for field in fields {
        let (field, telemetry) = field?;
        answers.add(field.number(), &pipeline.process(&field, &telemetry))?;
        frames += 1;
    }
    Ok(Processed { frames, first_failure: answers.finish()? })
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
    Ok(judge_docking(directory, measurements, motion)?.finish())
}

/// [`score_docking`], as far as the verdicts on the fields.
///
/// # Errors
/// As [`score_docking`].
pub fn judge_docking(
    directory: &Path,
    measurements: &Path,
    motion: Option<&Path>,
) -> Result<DockingScorer, Failure> {
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
    for truth in truths {
        let (number, rows) = truth?;
        let outcome = answers.next_if(|(answered, _)| *answered == number).map(|(_, outcome)| outcome);
        let report = reports.next_if(|(reported, _)| *reported == number).map(|(_, report)| report);
        for truth in &rows {
            let truth = true_field(truth, &setup);
            scorer.add_with_report(&truth, outcome.as_ref(), report.as_ref()).map_err(unscorable)?;
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
        _ => Ok(scorer),
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
        renderer: run_file.mitsuba.as_ref().map_or("fast", |_| "mitsuba").to_owned(),
        setup: setup.clone(),
    }
}

fn unscorable(error: score::ScoreError) -> Failure {
    Failure::Usage(format!("the truth cannot be scored: {error}"))
}
