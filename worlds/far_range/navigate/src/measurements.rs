//! Lines of sight of a campaign: those of a run, or of another file of the same frames.

use std::path::{Path, PathBuf};

use contract::navigation::LineOfSightMeasurement;
use contract::{AttitudeSource, ContractError, Covariance2, Direction, Icrs, Solution};
use far_range::FarRangeScenario;
use far_range::rows::{TelemetryRow, read_measurements, read_telemetry};
use files::{Failure, FileError, FileLocation, format_utc, line_of, read_origins};
use flight_dynamics::Tdm;
use hifitime::Epoch;
use scenario::run_file::RunFile;

/// Name of the lines of sight of a run.
pub(crate) const MEASUREMENTS: &str = "measurements.csv";

/// Largest angle between a line of sight and the reported boresight beyond the corner of the image, degrees.
const POINTING_MARGIN_DEG: f64 = 2.0;

/// Largest difference between the time of an observation and that of a frame, s: the attitude of the frame
/// holds for the observation. Time scales differ by more.
const TIME_TOLERANCE_S: f64 = 0.5;

/// Largest difference between a time stated beside a measurement and that of its frame, s: rounding.
const STATED_TIME_TOLERANCE_S: f64 = 1e-3;

/// Largest standard deviation of a line of sight, arcsec.
const MAX_SIGMA_ARCSEC: f64 = 36_000.0;

/// Source of the lines of sight.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeasurementSource {
    /// A table with the columns of `measurements.csv` (extension `csv`), or a tracking data message of CCSDS
    /// with right ascension and declination (KVN or XML); `None`: the table of the run.
    pub file: Option<PathBuf>,
    /// Standard deviation across columns and across rows of lines of sight without a covariance, arcsec,
    /// above 0 to 36000; `None`: the white errors of the setup. A message states none and needs it.
    pub sigma_arcsec: Option<f64>,
}

impl MeasurementSource {
    /// Returns the path of the file, for a run in `directory`.
    pub(crate) fn path(&self, directory: &Path) -> PathBuf {
        self.file.clone().unwrap_or_else(|| directory.join(MEASUREMENTS))
    }

    /// Returns the lines of sight, in order of time.
    pub(crate) fn measurements(
        &self,
        directory: &Path,
        run: &RunFile<FarRangeScenario>,
    ) -> Result<Vec<LineOfSightMeasurement>, Failure> {
        let path = self.path(directory);
        let covariance = self.covariance()?;
        let telemetry = read_telemetry(&directory.join("telemetry.csv"))?;
        let frames = Frames { directory, run, path: &path, telemetry: &telemetry };
        let is_table = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"));
        let mut measurements = match (is_table, covariance) {
            (true, covariance) => frames.of_table(covariance)?,
            (false, Some(covariance)) => frames.of_message(covariance)?,
            (false, None) => {
                return Err(Failure::Usage(format!(
                    "{}: a tracking data message states no standard deviation; give it by --sigma-arcsec",
                    path.display()
                )));
            }
        };
        measurements.sort_by_key(|measurement| (measurement.time, measurement.frame));
        Ok(measurements)
    }

    fn covariance(&self) -> Result<Option<Covariance2>, Failure> {
        let Some(arcsec) = self.sigma_arcsec else { return Ok(None) };
        if !(arcsec > 0.0 && arcsec <= MAX_SIGMA_ARCSEC) {
            return Err(Failure::Usage(format!(
                "--sigma-arcsec is {arcsec}, expected above 0 to {MAX_SIGMA_ARCSEC:.0}"
            )));
        }
        let sigma = (arcsec / 3600.0).to_radians();
        Ok(Some(Covariance2::from_sigmas(sigma, sigma, 0.0).map_err(ContractError::OutOfRange)?))
    }
}

/// Frames of a run, and a file of measurements of them.
struct Frames<'a> {
    directory: &'a Path,
    run: &'a RunFile<FarRangeScenario>,
    path: &'a Path,
    telemetry: &'a [TelemetryRow],
}

