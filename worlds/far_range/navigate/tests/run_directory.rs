//! Navigators on run directories: accuracy on a thinned ARGON, and input that they refuse.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

use std::fs;
use std::path::Path;

use boresight_navigate::{
    BoundReport, Campaign, Estimator, KnowledgeConfig, bound_of, navigate, read_navigation,
};
use contract::{
    AttitudeSource, CameraFrame, Covariance2, Direction, Icrs, Measurement, NoSolution, Outcome, PixelPoint,
    Rotation, Solution, Telemetry,
};
use draws::{Effect, Seed, normal};
use far_range::FarRangeScenario;
use far_range::rows::{MeasurementLine, MeasurementWriter, TelemetryLine, TelemetryRow, TelemetryWriter};
use nalgebra::Vector3;
use scenario::run_file::{RunFile, ScenarioFile};
use sim::truth::Schedule;
use tempfile::TempDir;

/// Standard deviation of each angle of a line of sight, rad (10″).
const SIGMA_RAD: f64 = 10.0 / 206_264.8;

/// ARGON with a frame every 300 s in place of 15 s.
fn argon() -> FarRangeScenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../scenarios/argon.toml");
    let mut scenario = FarRangeScenario::parse(&path, &fs::read_to_string(&path).unwrap()).unwrap();
    for group in &mut scenario.schedule {
        group.cadence_s *= 20.0;
        group.count /= 20;
    }
    scenario
}

fn run_of(scenario: &FarRangeScenario) -> RunFile<FarRangeScenario> {
    RunFile::new("argon", scenario, Default::default(), None, None).unwrap()
}

/// Writes `measurements.csv` and `telemetry.csv` of the first `count` frames: true lines of sight with white
/// errors, from a camera that points at the target.
fn write(directory: &Path, scenario: &FarRangeScenario, count: u64) {
    let (trajectory, schedule) = (scenario.trajectory().unwrap(), Schedule::new(&scenario.schedule).unwrap());
    let camera_from_body = scenario.mounting.nominal.camera_from_body();
    let mut measurements = MeasurementWriter::create(&directory.join("measurements.csv")).unwrap();
    let mut telemetry = TelemetryWriter::create(&directory.join("telemetry.csv")).unwrap();
    let seed = Seed { seed: scenario.seed, case: 0 };
    for frame in 0..schedule.frame_count().min(count) {
        let (_, time) = schedule.frame(frame).unwrap();
        let z = trajectory.states_at(time).line_of_sight_km().normalize();
        let x = z.cross(&Vector3::z()).normalize();
        let camera_from_icrs: Rotation<CameraFrame, Icrs> = Rotation::from_axes(&x, &z.cross(&x), &z);
        let error = |index| SIGMA_RAD * normal(&mut seed.stream(frame, Effect::PixelNoise, index));
        let measured = Direction::from_vector(Vector3::new(error(0), error(1), 1.0)).unwrap();
        let measurement = Measurement {
            position: PixelPoint::new(400.0, 300.0),
            position_covariance: None,
            line_of_sight: Some(camera_from_icrs.inverse() * measured),
            line_of_sight_covariance: Some(Covariance2::from_sigmas(SIGMA_RAD, SIGMA_RAD, 0.0).unwrap()),
            log_odds: None,
        };
        let outcome = Outcome {
            solution: Solution::Detected(measurement),
            camera_from_icrs: Some(camera_from_icrs),
            attitude_source: Some(AttitudeSource::Stars),
            n_stars: Some(20),
            clusters: Vec::new(),
        };
        measurements.line(&MeasurementLine::from_outcome(frame, &outcome)).unwrap();
        let telemetry_of_frame = Telemetry {
            time,
            exposure_s: 0.1,
            body_from_icrs: camera_from_body.inverse() * camera_from_icrs,
            velocity_km_s: None,
        };
        telemetry
            .line(&TelemetryLine::from(&TelemetryRow {
                frame,
                file: None,
                telemetry: telemetry_of_frame,
                windows: None,
            }))
            .unwrap();
    }
    measurements.finish().unwrap();
    telemetry.finish().unwrap();
}

