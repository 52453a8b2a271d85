//! `telemetry.csv`: the telemetry that a pipeline may use for each frame.

use std::path::Path;

use contract::{Body, Icrs, Rotation, Telemetry, Window};
use files::{
    CsvLine, CsvReader, CsvRow, CsvWriter, FileError, format_utc, optional, parse_utc, table, windows,
};
use nalgebra::Vector3;

/// Columns of the velocity components.
const VELOCITY: [&str; 3] = ["v_orbital_j2000_x_km_s", "v_orbital_j2000_y_km_s", "v_orbital_j2000_z_km_s"];

table! {
    /// A row of `telemetry.csv`.
    pub struct TelemetryLine: csv {
        /// number of the frame; ascending, gaps allowed
        frame: u64,
        /// path of the image below the directory; empty when none was saved. `process` needs it
        file: String = optional(["file"]),
        /// middle of the exposure: 2012-04-25T13:02:07.250000000Z; up to nine decimals, `Z` is required;
        /// ascending. Second 60 is accepted only where a leap second was inserted
        time_utc: String,
        /// exposure time, s, 0 or more
        exposure_s: f64,
        /// measured attitude of the spacecraft, norm 1 within 1e-5
        body_from_icrs: Rotation<Body, Icrs> = ["q_sc_j2000_w", "q_sc_j2000_x", "q_sc_j2000_y", "q_sc_j2000_z"],
        /// measured velocity about the Earth, km/s, ICRS axes, at most 100 km/s; all three or none
        velocity_km_s: Option<Vector3<f64>> = optional(VELOCITY),
        /// transmitted regions `x y columns rows`, separated by `;`; `none` when nothing was transmitted;
        /// empty when the whole image was, or when the header of the image states the regions
        windows: String = optional(["windows"]),
    }
}

/// Speed above that of any orbit about the Earth, km/s; a larger value indicates a wrong unit.
const FASTEST_KM_S: f64 = 100.0;

/// Telemetry of one frame, with the path of its image.
#[derive(Debug, Clone, PartialEq)]
pub struct TelemetryRow {
    /// Number of the frame.
    pub frame: u64,
    /// Path of the image relative to the table; `None` if no image was saved.
    pub file: Option<String>,
    /// Telemetry of the frame.
    pub telemetry: Telemetry,
    /// Transmitted regions; `None`: the whole image, or the regions stated in the header of the image.
    pub windows: Option<Vec<Window>>,
}

impl From<&TelemetryRow> for TelemetryLine {
    fn from(row: &TelemetryRow) -> Self {
        let Telemetry { time, exposure_s, body_from_icrs, velocity_km_s } = row.telemetry;
        Self {
            frame: row.frame,
            file: row.file.clone().unwrap_or_default(),
            time_utc: format_utc(time),
            exposure_s,
            body_from_icrs,
            velocity_km_s,
            windows: windows::format(row.windows.as_deref()),
        }
    }
}

/// Writer of the table, row by row.
pub type TelemetryWriter = CsvWriter<TelemetryLine>;

/// Reads the table. Frame numbers ascend, with gaps allowed; times ascend.
///
/// # Errors
/// A [`FileError`] that names line and column of the first invalid cell; also for an empty table.
pub fn read_telemetry(path: &Path) -> Result<Vec<TelemetryRow>, FileError> {
    read_with_lines(path).map(|rows| rows.into_iter().map(|(_, row)| row).collect())
}

/// Shortest exposure besides 0, s. A shorter one is a mistake of a unit or a cut number.
const SHORTEST_EXPOSURE_S: f64 = 1e-9;

/// Reads the table like [`read_telemetry`], each row with its line in the file.
pub(crate) fn read_with_lines(path: &Path) -> Result<Vec<(u64, TelemetryRow)>, FileError> {
    CsvReader::open::<TelemetryLine>(path)?.read_all(parse)
}

