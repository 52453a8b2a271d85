//! Lines exchanged with an external docking pipeline: JSON, one object per line, UTF-8.
//!
//! Greeting, to the process (metres; `marks` are corners y1, y2 in the disk's plane):
//! ```json
//! {"boresight_pipeline": 1, "world": "docking", "cameras": [{"columns": 768, "rows": 576, "focal_length_mm": 24.2, "...": 0}],
//!  "bit_depth": 8, "target": {"name": "progress", "mark_circle_radius_m": 0.25, "marks": [[[0, 0], [0, 0], [0, 0], [0, 0]]],
//!  "cross": {"height_m": 0.3, "...": 0}, "...": 0}}
//! ```
//! The answer to it: `{"boresight_pipeline": 1, "name": "my pipeline"}`.
//!
//! Field, to the process (`image` is a grey PNG that is removed after the answer; its row k is the camera's
//! row k, 2k or 2k + 1 for `lines` `all`, `even` or `odd`):
//! ```json
//! {"field": 12, "image": "/tmp/12.png", "lines": "even", "time_s": 0.24, "camera": 0, "contrast": 1.0, "brightness": 0.0}
//! ```
//! The answer to it, with angles in degrees. The standard deviations and the requested digitiser setting
//! (`contrast`, `brightness`) are optional:
//! ```json
//! {"field": 12, "status": "measured", "d_m": [0.1, -0.2, 9.7], "phi_deg": [0.1, 0.0, 1.2],
//!  "sigma_d_m": [0.02, 0.02, 0.01], "sigma_phi_deg": [0.1, 0.1, 0.05], "contrast": 1.4, "brightness": -0.1}
//! ```
//! Alternatively, the answer is the range only, `{"field": 12, "status": "range_only", "range_m": 310,
//! "sigma_range_m": 4}`, or the reason why there is no solution, `{"field": 12, "status": "no_target"}`. The
//! reasons are those of [`contract::docking::NoPose::code`], and `failed: ` followed by a reason. An unknown
//! key makes an answer unusable. A line has at most [`super::protocol::MAX_LINE_BYTES`] bytes.

use std::path::Path;

use contract::Camera;
use contract::docking::{
    Digitiser, Docking, DockingOutcome, DockingSetup, DockingSolution, FailedCheck, Features, Field,
    FieldMeasurement, FieldTelemetry, NoPose, Pose, PoseEstimate, TargetModel,
};
use nalgebra::{Matrix6, Vector3, Vector6};
use serde::{Deserialize, Serialize};

use super::protocol::{VERSION, line, parse, shortened, utf8};
use super::{Protocol, WriteTime};

#[derive(Serialize)]
struct Greeting<'a> {
    boresight_pipeline: u32,
    world: &'static str,
    cameras: &'a [Camera],
    bit_depth: u8,
    target: &'a TargetModel,
}

#[derive(Serialize)]
struct Request<'a> {
    field: u64,
    image: &'a str,
    lines: &'static str,
    time_s: f64,
    camera: usize,
    contrast: f64,
    brightness: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Answer {
    field: u64,
    status: String,
    d_m: Option<[f64; 3]>,
    phi_deg: Option<[f64; 3]>,
    sigma_d_m: Option<[f64; 3]>,
    sigma_phi_deg: Option<[f64; 3]>,
    range_m: Option<f64>,
    sigma_range_m: Option<f64>,
    contrast: Option<f64>,
    brightness: Option<f64>,
}

impl Protocol for Docking {
    const EXTENSION: &'static str = "png";

    fn greeting(setup: &DockingSetup) -> Result<Vec<u8>, String> {
        line(&Greeting {
            boresight_pipeline: VERSION,
            world: "docking",
            cameras: &setup.cameras,
            bit_depth: setup.bit_depth,
            target: &setup.target,
        })
    }

    fn request(
        field: &Field,
        telemetry: &FieldTelemetry,
        _: WriteTime,
        path: &Path,
    ) -> Result<Vec<u8>, String> {
        line(&Request {
            field: field.number(),
            image: utf8(path)?,
            lines: field.lines().code(),
            time_s: telemetry.time_s,
            camera: telemetry.camera,
            contrast: telemetry.digitiser.contrast,
            brightness: telemetry.digitiser.brightness,
        })
    }

