//! Far range: star fields with a distant spacecraft.

mod answers;
mod dataset;
mod inject;
mod mission;
pub(crate) mod star_list;

use crate::rows::{FrameTruthRow, ObjectTruthRow};
use crate::scoring::unit_table;
pub use mission::{FarRangeMission, SceneTruth, simulator};

use std::fmt::Debug;
use std::path::Path;

use contract::{
    Body, CameraFrame, FarRange, Frame, Icrs, Outcome, PipelineFactory, Rotation, Setup, Telemetry,
};
use files::{
    ExpectedImage, Failure, FrameHeader, ImageFormat, RunDirectory, TableReader, write_expected, write_frame,
};
use indexmap::IndexMap;
use pipeline::far_range::{FarRangeConfig, FarRangeFactory, Mode};
use run::RowsByNumber;
use run::any_world::{Options, ScenarioSource};
use run::check::{FieldOfView, size};
use run::frame_jobs::{Expectation, FrameJobs};
use run::world::{self, InformedPipeline, OpenDataset, World, unscorable};
use scenario::AttitudeChoice;
use scenario::run_file::RunFile;
use score::{Figure, FigureSpec, ScoreError, UnitTable};
use serde_json::{Value, json};
use sim::Simulator;
use sim::catalog::Catalog;
use sim::onboard::image_bytes;
use sim::optics::Projection;
use sim::truth::ObjectTruth;

use self::answers::FrameAnswers;
use self::dataset::{FrameDataset, save_image};
use self::inject::InjectedPipeline;
use self::star_list::star_list;
use crate::rows::{
    Dataset, FrameCluster, StarRow, TelemetryRow, outcome_as_filed, read_measurements, read_stars,
    read_telemetry,
};
use crate::scenario::{FarRangeScenario, is_argon};
use crate::scoring::{
    ARGON_TABLE_2, Cause, FarRangeJudgement, GrantedAttitude, Score, ScoreContext, WithinLimits, names,
};

/// Signal-to-noise ratio of the faintest star that a check reports.
const LIMITING_SNR: f64 = 5.0;

/// Size of a 16-bit FITS file, bytes, including a header of about three blocks.
fn fits_bytes(columns: usize, rows: usize) -> u64 {
    const BLOCK: u64 = 2880;
    ((columns * rows * size_of::<u16>()) as u64).div_ceil(BLOCK) * BLOCK + 3 * BLOCK
}

/// Relative speed above which chaser and target pass each other, km/s.
const PASSING_KM_S: f64 = 1.0;

/// Returns a remark on spacecraft that pass each other at the first frame: their orbits are unrelated, or one
/// velocity has the wrong sign.
fn passing_speed(simulator: &Simulator) -> Option<String> {
    let (_, time) = simulator.schedule().frame(0)?;
    let states = simulator.trajectory().states_at(time);
    let speed_km_s = (states.target.velocity_km_s - states.chaser.velocity_km_s).norm();
    (speed_km_s > PASSING_KM_S).then(|| {
        format!(
            "trajectory: at the first frame chaser and target pass each other at {speed_km_s:.3} km/s, {:.3} km \
             apart; a velocity with the wrong sign, or two unrelated orbits?",
            states.range_km()
        )
    })
}

impl World for FarRangeMission {
    const STARTING_POINT: &'static str = crate::STARTING_POINT;
    const SETUP_FILE: &'static str = "camera.toml";
    const TRUTH_FILE: &'static str = "truth/frames.parquet";
    const EVIDENCE_FILE: Option<&'static str> = Some("clusters.parquet");
    const HEADLINE: &'static str = names::CORRECT_RATE;
    const IMAGES: ImageFormat = ImageFormat::Fits;
    const PICTURES: &'static str = "png";

    type Scenario = FarRangeScenario;
    type Config = FarRangeConfig;
    type Interface = FarRange;
    type Images = ImageFormat;
    type Exposure = sim::Exposure;
    type Workspace<'a> = sim::SimulatedCamera<'a>;
    type Truth = SceneTruth;
    /// No feedback: the camera controls its exposure time without the pipeline.
    type State = ();
    type Dataset<'a> = FrameDataset;
    type Answers = FrameAnswers;
    type Scorer<'a> = Scorer<'a>;
    type Judgement = FarRangeJudgement;