fn read(directory: &Path, scenario: &FarRangeScenario) -> Result<Campaign, String> {
    let knowledge = KnowledgeConfig::default();
    Campaign::read(directory, &run_of(scenario), &knowledge).map_err(|error| error.to_string())
}

/// The paper: errors in R and N are smaller than in T, because the boresight is nearly along the velocity.
#[test]
fn radial_and_normal_errors_are_smaller_than_along_the_track() {
    let (folder, scenario) = (TempDir::new().unwrap(), argon());
    write(folder.path(), &scenario, u64::MAX);
    let campaign = read(folder.path(), &scenario).unwrap();
    for estimator in [Estimator::Batch, Estimator::Sequential] {
        let result = navigate(&campaign, estimator, 3600.0).unwrap();
        let [r, t, n] = ["r", "t", "n"].map(|axis| result.score.position_m[axis]);
        let all = format!("{estimator:?} {:?}", result.score);
        assert_eq!(result.score.estimates, result.score.requested, "{all}");
        assert!(3.0 * r.rms < t.rms && 3.0 * n.rms < t.rms, "{all}");
        assert!(3.0 * r.sigma_rms < t.sigma_rms && 3.0 * n.sigma_rms < t.sigma_rms, "{all}");
        assert!(result.score.range_error_end_percent.unwrap() < 1.0, "{all}");
        assert!(result.score.convergence_s.is_some(), "{all}");
        let within = [r, t, n].iter().map(|axis| axis.within_3_sigma).fold(1.0, f64::min);
        assert!(within > 0.9, "{all}");
        // The table reads back unchanged.
        let out = folder.path().join(estimator.code());
        result.write(&out).unwrap();
        assert_eq!(read_navigation(&out.join("navigation.csv")).unwrap(), result.rows);
        assert!(result.write(&out).unwrap_err().to_string().contains("navigation.json"));
    }
    let bound = bound_of(&campaign, 4).unwrap();
    let end = bound.bounds.last().unwrap();
    let [filter, batch] = [end.filter_m.unwrap(), end.batch_m.unwrap()];
    // At the end, the filter has all measurements.
    filter.iter().zip(batch).for_each(|(a, b)| assert!((a / b - 1.0).abs() < 1e-6, "{filter:?} {batch:?}"));
    assert!(filter[0] < filter[1] && filter[2] < filter[1], "{filter:?}");
}

/// Manoeuvres make the distance observable: without them σ of the distance remains that of the prior.
#[test]
fn without_a_manoeuvre_the_distance_keeps_a_large_sigma() {
    let mut scenario = argon();
    scenario.orbit.as_mut().unwrap().manoeuvres.clear();
    let along_track = |scenario: &FarRangeScenario| {
        let folder = TempDir::new().unwrap();
        write(folder.path(), scenario, u64::MAX);
        let campaign = read(folder.path(), scenario).unwrap();
        navigate(&campaign, Estimator::Batch, 7200.0).unwrap().score.position_m["t"]
    };
    let (quiet, moved) = (along_track(&scenario), along_track(&argon()));
    assert!(quiet.sigma_rms > 1.5 * moved.sigma_rms && quiet.within_3_sigma > 0.9, "{quiet:?} {moved:?}");
    let planned = |scenario: &FarRangeScenario| {
        let plan = Campaign::from_plan("argon", "", scenario, &KnowledgeConfig::default()).unwrap();
        bound_of(&plan, 2).unwrap()
    };
    let (without, with) = (planned(&scenario), planned(&argon()));
    let percent = |bound: &BoundReport| bound.range_sigma_percent.unwrap_or(f64::INFINITY);
    // Regions of eight rows cut the target; whole images do not.
    let whole = planned(&FarRangeScenario { roi: None, ..argon() });
    assert!(percent(&with) < 1.5, "{with:?}");
    assert!(percent(&whole) < 0.7 * percent(&with), "{whole:?} {with:?}");
    assert!(percent(&without) > 1.5 * percent(&with), "{without:?} {with:?}");
}