    fn outcome(answer: &[u8], number: u64, _: &DockingSetup) -> Result<DockingOutcome, String> {
        outcome(answer, number)
    }
}

/// Returns the outcome stated by an answer to field `number`.
///
/// # Errors
/// The reason why the answer cannot be used.
pub fn outcome(answer: &[u8], number: u64) -> Result<DockingOutcome, String> {
    let answer: Answer = parse(answer)?;
    if answer.field != number {
        return Err(format!("its answer is for field {}, expected field {number}", answer.field));
    }
    let solution = match answer.status.as_str() {
        "measured" => DockingSolution::Measured(Box::new(measurement(&answer)?)),
        "range_only" => range_only(&answer)?,
        text if let Ok(doubt) = text.parse::<FailedCheck>() => {
            DockingSolution::Doubtful { measurement: Box::new(measurement(&answer)?), doubt }
        }
        status => match NoPose::parse(status) {
            None => return Err(format!("its status `{}` is unknown", shortened(status))),
            Some(NoPose::Failed(reason)) => DockingSolution::NoSolution(NoPose::Failed(shortened(&reason))),
            Some(reason) => DockingSolution::NoSolution(reason),
        },
    };
    let digitiser = digitiser(&answer)?;
    Ok(DockingOutcome { solution, features: Features::default(), motion: None, digitiser })
}

fn measurement(answer: &Answer) -> Result<FieldMeasurement, String> {
    let (Some(d), Some(phi_deg)) = (answer.d_m, answer.phi_deg) else {
        return Err("its status requires a pose, but d_m or phi_deg is missing".to_owned());
    };
    let position_m = Vector3::from(d);
    if position_m == Vector3::zeros() {
        return Err("its d_m is the centre of the target, expected a position outside".to_owned());
    }
    let sigma_d = answer.sigma_d_m.unwrap_or_default();
    let sigma_phi = answer.sigma_phi_deg.unwrap_or_default().map(f64::to_radians);
    for sigma in sigma_d.iter().chain(&sigma_phi) {
        if *sigma < 0.0 {
            return Err(format!("its standard deviation is {sigma}, expected 0 or more"));
        }
    }
    let [a, b, c] = sigma_d;
    let [d, e, f] = sigma_phi;
    let sigmas = Vector6::new(a, b, c, d, e, f);
    let pose = Pose { position_m, phi_rad: Vector3::from(phi_deg.map(f64::to_radians)) };
    let covariance = Matrix6::from_diagonal(&sigmas.component_mul(&sigmas));
    Ok(FieldMeasurement { best: PoseEstimate { pose, covariance }, paper: None })
}

fn range_only(answer: &Answer) -> Result<DockingSolution, String> {
    let range_m = answer.range_m.ok_or("its status requires a range, but range_m is missing")?;
    let sigma_m = answer.sigma_range_m.unwrap_or(0.0);
    if range_m <= 0.0 || sigma_m < 0.0 {
        return Err(format!(
            "its range_m is {range_m}, expected above 0, or its sigma_range_m is {sigma_m}, expected 0 or \
             more"
        ));
    }
    Ok(DockingSolution::RangeOnly { range_m, sigma_m })
}

