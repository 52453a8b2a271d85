//! Lines exchanged with an external pipeline: JSON, one object per line, UTF-8.
//!
//! Greeting, to the process (the star list is the uploaded one; directions are unit vectors along the axes of
//! ICRS, without aberration; quaternions are Hamilton's, scalar first, v_cam = q v_sc q*):
//! ```json
//! {"boresight_pipeline": 1, "camera": {"columns": 752, "rows": 580, "focal_length_mm": 20.187, "...": 0},
//!  "q_cam_sc": [1, 0, 0, 0], "bit_depth": 12, "readout": {"gain_e_per_dn": 10, "...": 0},
//!  "calibration": {"full_well_e": 40000, "...": 0}, "stars": [{"id": 11767, "icrs": [0, 0, 1], "magnitude": 1.97}]}
//! ```
//! (`readout` and `calibration` are absent if unknown.) The answer to it:
//! ```json
//! {"boresight_pipeline": 1, "name": "my pipeline"}
//! ```
//! Frame, to the process (`image` is a FITS file of 16 bits that is removed after the answer; `windows` are
//! the transmitted regions as [x, y, columns, rows], `null` when the whole image was transmitted; the
//! velocity is the one about the Earth, `null` if unknown):
//! ```json
//! {"frame": 12, "image": "/tmp/12.fits", "windows": null, "telemetry": {"time_utc": "2012-04-25T00:00:00.000000000Z",
//!  "exposure_s": 0.25, "q_sc_j2000": [1, 0, 0, 0], "v_orbital_j2000_km_s": [7.5, 0, 0]}}
//! ```
//! The answer to it. A detection has a position in pixels (the centre of the first pixel is 0, 0). Optional
//! are a line of sight, the attitude of the camera, the number of stars identified, and the covariances of
//! the position, px, and of the line of sight, degrees, each as two standard deviations and their
//! correlation:
//! ```json
//! {"frame": 12, "status": "detected", "x_px": 395.2, "y_px": 288.1, "los_j2000": [1, 0, 0],
//!  "q_cam_j2000": [1, 0, 0, 0], "n_stars": 14, "sigma_x_px": 0.05, "sigma_y_px": 0.04, "correlation_xy": 0.1,
//!  "sigma_ra_deg": 0.002, "sigma_dec_deg": 0.002, "correlation_ra_dec": 0}
//! ```
//! Without a target, the answer is `{"frame": 12, "status": "no_target"}`. Other reasons are those of
//! [`contract::NoSolution::code`], and `failed: ` followed by a reason. An unknown key makes an answer
//! unusable; otherwise a misspelt key would be treated as missing. A line has at most [`MAX_LINE_BYTES`]
//! bytes.

use std::path::Path;

use contract::{
    Calibration, Camera, Covariance2, Direction, FarRange, Frame, Measurement, NoSolution, OutOfRange,
    Outcome, PixelPoint, Readout, Rotation, Setup, Solution, Telemetry,
};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::{Protocol, WriteTime};

/// Version of the protocol, the first key of every greeting.
pub const VERSION: u32 = 1;

/// Longest line that a process may write, 1 MiB.
pub const MAX_LINE_BYTES: usize = 1 << 20;

#[derive(Serialize)]
struct Greeting<'a> {
    boresight_pipeline: u32,
    camera: &'a Camera,
    q_cam_sc: [f64; 4],
    bit_depth: u8,
    #[serde(skip_serializing_if = "Option::is_none")]
    readout: Option<Readout>,
    #[serde(skip_serializing_if = "is_unknown")]
    calibration: Calibration,
    #[serde(skip_serializing_if = "Option::is_none")]
    zero_suppression_dn: Option<u16>,
    stars: Vec<Star>,
}

fn is_unknown(calibration: &Calibration) -> bool {
    *calibration == Calibration::default()
}

#[derive(Serialize)]
struct Star {
    id: u32,
    icrs: [f64; 3],
    magnitude: f64,
}

#[derive(Deserialize)]
struct GreetingAnswer {
    boresight_pipeline: u32,
    /// Name of the pipeline. Required to make logs readable; otherwise unused.
    #[serde(rename = "name")]
    _name: String,
}

#[derive(Serialize)]
struct Request<'a> {
    frame: u64,
    image: &'a str,
    windows: Option<Vec<[usize; 4]>>,
    telemetry: TelemetryLine,
}