#[test]
fn one_measurement_leaves_the_prior() {
    let (folder, scenario) = (TempDir::new().unwrap(), argon());
    write(folder.path(), &scenario, 1);
    let campaign = read(folder.path(), &scenario).unwrap();
    let result = navigate(&campaign, Estimator::Batch, 600.0).unwrap();
    assert_eq!(result.score.estimates, 1);
    let t = result.score.position_m["t"];
    assert!(t.sigma_rms > 400.0 && t.within_3_sigma == 1.0, "{t:?}");
    // Without a prior there is no orbit, and no figure.
    let knowledge = KnowledgeConfig { prior_sigma_m: None, ..KnowledgeConfig::default() };
    let campaign = Campaign::read(folder.path(), &run_of(&scenario), &knowledge).unwrap();
    let result = navigate(&campaign, Estimator::Batch, 600.0).unwrap();
    assert_eq!(result.score.unanswered.values().sum::<u64>(), 1, "{:?}", result.score);
    assert!(result.score.position_m.is_empty());
}

/// Each wrong input with the parts of its message.
#[test]
fn wrong_input_is_refused_by_file_and_field() {
    let refused = |edit: &dyn Fn(&Path), parts: &[&str]| {
        let (folder, scenario) = (TempDir::new().unwrap(), argon());
        write(folder.path(), &scenario, 10);
        edit(folder.path());
        let message = read(folder.path(), &scenario).unwrap_err();
        for part in parts {
            assert!(message.contains(part), "{part}: {message}");
        }
    };
    let replace = |name: &'static str, change: &'static dyn Fn(Vec<String>) -> Vec<String>| {
        move |folder: &Path| {
            let path = folder.join(name);
            let lines = fs::read_to_string(&path).unwrap().lines().map(str::to_owned).collect();
            fs::write(&path, change(lines).join("\n") + "\n").unwrap();
        }
    };
    refused(
        &replace("measurements.csv", &|lines| {
            lines.iter().map(|line| line.replacen("9,", "99,", usize::from(line.starts_with("9,")))).collect()
        }),
        &["measurements.csv", "frame", "99", "telemetry.csv"],
    );
    refused(
        &replace("measurements.csv", &|mut lines| {
            let mut cells: Vec<String> = lines[3].split(',').map(str::to_owned).collect();
            for cell in &mut cells[4..7] {
                *cell = (-cell.parse::<f64>().unwrap()).to_string();
            }
            lines[3] = cells.join(",");
            lines
        }),
        &["measurements.csv", "los_j2000_x", "boresight", "line 4"],
    );
    refused(
        &replace("measurements.csv", &|mut lines| {
            let mut cells: Vec<String> = lines[2].split(',').map(str::to_owned).collect();
            cells[5] = "NaN".to_owned();
            lines[2] = cells.join(",");
            lines
        }),
        &["measurements.csv", "los_j2000_y", "NaN"],
    );
    refused(
        &replace("measurements.csv", &|mut lines| {
            let place = lines[0].split(',').position(|name| name == "sigma_ra_deg").unwrap();
            let mut cells: Vec<String> = lines[1].split(',').map(str::to_owned).collect();
            cells[place] = "-0.001".to_owned();
            lines[1] = cells.join(",");
            lines
        }),
        &["measurements.csv", "sigma_ra_deg", "-0.001"],
    );
    refused(
        &|folder| {
            let path = folder.join("measurements.csv");
            fs::remove_file(&path).unwrap();
            let mut measurements = MeasurementWriter::create(&path).unwrap();
            let outcome = Outcome::without_solution(NoSolution::NoTarget);
            measurements.line(&MeasurementLine::from_outcome(0, &outcome)).unwrap();
            measurements.finish().unwrap();
        },
        &["measurements.csv", "los_j2000_x", "at least one row"],
    );
    refused(&|folder| fs::remove_file(folder.join("telemetry.csv")).unwrap(), &["telemetry.csv"]);
}

#[test]
fn an_interval_without_progress_is_refused() {
    let (folder, scenario) = (TempDir::new().unwrap(), argon());
    write(folder.path(), &scenario, 10);
    let campaign = read(folder.path(), &scenario).unwrap();
    for every_s in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-6] {
        let message = navigate(&campaign, Estimator::Batch, every_s).unwrap_err().to_string();
        assert!(message.contains("--every"), "{message}");
    }
}