fn parse(row: &CsvRow<'_>, previous: Option<&TelemetryRow>) -> Result<TelemetryRow, FileError> {
    let TelemetryLine { frame, file, time_utc, exposure_s, body_from_icrs, velocity_km_s, windows } =
        TelemetryLine::read(row)?;
    row.check_ascends("frame", frame, previous.map(|row| row.frame))?;
    let time = parse_utc(time_utc.trim()).map_err(|expected| row.error("time_utc", expected))?;
    if previous.is_some_and(|previous| time <= previous.telemetry.time) {
        return Err(row.error("time_utc", "later than the time of the previous row"));
    }
    if exposure_s != 0.0 && exposure_s < SHORTEST_EXPOSURE_S {
        return Err(row.error("exposure_s", "0, or 1e-9 or greater"));
    }
    if velocity_km_s.is_some_and(|velocity| velocity.norm() > FASTEST_KM_S) {
        return Err(row.error(VELOCITY[0], "a velocity about the Earth of at most 100 km/s"));
    }
    let windows = windows::parse(&windows).map_err(|expected| row.error("windows", expected))?;
    let file = Some(file).filter(|file| !file.is_empty());
    let telemetry = Telemetry { time, exposure_s, body_from_icrs, velocity_km_s };
    Ok(TelemetryRow { frame, file, telemetry, windows })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use hifitime::{Epoch, Unit};
    use proptest::prelude::*;
    use tempfile::tempdir;

    use super::*;

    const HEADER: &str = "frame,file,time_utc,exposure_s,q_sc_j2000_w,q_sc_j2000_x,q_sc_j2000_y,q_sc_j2000_z";

    /// Returns the error message for a table with these rows.
    fn refused(header: &str, rows: &[&str]) -> String {
        let directory = tempdir().unwrap();
        let path = directory.path().join("telemetry.csv");
        fs::write(&path, format!("{header}\n{}\n", rows.join("\n"))).unwrap();
        read_telemetry(&path).unwrap_err().to_string()
    }

    fn check_refused(rows: &[&str], line: &str, column: &str) {
        let message = refused(HEADER, rows);
        assert!(message.contains("telemetry.csv"), "{message}");
        assert!(message.contains(line) && message.contains(&format!("`{column}`")), "{message}");
    }

    const GOOD: &str = "1,a.fits,2012-04-25T00:00:00Z,0.25,1,0,0,0";

    #[test]
    fn each_bad_cell_is_named_by_line_and_column() {
        check_refused(&[GOOD, "x,,2012-04-25T00:00:01Z,0.25,1,0,0,0"], "line 3", "frame");
        check_refused(&[GOOD, "2,,2012-04-25T23:59:60Z,0.25,1,0,0,0"], "line 3", "time_utc");
        check_refused(&["1,,yesterday,0.25,1,0,0,0"], "line 2", "time_utc");
        check_refused(&["1,,2012-04-25T00:00:01Z,-0.25,1,0,0,0"], "line 2", "exposure_s");
        check_refused(&["1,,2012-04-25T00:00:01Z,1e-320,1,0,0,0"], "line 2", "exposure_s");
        check_refused(&["1,,2012-04-25T00:00:01Z,NaN,1,0,0,0"], "line 2", "exposure_s");
        check_refused(&["1,,2012-04-25T00:00:01Z,inf,1,0,0,0"], "line 2", "exposure_s");
        check_refused(&["1,,2012-04-25T00:00:01Z,0.25,1,0,nan,0"], "line 2", "q_sc_j2000_y");
        check_refused(&["1,,2012-04-25T00:00:01Z,0.25,1,0,,0"], "line 2", "q_sc_j2000_y");
        check_refused(&["1,,2012-04-25T00:00:01Z,0.25,1,0.1,0,0"], "line 2", "q_sc_j2000_w");
        check_refused(&[GOOD, GOOD], "line 3", "frame");
        check_refused(&[GOOD, "0,,2012-04-25T00:00:01Z,0.25,1,0,0,0"], "line 3", "frame");
        check_refused(&[GOOD, "2,,2012-04-24T00:00:01Z,0.25,1,0,0,0"], "line 3", "time_utc");
        check_refused(&[GOOD, "2,,2012-04-25T00:00:01Z"], "line 3", "number of cells");
        check_refused(&[], "header", "number of rows");
    }

    #[test]
    fn a_missing_column_and_an_unknown_one_are_named() {
        let message = refused("frame,time_utc,exposure_s", &["1,2012-04-25T00:00:00Z,1"]);
        assert!(message.contains("`q_sc_j2000_w` is missing"), "{message}");
        let message = refused(&format!("{HEADER},v_orbital_j2000_x_kms"), &[&format!("{GOOD},1")]);
        assert!(message.contains("did you mean `v_orbital_j2000_x_km_s`"), "{message}");
        let message = refused(&format!("{HEADER},frame"), &[&format!("{GOOD},1")]);
        assert!(message.contains("each column once"), "{message}");
        let half = refused(&format!("{HEADER},v_orbital_j2000_x_km_s"), &[&format!("{GOOD},7.5")]);
        assert!(half.contains("`v_orbital_j2000_y_km_s`"), "{half}");
        let windows = refused(&format!("{HEADER},windows"), &[&format!("{GOOD},1 2 3")]);
        assert!(windows.contains("line 2") && windows.contains("`windows`"), "{windows}");
    }

    #[test]
    fn a_byte_order_mark_crlf_and_columns_in_another_order_are_read() {
        let directory = tempdir().unwrap();
        let path = directory.path().join("telemetry.csv");
        let text = "\u{feff}time_utc, frame ,q_sc_j2000_x,q_sc_j2000_w,q_sc_j2000_y,q_sc_j2000_z,exposure_s\r\n\
                    2012-04-25T00:00:00Z,7,0,1,0,0,0.5\r\n";
        fs::write(&path, text).unwrap();
        let rows = read_telemetry(&path).unwrap();
        assert_eq!((rows[0].frame, rows[0].telemetry.exposure_s, rows[0].file.clone()), (7, 0.5, None));
        assert_eq!(rows[0].telemetry.velocity_km_s, None);
    }

    prop_compose! {
        fn any_row()(
            seconds in 0.0..1e6_f64, exposure_s in 0.0..10.0_f64, axis in prop::array::uniform3(-3.0..3.0_f64),
            velocity in prop::option::of(prop::array::uniform3(-8.0..8.0_f64)),
            file in prop::option::of("[a-z ,\"]{1,8}.fits"), corner in 0_usize..100, regions in 0_usize..4,
        ) -> TelemetryRow {
            TelemetryRow {
                frame: 0,
                file,
                telemetry: Telemetry {
                    time: Epoch::from_gregorian_utc_at_midnight(2012, 4, 23) + Unit::Second * seconds,
                    exposure_s,
                    body_from_icrs: Rotation::from_rotation_vector(Vector3::from(axis)),
                    velocity_km_s: velocity.map(Vector3::from),
                },
                windows: (regions > 0)
                    .then(|| vec![Window { x: corner, y: 1, columns: 64, rows: 64 }; regions - 1]),
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn every_bit_round_trips(mut rows in prop::collection::vec(any_row(), 1..8)) {
            rows.sort_by_key(|row| row.telemetry.time);
            for (number, row) in rows.iter_mut().enumerate() {
                row.frame = 3 * number as u64;
            }
            let directory = tempdir().unwrap();
            let path = directory.path().join("telemetry.csv");
            let mut writer = TelemetryWriter::create(&path).unwrap();
            rows.iter().for_each(|row| writer.line(&row.into()).unwrap());
            writer.finish().unwrap();
            prop_assert_eq!(read_telemetry(&path).unwrap(), rows);
        }
    }
}
