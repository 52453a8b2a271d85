//! Two-line elements, propagated by SGP4.

use std::path::Path;

use files::{FileError, FileLocation};
use hifitime::{Duration, Epoch};
use nalgebra::Vector3;
use sgp4::{Constants, Elements, MinutesSinceEpoch};
use sim::truth::{State, clock};

use crate::coverage::{Coverage, seconds_between};
use crate::frame::ReferenceFrame;

/// Largest file that is read.
const MAX_BYTES: u64 = 1 << 16;

/// Time from the epoch of the elements within which they are used, days. The error of SGP4 grows by a
/// kilometre per day and more.
const VALID_DAYS: i32 = 30;

/// Step of the search for the times that SGP4 supports, hours.
const STEP_HOURS: i32 = 6;

/// Length of a line of elements.
const LENGTH: usize = 69;

/// Columns of line 1, from 0, with their field and the characters that they may have besides digits.
const LINE_1: [(std::ops::Range<usize>, &str, &str); 8] = [
    (18..20, "epoch year", ""),
    (20..32, "epoch day", " ."),
    (33..43, "first derivative of the mean motion", " +-."),
    (44..52, "second derivative of the mean motion", " +-"),
    (53..61, "drag term B*", " +-"),
    (62..63, "ephemeris type", " "),
    (64..68, "element set number", " "),
    (68..69, "checksum", ""),
];

/// Columns of line 2.
const LINE_2: [(std::ops::Range<usize>, &str, &str); 8] = [
    (8..16, "inclination", " ."),
    (17..25, "right ascension of the ascending node", " ."),
    (26..33, "eccentricity", ""),
    (34..42, "argument of perigee", " ."),
    (43..51, "mean anomaly", " ."),
    (52..63, "mean motion", " ."),
    (63..68, "revolution number", " "),
    (68..69, "checksum", ""),
];

/// Element set of one spacecraft, with its propagator.
///
/// The propagator is SGP4 of the crate `sgp4` with the constants of WGS 72 and the formulas of the US Space
/// Force, for which elements are published. Its states are in TEME, rounded to 0.1 mm and 0.1 µm/s: the crate
/// uses the platform's trigonometric functions, and their last digits must not decide about pixels. Then they
/// are turned to ICRS ([`ReferenceFrame::Teme`]).
#[derive(Debug, Clone)]
pub struct Tle {
    name: Option<String>,
    epoch: Epoch,
    constants: Constants,
    coverage: Coverage,
}

