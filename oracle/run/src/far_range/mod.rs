//! The far range: star fields with a distant spacecraft.

pub mod answers;
pub mod dataset;
mod inject;
mod prepared;
pub mod star_list;

pub use prepared::{Prepared, SceneTruth};

use std::path::Path;

use contract::{FarRange, Frame, Outcome, Setup, Telemetry};
use files::{
    Expected, Failure, FrameCluster, ImageFormat, RunDirectory, TableReader, read_measurements,
    write_expected,
};
use indexmap::IndexMap;
use scenario::FarRangeScenario;
use scenario::run_file::RunFile;
use score::{Figure, Score, ScoreContext, ScoreError, Scored, UnitTable};
use sim::optics::Projection;
use sim::truth::{FrameTruth, ObjectTruth};

use self::answers::FrameAnswers;
use self::dataset::{FrameDataset, save_image};
use self::inject::InjectedPipeline;
use crate::by_number::ByNumber;
use crate::world::{self, Expectation, Flight, InformedPipeline, World, unscorable};

impl World for Prepared {
    type Interface = FarRange;
    type Images = ImageFormat;
    type Exposure = sim::Exposure;
    type Workspace<'a> = sim::SimulatedCamera<'a>;
    type Truth = SceneTruth;
    /// The camera controls its exposure time on its own.
    type Feedback = ();
    type Dataset<'a> = FrameDataset;
    type Answers = FrameAnswers;
    type Scorer<'a> = Scorer<'a>;
    type Scored = Scored;

    fn frame_count(&self) -> u64 {
        self.simulator.schedule().frame_count()
    }

    fn setup(&self) -> &Setup {
        &self.setup
    }

    fn exposure_bytes(&self) -> usize {
        let (columns, rows) = self.simulator.projection().detector();
        columns * rows * size_of::<u16>()
    }

    fn workspace(&self) -> Result<sim::SimulatedCamera<'_>, Failure> {
        Ok(self.simulator.camera()?)
    }

    fn expose(&self, camera: &mut sim::SimulatedCamera<'_>, frame: u64) -> Result<sim::Exposure, Failure> {
        Ok(camera.expose(frame)?)
    }

    fn receive(exposure: sim::Exposure, (): &()) -> (Frame, Telemetry, SceneTruth) {
        let sim::Exposure { frame, telemetry, truth, objects } = exposure;
        (frame, telemetry, SceneTruth { frame: truth, objects })
    }

    fn feedback((): (), _: &Outcome) {}

    fn save(
        &self,
        camera: &sim::SimulatedCamera<'_>,
        exposure: &sim::Exposure,
        directory: &RunDirectory,
        flight: &Flight<ImageFormat>,
    ) -> Result<(), Failure> {
        if let Some(format) = flight.images {
            save_image(directory, format, &self.simulator, &self.run_file, exposure)?;
        }
        if flight.expectation == Expectation::Kept {
            let image = camera.expected();
            let (columns, rows) = image.size();
            let electrons = image.iter().map(|electrons| electrons as f32).collect();
            let path = directory.expected(exposure.frame.number());
            write_expected(&path, &Expected { columns, rows, electrons })?;
        }
        Ok(())
    }

    fn reuse(camera: &mut sim::SimulatedCamera<'_>, frame: Frame) {
        camera.reuse(frame);
    }

    fn informed(&self) -> Result<Option<Box<dyn InformedPipeline<Self>>>, Failure> {
        let Some(stage) = self.run_file.inject else { return Ok(None) };
        let pipeline = InjectedPipeline::new(stage, &self.scenario().far_range, &self.setup)?;
        Ok(Some(Box::new(pipeline)))
    }

    fn dataset(
        &self,
        directory: &RunDirectory,
        flight: &Flight<ImageFormat>,
    ) -> Result<FrameDataset, Failure> {
        if flight.expectation == Expectation::Kept {
            directory.create_expected()?;
        }
        FrameDataset::create(directory, &self.run_file, &self.stars, self.star_epoch, flight.images)
    }

    fn scorer(&self) -> Scorer<'_> {
        Scorer(score::Scorer::new(context(&self.run_file, self.simulator.projection())))
    }

    fn score_files(
        directory: &Path,
        measurements: &Path,
        clusters: Option<&Path>,
    ) -> Result<Scored, Failure> {
        let run_file = RunFile::<FarRangeScenario>::read(&directory.join("run.toml"))?;
        let projection = Projection::new(&run_file.scenario.camera)?;
        let mut scorer = score::Scorer::new(context(&run_file, &projection));
        let truth = directory.join("truth/frames.parquet");
        let table = directory.join("truth/objects.parquet");
        let mut objects = TableReader::<ObjectTruth>::open(&table)?;
        let frames = TableReader::<FrameTruth>::open(&truth)?;
        let mut clusters = clusters.map(TableReader::<FrameCluster>::open).transpose()?;
        let mut answers = ByNumber::new(
            read_measurements(measurements, &run_file.scenario.camera)?,
            measurements,
            "frame",
            &truth,
        );
        for frame in frames {
            let (number, truths) = frame?;
            let objects = objects.rows_of(number)?;
            let mut outcome = answers.of(number)?;
            if let Some((outcome, table)) = outcome.as_mut().zip(clusters.as_mut()) {
                outcome.clusters = table.rows_of(number)?.into_iter().map(|row| row.cluster).collect();
            }
            for of_frame in &truths {
                scorer.add(of_frame, &objects, outcome.as_ref()).map_err(|error| {
                    let is_of_frames = matches!(
                        error,
                        ScoreError::Order { .. } | ScoreError::Impossible { field: "range_km", .. }
                    );
                    let path = if is_of_frames { &truth } else { &table };
                    Failure::Usage(format!("{}: {}", path.display(), unscorable(error)))
                })?;
            }
        }
        answers.end()?;
        Ok(scorer.finish())
    }
}

/// Judges the frames of a run.
pub struct Scorer<'a>(score::Scorer<'a>);

impl world::Scorer<Prepared> for Scorer<'_> {
    fn add(&mut self, truth: &SceneTruth, outcome: &Outcome) -> Result<(), Failure> {
        self.0.add(&truth.frame, &truth.objects, Some(outcome)).map_err(unscorable)?;
        Ok(())
    }

    fn finish(self) -> Scored {
        self.0.finish()
    }
}

impl world::Scored for Scored {
    type Score = Score;

    fn score(&self) -> &Score {
        &self.score
    }

    fn figures(&self) -> &IndexMap<String, Figure> {
        &self.score.figures
    }

    fn units(&self) -> UnitTable {
        UnitTable::of_frames(&self.verdicts)
    }
}

fn context<'a>(run_file: &RunFile, projection: &'a Projection) -> ScoreContext<'a> {
    ScoreContext {
        scenario: run_file.name.clone(),
        seed: run_file.scenario.seed,
        version: run_file.version.clone(),
        inject: run_file.inject.map(|stage| stage.to_string()),
        columns: run_file.scenario.camera.columns,
        rows: run_file.scenario.camera.rows,
        unproject: Box::new(|point| projection.unproject(point)),
    }
}
