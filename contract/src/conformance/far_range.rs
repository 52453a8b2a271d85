//! Conformance checks of far-range pipelines.

use hifitime::Epoch;
use nalgebra::Vector3;

use super::{Conformance, Input};
use crate::{FarRange, Frame, Outcome, Rotation, Setup, Solution, Telemetry};

impl Conformance for FarRange {
    fn inputs(setup: &Setup) -> Vec<Input<Self>> {
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
            ("an all-zero first frame", 0.0, flat(0)),
            ("a flat frame", 15.0, flat(full_scale / 50)),
            ("one bright pixel", 30.0, spot(columns / 2, rows / 2)),
            ("the bright pixel moved", 45.0, spot(columns / 2 + 2, rows / 2)),
            ("a repeated time", 45.0, spot(columns / 2 + 2, rows / 2)),
            ("a bright pixel in the corner", 60.0, spot(0, 0)),
            ("a saturated frame", 75.0, flat(full_scale)),
            ("a checkerboard", 90.0, checkerboard),
            ("a frame hours later", 20_000.0, spot(columns / 3, rows / 3)),
            ("an earlier frame", 100.0, spot(columns / 3, rows / 3)),
        ];
        images
            .into_iter()
            .enumerate()
            .map(|(number, (name, seconds, dn))| {
                let frame = Frame::new(number as u64, columns, rows, setup.bit_depth, dn, None)
                    .expect("the image is made with the camera's own size");
                let telemetry = Telemetry {
                    time: Epoch::from_gregorian_utc_at_midnight(2012, 4, 25)
                        + hifitime::Unit::Second * seconds,
                    exposure_s: 0.25,
                    body_from_icrs: Rotation::identity(),
                    velocity_km_s: (number % 2 == 0).then(|| Vector3::new(7.5, 0.0, 0.0)),
                };
                (name, frame, telemetry)
            })
            .collect()
    }

    fn violation(outcome: &Outcome, setup: &Setup) -> Option<String> {
        if let Solution::Detected(measurement) = &outcome.solution {
            let position = measurement.position;
            if !position.is_on_detector(setup.camera.columns, setup.camera.rows) {
                return Some(format!("the target is not on the detector: ({}, {})", position.x, position.y));
            }
            if let Some(los) = &measurement.line_of_sight
                && !is_unit_norm(los.vector().norm())
            {
                return Some(format!("the line of sight is not a unit vector: {los:?}"));
            }
            if let Some(log_odds) = measurement.log_odds
                && !log_odds.is_finite()
            {
                return Some(format!("the logarithm of the odds of the target is {log_odds}"));
            }
            if measurement.line_of_sight.is_none()
                && let Some(covariance) = &measurement.line_of_sight_covariance
            {
                return Some(format!(
                    "a covariance of the line of sight is stated without a line of sight: {covariance:?}"
                ));
            }
        }
        if let Some(attitude) = &outcome.camera_from_icrs
            && !is_unit_norm(attitude.quaternion().norm())
        {
            return Some(format!("the camera's attitude is not a unit quaternion: {attitude:?}"));
        }
        outcome
            .clusters
            .iter()
            .find(|cluster| {
                !(cluster.position.x.is_finite()
                    && cluster.position.y.is_finite()
                    && cluster.size.is_finite())
            })
            .map(|cluster| format!("a cluster is not finite: {cluster:?}"))
    }
}

/// Returns true if a norm is 1 within the tolerance; false for NaN.
fn is_unit_norm(norm: f64) -> bool {
    (norm - 1.0).abs() < 1e-6
}
