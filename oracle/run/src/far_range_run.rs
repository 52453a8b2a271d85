//! Simulate, process, score: what the commands `run`, `render`, `process` and `score` do.

use std::ops::Range;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use contract::docking::{DockingOutcome, DockingSolution, NoPose};
use contract::{FarRange, Frame, NoSolution, Outcome, Pipeline, PipelineFactory, Setup, Solution};
use files::{
    Dataset, Expected, Failure, FileError, FrameCluster, ImageFormat, MeasurementWriter, PartialFiles,
    RunDirectory, StarRow, TableReader, TableWriter, WholeFile, read_measurements, write_expected,
};
use hifitime::Epoch;
use scenario::run_file::RunFile;
use scenario::{FarRangeScenario, ScenarioSource, Stage};
use score::{ScoreContext, Scored, Scorer};
use sim::Simulator;
use sim::truth::{FrameTruth, ObjectTruth};

use crate::dataset_writer::{DatasetWriter, save_image};
use crate::flight::fly;
use crate::inject::InjectedPipeline;
use crate::star_list::star_list;

/// Which frames are made, on how many threads, and whether their images are kept.
#[derive(Debug, Clone)]
pub struct Flight {
    /// The frames.
    pub frames: Range<u64>,
    /// Threads that make frames; what is made does not depend on it.
    pub jobs: usize,
    /// Images to keep.
    pub images: Option<ImageFormat>,
    /// Whether the noise-free expectation of every frame is kept with the truth.
    pub expectation: Expectation,
}

/// What becomes of the noise-free expectation of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Expectation {
    /// Written to `truth/expected/`, electrons, EXR.
    Kept,
    /// Dropped.
    Dropped,
}

/// What a run gave.
#[derive(Debug)]
pub struct Ran {
    /// Score and verdicts.
    pub scored: Scored,
    /// The first failure of the pipeline, if it failed at all.
    pub first_failure: Option<FirstFailure>,
}

/// A scenario with its simulator and star list, ready to fly.
pub struct Prepared {
    simulator: Simulator,
    run_file: RunFile,
    stars: Vec<StarRow>,
    star_epoch: Epoch,
}

impl Prepared {
    /// Checks a scenario and prepares its simulator.
    ///
    /// # Errors
    /// A [`Failure`] with the place of the first value that is not allowed.
    pub fn new(source: &ScenarioSource) -> Result<Self, Failure> {
        Self::with_truth_for(source, None)
    }

    /// [`Prepared::new`], for a run of the built-in pipeline in which the truth stands in the place of a stage's result.
    ///
    /// # Errors
    /// As [`Prepared::new`]; [`Failure::Usage`] for the regions of interest of a scenario that has none.
    pub fn with_truth_for(source: &ScenarioSource, inject: Option<Stage>) -> Result<Self, Failure> {
        let mut scenario = source.far_range("far range")?.clone();
        if inject == Some(Stage::Roi) && scenario.roi.take().is_none() {
            return Err(Failure::Usage(format!(
                "--inject is roi, expected a scenario with regions of interest: `{}` has no [roi]",
                source.name
            )));
        }
        let simulator = source.simulator(&scenario)?;
        let run_file = RunFile::new(&source.name, &scenario, Some(simulator.catalog().sha256()), inject)?;
        let (_, star_epoch) = simulator
            .schedule()
            .frame(0)
            .ok_or_else(|| Failure::Usage(format!("scenario `{}` has no frame", source.name)))?;
        let stars = star_list(simulator.catalog(), scenario.star_list.magnitude_limit, star_epoch);
        Ok(Self { simulator, run_file, stars, star_epoch })
    }

    /// Number of frames of the whole scenario.
    pub fn frame_count(&self) -> u64 {
        self.simulator.schedule().frame_count()
    }

    /// The scenario.
    pub fn scenario(&self) -> &FarRangeScenario {
        &self.run_file.scenario
    }

    /// What makes its frames.
    pub fn simulator(&self) -> &Simulator {
        &self.simulator
    }

    /// What a pipeline is told before the first frame.
    pub fn setup(&self) -> Setup {
        let scenario = self.scenario();
        Setup {
            camera: scenario.camera.clone(),
            camera_from_body: scenario.mounting.nominal.camera_from_body(),
            bit_depth: scenario.sensor.bit_depth,
            readout: Some(scenario.readout()),
            zero_suppression_dn: scenario.zero_suppression_dn,
            stars: self.stars.iter().map(StarRow::listed).collect(),
        }
    }