fn digitiser(answer: &Answer) -> Result<Option<Digitiser>, String> {
    let (contrast, brightness) = match (answer.contrast, answer.brightness) {
        (None, None) => return Ok(None),
        (Some(contrast), Some(brightness)) => (contrast, brightness),
        _ => {
            return Err(
                "it requests only one of contrast and brightness, expected both or neither".to_owned()
            );
        }
    };
    let digitiser = Digitiser { contrast, brightness };
    digitiser
        .check()
        .map_err(|error| format!("its requested setting of the digitiser is out of range: {error}"))?;
    Ok(Some(digitiser))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(answer: &str) -> Result<DockingOutcome, String> {
        outcome(answer.as_bytes(), 7)
    }

    fn refused(answer: &str, because: &str) {
        let reason = read(answer).unwrap_err();
        assert!(reason.contains(because), "{reason}");
    }

    #[test]
    fn a_pose_is_read_with_its_requested_digitiser_settings() {
        let got = read(
            r#"{"field": 7, "status": "measured", "d_m": [0.1, 0, 9], "phi_deg": [0, 0, 90], "sigma_d_m": [0.1, 0.1, 0.2],
               "contrast": 2, "brightness": -0.5}"#,
        )
        .unwrap();
        let best = &got.measurement().unwrap().best;
        assert_eq!(best.pose.position_m, Vector3::new(0.1, 0.0, 9.0));
        assert_eq!(best.pose.phi_rad.z, std::f64::consts::FRAC_PI_2);
        assert_eq!((best.covariance[(2, 2)], best.covariance[(3, 3)]), (0.2 * 0.2, 0.0));
        assert_eq!(got.digitiser, Some(Digitiser { contrast: 2.0, brightness: -0.5 }));
    }

    #[test]
    fn ranges_and_reasons_are_read() {
        let range =
            read(r#"{"field": 7, "status": "range_only", "range_m": 310, "sigma_range_m": 4}"#).unwrap();
        assert_eq!(range.solution, DockingSolution::RangeOnly { range_m: 310.0, sigma_m: 4.0 });
        let doubtful =
            read(r#"{"field": 7, "status": "doubtful: features", "d_m": [0, 0, 9], "phi_deg": [0, 0, 0]}"#)
                .unwrap();
        assert!(matches!(doubtful.solution, DockingSolution::Doubtful { doubt: FailedCheck::Features, .. }));
        assert_eq!((doubtful.measurement(), doubtful.any_measurement().is_some()), (None, true));
        for (status, expected) in [
            ("no_target", NoPose::NoTarget),
            ("out_of_field", NoPose::OutOfField),
            ("failed: out of film", NoPose::Failed("out of film".to_owned())),
        ] {
            let got = read(&format!(r#"{{"field": 7, "status": "{status}"}}"#)).unwrap();
            assert_eq!(got.solution, DockingSolution::NoSolution(expected));
        }
    }

    #[test]
    fn values_that_cannot_be_are_refused() {
        let measured = |rest: &str| format!(r#"{{"field": 7, "status": "measured", {rest}}}"#);
        refused(&measured(r#""d_m": [0, 0, 9]"#), "d_m or phi_deg is missing");
        refused(&measured(r#""d_m": [0, 0, NaN], "phi_deg": [0, 0, 0]"#), "cannot be read");
        refused(&measured(r#""d_m": [0, 0, 0], "phi_deg": [0, 0, 0]"#), "centre of the target");
        refused(&measured(r#""d_m": [0, 0, 9], "phi_deg": [0, 0]"#), "cannot be read");
        refused(
            &measured(r#""d_m": [0, 0, 9], "phi_deg": [0, 0, 0], "sigma_d_m": [1, 1, -1]"#),
            "is -1, expected 0 or more",
        );
        refused(
            &measured(r#""d_m": [0, 0, 9], "phi_deg": [0, 0, 0], "contrast": 1"#),
            "expected both or neither",
        );
        refused(
            &measured(r#""d_m": [0, 0, 9], "phi_deg": [0, 0, 0], "contrast": 0, "brightness": 0"#),
            "setting of the digitiser is out of range",
        );
        refused(&measured(r#""d_m": [0, 0, 9], "phi_Deg": [0, 0, 0]"#), "unknown field `phi_Deg`");
        refused(r#"{"field": 7, "status": "range_only"}"#, "range_m is missing");
        refused(r#"{"field": 7, "status": "doubtful: motion"}"#, "d_m or phi_deg is missing");
        refused(r#"{"field": 7, "status": "doubtful"}"#, "its status `doubtful` is unknown");
        refused(r#"{"field": 8, "status": "no_target"}"#, "its answer is for field 8, expected field 7");
        refused(r#"{"field": 7, "status": "fine"}"#, "its status `fine` is unknown");
    }
}
