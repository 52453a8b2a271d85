//! Checks that any pipeline must pass, whoever wrote it.

use hifitime::Epoch;
use nalgebra::Vector3;

use crate::{Frame, Outcome, PipelineFactory, Rotation, Setup, Solution, Telemetry};

/// A rule of the contract that a pipeline broke.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Violation {
    /// The input that showed it.
    pub input: &'static str,
    /// What was wrong with the answer.
    pub broken: String,
}

/// Runs the checks: every kind of frame is answered without a panic, no answer holds a NaN or a place that is
/// not a number, a detection lies on the detector, a fresh pipeline gives the same answers as another fresh one,
/// and frames that are missing, repeated or hours apart do not disturb it.
///
/// # Errors
/// Every violation found, in the order of the inputs.
pub fn check(factory: &dyn PipelineFactory, setup: &Setup) -> Result<(), Vec<Violation>> {
    let inputs = inputs(setup);
    let run = || -> Result<Vec<Outcome>, Violation> {
        let mut pipeline =
            factory.build(setup).map_err(|error| Violation { input: "setup", broken: error.to_string() })?;
        Ok(inputs.iter().map(|(_, frame, telemetry)| pipeline.process(frame, telemetry)).collect())
    };
    let (first, second) = match (run(), run()) {
        (Ok(first), Ok(second)) => (first, second),
        (Err(violation), _) | (_, Err(violation)) => return Err(vec![violation]),
    };
    let mut violations = Vec::new();
    for ((input, _, _), (outcome, again)) in inputs.iter().zip(first.iter().zip(&second)) {
        let mut broke = |broken: String| violations.push(Violation { input, broken });
        if let Some(broken) = not_sound(outcome, setup) {
            broke(broken);
        }
        if outcome != again {
            broke(format!("two fresh pipelines disagree: {:?} and {:?}", outcome.solution, again.solution));
        }
    }
    if violations.is_empty() { Ok(()) } else { Err(violations) }
}

/// What makes an answer unusable, if anything does.
fn not_sound(outcome: &Outcome, setup: &Setup) -> Option<String> {
    if let Solution::Detected(measurement) = &outcome.solution {
        let position = measurement.position;
        if !position.is_on_detector(setup.camera.columns, setup.camera.rows) {
            return Some(format!("the target is not on the detector: ({}, {})", position.x, position.y));
        }
        if let Some(los) = &measurement.line_of_sight
            && !is_one(los.vector().norm())
        {
            return Some(format!("the line of sight is not a unit vector: {los:?}"));
        }
    }
    if let Some(attitude) = &outcome.camera_from_icrs
        && !is_one(attitude.quaternion().norm())
    {
        return Some(format!("the camera's attitude is not a unit quaternion: {attitude:?}"));
    }
    outcome
        .clusters
        .iter()
        .find(|cluster| {
            !(cluster.position.x.is_finite() && cluster.position.y.is_finite() && cluster.size.is_finite())
        })
        .map(|cluster| format!("a cluster is not finite: {cluster:?}"))
}

/// Whether a norm is that of a unit; never so for a NaN.
fn is_one(norm: f64) -> bool {
    (norm - 1.0).abs() < 1e-6
}

/// A short sequence with every kind of frame that has broken a pipeline.
fn inputs(setup: &Setup) -> Vec<(&'static str, Frame, Telemetry)> {
    let camera = &setup.camera;
    let (columns, rows) = (camera.columns, camera.rows);
    let full_scale = (u32::MAX >> (32 - u32::from(setup.bit_depth))) as u16;
    let flat = |level: u16| vec![level; columns * rows];
    let spot = |x: usize, y: usize| {
        let mut dn = flat(full_scale / 50);
        dn[y.min(rows - 1) * columns + x.min(columns - 1)] = full_scale;
        dn
    };
    let checkerboard: Vec<u16> = (0..columns * rows)
        .map(|i| if (i % columns + i / columns) % 2 == 0 { full_scale } else { 0 })
        .collect();
    let images: Vec<(&'static str, f64, Vec<u16>)> = vec![
        ("an all-zero frame first", 0.0, flat(0)),
        ("a flat frame", 15.0, flat(full_scale / 50)),
        ("one bright pixel", 30.0, spot(columns / 2, rows / 2)),
        ("the bright pixel moved", 45.0, spot(columns / 2 + 2, rows / 2)),
        ("the same time again", 45.0, spot(columns / 2 + 2, rows / 2)),
        ("a bright pixel in the corner", 60.0, spot(0, 0)),
        ("a saturated frame", 75.0, flat(full_scale)),
        ("a checkerboard", 90.0, checkerboard),
        ("a frame hours later", 20_000.0, spot(columns / 3, rows / 3)),
        ("a frame from before", 100.0, spot(columns / 3, rows / 3)),
    ];
    images
        .into_iter()
        .enumerate()
        .map(|(number, (name, seconds, dn))| {
            let frame = Frame::new(number as u64, columns, rows, setup.bit_depth, dn, None)
                .expect("the image is made with the camera's own size");
            let telemetry = Telemetry {
                time: Epoch::from_gregorian_utc_at_midnight(2012, 4, 25) + hifitime::Unit::Second * seconds,
                exposure_s: 0.25,
                body_from_icrs: Rotation::identity(),
                velocity_km_s: (number % 2 == 0).then(|| Vector3::new(7.5, 0.0, 0.0)),
            };
            (name, frame, telemetry)
        })
        .collect()
}