    /// Makes frames and writes them as a dataset; `done` is told of each.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written.
    pub fn render(&self, directory: &RunDirectory, flight: &Flight, done: impl Fn()) -> Result<(), Failure> {
        let mut dataset = self.dataset(directory, flight)?;
        self.fly(directory, flight, |exposure| {
            let frame = dataset.add(exposure)?;
            done();
            Ok(frame)
        })?;
        dataset.finish()?;
        Ok(directory.seal()?)
    }

    /// Makes frames, has the pipeline process them and scores its answers; writes all of it, as long as `go_on`, asked after each
    /// frame, does not fail. A scenario is one sequence: the pipeline is built once. With the truth for a stage, the pipeline is the
    /// built-in one, whatever `factory` builds.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written or the pipeline cannot be built; what `go_on` says.
    pub fn run(
        &self,
        directory: &RunDirectory,
        flight: &Flight,
        factory: &dyn PipelineFactory<FarRange>,
        go_on: impl Fn() -> Result<(), Failure>,
    ) -> Result<Ran, Failure> {
        let mut dataset = self.dataset(directory, flight)?;
        let setup = self.setup();
        let mut pipeline = match self.run_file.inject {
            None => RunningPipeline::Own(factory.build(&setup)?),
            Some(stage) => RunningPipeline::Injected(Box::new(InjectedPipeline::new(
                stage,
                &self.scenario().far_range,
                &setup,
            )?)),
        };
        let mut answers = Answers::create(&directory.measurements(), &directory.clusters())?;
        let unproject = |point| self.simulator.projection().unproject(point);
        let mut scorer = Scorer::new(context(&self.run_file, &unproject));
        self.fly(directory, flight, |exposure| {
            let outcome = match &mut pipeline {
                RunningPipeline::Own(pipeline) => pipeline.process(&exposure.frame, &exposure.telemetry),
                RunningPipeline::Injected(pipeline) => pipeline.answer(&exposure)?,
            };
            answers.add(exposure.frame.number(), &outcome)?;
            scorer.add(&exposure.truth, &exposure.objects, Some(&outcome)).map_err(unscorable)?;
            let frame = dataset.add(exposure)?;
            go_on().map(|()| frame)
        })?;
        dataset.finish()?;
        let first_failure = answers.finish()?;
        let scored = scorer.finish();
        write_score(&directory.score(), &scored.score)?;
        directory.seal()?;
        Ok(Ran { scored, first_failure })
    }

    /// Makes frames on `jobs` threads, has a fresh pipeline process them, and hands each with its answer to `take`, in order, on
    /// the caller's thread. Nothing is written.
    ///
    /// # Errors
    /// A [`Failure`] when the pipeline cannot be built, and the first one of `take`.
    pub fn follow(
        &self,
        frames: Range<u64>,
        jobs: usize,
        factory: &dyn PipelineFactory<FarRange>,
        mut take: impl FnMut(sim::Exposure, Outcome) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let mut pipeline = factory.build(&self.setup())?;
        let make = |camera: &mut sim::SimulatedCamera<'_>, frame| Ok(camera.expose(frame)?);
        fly(&self.simulator, frames, jobs, make, |exposure| {
            let outcome = pipeline.process(&exposure.frame, &exposure.telemetry);
            take(exposure, outcome)
        })
    }

    /// Makes frames on this thread, has the pipeline process them and scores its answers; nothing is written.
    ///
    /// # Errors
    /// A [`Failure`] when the pipeline cannot be built.
    pub fn score(&self, frames: Range<u64>, factory: &dyn PipelineFactory<FarRange>) -> Result<Ran, Failure> {
        let mut pipeline = factory.build(&self.setup())?;
        let mut first_failure = None;
        let unproject = |point| self.simulator.projection().unproject(point);
        let mut scorer = Scorer::new(context(&self.run_file, &unproject));
        let mut camera = self.simulator.camera()?;
        for frame in frames {
            let exposure = camera.expose(frame)?;
            let outcome = pipeline.process(&exposure.frame, &exposure.telemetry);
            first_failure = first_failure.or_else(|| FirstFailure::of(frame, &outcome));
            scorer.add(&exposure.truth, &exposure.objects, Some(&outcome)).map_err(unscorable)?;
            camera.reuse(exposure.frame);
        }
        Ok(Ran { scored: scorer.finish(), first_failure })
    }

