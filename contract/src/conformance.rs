//! Checks that any pipeline must pass, whoever wrote it.

use hifitime::Epoch;
use nalgebra::Vector3;

use crate::docking::{
    Digitiser, DockingOutcome, DockingPipelineFactory, DockingSetup, DockingSolution, Field, FieldTelemetry,
    Lines, Motion, MotionReport,
};
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

/// Runs the checks on a docking pipeline: every kind of field is answered without a panic, no answer holds a NaN, a
/// covariance has no negative variance, a wish for the digitiser is one that it has, two fresh pipelines give the same
/// answers, and fields that are missing, repeated, of either parity or hours apart do not disturb it.
///
/// # Errors
/// Every violation found, in the order of the inputs.
pub fn check_docking(
    factory: &dyn DockingPipelineFactory,
    setup: &DockingSetup,
) -> Result<(), Vec<Violation>> {
    let inputs = docking_inputs(setup);
    let run = || -> Result<Vec<DockingOutcome>, Violation> {
        let mut pipeline =
            factory.build(setup).map_err(|error| Violation { input: "setup", broken: error.to_string() })?;
        Ok(inputs.iter().map(|(_, field, telemetry)| pipeline.process(field, telemetry)).collect())
    };
    let (first, second) = match (run(), run()) {
        (Ok(first), Ok(second)) => (first, second),
        (Err(violation), _) | (_, Err(violation)) => return Err(vec![violation]),
    };
    let mut violations = Vec::new();
    for ((input, _, _), (outcome, again)) in inputs.iter().zip(first.iter().zip(&second)) {
        if let Some(broken) = docking_not_sound(outcome) {
            violations.push(Violation { input, broken });
        }
        if outcome != again {
            let broken =
                format!("two fresh pipelines disagree: {:?} and {:?}", outcome.solution, again.solution);
            violations.push(Violation { input, broken });
        }
    }
    if violations.is_empty() { Ok(()) } else { Err(violations) }
}

/// What makes an answer to a field unusable, if anything does.
fn docking_not_sound(outcome: &DockingOutcome) -> Option<String> {
    let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
    match &outcome.solution {
        DockingSolution::Measured(measurement) => {
            let best = &measurement.best;
            let poses = [Some(best.pose), measurement.paper];
            if !poses
                .iter()
                .flatten()
                .all(|pose| finite(pose.position_m.as_slice()) && finite(pose.phi_rad.as_slice()))
            {
                return Some(format!("a pose is not finite: {measurement:?}"));
            }
            if !finite(best.covariance.as_slice()) || best.covariance.diagonal().min() < 0.0 {
                return Some(format!("a covariance is none: {:?}", best.covariance));
            }
        }
        DockingSolution::RangeOnly { range_m, sigma_m } => {
            if !(finite(&[*range_m, *sigma_m]) && *range_m > 0.0 && *sigma_m >= 0.0) {
                return Some(format!("a range is none: {range_m} m, {sigma_m} m"));
            }
        }
        DockingSolution::NoSolution(_) => {}
    }
    if outcome.motion.as_ref().is_some_and(|report| report.motions().next().is_none()) {
        return Some("a report of a motion has no motion".to_owned());
    }
    let mut motions = outcome.motion.iter().flat_map(MotionReport::motions);
    if let Some(motion) = motions.find(|motion| !is_finite_motion(motion)) {
        return Some(format!("a motion is not finite: {motion:?}"));
    }
    let wish = outcome.digitiser.as_ref().and_then(|wish| wish.check().err());
    wish.map(|error| format!("no digitiser has the setting asked for: {error}"))
}

fn is_finite_motion(motion: &Motion) -> bool {
    let parts: [&[f64]; 8] = [
        &[motion.time_s],
        motion.pose.position_m.as_slice(),
        motion.pose.phi_rad.as_slice(),
        motion.velocity_m_s.as_slice(),
        motion.phi_rate_rad_s.as_slice(),
        motion.position_covariance.as_slice(),
        motion.attitude_covariance.as_slice(),
        motion.cross_covariance.as_slice(),
    ];
    parts.into_iter().flatten().all(|value| value.is_finite())
}

/// The digital number at a column and a row, of a full scale.
type Pattern = fn(usize, usize, u16) -> u16;

/// A short sequence with every kind of field that has broken a pipeline.
fn docking_inputs(setup: &DockingSetup) -> Vec<(&'static str, Field, FieldTelemetry)> {
    let Some(camera) = setup.cameras.first() else { return Vec::new() };
    let full_scale = (u32::MAX >> (32 - u32::from(setup.bit_depth))) as u16;
    let columns = camera.columns;
    let inputs: [(&'static str, u64, Lines, f64, Pattern); 10] = [
        ("an all-zero field first", 0, Lines::Even, 0.0, |_, _, _| 0),
        ("a flat field", 1, Lines::Odd, 0.02, |_, _, full| full / 3),
        ("a saturated field", 2, Lines::Even, 0.04, |_, _, full| full),
        ("a checkerboard", 3, Lines::Odd, 0.06, |x, y, full| if (x + y) % 2 == 0 { full } else { 0 }),
        ("a ramp", 4, Lines::Even, 0.08, |x, _, full| (x % (usize::from(full) + 1)) as u16),
        (
            "two fields of the same parity",
            6,
            Lines::Even,
            0.12,
            |_, y, full| if y % 40 < 20 { full } else { 0 },
        ),
        (
            "a progressive frame",
            7,
            Lines::All,
            0.14,
            |x, y, full| if x / 9 % 2 == y / 9 % 2 { full } else { 0 },
        ),
        ("the same time again", 8, Lines::Even, 0.14, |x, _, full| if x % 50 < 5 { full } else { full / 5 }),
        (
            "a field hours later",
            9,
            Lines::Odd,
            20_000.0,
            |x, y, full| if x.abs_diff(y) < 4 { full } else { 0 },
        ),
        ("a field from before", 10, Lines::Even, 0.2, |_, _, full| full / 7),
    ];
    let fields = inputs.into_iter().map(|(name, number, lines, time_s, dn)| {
        let rows = lines.rows(camera.rows);
        let image = (0..columns * rows).map(|i| dn(i % columns, i / columns, full_scale)).collect();
        let field = Frame::new(number, columns, rows, setup.bit_depth, image, None)
            .and_then(|image| Field::new(image, lines, camera.rows))
            .expect("the image is made with the camera's own size");
        // The last camera for the later fields: a lens may be changed at any time.
        let camera = if number < 8 { 0 } else { setup.cameras.len() - 1 };
        (name, field, FieldTelemetry { time_s, camera, digitiser: Digitiser::default() })
    });
    fields.collect()
}
