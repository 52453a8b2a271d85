//! Input of a navigator from a run directory.

use std::path::{Path, PathBuf};

use contract::navigation::{Event, LineOfSightMeasurement, ManoeuvreReport, NavigationSetup};
use contract::{AttitudeSource, ContractError, Covariance2, Direction, Rotation};
use far_range::FarRangeScenario;
use files::{Checksums, Failure, FileError, FileLocation, refuse_unfinished};
use hifitime::Epoch;
use nalgebra::Vector3;
use run::check_world_of_run;
use scenario::run_file::{RunFile, ScenarioFile};
use sim::truth::{Schedule, Trajectory};

use crate::knowledge::{KnowledgeConfig, Method};
use crate::measurements::{MEASUREMENTS, MeasurementSource};
use crate::truth::Truth;

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
    /// File of the lines of sight; `None`: that of the run.
    pub measurements_file: Option<PathBuf>,
    /// True if the attitude of a line of sight is that of its image alone; false if it is that of telemetry
    /// with a mounting from stars.
    pub(crate) attitude_of_images: bool,
    pub(crate) arrivals: Vec<Arrival>,
    pub(crate) last: Epoch,
    pub(crate) truth: Truth,
}

/// Files of a run that a campaign reads.
const READ: [&str; 3] = ["run.toml", MEASUREMENTS, "telemetry.csv"];

impl Campaign {
    /// Opens the directory of a complete far-range run, with lines of sight from `source`.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a run of another world; those of [`Campaign::read`]; a [`Failure`] for an
    /// unfinished run, or a file that differs from its checksum.
    pub fn open(
        directory: &Path,
        knowledge: &KnowledgeConfig,
        source: &MeasurementSource,
    ) -> Result<Self, Failure> {
        check_world_of_run(directory, FarRangeScenario::WORLD)?;
        refuse_unfinished(directory)?;
        let run = RunFile::read(&directory.join("run.toml"))?;
        let campaign = Self::read_with(directory, &run, knowledge, source)?;
        let is_read = |name: &str| READ.contains(&name) && (source.file.is_none() || name != MEASUREMENTS);
        Checksums::check(directory, is_read)?;
        Ok(campaign)
    }

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
        Self::read_with(directory, run, knowledge, &MeasurementSource::default())
    }

    /// [`Campaign::read`] with lines of sight from `source`.
    ///
    /// # Errors
    /// Those of [`Campaign::read`]; [`Failure::Usage`] for a standard deviation that is not positive, or for
    /// a file that states none and needs one.
    pub fn read_with(
        directory: &Path,
        run: &RunFile<FarRangeScenario>,
        knowledge: &KnowledgeConfig,
        source: &MeasurementSource,
    ) -> Result<Self, Failure> {
        let scenario = &run.scenario;
        let measurements = source.measurements(directory, run)?;
        let truth = Truth::new(scenario)?;
        let times: Vec<Epoch> = measurements.iter().map(|measurement| measurement.time).collect();
        let (Some(first), Some(last)) = (measurements.first(), times.last().copied()) else {
            let path = source.path(directory);
            let expected = "a detected target with a line of sight in at least one row";
            return Err(FileError::value(&path, FileLocation::Whole, "los_j2000_x", "", expected).into());
        };
        // Only a pipeline that solves the attitude in each image states the error of a line of sight.
        let has_covariance = measurements.iter().any(|measurement| measurement.covariance.is_some());
        let method = if has_covariance { Method::StarAttitude } else { Method::StarMounting };
        let epoch = first.time;
        let setup = knowledge.setup(scenario, &truth, &times, first.camera_from_icrs, method)?;
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
            measurements_file: source.file.clone(),
            attitude_of_images: has_covariance,
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
        // Boresight along the line of sight, columns across the plane of the orbit.
        let camera = |time: Epoch| {
            let states = truth.trajectory().states_at(time);
            let z = states.line_of_sight_km().normalize();
            let x = z.cross(&states.chaser.position_km).normalize();
            Rotation::from_axes(&x, &z.cross(&x), &z)
        };
        let setup = knowledge.setup(scenario, &truth, &times, camera(epoch), Method::StarMounting)?;
        let [across, along] = setup
            .errors
            .with_stars
            .white_arcsec
            .map(|arcsec| (arcsec / 3600.0).to_radians() / (stride as f64).sqrt());
        let covariance = Covariance2::from_sigmas(across, along, 0.0).map_err(ContractError::OutOfRange)?;
        let mut arrivals = Vec::with_capacity(frames.len());
        for (frame, time) in frames {
            let sight_km = truth.trajectory().states_at(time).line_of_sight_km();
            let measurement = LineOfSightMeasurement {
                frame,
                time,
                line_of_sight: Direction::from_vector(sight_km)?,
                camera_from_icrs: camera(time),
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
        let measurements_file = None;
        Ok(Self {
            name,
            hash,
            setup,
            lines_of_sight,
            manoeuvres: count,
            measurements_file,
            attitude_of_images: false,
            arrivals,
            last,
            truth,
        })
    }

    /// Returns true if a manoeuvre before a time has not been reported by then.
    pub(crate) fn awaits_report(&self, time: Epoch) -> bool {
        self.arrivals.iter().any(|arrival| {
            let is_manoeuvre = matches!(arrival.event, Event::Manoeuvre(_));
            is_manoeuvre && arrival.event.time() < time && arrival.arrives > time
        })
    }

    /// Returns the epoch of the setup, the time of the first line of sight.
    pub fn epoch(&self) -> Epoch {
        self.setup.epoch
    }
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
