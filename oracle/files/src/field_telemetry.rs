//! `telemetry.csv` of a docking dataset: what a pipeline may know about each field.

use std::path::Path;

use contract::docking::{Digitiser, FieldTelemetry, Lines};

use super::FileError;
use super::csv_table::Presence::{Optional, Required};
use super::csv_table::{CsvReader, CsvRow, CsvWriter, Layout, cell};

const LAYOUT: Layout = &[
    ("field", Required),
    ("file", Optional),
    ("time_s", Required),
    ("lines", Required),
    ("camera", Optional),
    ("contrast", Optional),
    ("brightness", Optional),
];

/// One row: the telemetry of one field, and where its image is.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldRow {
    /// Number of the field.
    pub field: u64,
    /// The image's file, relative to the table; `None` when no image was saved.
    pub file: Option<String>,
    /// Which rows of the camera the image holds.
    pub lines: Lines,
    /// What is known of the field. In a table without them the camera is 0 and the digitiser the default one.
    pub telemetry: FieldTelemetry,
}

/// Writes the table row by row.
pub struct FieldTelemetryWriter(CsvWriter);

impl FieldTelemetryWriter {
    /// Creates the table.
    ///
    /// # Errors
    /// [`FileError::Io`] when the file exists or cannot be created.
    pub fn create(path: &Path) -> Result<Self, FileError> {
        CsvWriter::create(path, LAYOUT).map(Self)
    }

    /// Writes one row. Numbers are written so that they read back to the same bits.
    ///
    /// # Errors
    /// [`FileError::Io`].
    pub fn write(&mut self, row: &FieldRow) -> Result<(), FileError> {
        let FieldTelemetry { time_s, camera, digitiser } = row.telemetry;
        self.0.write([
            row.field.to_string(),
            row.file.clone().unwrap_or_default(),
            cell(time_s),
            row.lines.code().to_owned(),
            camera.to_string(),
            cell(digitiser.contrast),
            cell(digitiser.brightness),
        ])
    }

    /// Completes the file.
    ///
    /// # Errors
    /// [`FileError::Io`].
    pub fn finish(self) -> Result<(), FileError> {
        self.0.finish()
    }
}

/// Reads the table, each row with its line in the file. Fields and times ascend; fields may be missing.
///
/// # Errors
/// A [`FileError`] that names line and column of the first cell that is not as it should be; an empty table is one
/// too.
pub(super) fn read_with_lines(path: &Path) -> Result<Vec<(u64, FieldRow)>, FileError> {
    CsvReader::open(path, LAYOUT)?.read_all(parse)
}

/// Reads the table: see [`FieldRow`].
///
/// # Errors
/// A [`FileError`] that names line and column of the first cell that is not as it should be; an empty table is one
/// too.
pub fn read_field_telemetry(path: &Path) -> Result<Vec<FieldRow>, FileError> {
    read_with_lines(path).map(|rows| rows.into_iter().map(|(_, row)| row).collect())
}

fn parse(row: &CsvRow<'_>, previous: Option<&FieldRow>) -> Result<FieldRow, FileError> {
    let field = row.number_after("field", previous.map(|previous| previous.field))?;
    let time_s = row.number("time_s")?;
    if let Some(previous) = previous.filter(|previous| time_s <= previous.telemetry.time_s) {
        return Err(
            row.error("time_s", format!("later than {}, that of the row before", previous.telemetry.time_s))
        );
    }
    let lines =
        Lines::parse(row.text("lines").trim()).ok_or_else(|| row.error("lines", "all, even or odd"))?;
    let given = |column: &'static str| !row.text(column).trim().is_empty();
    let nominal = Digitiser::default();
    let digitiser = Digitiser {
        contrast: if given("contrast") { row.number("contrast")? } else { nominal.contrast },
        brightness: if given("brightness") { row.number("brightness")? } else { nominal.brightness },
    };
    for (column, part) in [
        ("contrast", Digitiser { contrast: digitiser.contrast, ..nominal }),
        ("brightness", Digitiser { brightness: digitiser.brightness, ..nominal }),
    ] {
        part.check().map_err(|error| row.error(column, error.to_string()))?;
    }
    let camera = if given("camera") { row.count("camera")? } else { 0 };
    let file = Some(row.text("file").trim()).filter(|file| !file.is_empty()).map(str::to_owned);
    Ok(FieldRow { field, file, lines, telemetry: FieldTelemetry { time_s, camera, digitiser } })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use tempfile::tempdir;

    use super::*;

    #[test]
    fn rows_come_back_to_the_bit() {
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
        rows.iter().for_each(|row| writer.write(row).unwrap());
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