impl Tle {
    /// Reads a file with one element set: two lines, or three with the name first.
    ///
    /// # Errors
    /// [`FileError`] with line and field for other content, a wrong checksum, or elements outside the range
    /// of SGP4.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let text = config::regular_file::read_text(path, MAX_BYTES)
            .map_err(|source| FileError::io(path, "read", source))?;
        Self::parse(path, &text)
    }

    /// [`Tle::read`] for text in memory; `path` is for messages.
    ///
    /// # Errors
    /// See [`Tle::read`].
    pub fn parse(path: &Path, text: &str) -> Result<Self, FileError> {
        let lines: Vec<(u64, &str)> =
            (1..).zip(text.lines().map(str::trim_end)).filter(|(_, line)| !line.is_empty()).collect();
        let (name, first, second) = match lines.as_slice() {
            [first, second] => (None, *first, *second),
            [(_, name), first, second] => (Some(name.trim_start_matches("0 ").trim()), *first, *second),
            _ => {
                let expected = "2 lines of one element set, or 3 with its name first";
                let count = lines.len();
                return Err(FileError::value(path, FileLocation::Whole, "number of lines", count, expected));
            }
        };
        check_line(path, first, '1', &LINE_1)?;
        check_line(path, second, '2', &LINE_2)?;
        let refused = |line: u64, value: &str, error: &dyn std::fmt::Display| {
            let expected = format!("an element set that SGP4 supports: {error}");
            FileError::value(path, FileLocation::Line(line), "elements", value, expected)
        };
        let elements = Elements::from_tle(None, first.1.as_bytes(), second.1.as_bytes())
            .map_err(|error| refused(first.0, first.1, &error))?;
        let constants = Constants::from_elements_afspc_compatibility_mode(&elements)
            .map_err(|error| refused(second.0, second.1, &error))?;
        let nanoseconds = elements.datetime.and_utc().timestamp_nanos_opt();
        let epoch = clock::from_unix_ns(nanoseconds.unwrap_or_default());
        let mut tle = Self {
            name: name.filter(|name| !name.is_empty()).map(str::to_owned),
            epoch,
            constants,
            coverage: Coverage { start: epoch, stop: epoch },
        };
        if tle.teme_at(epoch).is_none() {
            return Err(refused(second.0, second.1, &"SGP4 gives no state at its epoch"));
        }
        tle.coverage = tle.supported();
        Ok(tle)
    }

    /// Name of the spacecraft; `None` if the file states none.
    pub fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// Epoch of the elements.
    pub fn epoch(&self) -> Epoch {
        self.epoch
    }

    /// Span in which the elements are used: up to 30 days before and after their epoch, less if SGP4 fails
    /// there (the spacecraft decays).
    pub fn coverage(&self) -> Coverage {
        self.coverage
    }

    fn supported(&self) -> Coverage {
        let end = |sign: i32| {
            let steps = (0..=VALID_DAYS * 24 / STEP_HOURS)
                .map(|step| self.epoch + Duration::from_hours(f64::from(sign * step * STEP_HOURS)));
            steps.take_while(|time| self.teme_at(*time).is_some()).last().unwrap_or(self.epoch)
        };
        Coverage { start: end(-1), stop: end(1) }
    }

    /// Returns the state in TEME, rounded; `None` where SGP4 gives none.
    fn teme_at(&self, time: Epoch) -> Option<State> {
        let minutes = seconds_between(self.epoch, time) / 60.0;
        let state = self.constants.propagate_afspc_compatibility_mode(MinutesSinceEpoch(minutes)).ok()?;
        let rounded = |vector: [f64; 3], scale: f64| {
            Vector3::from(vector.map(|component| libm::round(component * scale) / scale))
        };
        let state =
            State { position_km: rounded(state.position, 1e7), velocity_km_s: rounded(state.velocity, 1e10) };
        let is_finite =
            state.position_km.iter().chain(&state.velocity_km_s).all(|component| component.is_finite());
        is_finite.then_some(state)
    }

    /// Returns the state at `time`, ICRS axes; `None` outside the coverage.
    pub(crate) fn state_at(&self, time: Epoch) -> Option<State> {
        if time < self.coverage.start || self.coverage.stop < time {
            return None;
        }
        let State { position_km, velocity_km_s } = self.teme_at(time)?;
        Some(ReferenceFrame::Teme.icrs_state(time, &position_km, &velocity_km_s))
    }
}

/// Checks length, first character, checksum and numbers of a line. The crate `sgp4` assumes some of them.
fn check_line(
    path: &Path,
    (number, line): (u64, &str),
    first: char,
    columns: &[(std::ops::Range<usize>, &str, &str)],
) -> Result<(), FileError> {
    let refused = |field: &str, value: &str, expected: String| {
        Err(FileError::value(path, FileLocation::Line(number), field, value, expected))
    };
    if line.len() != LENGTH || !line.is_ascii() || line.bytes().any(|byte| byte.is_ascii_control()) {
        let expected = format!("{LENGTH} ASCII characters of line {first} of an element set");
        return refused("line", line, expected);
    }
    if !line.starts_with(first) {
        return refused("line", line, format!("`{first}` as its first character"));
    }
    for (range, field, more) in columns {
        let value = line.get(range.clone()).unwrap_or_default();
        let is_number = value.chars().all(|character| character.is_ascii_digit() || more.contains(character));
        if !is_number || (more.is_empty() && value.is_empty()) {
            let place = format!("a number in the columns {} to {}", range.start + 1, range.end);
            return refused(field, value, place);
        }
    }
    let digits = line.bytes().take(LENGTH - 1);
    let sum = digits.map(|byte| match byte {
        b'0'..=b'9' => u32::from(byte - b'0'),
        b'-' => 1,
        _ => 0,
    });
    let checksum = (sum.sum::<u32>() % 10).to_string();
    if line.ends_with(&checksum) {
        Ok(())
    } else {
        refused("checksum", line.get(68..).unwrap_or_default(), checksum)
    }
}