    fn prepare(source: &ScenarioSource, _: &FarRangeScenario, options: Options) -> Result<Self, Failure> {
        if let Some(renderer) = options.renderer.word() {
            let message = format!("--renderer {renderer} requires a docking scenario");
            return Err(Failure::Usage(message));
        }
        Self::with_options(source, options.inject, options.attitude)
    }

    fn run_file(&self) -> &RunFile<FarRangeScenario> {
        &self.run_file
    }

    fn summary(&self) -> (Value, String) {
        let (scenario, name) = (self.scenario(), &self.run_file.name);
        let (frames, stars) = (self.frame_count(), self.simulator.catalog().stars().len());
        let bit_depth = scenario.sensor.bit_depth;
        let image = image_bytes(scenario.camera.columns, scenario.camera.rows, bit_depth);
        let (budget, telemetry) = match &scenario.roi {
            None => (image, format!("whole images: {image} bytes of telemetry per frame")),
            Some(roi) => {
                let budget = roi.budget_bytes(bit_depth);
                let regions = format!("{} regions of {} × {} pixels", roi.count, roi.columns, roi.rows);
                (
                    budget,
                    format!(
                        "{regions}: at most {budget} bytes of telemetry per frame (whole image: {image})"
                    ),
                )
            }
        };
        let simulator = &self.simulator;
        let view = FieldOfView::from_projection(simulator.projection());
        let [shortest_s, longest_s] = simulator.exposures_s();
        let limit = simulator.limiting_magnitude(longest_s, LIMITING_SNR);
        let duration_s = simulator.schedule().ends().map_or(0.0, |[first, last]| (last - first).to_seconds());
        let file = fits_bytes(scenario.camera.columns, scenario.camera.rows);
        let document = json!({
            "scenario": name,
            "ok": true,
            "frames": frames,
            "stars": stars,
            "frame_bytes_at_most": budget,
            "whole_image_bytes": image,
            "field_deg": view.field_deg,
            "pixel_arcsec": view.pixel_arcsec,
            "exposure_s": [shortest_s, longest_s],
            "limiting_magnitude": limit,
            "duration_s": duration_s,
            "fits_bytes": file,
        });
        let limit = match limit {
            Some(limit) => format!(
                "the faintest star with SNR {LIMITING_SNR} in the longest exposure has V = {limit:.2}"
            ),
            None => format!("no star has SNR {LIMITING_SNR} in the longest exposure"),
        };
        let text = format!(
            "{name}: {frames} frames, {stars} stars, no mistake found\n{telemetry}\n{}\n\
             exposures of {shortest_s} s to {longest_s} s; {limit}\n\
             {frames} frames in {duration_s:.0} s; as FITS {} each, {} in total",
            view.text(),
            size(file),
            size(file.saturating_mul(frames)),
        );
        (document, text)
    }

    fn warnings(&self) -> Vec<String> {
        let beyond = dataset::sip_reach_px(&self.simulator, &self.scenario().camera).map(|reach_px| {
            format!(
                "camera.radial, camera.tangential: no SIP polynomial fits the distortion beyond \
                 {reach_px:.0} px from the principal point; FITS files are written without world coordinates"
            )
        });
        let mut warnings: Vec<String> = beyond.into_iter().collect();
        warnings.extend(self.scenario().motion_remarks());
        warnings.extend(passing_speed(&self.simulator));
        warnings
    }

    fn config(scenario: &FarRangeScenario) -> &FarRangeConfig {
        &scenario.far_range
    }

    fn built_in(config: &FarRangeConfig) -> Result<Box<dyn PipelineFactory<FarRange> + Send>, Failure> {
        let factory = FarRangeFactory::new(config.clone());
        Ok(Box::new(factory.map_err(|error| Failure::Usage(error.to_string()))?))
    }

