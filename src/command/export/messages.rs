//! Messages from the files of a run.

use std::path::Path;

use clap::ValueEnum;
use contract::Solution;
use files::{CameraFile, Failure, FileError, TableReader, read_measurements, read_telemetry};
use flight_dynamics::{
    Aem, AemSegment, AttitudeDirection, AttitudeNode, Coverage, Header, Interpolation, Method, Observation,
    Oem, OemSegment, ReferenceFrame, StateNode, Tdm, TdmSegment, TimeSystem,
};
use hifitime::Epoch;
use scenario::FarRangeScenario;
use scenario::run_file::RunFile;
use sim::truth::{FrameTruth, Schedule, State, clock};

/// Names of the spacecraft in messages.
const CHASER: &str = "CHASER";
const TARGET: &str = "TARGET";

/// International designator of spacecraft that have none.
const NO_DESIGNATOR: &str = "UNKNOWN";

/// Fewest intervals of a segment: those of a polynomial of degree 7.
const MIN_INTERVALS: u32 = 8;

/// Most states of a message.
const MAX_STATES: f64 = 1e7;

/// Spacecraft of an orbit ephemeris message.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Spacecraft {
    /// The chaser
    #[default]
    Chaser,
    /// The target
    Target,
}

fn header(run: &RunFile<FarRangeScenario>) -> Header {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    let seconds = now.map_or(0, |now| now.as_secs());
    let version = &run.version;
    Header {
        originator: "BORESIGHT".to_owned(),
        creation_time: clock::from_unix_ns(i64::try_from(seconds).unwrap_or(0).saturating_mul(1_000_000_000)),
        message_id: None,
        comments: vec![
            format!("scenario {}, hash {}, Boresight {version}", run.name, run.hash),
            "Axes are those of the star catalogue, ICRS.".to_owned(),
        ],
    }
}

/// Returns the true motion of a spacecraft from a step before the first to a step after the last frame. An
/// impulsive manoeuvre, and the begin and the end of a finite burn, end a segment, as do the segments of a
/// file: each has the state just before, and the next segment the state just after. The velocities of mean
/// elements are no exact derivatives of the positions, so the interpolation is LAGRANGE.
pub(super) fn oem(
    run: &RunFile<FarRangeScenario>,
    spacecraft: Spacecraft,
    step_s: f64,
) -> Result<Oem, Failure> {
    let trajectory = run.scenario.trajectory()?;
    let schedule = Schedule::new(&run.scenario.schedule)?;
    let [first, last] = schedule.ends().ok_or_else(|| Failure::Usage("the run has no frames".to_owned()))?;
    let (start_s, stop_s) = (trajectory.seconds(first) - step_s, trajectory.seconds(last) + step_s);
    if (stop_s - start_s) / step_s > MAX_STATES {
        return Err(Failure::Usage(format!(
            "--step-s is {step_s}, expected a step with at most {MAX_STATES:.0} states"
        )));
    }
    let mut borders_s = vec![start_s];
    let borders = match spacecraft {
        Spacecraft::Chaser => trajectory.chaser_borders_s(),
        Spacecraft::Target => trajectory.target_borders_s(),
    };
    for time_s in borders {
        if borders_s.last().is_some_and(|border| *border < time_s) && time_s < stop_s {
            borders_s.push(time_s);
        }
    }
    borders_s.push(stop_s);
    let of_both = |time_s: f64| {
        let states = trajectory.states_at_seconds(time_s);
        match spacecraft {
            Spacecraft::Chaser => states.chaser,
            Spacecraft::Target => states.target,
        }
    };
    let time = |time_s: f64| {
        let nanoseconds = libm::round(time_s * 1e9) as i128;
        trajectory.epoch() + hifitime::Duration::from_total_nanoseconds(nanoseconds)
    };
    let mut segments = Vec::new();
    for (index, pair) in borders_s.windows(2).enumerate() {
        let &[from_s, to_s] = pair else { continue };
        let intervals = (libm::ceil((to_s - from_s) / step_s) as u32).max(MIN_INTERVALS);
        let is_before_manoeuvre = index + 2 < borders_s.len();
        let states = (0..=intervals).map(|k| {
            // Whole milliseconds inside the segment: other tools read them without loss.
            let inside = from_s + (to_s - from_s) * f64::from(k) / f64::from(intervals);
            let time_s = match k {
                0 => from_s,
                k if k == intervals => to_s,
                _ => libm::round(inside * 1e3) / 1e3,
            };
            let state = if k == intervals && is_before_manoeuvre {
                just_before(&of_both, to_s)
            } else {
                of_both(time_s)
            };
            StateNode {
                time: time(time_s),
                position_km: state.position_km,
                velocity_km_s: state.velocity_km_s,
            }
        });
        segments.push(OemSegment {
            object_name: match spacecraft {
                Spacecraft::Chaser => CHASER,
                Spacecraft::Target => TARGET,
            }
            .to_owned(),
            object_id: NO_DESIGNATOR.to_owned(),
            frame: ReferenceFrame::Icrf,
            time_system: TimeSystem::Utc,
            coverage: Coverage { start: time(from_s), stop: time(to_s) },
            interpolation: Some(Interpolation { method: Method::Lagrange, degree: 7 }),
            states: states.collect(),
            covariances: Vec::new(),
        });
    }
    Ok(Oem { header: header(run), segments })
}