#[derive(Serialize)]
struct TelemetryLine {
    time_utc: String,
    exposure_s: f64,
    q_sc_j2000: [f64; 4],
    v_orbital_j2000_km_s: Option<[f64; 3]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Answer {
    frame: u64,
    status: String,
    x_px: Option<f64>,
    y_px: Option<f64>,
    los_j2000: Option<[f64; 3]>,
    q_cam_j2000: Option<[f64; 4]>,
    n_stars: Option<u32>,
    sigma_x_px: Option<f64>,
    sigma_y_px: Option<f64>,
    correlation_xy: Option<f64>,
    sigma_ra_deg: Option<f64>,
    sigma_dec_deg: Option<f64>,
    correlation_ra_dec: Option<f64>,
    log_odds: Option<f64>,
}

/// Status of an answer with a target.
const DETECTED: &str = "detected";

impl Answer {
    fn position_covariance(&self) -> [Option<f64>; 3] {
        [self.sigma_x_px, self.sigma_y_px, self.correlation_xy]
    }

    fn line_of_sight_covariance(&self) -> [Option<f64>; 3] {
        [self.sigma_ra_deg, self.sigma_dec_deg, self.correlation_ra_dec]
    }

    fn states_a_covariance(&self) -> bool {
        let stated = [self.position_covariance(), self.line_of_sight_covariance()];
        stated.iter().flatten().any(Option::is_some)
    }
}

/// Checks the answer to the greeting.
///
/// # Errors
/// The reason why the answer cannot be used.
pub fn check_greeting(answer: &[u8]) -> Result<(), String> {
    let answer: GreetingAnswer = parse(answer)?;
    if answer.boresight_pipeline == VERSION {
        Ok(())
    } else {
        Err(format!("it uses version {} of the protocol, expected {VERSION}", answer.boresight_pipeline))
    }
}

impl Protocol for FarRange {
    const EXTENSION: &'static str = "fits";

    fn greeting(setup: &Setup) -> Result<Vec<u8>, String> {
        let star = |star: &contract::ListedStar| Star {
            id: star.id,
            icrs: (*star.direction.vector()).into(),
            magnitude: star.magnitude,
        };
        line(&Greeting {
            boresight_pipeline: VERSION,
            camera: &setup.camera,
            q_cam_sc: setup.camera_from_body.wxyz(),
            bit_depth: setup.bit_depth,
            readout: setup.readout,
            calibration: setup.calibration,
            zero_suppression_dn: setup.zero_suppression_dn,
            stars: setup.stars.iter().map(star).collect(),
        })
    }

    fn request(
        frame: &Frame,
        telemetry: &Telemetry,
        write_time: WriteTime,
        path: &Path,
    ) -> Result<Vec<u8>, String> {
        let image = utf8(path)?;
        let windows =
            frame.windows().map(|windows| windows.iter().map(|w| [w.x, w.y, w.columns, w.rows]).collect());
        line(&Request {
            frame: frame.number(),
            image,
            windows,
            telemetry: TelemetryLine {
                time_utc: write_time(telemetry.time),
                exposure_s: telemetry.exposure_s,
                q_sc_j2000: telemetry.body_from_icrs.wxyz(),
                v_orbital_j2000_km_s: telemetry.velocity_km_s.map(Into::into),
            },
        })
    }

