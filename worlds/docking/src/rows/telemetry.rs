//! `telemetry.csv` of a docking dataset: the telemetry that a pipeline may use for each field.

use std::path::Path;

use contract::docking::{Digitiser, FieldTelemetry, Lines};
use files::{CsvLine, CsvReader, CsvRow, CsvWriter, FileError, optional, table};

table! {
    /// A row of `telemetry.csv`.
    pub struct FieldTelemetryLine: csv {
        /// number of the field; ascending, gaps allowed
        field: u64,
        /// path of the image below the directory; empty when none was saved
        file: String = optional(["file"]),
        /// time of the field, s since the beginning; ascending
        time_s: f64,
        /// camera rows of the field: `even` (0, 2, 4 …), `odd`, `all` (a progressive frame)
        lines: String,
        /// index of the camera that took the field, from 0; 0 when empty
        camera: Option<usize> = optional(["camera"]),
        /// contrast of the digitiser; 1 when empty
        contrast: Option<f64> = optional(["contrast"]),
        /// brightness of the digitiser; 0 when empty
        brightness: Option<f64> = optional(["brightness"]),
    }
}

/// Telemetry of one field, with the path of its image.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldRow {
    /// Number of the field.
    pub field: u64,
    /// Path of the image relative to the table; `None` if no image was saved.
    pub file: Option<String>,
    /// Camera rows that the image contains.
    pub lines: Lines,
    /// Telemetry of the field. In a table without these columns, the camera is 0 and the digitiser setting
    /// the default.
    pub telemetry: FieldTelemetry,
}

/// Writer of the table, row by row.
pub type FieldTelemetryWriter = CsvWriter<FieldTelemetryLine>;

impl FieldTelemetryLine {
    /// Returns the row of the telemetry of a field.
    pub fn from_row(row: &FieldRow) -> Self {
        let FieldTelemetry { time_s, camera, digitiser } = row.telemetry;
        Self {
            field: row.field,
            file: row.file.clone().unwrap_or_default(),
            time_s,
            lines: row.lines.code().to_owned(),
            camera: Some(camera),
            contrast: Some(digitiser.contrast),
            brightness: Some(digitiser.brightness),
        }
    }
}

/// Reads the table, each row with its line in the file. Field numbers and times ascend; fields may be
/// missing.
///
/// # Errors
/// A [`FileError`] that names line and column of the first invalid cell; also for an empty table.
pub(crate) fn read_with_lines(path: &Path) -> Result<Vec<(u64, FieldRow)>, FileError> {
    CsvReader::open::<FieldTelemetryLine>(path)?.read_all(parse)
}

/// Reads the table: see [`FieldRow`].
///
/// # Errors
/// A [`FileError`] that names line and column of the first invalid cell; also for an empty table.
pub fn read_field_telemetry(path: &Path) -> Result<Vec<FieldRow>, FileError> {
    read_with_lines(path).map(|rows| rows.into_iter().map(|(_, row)| row).collect())
}

fn parse(row: &CsvRow<'_>, previous: Option<&FieldRow>) -> Result<FieldRow, FileError> {
    let line = FieldTelemetryLine::read(row)?;
    let (field, time_s) = (line.field, line.time_s);
    row.check_ascends("field", field, previous.map(|previous| previous.field))?;
    if let Some(previous) = previous.filter(|previous| time_s <= previous.telemetry.time_s) {
        return Err(row.error(
            "time_s",
            format!("later than {}, the time of the previous row", previous.telemetry.time_s),
        ));
    }
    let lines = Lines::parse(line.lines.trim()).ok_or_else(|| row.error("lines", "all, even or odd"))?;
    let nominal = Digitiser::default();
    let digitiser = Digitiser {
        contrast: line.contrast.unwrap_or(nominal.contrast),
        brightness: line.brightness.unwrap_or(nominal.brightness),
    };
    digitiser.check().map_err(|error| {
        let column = if error.path.ends_with("contrast") { "contrast" } else { "brightness" };
        row.error(column, error.to_string())
    })?;
    let camera = line.camera.unwrap_or(0);
    let file = Some(line.file.trim()).filter(|file| !file.is_empty()).map(str::to_owned);
    Ok(FieldRow { field, file, lines, telemetry: FieldTelemetry { time_s, camera, digitiser } })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use tempfile::tempdir;

    use super::*;

    #[test]
    fn rows_round_trip_bit_for_bit() {
        let directory = tempdir().unwrap();
        let path = directory.path().join("telemetry.csv");
        let row = |field: u64, file: Option<&str>| FieldRow {
            field,
            file: file.map(str::to_owned),
            lines: Lines::Odd,
            telemetry: FieldTelemetry {
                time_s: field as f64 / 3.0,
                camera: 1,
                digitiser: Digitiser { contrast: 1.1, brightness: -0.07 },
            },
        };
        let rows = vec![row(0, Some("frames/000000.png")), row(7, None)];
        let mut writer = FieldTelemetryWriter::create(&path).unwrap();
        rows.iter().for_each(|row| writer.line(&FieldTelemetryLine::from_row(row)).unwrap());
        writer.finish().unwrap();
        assert_eq!(read_field_telemetry(&path).unwrap(), rows);
    }

    #[test]
    fn a_wrong_cell_names_its_line_and_column() {
        let directory = tempdir().unwrap();
        let path = directory.path().join("telemetry.csv");
        let check = |rows: &str, parts: [&str; 2]| {
            fs::write(&path, format!("field,file,time_s,lines,contrast\n{rows}")).unwrap();
            let message = read_field_telemetry(&path).unwrap_err().to_string();
            assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        };
        check("0,a.png,0,even,\n0,b.png,1,odd,\n", ["line 3", "`field`"]);
        check("0,a.png,0,even,\n1,b.png,0,odd,\n", ["line 3", "`time_s`"]);
        check("0,a.png,0,upper,\n", ["line 2", "all, even or odd"]);
        check("0,a.png,NaN,even,\n", ["`time_s`", "finite"]);
        check("0,a.png,0,even,99\n", ["`contrast`", "0.1 to 20"]);
        check("", ["number of rows", "at least 1"]);
    }
}