    fn check_built_in(source: &ScenarioSource, scenario: &FarRangeScenario) -> Result<(), Failure> {
        let (floor_dn, bit_depth) = (scenario.zero_suppression_dn, scenario.sensor.bit_depth);
        source.check_part(Self::CODE, scenario.far_range.check_suppression(floor_dn, bit_depth))
    }

    /// Writes FITS with only the telemetry in its header.
    fn write_image(frame: &Frame, telemetry: &Telemetry, path: &Path) -> Result<(), String> {
        let header = FrameHeader {
            time: telemetry.time,
            exposure_s: telemetry.exposure_s,
            gain_e_per_dn: None,
            seed: 0,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            configuration_hash: String::new(),
            observer_velocity_km_s: None,
            wcs: None,
        };
        write_frame(path, ImageFormat::Fits, frame, &header).map_err(|error| error.to_string())
    }

    fn files_for_pipelines(_: ImageFormat) -> String {
        "camera.toml, stars.csv, telemetry.csv, frames/".to_owned()
    }

    fn open(directory: &Path) -> Result<OpenDataset<Self>, Failure> {
        let dataset = Dataset::open(directory)?;
        let (setup, config) = (setup_of(directory, &dataset)?, dataset.camera().far_range.clone());
        let frames = dataset.frames().to_vec();
        let count = Some(frames.len() as u64);
        let images = frames.into_iter().map(move |frame| Ok((dataset.read(&frame)?, *frame.telemetry())));
        Ok(OpenDataset { setup, config, count, images: Box::new(images) })
    }

    fn telemetry_rows(directory: &Path, add: &mut dyn FnMut(&dyn Debug)) -> Result<(), Failure> {
        for TelemetryRow { frame, telemetry, windows, .. } in
            read_telemetry(&directory.join("telemetry.csv"))?
        {
            add(&(frame, telemetry, windows));
        }
        Ok(())
    }

    fn figures() -> Vec<FigureSpec> {
        crate::scoring::figures()
    }

    fn causes() -> Vec<(&'static str, &'static str)> {
        let of = |verdict| Cause::ALL.map(|cause| (verdict, cause.code()));
        [of("missed"), of("wrong")].concat()
    }

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

    fn expose(
        &self,
        camera: &mut sim::SimulatedCamera<'_>,
        frame: u64,
        (): &(),
    ) -> Result<sim::Exposure, Failure> {
        Ok(camera.expose(frame)?)
    }

    fn receive(exposure: sim::Exposure, (): &()) -> (Frame, Telemetry, SceneTruth) {
        let sim::Exposure { frame, telemetry, truth, objects } = exposure;
        (frame, telemetry, SceneTruth { frame: truth, objects })
    }

    fn save(
        &self,
        camera: &sim::SimulatedCamera<'_>,
        exposure: &sim::Exposure,
        directory: &RunDirectory,
        frame_jobs: &FrameJobs<ImageFormat>,
    ) -> Result<(), Failure> {
        if let Some(format) = frame_jobs.images {
            save_image(directory, format, &self.simulator, &self.run_file, exposure)?;
        }
        if frame_jobs.expectation == Expectation::Kept {
            let image = camera.expected();
            let (columns, rows) = image.size();
            let electrons = image.iter().map(|electrons| electrons as f32).collect();
            let path = directory.expected(exposure.frame.number());
            write_expected(&path, &ExpectedImage { columns, rows, electrons })?;
        }
        Ok(())
    }

    fn reuse(camera: &mut sim::SimulatedCamera<'_>, frame: Frame) {
        camera.reuse(frame);
    }

    /// Returns the best mode for comparison with the paper's mode on ARGON; there the paper's published
    /// figures are shown too.
    fn comparison_pipeline(&self) -> Result<Option<Box<dyn PipelineFactory<FarRange> + Send>>, Failure> {
        let scenario = self.scenario();
        let is_papers = scenario.far_range.mode == Mode::Paper && self.run_file.inject.is_none();
        let best = FarRangeConfig { mode: Mode::Best, ..scenario.far_range.clone() };
        let is_possible =
            best.check_suppression(scenario.zero_suppression_dn, scenario.sensor.bit_depth).is_ok();
        (is_papers && is_argon(scenario) && is_possible).then(|| Self::built_in(&best)).transpose()
    }