    fn dataset(&self, directory: &RunDirectory, flight: &Flight) -> Result<DatasetWriter, Failure> {
        if flight.expectation == Expectation::Kept {
            directory.create_expected()?;
        }
        DatasetWriter::create(directory, &self.run_file, &self.stars, self.star_epoch, flight.images)
    }

    /// Makes frames and hands them to `take`, which gives back their images: later ones are made in their memory.
    fn fly(
        &self,
        directory: &RunDirectory,
        flight: &Flight,
        mut take: impl FnMut(sim::Exposure) -> Result<Frame, Failure>,
    ) -> Result<(), Failure> {
        let spare = Mutex::new(Vec::new());
        let spares = || spare.lock().unwrap_or_else(PoisonError::into_inner);
        let make = |camera: &mut sim::SimulatedCamera<'_>, frame| {
            let reused = spares().pop();
            reused.into_iter().for_each(|frame| camera.reuse(frame));
            let exposure = camera.expose(frame)?;
            if let Some(format) = flight.images {
                save_image(directory, format, &self.simulator, &self.run_file, &exposure)?;
            }
            if flight.expectation == Expectation::Kept {
                let image = camera.expected();
                let (columns, rows) = image.size();
                let electrons = image.iter().map(|electrons| electrons as f32).collect();
                write_expected(&directory.expected(frame), &Expected { columns, rows, electrons })?;
            }
            Ok(exposure)
        };
        fly(&self.simulator, flight.frames.clone(), flight.jobs, make, |exposure| {
            spares().push(take(exposure)?);
            Ok(())
        })
    }
}

/// Has a pipeline process a dataset, real images included, and writes its answers to `measurements`, with its
/// clusters beside them.
///
/// # Errors
/// A [`Failure`] when an image cannot be read or a file not be written.
pub fn process(
    dataset: &Dataset,
    setup: &Setup,
    factory: &dyn PipelineFactory<FarRange>,
    measurements: &Path,
    clusters: &Path,
    done: impl Fn(),
) -> Result<Processed, Failure> {
    // Under other names until all is done, so that a run that fails leaves nothing in the way of the next one.
    let partial = PartialFiles::of(&[measurements, clusters])?;
    let mut pipeline = factory.build(setup)?;
    let mut answers = Answers::create(partial.path(0), partial.path(1))?;
    for frame in dataset.frames() {
        let image = dataset.read(frame)?;
        answers.add(image.number(), &pipeline.process(&image, frame.telemetry()))?;
        done();
    }
    let first_failure = answers.finish()?;
    partial.complete()?;
    Ok(Processed { frames: dataset.frames().len() as u64, first_failure })
}

/// What [`process`] did.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Processed {
    /// Frames answered.
    pub frames: u64,
    /// The first failure of the pipeline, if it failed at all.
    pub first_failure: Option<FirstFailure>,
}

/// The first frame that a pipeline failed at, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FirstFailure {
    /// Number of the frame.
    pub frame: u64,
    /// The reason.
    pub reason: String,
}

impl FirstFailure {
    /// That of a frame, if the pipeline itself failed at it.
    fn of(frame: u64, outcome: &Outcome) -> Option<Self> {
        match &outcome.solution {
            Solution::NoSolution(NoSolution::Failed(reason)) => Some(Self { frame, reason: reason.clone() }),
            _ => None,
        }
    }

    /// That of a field, if the pipeline itself failed at it.
    pub(crate) fn of_field(frame: u64, outcome: &DockingOutcome) -> Option<Self> {
        match &outcome.solution {
            DockingSolution::NoSolution(NoPose::Failed(reason)) => {
                Some(Self { frame, reason: reason.clone() })
            }
            _ => None,
        }
    }
}

