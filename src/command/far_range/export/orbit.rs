//! Orbit ephemeris messages: the true motion of a spacecraft, and the estimated motion of the target.

use std::path::Path;

use clap::ValueEnum;
use far_range::FarRangeScenario;
use files::Failure;
use flight_dynamics::{Interpolation, Method, Oem, OemSegment};
use navigate::{TABLE_FILE, TargetOrbit, TargetState};
use scenario::run_file::RunFile;
use sim::truth::State;

use super::parts::{CHASER, Export, TARGET, header, true_frames};

/// Fewest intervals of a segment of truth: those of a polynomial of degree 7.
const MIN_INTERVALS: u32 = 8;

/// Interpolation of the truth: the velocities of mean elements are no exact derivatives of the positions.
const OF_TRUTH: Interpolation = Interpolation { method: Method::Lagrange, degree: 7 };

/// Largest degree between estimates: six of them at a tenth of a revolution apart give the orbit to
/// centimetres.
const MAX_ESTIMATE_DEGREE: usize = 11;

/// Most states of a message.
const MAX_STATES: f64 = 1e7;

/// Spacecraft of an orbit ephemeris message.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Spacecraft {
    /// The chaser
    Chaser,
    /// The target
    Target,
}

/// Returns the true motion of a spacecraft from a step before the first to a step after the last frame of the
/// run, as far as the trajectory is defined. An impulsive manoeuvre, and the begin and the end of a finite
/// burn, end a segment, as do the segments of a file: each has the state just before, and the next segment
/// the state just after.
pub(super) fn true_orbit(
    directory: &Path,
    run: &RunFile<FarRangeScenario>,
    spacecraft: Spacecraft,
    step_s: f64,
) -> Result<Export<Oem>, Failure> {
    let trajectory = run.scenario.trajectory()?;
    let frames = true_frames(directory, run)?;
    let [first, last] = [frames.first(), frames.last()]
        .map(|frame| frame.map_or(trajectory.epoch(), |frame| frame.time))
        .map(|time| trajectory.seconds(time));
    let covered_s = trajectory.coverage_s();
    let (start_s, stop_s) = ((first - step_s).max(*covered_s.start()), (last + step_s).min(*covered_s.end()));
    if (stop_s - start_s) / step_s > MAX_STATES {
        return Err(Failure::Usage(format!(
            "--step-s is {step_s}, expected a step with at most {MAX_STATES:.0} states"
        )));
    }
    let (name, borders) = match spacecraft {
        Spacecraft::Chaser => (CHASER, trajectory.chaser_borders_s()),
        Spacecraft::Target => (TARGET, trajectory.target_borders_s()),
    };
    let mut borders_s = vec![start_s];
    for time_s in borders {
        if borders_s.last().is_some_and(|border| *border < time_s) && time_s < stop_s {
            borders_s.push(time_s);
        }
    }
    borders_s.push(stop_s);
    let state_at = |time_s: f64| {
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
                just_before(&state_at, to_s)
            } else {
                state_at(time_s)
            };
            (time(time_s), state, None)
        });
        let states: Vec<TargetState> = states.collect();
        segments.extend(OemSegment::from_states(name, OF_TRUTH, &states));
    }
    Ok(Export { message: Oem { header: header(run, Vec::new()), segments }, left_out: 0 })
}

/// State just before a manoeuvre: that of a nanosecond earlier, moved along its velocity. Gravity changes the
/// velocity by 8e-12 km/s in that time.
fn just_before(state_at: &impl Fn(f64) -> State, time_s: f64) -> State {
    const EARLIER_S: f64 = 1e-9;
    let state = state_at(time_s - EARLIER_S);
    State { position_km: state.position_km + state.velocity_km_s * EARLIER_S, ..state }
}

/// Returns the orbit of the target by relative navigation, from the table in `directory`. A requested time
/// without an estimate ends a segment; an estimate between two such times is left out, because a segment has
/// a span. Velocities are derivatives of positions, so the interpolation is HERMITE.
pub(super) fn estimated_orbit(
    directory: &Path,
    run: &RunFile<FarRangeScenario>,
) -> Result<Export<Oem>, Failure> {
    let TargetOrbit { navigator, arcs } = TargetOrbit::read(directory, run)?;
    let mut segments = Vec::new();
    let mut left_out = 0;
    for arc in &arcs {
        let degree = (2 * arc.len()).saturating_sub(1).clamp(1, MAX_ESTIMATE_DEGREE);
        let interpolation = Interpolation { method: Method::Hermite, degree };
        match OemSegment::from_states(TARGET, interpolation, arc) {
            Some(segment) => segments.push(segment),
            None => left_out += arc.len(),
        }
    }
    if segments.is_empty() {
        return Err(Failure::Usage(format!(
            "{}: has no two successive estimates, which a message of an orbit needs",
            directory.join(TABLE_FILE).display()
        )));
    }
    let is_with_covariance = segments.iter().any(|segment| !segment.covariances.is_empty());
    let mut comments = vec![format!(
        "Estimates of the navigator {navigator}: true orbit of the chaser, estimated relative orbit."
    )];
    if is_with_covariance {
        comments.push("Covariances are those of the relative orbit.".to_owned());
    }
    Ok(Export { message: Oem { header: header(run, comments), segments }, left_out })
}

/// Number of states of a message.
pub(super) fn state_count(oem: &Oem) -> usize {
    oem.segments.iter().map(|segment| segment.states.len()).sum()
}
