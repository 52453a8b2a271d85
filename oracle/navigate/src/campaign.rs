//! Input of a navigator from a run directory.

use std::path::Path;

use contract::navigation::{Event, LineOfSightMeasurement, ManoeuvreReport, NavigationSetup};
use contract::{AttitudeSource, ContractError, Covariance2, Direction, Rotation, Solution};
use files::{Failure, FileError, FileLocation, line_of, read_measurements, read_origins, read_telemetry};
use hifitime::Epoch;
use nalgebra::Vector3;
use scenario::FarRangeScenario;
use scenario::run_file::RunFile;
use sim::truth::{Schedule, Trajectory};

use crate::knowledge::{KnowledgeConfig, Method};
use crate::truth::Truth;

/// Largest angle between a line of sight and the reported boresight beyond the corner of the image, degrees.
const POINTING_MARGIN_DEG: f64 = 2.0;

/// Largest number of lines of sight of a planned campaign.
const MAX_PLANNED: u64 = 20_000;

/// An event with the time from which the navigator has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Arrival {
    pub(crate) arrives: Epoch,
    pub(crate) event: Event,
}

/// Input of a navigator, with the truth to judge its answers.
#[derive(Debug, Clone)]
pub struct Campaign {
    /// Name of the scenario.
    pub name: String,
    /// Hash of the run's scenario.
    pub hash: String,
    /// Setup of the navigator.
    pub setup: NavigationSetup,
    /// Number of lines of sight.
    pub lines_of_sight: u64,
    /// Number of reported manoeuvres within the campaign.
    pub manoeuvres: u64,
    pub(crate) arrivals: Vec<Arrival>,
    pub(crate) last: Epoch,
    pub(crate) truth: Truth,
}

impl Campaign {
    /// Reads the directory of a far-range run whose `run.toml` was read: `measurements.csv` and
    /// `telemetry.csv`.
    ///
    /// # Errors
    /// A [`Failure`] that names file, line and field of the first invalid value; for measurements of another
    /// run (a frame without telemetry, another configuration, a line of sight outside the camera's field);
    /// for a run without a line of sight.
    pub fn read(
        directory: &Path,
        run: &RunFile<FarRangeScenario>,
        knowledge: &KnowledgeConfig,
    ) -> Result<Self, Failure> {
        let scenario = &run.scenario;
        let measurements = measurements(directory, run)?;
        let truth = Truth::new(scenario)?;
        let times: Vec<Epoch> = measurements.iter().map(|measurement| measurement.time).collect();
        let (Some(epoch), Some(last)) = (times.first().copied(), times.last().copied()) else {
            let path = directory.join("measurements.csv");
            let expected = "a detected target with a line of sight in at least one row";
            return Err(FileError::value(&path, FileLocation::Whole, "los_j2000_x", "", expected).into());
        };
        // Only a pipeline that solves the attitude in each image states the error of a line of sight.
        let has_covariance = measurements.iter().any(|measurement| measurement.covariance.is_some());
        let method = if has_covariance { Method::StarAttitude } else { Method::StarMounting };
        let setup = knowledge.setup(scenario, &truth, &times, method)?;
        let mut arrivals: Vec<Arrival> = measurements
            .into_iter()
            .map(|measurement| Arrival { arrives: measurement.time, event: Event::LineOfSight(measurement) })
            .collect();
        let lines_of_sight = arrivals.len() as u64;
        let manoeuvres = manoeuvres(scenario, truth.trajectory(), epoch, last);
        let count = manoeuvres.len() as u64;
        arrivals.extend(manoeuvres);
        arrivals.sort_by_key(|arrival| arrival.arrives);
        Ok(Self {
            name: run.name.clone(),
            hash: run.hash.clone(),
            setup,
            lines_of_sight,
            manoeuvres: count,
            arrivals,
            last,
            truth,
        })
    }

    /// Creates the campaign of a scenario that has not been flown: every frame has a line of sight, with the
    /// errors of an attitude from telemetry and a mounting from stars. Above 20000 frames, each line of sight
    /// stands for several, with a smaller error.
    ///
    /// # Errors
    /// A [`Failure`] for an invalid orbit or schedule, or a scenario without frames.
    pub fn from_plan(
        name: &str,
        hash: &str,
        scenario: &FarRangeScenario,
        knowledge: &KnowledgeConfig,
    ) -> Result<Self, Failure> {
        let truth = Truth::new(scenario)?;
        let schedule = Schedule::new(&scenario.schedule)?;
        let stride = schedule.frame_count().div_ceil(MAX_PLANNED).max(1);
        let numbers = (0..schedule.frame_count()).step_by(usize::try_from(stride).unwrap_or(usize::MAX));
        let frames: Vec<(u64, Epoch)> =
            numbers.filter_map(|frame| Some((frame, schedule.frame(frame)?.1))).collect();
        let times: Vec<Epoch> = frames.iter().map(|(_, time)| *time).collect();
        let (Some(epoch), Some(last)) = (times.first().copied(), times.last().copied()) else {
            return Err(Failure::Usage(format!("scenario `{name}` has no frames")));
        };
        let setup = knowledge.setup(scenario, &truth, &times, Method::StarMounting)?;
        let [across, along] = setup
            .errors
            .with_stars
            .white_arcsec
            .map(|arcsec| (arcsec / 3600.0).to_radians() / (stride as f64).sqrt());
        let covariance = Covariance2::from_sigmas(across, along, 0.0).map_err(ContractError::OutOfRange)?;
        let mut arrivals = Vec::with_capacity(frames.len());
        for (frame, time) in frames {
            let sight_km = truth.trajectory().states_at(time).line_of_sight_km();
            let z = sight_km.normalize();
            let x = z.cross(&Vector3::ith(z.iamin(), 1.0)).normalize();
            let measurement = LineOfSightMeasurement {
                frame,
                time,
                line_of_sight: Direction::from_vector(sight_km)?,
                camera_from_icrs: Rotation::from_axes(&x, &z.cross(&x), &z),
                covariance: Some(covariance),
                attitude_source: Some(AttitudeSource::Stars),
            };
            arrivals.push(Arrival { arrives: time, event: Event::LineOfSight(measurement) });
        }
        let lines_of_sight = arrivals.len() as u64;
        let manoeuvres = manoeuvres(scenario, truth.trajectory(), epoch, last);
        let count = manoeuvres.len() as u64;
        arrivals.extend(manoeuvres);
        arrivals.sort_by_key(|arrival| arrival.arrives);
        let (name, hash) = (name.to_owned(), hash.to_owned());
        Ok(Self { name, hash, setup, lines_of_sight, manoeuvres: count, arrivals, last, truth })
    }