    fn outcome(answer: &[u8], number: u64, setup: &Setup) -> Result<Outcome, String> {
        outcome(answer, number, (setup.camera.columns, setup.camera.rows))
    }
}

/// Returns the outcome stated by an answer to frame `number`, for a detector of `size_px` (columns, rows).
///
/// # Errors
/// The reason why the answer cannot be used.
pub fn outcome(answer: &[u8], number: u64, size_px: (usize, usize)) -> Result<Outcome, String> {
    let answer: Answer = parse(answer)?;
    if answer.frame != number {
        return Err(format!("its answer is for frame {}, expected frame {number}", answer.frame));
    }
    let camera_from_icrs = answer
        .q_cam_j2000
        .map(|wxyz| Rotation::from_wxyz(wxyz).map_err(|error| format!("its q_cam_j2000: {error}")))
        .transpose()?;
    let solution = match answer.status.as_str() {
        status if status != DETECTED && answer.states_a_covariance() => {
            return Err(format!("it states a covariance with the status `{}`", shortened(status)));
        }
        status if status != DETECTED && answer.log_odds.is_some() => {
            return Err(format!("it states log_odds with the status `{}`", shortened(status)));
        }
        DETECTED => Solution::Detected(measurement(&answer, size_px)?),
        status => match NoSolution::parse(status) {
            None => return Err(format!("its status `{}` is unknown", shortened(status))),
            Some(NoSolution::Failed(reason)) => Solution::NoSolution(NoSolution::Failed(shortened(&reason))),
            Some(reason) => Solution::NoSolution(reason),
        },
    };
    Ok(Outcome {
        solution,
        camera_from_icrs,
        attitude_source: None,
        n_stars: answer.n_stars,
        clusters: Vec::new(),
    })
}

fn measurement(answer: &Answer, (columns, rows): (usize, usize)) -> Result<Measurement, String> {
    let (Some(x), Some(y)) = (answer.x_px, answer.y_px) else {
        return Err("its status requires a position, but x_px or y_px is missing".to_owned());
    };
    let position = PixelPoint::new(x, y);
    if !position.is_on_detector(columns, rows) {
        return Err(format!("its target at ({x}, {y}) is not on the detector of {columns} × {rows} pixels"));
    }
    let line_of_sight = match answer.los_j2000 {
        None => None,
        Some(los) => {
            let vector = Vector3::from(los);
            let direction = Direction::from_vector(vector)
                .ok()
                .filter(|_| (vector.norm() - 1.0).abs() < 1e-5)
                .ok_or_else(|| format!("its los_j2000 {los:?} is not a unit vector"))?;
            Some(direction)
        }
    };
    let of_position = answer.position_covariance();
    let of_line_of_sight = answer.line_of_sight_covariance();
    if line_of_sight.is_none() && of_line_of_sight.iter().any(Option::is_some) {
        return Err("it states a covariance of a line of sight, but no los_j2000".to_owned());
    }
    let in_px = |[x, y, correlation]: [f64; 3]| Covariance2::from_sigmas(x, y, correlation);
    Ok(Measurement {
        position,
        position_covariance: covariance(["sigma_x_px", "sigma_y_px", "correlation_xy"], of_position, in_px)?,
        line_of_sight,
        line_of_sight_covariance: covariance(
            ["sigma_ra_deg", "sigma_dec_deg", "correlation_ra_dec"],
            of_line_of_sight,
            Covariance2::from_degrees,
        )?,
        log_odds: answer.log_odds,
    })
}

/// Returns the covariance given by three keys of an answer, if any.
fn covariance(
    keys: [&str; 3],
    said: [Option<f64>; 3],
    make: impl FnOnce([f64; 3]) -> Result<Covariance2, OutOfRange>,
) -> Result<Option<Covariance2>, String> {
    let values = match said {
        [None, None, None] => return Ok(None),
        [Some(x), Some(y), Some(correlation)] => [x, y, correlation],
        _ => return Err(format!("it states only some of {}, expected all three or none", keys.join(", "))),
    };
    let refused = |wrong: OutOfRange| {
        let [x, y, correlation] = keys;
        let (key, value) = match wrong.path.as_str() {
            "sigma_x" => (x, values[0]),
            "sigma_y" => (y, values[1]),
            _ => (correlation, values[2]),
        };
        format!("its {key} is {value}, expected {}", wrong.expected)
    };
    make(values).map(Some).map_err(refused)
}

pub(super) fn line(value: &impl Serialize) -> Result<Vec<u8>, String> {
    let mut line =
        serde_json::to_vec(value).map_err(|error| format!("the line cannot be encoded: {error}"))?;
    line.push(b'\n');
    Ok(line)
}

/// Returns a path as text for a line.
pub(super) fn utf8(path: &Path) -> Result<&str, String> {
    path.to_str().ok_or_else(|| format!("the path {} is not UTF-8", path.display()))
}

pub(super) fn parse<'a, T: Deserialize<'a>>(line: &'a [u8]) -> Result<T, String> {
    // Some languages write a byte-order mark before their first line.
    let line = line.strip_prefix("\u{feff}".as_bytes()).unwrap_or(line);
    serde_json::from_slice(line).map_err(|error| {
        format!("its answer `{}` cannot be read: {error}", shortened(&String::from_utf8_lossy(line)))
    })
}

/// Returns the beginning of a text, for a message.
pub(super) fn shortened(text: &str) -> String {
    const MOST: usize = 200;
    let text = text.trim_end();
    let beginning = text.char_indices().nth(MOST).and_then(|(end, _)| text.get(..end));
    harmless(&beginning.map_or_else(|| text.to_owned(), |beginning| format!("{beginning}…")))
}

/// Returns a text without control characters and without characters that are invisible or change the order of
/// others. Text quoted from a file or a program may contain escape sequences for terminals and marks of the
/// writing direction (U+202E and others), which are replaced by their code numbers. Line breaks and tabs
/// remain.
pub fn harmless(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for character in text.chars() {
        if is_harmful(character) {
            shown.extend(character.escape_unicode());
        } else {
            shown.push(character);
        }
    }
    shown
}

/// Returns true for a character that can change how a terminal shows the text about it.
fn is_harmful(character: char) -> bool {
    (character.is_control() && !matches!(character, '\n' | '\t')) || is_invisible(character)
}

/// Returns true for the characters that have no image (Unicode 16.0, Default_Ignorable_Code_Point; not the
/// joiners and the sixteen common variation selectors, which shape visible characters), and for the
/// separators of lines and paragraphs.
pub fn is_invisible(character: char) -> bool {
    matches!(
        character,
        '\u{ad}'
            | '\u{34f}'
            | '\u{61c}'
            | '\u{115f}'..='\u{1160}'
            | '\u{17b4}'..='\u{17b5}'
            | '\u{180e}'
            | '\u{200b}'
            | '\u{200e}'..='\u{200f}'
            | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}'
            | '\u{3164}'
            | '\u{feff}'
            | '\u{ffa0}'
            | '\u{fff0}'..='\u{fffb}'
            | '\u{1bca0}'..='\u{1bca3}'
            | '\u{1d173}'..='\u{1d17a}'
            | '\u{e0000}'..='\u{e0fff}'
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use contract::NoSolution;

    #[test]
    fn characters_that_change_the_text_about_them_are_shown_by_number() {
        assert_eq!(harmless("a\u{202e}b\u{feff}c\u{200b}"), "a\\u{202e}b\\u{feff}c\\u{200b}");
        assert_eq!(harmless("ä φ σ′ \u{200d}\u{fe0f}"), "ä φ σ′ \u{200d}\u{fe0f}");
    }

    #[test]
    fn a_greeting_may_begin_with_a_byte_order_mark() {
        assert_eq!(check_greeting("\u{feff}{\"boresight_pipeline\":1,\"name\":\"x\"}".as_bytes()), Ok(()));
    }

    fn read(answer: &str) -> Result<Outcome, String> {
        outcome(answer.as_bytes(), 7, (100, 80))
    }

    fn refused(answer: &str, because: &str) {
        let reason = read(answer).unwrap_err();
        assert!(reason.contains(because), "{reason}");
    }

    #[test]
    fn a_detection_is_read() {
        let got = read(
            r#"{"frame": 7, "status": "detected", "x_px": 1.5, "y_px": 79.5, "los_j2000": [0, 0, 1], "n_stars": 3}"#,
        )
        .unwrap();
        let measurement = got.measurement().unwrap();
        assert_eq!(measurement.position, PixelPoint::new(1.5, 79.5));
        assert_eq!(measurement.line_of_sight, Some(Direction::from_unit(Vector3::z())));
        assert_eq!((got.n_stars, got.camera_from_icrs), (Some(3), None));
    }

    #[test]
    fn covariances_are_read_in_the_units_of_their_keys() {
        let detected = |rest: &str| {
            format!(
                r#"{{"frame": 7, "status": "detected", "x_px": 1, "y_px": 2, "los_j2000": [0, 0, 1]{rest}}}"#
            )
        };
        let got = read(&detected(
            r#", "sigma_x_px": 0.5, "sigma_y_px": 0.25, "correlation_xy": -0.5,
               "sigma_ra_deg": 90, "sigma_dec_deg": 180, "correlation_ra_dec": 0"#,
        ));
        let measurement = *got.unwrap().measurement().unwrap();
        assert_eq!(measurement.position_covariance.unwrap().matrix(), [0.25, -0.0625, 0.0625]);
        let pi = std::f64::consts::PI;
        assert_eq!(measurement.line_of_sight_covariance.unwrap().matrix(), [pi * pi / 4.0, 0.0, pi * pi]);
        let without = read(&detected(r#", "sigma_x_px": null"#)).unwrap();
        assert_eq!(without.measurement().unwrap().position_covariance, None);
    }

    #[test]
    fn invalid_covariances_are_refused_by_their_key() {
        let refused = |rest: &str, because: &str| {
            refused(
                &format!(r#"{{"frame": 7, "status": "detected", "x_px": 1, "y_px": 2, {rest}}}"#),
                because,
            )
        };
        let px = |x: &str, y: &str, rho: &str| {
            format!(r#""sigma_x_px": {x}, "sigma_y_px": {y}, "correlation_xy": {rho}"#)
        };
        refused(&px("0", "1", "0"), "its sigma_x_px is 0, expected a positive number");
        refused(&px("1", "-2", "0"), "its sigma_y_px is -2, expected a positive number");
        refused(&px("1", "2", "1"), "its correlation_xy is 1, expected above -1 to below 1");
        refused(
            &px("1", "2", "null"),
            "only some of sigma_x_px, sigma_y_px, correlation_xy, expected all three or none",
        );
        let degrees = r#""sigma_ra_deg": 1, "sigma_dec_deg": 0, "correlation_ra_dec": 0"#;
        refused(degrees, "a covariance of a line of sight, but no los_j2000");
        refused(
            &format!(r#""los_j2000": [0, 0, 1], {degrees}"#),
            "its sigma_dec_deg is 0, expected a positive",
        );
        self::refused(
            r#"{"frame": 7, "status": "no_target", "sigma_x_px": 1}"#,
            "a covariance with the status `no_target`",
        );
    }

    #[test]
    fn a_reason_is_short_and_free_of_control_characters() {
        assert_eq!(shortened("out of\tfilm \u{1b}[2J\r\n"), "out of\tfilm \\u{1b}[2J");
        assert_eq!(shortened(&"ä".repeat(200)), "ä".repeat(200));
        assert_eq!(shortened(&"ä".repeat(201)), "ä".repeat(200) + "…");
    }

    #[test]
    fn every_reason_is_read() {
        for (status, expected) in [
            ("no_target", NoSolution::NoTarget),
            ("empty_frame", NoSolution::EmptyFrame),
            ("no_previous_frame", NoSolution::NoPreviousFrame),
            ("failed: out of film", NoSolution::Failed("out of film".to_owned())),
        ] {
            let got = read(&format!(r#"{{"frame": 7, "status": "{status}"}}"#)).unwrap();
            assert_eq!(got.solution, Solution::NoSolution(expected));
        }
    }

    #[test]
    fn values_that_cannot_be_are_refused() {
        let detected = |rest: &str| format!(r#"{{"frame": 7, "status": "detected", {rest}}}"#);
        refused(&detected(r#""x_px": NaN, "y_px": 1"#), "cannot be read");
        refused(&detected(r#""x_px": 1e999, "y_px": 1"#), "cannot be read");
        refused(&detected(r#""x_px": null, "y_px": 1"#), "x_px or y_px is missing");
        refused(&detected(r#""x_px": 100, "y_px": 1"#), "is not on the detector of 100 × 80 pixels");
        refused(&detected(r#""x_px": 1, "y_px": 1, "los_j2000": [1, 1, 0]"#), "is not a unit vector");
        refused(&detected(r#""x_px": 1, "y_px": 1, "los_j2000": [0, 0, 0]"#), "is not a unit vector");
        refused(&detected(r#""x_px": 1, "y_px": 1, "q_cam_j2000": [2, 0, 0, 0]"#), "norm 2");
        refused(&detected(r#""x_px": 1, "y_px": 1, "n_stars": -1"#), "cannot be read");
        refused(&detected(r#""x_px": 1, "y_px": 1, "los_J2000": [0, 0, 1]"#), "unknown field `los_J2000`");
    }

    #[test]
    fn an_invalid_answer_is_refused() {
        refused("hello", "its answer `hello` cannot be read");
        refused("", "cannot be read");
        refused(r#"{"frame": 8, "status": "no_target"}"#, "its answer is for frame 8, expected frame 7");
        refused(r#"{"frame": 7, "status": "fine"}"#, "its status `fine` is unknown");
        assert!(read(&"x".repeat(100_000)).unwrap_err().len() < 400, "a message quotes the beginning only");
    }

    #[test]
    fn a_greeting_in_another_version_is_refused() {
        assert!(check_greeting(br#"{"boresight_pipeline": 1, "name": "a"}"#).is_ok());
        let reason = check_greeting(br#"{"boresight_pipeline": 2, "name": "a"}"#).unwrap_err();
        assert_eq!(reason, "it uses version 2 of the protocol, expected 1");
    }
}
