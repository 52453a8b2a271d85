//! Origin of measurements: columns that a CSV of measurements of any world may have in addition to its own.

use std::path::Path;

use hifitime::Epoch;

use super::lines::Lines;
use super::table::csv_error;
use crate::error::{FileLocation, open_regular};
use crate::{FileError, parse_utc};

/// Column with the time of the frame, UTC.
const TIME: &str = "time_utc";
/// Column with the hash of the run's configuration, identical to `CONFHASH` of its FITS files and `hash` of
/// its `run.toml`.
const CONFIGURATION: &str = "configuration";

/// Columns that state the origin of a row.
pub const COLUMNS: [&str; 2] = [TIME, CONFIGURATION];

/// Origin of a measurement, as far as its row states it.
#[derive(Debug, Clone, PartialEq)]
pub struct AnswerOrigin {
    /// Line in the file.
    pub line: u64,
    /// Number of the frame.
    pub frame: u64,
    /// Time of the frame.
    pub time: Option<Epoch>,
    /// Hash of the configuration of the run, hexadecimal.
    pub configuration: Option<String>,
}

/// Returns the line of a CSV whose cell in `column` is `number`. Used in the message about a row that does
/// not belong to the table.
pub fn line_of(path: &Path, column: &str, number: u64) -> Option<u64> {
    let file = Lines::new(open_regular(path).ok()?);
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(file);
    let position = reader.headers().ok()?.iter().position(|name| name == column)?;
    let is_of_number = |record: &csv::StringRecord| {
        record.get(position)?.parse().ok().filter(|found: &u64| *found == number)
    };
    let record = reader.records().map_while(Result::ok).find(|record| is_of_number(record).is_some())?;
    record.position().map(csv::Position::line)
}

/// Reads the origins that a table of measurements contains; empty if it has neither column. `frame` is the
/// name of the column of frame numbers.
///
/// # Errors
/// A [`FileError`] that names line and column of the first invalid cell.
pub fn read_origins(path: &Path, frame: &str) -> Result<Vec<AnswerOrigin>, FileError> {
    let file = Lines::new(open_regular(path)?);
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(file);
    let header = reader.headers().map_err(|error| csv_error(path, &error))?.clone();
    let position = |name: &str| header.iter().position(|column| column == name);
    let (number, time, configuration) = (position(frame), position(TIME), position(CONFIGURATION));
    if time.is_none() && configuration.is_none() {
        return Ok(Vec::new());
    }
    let mut origins = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| csv_error(path, &error))?;
        let line = record.position().map_or(0, csv::Position::line);
        let cell = |at: Option<usize>| at.and_then(|at| record.get(at)).filter(|cell| !cell.is_empty());
        let refuse = |column: &str, found: &str, expected: &str| {
            FileError::value(path, FileLocation::Line(line), column, found, expected)
        };
        let text = cell(number).unwrap_or_default();
        let number = text.parse().map_err(|_| refuse(frame, text, "the number of a frame"))?;
        let time = cell(time)
            .map(|text| parse_utc(text).map_err(|expected| refuse(TIME, text, &expected)))
            .transpose()?;
        origins.push(AnswerOrigin {
            line,
            frame: number,
            time,
            configuration: cell(configuration).map(str::to_owned),
        });
    }
    Ok(origins)
}