    fn informed_pipeline(&self) -> Result<Option<Box<dyn InformedPipeline<Self>>>, Failure> {
        let Some(stage) = self.run_file.inject else { return Ok(None) };
        let pipeline = InjectedPipeline::new(stage, &self.scenario().far_range, &self.setup)?;
        Ok(Some(Box::new(pipeline)))
    }

    fn dataset(
        &self,
        directory: &RunDirectory,
        frame_jobs: &FrameJobs<ImageFormat>,
    ) -> Result<FrameDataset, Failure> {
        if frame_jobs.expectation == Expectation::Kept {
            directory.create_expected()?;
        }
        FrameDataset::create(
            directory,
            &self.run_file,
            &self.stars,
            self.star_epoch,
            self.simulator.trajectory().manoeuvres(),
            frame_jobs.images,
        )
    }

    fn scorer(&self) -> Scorer<'_> {
        Scorer::new(&self.run_file, self.simulator.projection())
    }

    fn score_files(
        directory: &Path,
        measurements: &Path,
        clusters: Option<&Path>,
        attitude: Option<AttitudeChoice>,
    ) -> Result<FarRangeJudgement, Failure> {
        let mut run_file = RunFile::<FarRangeScenario>::read(&directory.join("run.toml"))?;
        run_file.scenario.score.attitude = attitude.or(run_file.scenario.score.attitude);
        let projection = Projection::new(&run_file.scenario.camera)?;
        let mut scorer = Scorer::new(&run_file, &projection);
        let truth = directory.join(Self::TRUTH_FILE);
        let table = directory.join("truth/objects.parquet");
        let mut objects = TableReader::<ObjectTruthRow>::open(&table)?;
        let frames = TableReader::<FrameTruthRow>::open(&truth)?;
        let telemetry = directory.join("telemetry.csv");
        let rows = match run_file.scenario.score.attitude {
            Some(AttitudeChoice::Telemetry) => read_telemetry(&telemetry)?,
            Some(AttitudeChoice::True) | None => Vec::new(),
        };
        let rows = rows.into_iter().map(|row| (row.frame, row.telemetry.body_from_icrs)).collect();
        let mut measured_attitudes = RowsByNumber::new(rows, &telemetry, "frame", &truth);
        let mut clusters = clusters.map(TableReader::<FrameCluster>::open).transpose()?;
        let mut answers = RowsByNumber::new(
            read_measurements(measurements, &run_file.scenario.camera)?,
            measurements,
            "frame",
            &truth,
        );
        for frame in frames {
            let (number, truths) = frame?;
            let objects: Vec<ObjectTruth> = objects.rows_of(number)?.into_iter().map(|row| row.0).collect();
            let mut outcome = answers.take(number)?;
            if let Some((outcome, table)) = outcome.as_mut().zip(clusters.as_mut()) {
                outcome.clusters = table.rows_of(number)?.into_iter().map(|row| row.cluster).collect();
            }
            let granted = scorer.granted(measured_attitudes.take(number)?).ok_or_else(|| {
                Failure::Usage(format!(
                    "{}: frame {number} has no row; --attitude telemetry requires its attitude",
                    telemetry.display()
                ))
            })?;
            for of_frame in &truths {
                scorer.scorer.add(&of_frame.0, &objects, outcome.as_ref(), granted).map_err(|error| {
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
        Ok(world::Scorer::finish(scorer))
    }
}

/// Returns the setup of a dataset for the pipeline, with the dataset's star list, or the built-in catalogue
/// down to the magnitude limit of the dataset.
fn setup_of(directory: &Path, dataset: &Dataset) -> Result<Setup, Failure> {
    let camera = dataset.camera();
    let file = directory.join("stars.csv");
    let stars = if file.exists() {
        read_stars(&file)?
    } else {
        let epoch = dataset
            .star_epoch()
            .ok_or_else(|| Failure::Usage(format!("{}: the dataset has no frames", directory.display())))?;
        star_list(&Catalog::hipparcos2(), camera.magnitude_limit, epoch)
    };
    Ok(Setup {
        camera: camera.camera.clone(),
        camera_from_body: camera.mounting.camera_from_body(),
        bit_depth: camera.bit_depth,
        readout: camera.readout,
        calibration: camera.calibration,
        zero_suppression_dn: camera.zero_suppression_dn,
        stars: stars.iter().map(StarRow::to_listed_star).collect(),
    })
}

/// Scores the frames of a run.
pub struct Scorer<'a> {
    scorer: crate::scoring::Scorer<'a>,
    is_argon: bool,
    attitude: Option<AttitudeChoice>,
    nominal_camera_from_body: Rotation<CameraFrame, Body>,
}

impl<'a> Scorer<'a> {
    fn new(run_file: &RunFile<FarRangeScenario>, projection: &'a Projection) -> Self {
        let scorer = crate::scoring::Scorer::new(context(run_file, projection));
        let scenario = &run_file.scenario;
        Self {
            scorer,
            is_argon: is_argon(scenario),
            attitude: scenario.score.attitude,
            nominal_camera_from_body: scenario.mounting.nominal.camera_from_body(),
        }
    }

    /// Returns the attitude that is granted in a frame with this measured attitude; `None` if the measured
    /// attitude is requested and missing.
    fn granted(&self, measured: Option<Rotation<Body, Icrs>>) -> Option<GrantedAttitude> {
        Some(match self.attitude {
            None => GrantedAttitude::None,
            Some(AttitudeChoice::True) => GrantedAttitude::True,
            Some(AttitudeChoice::Telemetry) => {
                GrantedAttitude::Telemetry(self.nominal_camera_from_body * measured?)
            }
        })
    }
}

impl world::Scorer<FarRangeMission> for Scorer<'_> {
    fn add(&mut self, truth: &SceneTruth, telemetry: &Telemetry, outcome: &Outcome) -> Result<(), Failure> {
        let granted = self.granted(Some(telemetry.body_from_icrs)).unwrap_or_default();
        let filed = outcome_as_filed(outcome);
        self.scorer.add(&truth.frame, &truth.objects, Some(&filed), granted).map_err(unscorable)?;
        Ok(())
    }

    fn finish(self) -> FarRangeJudgement {
        FarRangeJudgement { published: self.is_argon.then_some(&ARGON_TABLE_2), ..self.scorer.finish() }
    }
}

impl world::Judgement for FarRangeJudgement {
    type Score = Score;

    fn score(&self) -> &Score {
        &self.score
    }

    fn figures(&self) -> &IndexMap<String, Figure> {
        &self.score.figures
    }

    fn units(&self) -> UnitTable {
        unit_table(&self.verdicts, &self.limits)
    }

    fn show_comparison(&mut self, other: Self) {
        self.best_mode = Some(Box::new(other.score));
    }
}

/// Returns the angular limits of "within one pixel" and "within two" in a scenario.
pub fn limits(scenario: &FarRangeScenario) -> WithinLimits {
    let of_camera = || WithinLimits::from_pixels(&scenario.camera);
    scenario.score.within_deg.map_or_else(of_camera, WithinLimits::from_degrees)
}

fn context<'a>(run_file: &RunFile<FarRangeScenario>, projection: &'a Projection) -> ScoreContext<'a> {
    ScoreContext {
        scenario: run_file.name.clone(),
        seed: run_file.scenario.seed,
        version: run_file.version.clone(),
        inject: run_file.inject.map(|stage| stage.to_string()),
        columns: run_file.scenario.camera.columns,
        rows: run_file.scenario.camera.rows,
        limits: limits(&run_file.scenario),
        warm_up_frames: run_file.scenario.score.warm_up_frames,
        unproject: Box::new(|point| projection.unproject(point)),
    }
}