/// State just before a manoeuvre: that of a nanosecond earlier, moved along its velocity. Gravity changes the
/// velocity by 8e-12 km/s in that time.
fn just_before(state_at: &impl Fn(f64) -> State, time_s: f64) -> State {
    const EARLIER_S: f64 = 1e-9;
    let state = state_at(time_s - EARLIER_S);
    State { position_km: state.position_km + state.velocity_km_s * EARLIER_S, ..state }
}

/// Returns the true attitude at the frames, and at the begin of the first and the end of the last exposure of
/// each group; each group is a segment.
pub(super) fn aem(directory: &Path, run: &RunFile<FarRangeScenario>) -> Result<Aem, Failure> {
    let path = directory.join("truth/frames.parquet");
    let trajectory = run.scenario.trajectory()?;
    let attitude = run.scenario.true_attitude(trajectory.epoch())?;
    let at = |time: Epoch, frame: u64| {
        AttitudeNode::from_rotation(time, &attitude.truth(&trajectory.states_at(time), frame))
    };
    let mut groups: Vec<(String, Vec<AttitudeNode>)> = Vec::new();
    // Time and number of the frame before.
    let mut last: Option<(Epoch, u64)> = None;
    for rows in TableReader::<FrameTruth>::open(&path)? {
        for truth in rows?.1 {
            let node = AttitudeNode::from_rotation(truth.time, &truth.body_from_icrs);
            match groups.last_mut() {
                Some((group, nodes)) if *group == truth.group => nodes.push(node),
                before => {
                    if let (Some((_, nodes)), Some((time, frame))) = (before, last) {
                        nodes.push(at(run.scenario.needed_about(time).stop, frame));
                    }
                    let begin = run.scenario.needed_about(truth.time).start;
                    groups.push((truth.group, vec![at(begin, truth.frame), node]));
                }
            }
            last = Some((truth.time, truth.frame));
        }
    }
    if let (Some((_, nodes)), Some((time, frame))) = (groups.last_mut(), last) {
        nodes.push(at(run.scenario.needed_about(time).stop, frame));
    }
    let segments = groups.into_iter().filter_map(|(_, attitudes)| {
        let ends = attitudes.first().zip(attitudes.last()).filter(|(first, last)| first.time < last.time)?;
        Some(AemSegment {
            object_name: CHASER.to_owned(),
            object_id: NO_DESIGNATOR.to_owned(),
            frame: ReferenceFrame::Icrf,
            body_frame: "SC_BODY_1".to_owned(),
            direction: AttitudeDirection::BodyFromFrame,
            time_system: TimeSystem::Utc,
            coverage: Coverage { start: ends.0.time, stop: ends.1.time },
            interpolation: Some(Interpolation::ATTITUDE_DEFAULT),
            attitudes,
        })
    });
    let segments: Vec<AemSegment> = segments.collect();
    if segments.is_empty() {
        return Err(Failure::Usage(format!(
            "{}: has no frames, which a message of attitudes needs",
            path.display()
        )));
    }
    Ok(Aem { header: header(run), segments })
}

/// Returns the measured lines of sight with the times of telemetry. The format has no covariance; the comment
/// has the root mean square of the standard deviations.
pub(super) fn tdm(directory: &Path, run: &RunFile<FarRangeScenario>) -> Result<Tdm, Failure> {
    let camera = CameraFile::read(&directory.join("camera.toml"))?;
    let path = directory.join("measurements.csv");
    let telemetry = read_telemetry(&directory.join("telemetry.csv"))?;
    let mut observations = Vec::new();
    let (mut squares, mut known) = ([0.0; 2], 0_u32);
    for (frame, outcome) in read_measurements(&path, &camera.camera)? {
        let Solution::Detected(measurement) = outcome.solution else { continue };
        let Some(line_of_sight) = measurement.line_of_sight else { continue };
        let row = telemetry.binary_search_by_key(&frame, |row| row.frame).ok();
        let row = row.and_then(|place| telemetry.get(place)).ok_or_else(|| missing(directory, frame))?;
        observations.push(Observation::from_direction(row.telemetry.time, &line_of_sight));
        if let Some(covariance) = measurement.line_of_sight_covariance {
            let [xx, _, yy] = covariance.matrix();
            squares = [squares[0] + xx, squares[1] + yy];
            known += 1;
        }
    }
    let unique = observations.windows(2).all(|pair| pair.iter().map(|o| o.time).is_sorted_by(|a, b| a < b));
    if observations.is_empty() || !unique {
        let reason = if unique { "no lines of sight" } else { "times that do not ascend" };
        return Err(Failure::Usage(format!(
            "{}: has {reason}, which a tracking data message needs",
            path.display()
        )));
    }
    let mut comments = vec![
        "Measured direction from the observer to the target, without aberration: geometric, as the target moves \
         with the observer."
            .to_owned(),
    ];
    if known > 0 {
        let [across, along] = squares.map(|sum| (sum / f64::from(known)).sqrt().to_degrees());
        comments.push(format!(
            "Standard deviations along the camera's x and y, root mean square of {known}: {across:.3e} {along:.3e} deg"
        ));
        comments.push(
            "The format has no covariance; that of each direction is in measurements.csv of the run."
                .to_owned(),
        );
    }
    let segment = TdmSegment {
        comments,
        observer: CHASER.to_owned(),
        target: TARGET.to_owned(),
        frame: ReferenceFrame::Icrf,
        time_system: TimeSystem::Utc,
        observations,
    };
    Ok(Tdm { header: header(run), segments: vec![segment] })
}

fn missing(directory: &Path, frame: u64) -> Failure {
    let path = directory.join("telemetry.csv");
    FileError::value(&path, files::FileLocation::Whole, "frame", frame, "a row for every measured frame")
        .into()
}