impl Frames<'_> {
    fn of_table(&self, covariance: Option<Covariance2>) -> Result<Vec<LineOfSightMeasurement>, Failure> {
        let path = self.path;
        for origin in read_origins(path, "frame")? {
            let refuse = |field: &str, found: String, expected: String| {
                let place = FileLocation::Line(origin.line);
                Err(Failure::from(FileError::value(path, place, field, found, expected)))
            };
            if let Some(found) = origin.configuration.as_ref().filter(|found| **found != self.run.hash) {
                let file = self.directory.join("run.toml");
                let expected = format!("{}, the hash in {}", self.run.hash, file.display());
                return refuse("configuration", found.clone(), expected);
            }
            let row = self.of_frame(origin.frame);
            if let Some((stated, row)) = origin.time.zip(row) {
                let time = row.telemetry.time;
                if (stated - time).abs().to_seconds() > STATED_TIME_TOLERANCE_S {
                    let expected = format!("{}, the time of frame {}", format_utc(time), origin.frame);
                    return refuse("time_utc", format_utc(stated), expected);
                }
            }
        }
        let camera_from_body = self.run.scenario.mounting.nominal.camera_from_body();
        let mut measurements = Vec::new();
        for (frame, outcome) in read_measurements(path, &self.run.scenario.camera)? {
            let refuse = |field: &str, value: String, expected: String| {
                let place = line_of(path, "frame", frame).map_or(FileLocation::Whole, FileLocation::Line);
                Failure::from(FileError::value(path, place, field, value, expected))
            };
            let row = self.of_frame(frame).ok_or_else(|| {
                let telemetry = self.directory.join("telemetry.csv");
                refuse("frame", frame.to_string(), format!("a frame of {}", telemetry.display()))
            })?;
            let Solution::Detected(measurement) = outcome.solution else { continue };
            let Some(line_of_sight) = measurement.line_of_sight else { continue };
            let reported = camera_from_body * row.telemetry.body_from_icrs;
            if let Some((found, expected)) = self.off(row, &line_of_sight) {
                return Err(refuse("los_j2000_x", found, expected));
            }
            measurements.push(LineOfSightMeasurement {
                frame,
                time: row.telemetry.time,
                line_of_sight,
                camera_from_icrs: outcome.camera_from_icrs.unwrap_or(reported),
                covariance: measurement.line_of_sight_covariance.or(covariance),
                attitude_source: outcome.attitude_source,
            });
        }
        Ok(measurements)
    }

    /// Lines of sight of a message. Their directions are absolute, so their errors are those of an attitude
    /// from stars; the attitude of the frame only states the camera's axes.
    fn of_message(&self, covariance: Covariance2) -> Result<Vec<LineOfSightMeasurement>, Failure> {
        let camera_from_body = self.run.scenario.mounting.nominal.camera_from_body();
        let mut measurements = Vec::new();
        for segment in Tdm::read(self.path)?.segments {
            for observation in &segment.observations {
                let stated = segment.time_system.format_time(observation.time);
                let refuse = |field: &str, value: String, expected: String| {
                    let failure = FileError::value(self.path, FileLocation::Whole, field, value, expected);
                    Failure::from(failure)
                };
                let row = self.at(observation.time).ok_or_else(|| {
                    let telemetry = self.directory.join("telemetry.csv");
                    refuse(
                        "EPOCH",
                        format!("{stated} ({})", segment.time_system.code()),
                        format!(
                            "the time of a frame in {}, within {TIME_TOLERANCE_S} s: measurements of this \
                             run, and TIME_SYSTEM the scale of their times",
                            telemetry.display()
                        ),
                    )
                })?;
                let line_of_sight = observation.direction(segment.frame);
                if let Some((found, expected)) = self.off(row, &line_of_sight) {
                    return Err(refuse("ANGLE_1", format!("{found}, at {stated}"), expected));
                }
                measurements.push(LineOfSightMeasurement {
                    frame: row.frame,
                    time: observation.time,
                    line_of_sight,
                    camera_from_icrs: camera_from_body * row.telemetry.body_from_icrs,
                    covariance: Some(covariance),
                    attitude_source: Some(AttitudeSource::Stars),
                });
            }
        }
        Ok(measurements)
    }

    fn of_frame(&self, frame: u64) -> Option<&TelemetryRow> {
        let place = self.telemetry.binary_search_by_key(&frame, |row| row.frame).ok()?;
        self.telemetry.get(place)
    }

    /// Returns the frame at a time; `None` if there is none within the tolerance.
    fn at(&self, time: Epoch) -> Option<&TelemetryRow> {
        let after = self.telemetry.partition_point(|row| row.telemetry.time < time);
        let near = self.telemetry.get(after.saturating_sub(1)..)?.iter().take(2);
        let distance = |row: &&TelemetryRow| (row.telemetry.time - time).abs();
        near.min_by_key(distance).filter(|row| distance(row).to_seconds() <= TIME_TOLERANCE_S)
    }

    /// Returns a direction outside the camera's field, and the expected one; `None` for one in the field.
    fn off(&self, row: &TelemetryRow, line_of_sight: &Direction<Icrs>) -> Option<(String, String)> {
        let corner_deg = half_diagonal_deg(&self.run.scenario) + POINTING_MARGIN_DEG;
        let reported = self.run.scenario.mounting.nominal.camera_from_body() * row.telemetry.body_from_icrs;
        let off_deg = (reported * *line_of_sight).separation(&Direction::z()).degrees();
        (off_deg > corner_deg).then(|| {
            (
                format!("a direction {off_deg:.1}° from the boresight in telemetry.csv"),
                format!("at most {corner_deg:.1}°: a line of sight of this run"),
            )
        })
    }
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