    /// Returns the epoch of the setup, the time of the first line of sight.
    pub fn epoch(&self) -> Epoch {
        self.setup.epoch
    }
}

/// Returns the lines of sight of a run, in order of time.
fn measurements(
    directory: &Path,
    run: &RunFile<FarRangeScenario>,
) -> Result<Vec<LineOfSightMeasurement>, Failure> {
    let scenario = &run.scenario;
    let path = directory.join("measurements.csv");
    let telemetry = read_telemetry(&directory.join("telemetry.csv"))?;
    for origin in read_origins(&path, "frame")? {
        if let Some(found) = origin.configuration.filter(|found| *found != run.hash) {
            let expected = format!("{}, the hash in {}", run.hash, directory.join("run.toml").display());
            let place = FileLocation::Line(origin.line);
            return Err(FileError::value(&path, place, "configuration", found, expected).into());
        }
    }
    let camera_from_body = scenario.mounting.nominal.camera_from_body();
    let corner_deg = half_diagonal_deg(scenario) + POINTING_MARGIN_DEG;
    let mut measurements = Vec::new();
    for (frame, outcome) in read_measurements(&path, &scenario.camera)? {
        let refuse = |field: &str, value: String, expected: String| {
            let place = line_of(&path, "frame", frame).map_or(FileLocation::Whole, FileLocation::Line);
            Failure::from(FileError::value(&path, place, field, value, expected))
        };
        let row = telemetry.binary_search_by_key(&frame, |row| row.frame).ok();
        let row = row.and_then(|place| telemetry.get(place));
        let row = row.ok_or_else(|| {
            refuse("frame", frame.to_string(), "a frame of telemetry.csv beside it".to_owned())
        })?;
        let Solution::Detected(measurement) = outcome.solution else { continue };
        let Some(line_of_sight) = measurement.line_of_sight else { continue };
        let reported = camera_from_body * row.telemetry.body_from_icrs;
        let off_deg = (reported * line_of_sight).separation(&Direction::z()).degrees();
        if off_deg > corner_deg {
            return Err(refuse(
                "los_j2000_x",
                format!("a direction {off_deg:.1}° from the boresight in telemetry.csv"),
                format!("at most {corner_deg:.1}°: a line of sight of this run"),
            ));
        }
        measurements.push(LineOfSightMeasurement {
            frame,
            time: row.telemetry.time,
            line_of_sight,
            camera_from_icrs: outcome.camera_from_icrs.unwrap_or(reported),
            covariance: measurement.line_of_sight_covariance,
            attitude_source: outcome.attitude_source,
        });
    }
    measurements.sort_by_key(|measurement| (measurement.time, measurement.frame));
    Ok(measurements)
}

fn half_diagonal_deg(scenario: &FarRangeScenario) -> f64 {
    let camera = &scenario.camera;
    let side = |count: usize, principal: f64, pitch_um: f64| {
        principal.max(count as f64 - principal) * pitch_um * 1e-3
    };
    let across = side(camera.columns, camera.principal_x_px, camera.pixel_width_um);
    let along = side(camera.rows, camera.principal_y_px, camera.pixel_height_um);
    libm::atan(libm::hypot(across, along) / camera.focal_length_mm).to_degrees()
}

/// Returns the reports of the manoeuvres after the epoch, with the standard deviations that the scenario
/// states for reports.
fn manoeuvres(
    scenario: &FarRangeScenario,
    trajectory: &Trajectory,
    epoch: Epoch,
    last: Epoch,
) -> Vec<Arrival> {
    let errors = scenario.manoeuvre_reports();
    let direction_sigma = errors.direction_sigma_deg.to_radians();
    let reports = trajectory.manoeuvres().iter().map(|manoeuvre| manoeuvre.report);
    let during = reports.filter(|report| report.time > epoch && report.time <= last);
    let arrival = during.map(|report| {
        let dv = Vector3::from(report.dv_rtn_m_s);
        let size_squared = dv.norm_squared();
        // The size errs along the impulse, the direction across it.
        let sigma = dv.map(|along| {
            let across_squared = (size_squared - along * along).max(0.0);
            libm::hypot(errors.size_sigma * along, direction_sigma * across_squared.sqrt())
        });
        let manoeuvre = ManoeuvreReport { time: report.time, dv_rtn_m_s: dv, sigma_rtn_m_s: sigma };
        Arrival { arrives: report.reported, event: Event::Manoeuvre(manoeuvre) }
    });
    arrival.collect()
}