/// Scores measurements, somebody's or our own, against the truth in `directory`. Clusters are evidence for the causes
/// of misses, where there are any.
///
/// # Errors
/// A [`Failure`] for a file that cannot be read, or a measurement of a frame that the truth does not have.
pub fn score(directory: &Path, measurements: &Path, clusters: Option<&Path>) -> Result<Scored, Failure> {
    let run_file = RunFile::<FarRangeScenario>::read(&directory.join("run.toml"))?;
    let projection = sim::optics::Projection::new(&run_file.scenario.camera)?;
    let unproject = |point| projection.unproject(point);
    let mut scorer = Scorer::new(context(&run_file, &unproject));

    let mut objects = TableReader::<ObjectTruth>::open(&directory.join("truth/objects.parquet"))?;
    let frames = TableReader::<FrameTruth>::open(&directory.join("truth/frames.parquet"))?;
    let mut clusters = clusters.map(TableReader::<FrameCluster>::open).transpose()?;
    let mut answers = read_measurements(measurements)?.into_iter().peekable();
    for frame in frames {
        let (number, truths) = frame?;
        let objects = objects.rows_of(number)?;
        let answer = answers.next_if(|(answered, _)| *answered == number);
        let outcome = match (answer, &mut clusters) {
            (Some((_, mut outcome)), Some(table)) => {
                outcome.clusters = table.rows_of(number)?.into_iter().map(|row| row.cluster).collect();
                Some(outcome)
            }
            (answer, _) => answer.map(|(_, outcome)| outcome),
        };
        for truth in &truths {
            scorer.add(truth, &objects, outcome.as_ref()).map_err(unscorable)?;
        }
        if let Some((earlier, _)) = answers.peek()
            && *earlier <= number
        {
            return Err(foreign_frame(measurements, *earlier, directory));
        }
    }
    match answers.next() {
        Some((frame, _)) => Err(foreign_frame(measurements, frame, directory)),
        None => Ok(scorer.finish()),
    }
}

fn foreign_frame(measurements: &Path, frame: u64, directory: &Path) -> Failure {
    Failure::Usage(format!(
        "{}: `frame` is `{frame}`, expected a frame of {}",
        measurements.display(),
        directory.join("truth/frames.parquet").display()
    ))
}

fn unscorable(error: score::ScoreError) -> Failure {
    Failure::Usage(format!("the truth cannot be scored: {error}"))
}

/// The pipeline of a run.
enum RunningPipeline {
    /// It answers by itself.
    Own(Box<dyn Pipeline<FarRange>>),
    /// It is told the truth for one stage.
    Injected(Box<InjectedPipeline>),
}

/// The files of a pipeline's answers.
struct Answers {
    measurements: MeasurementWriter,
    clusters: TableWriter<FrameCluster>,
    first_failure: Option<FirstFailure>,
}

impl Answers {
    fn create(measurements: &Path, clusters: &Path) -> Result<Self, FileError> {
        Ok(Self {
            measurements: MeasurementWriter::create(measurements)?,
            clusters: TableWriter::create(clusters)?,
            first_failure: None,
        })
    }

    fn add(&mut self, frame: u64, outcome: &Outcome) -> Result<(), FileError> {
        self.first_failure = self.first_failure.take().or_else(|| FirstFailure::of(frame, outcome));
        self.measurements.write(frame, outcome)?;
        self.clusters.write(outcome.clusters.iter().map(|&cluster| FrameCluster { frame, cluster }))
    }

    fn finish(self) -> Result<Option<FirstFailure>, FileError> {
        // The measurements last: without them, nobody misses the clusters.
        self.clusters.finish()?;
        self.measurements.finish()?;
        Ok(self.first_failure)
    }
}

fn context<'a>(run_file: &RunFile, unproject: score::Unproject<'a>) -> ScoreContext<'a> {
    ScoreContext {
        scenario: run_file.name.clone(),
        seed: run_file.scenario.seed,
        version: run_file.version.clone(),
        inject: run_file.inject.map(|stage| stage.to_string()),
        columns: run_file.scenario.camera.columns,
        rows: run_file.scenario.camera.rows,
        unproject,
    }
}

pub(crate) fn write_score(path: &Path, score: &impl serde::Serialize) -> Result<(), Failure> {
    let json = serde_json::to_string_pretty(score)
        .map_err(|error| Failure::Usage(format!("the score cannot be written as JSON: {error}")))?
        + "\n";
    Ok(WholeFile::with_text(path, &json)?.commit_new()?)
}
