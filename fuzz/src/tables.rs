//! Fuzz targets for tables: CSV and Parquet, and the directories that contain them.

use std::fmt::Debug;
use std::path::Path;

use boresight::docking::rows::{
    FeatureRow, FieldMeasurementLine, FieldMeasurementWriter, FieldRow, FieldTelemetryLine,
    FieldTelemetryWriter, FieldTruthRow, MotionLine, MotionWriter, read_field_measurements,
    read_field_telemetry, read_motion,
};
use boresight::far_range::rows::{
    Dataset, FrameCluster, FrameTruthRow, MeasurementLine, MeasurementWriter, ObjectTruthRow, TelemetryRow,
    TelemetryWriter, read_measurements, read_stars, read_telemetry, write_stars,
};
use boresight::files::{
    FileError, Row, TableReader, TableWriter, read_column, read_parquet_table, write_csv,
};
use boresight::gate::Baseline;
use boresight::navigate::read_navigation;
use boresight::read_csv_table;
use boresight::study::CaseTable;
use boresight::visibility::read_sky;
use contract::docking::{DockingOutcome, MotionReport};
use contract::{Camera, Outcome};
use sha2::{Digest, Sha256};

use crate::{Sandbox, written};

/// A valid baseline.
const BASELINE: &str = include_str!("../corpus/baseline/argon.toml");
const BASELINE_ROWS: &[u8] = include_bytes!("../corpus/baseline_rows/argon.parquet");

/// Camera of the frames to which the measurements refer.
const CAMERA: Camera = Camera {
    columns: 752,
    rows: 580,
    focal_length_mm: 20.187,
    pixel_width_um: 8.6,
    pixel_height_um: 8.3,
    principal_x_px: 395.0,
    principal_y_px: 288.0,
    radial: [0.0; 3],
    tangential: [0.0; 2],
};

/// Passes the bytes to every CSV reader; each reader recognises its tables by their header.
pub(crate) fn csv(sandbox: &Sandbox, bytes: &[u8]) {
    let path = sandbox.file("a.csv", bytes);
    written_again(sandbox, &path, read_telemetry, write_telemetry);
    written_again(sandbox, &path, read_field_telemetry, write_field_telemetry);
    written_again(sandbox, &path, |path| read_measurements(path, &CAMERA), write_measurements);
    written_again(sandbox, &path, read_field_measurements, write_field_measurements);
    written_again(sandbox, &path, read_motion, write_motion);
    written_again(sandbox, &path, read_stars, write_stars);
    written_again(sandbox, &path, read_navigation, write_csv);
    let _ = read_sky(&path);
    let _ = read_column(&path, "value");
    let _ = read_csv_table(&path);
}

/// Reads a table; a table that is read is written and read again.
fn written_again<R: Debug + PartialEq>(
    sandbox: &Sandbox,
    path: &Path,
    read: impl Fn(&Path) -> Result<Vec<R>, FileError>,
    write: impl Fn(&Path, &[R]) -> Result<(), FileError>,
) {
    if let Ok(rows) = read(path) {
        let write = |path: &Path, rows: &Vec<R>| write(path, rows);
        written::check(sandbox, "again.csv", &rows, write, read);
    }
}

fn write_telemetry(path: &Path, rows: &[TelemetryRow]) -> Result<(), FileError> {
    let mut writer = TelemetryWriter::create(path)?;
    rows.iter().try_for_each(|row| writer.line(&row.into()))?;
    writer.finish()
}

fn write_field_telemetry(path: &Path, rows: &[FieldRow]) -> Result<(), FileError> {
    let mut writer = FieldTelemetryWriter::create(path)?;
    rows.iter().try_for_each(|row| writer.line(&FieldTelemetryLine::from_row(row)))?;
    writer.finish()
}

fn write_measurements(path: &Path, rows: &[(u64, Outcome)]) -> Result<(), FileError> {
    let mut writer = MeasurementWriter::create(path)?;
    rows.iter()
        .try_for_each(|(frame, outcome)| writer.line(&MeasurementLine::from_outcome(*frame, outcome)))?;
    writer.finish()
}

fn write_field_measurements(path: &Path, rows: &[(u64, DockingOutcome)]) -> Result<(), FileError> {
    let mut writer = FieldMeasurementWriter::create(path)?;
    rows.iter()
        .try_for_each(|(field, outcome)| writer.line(&FieldMeasurementLine::from_outcome(*field, outcome)))?;
    writer.finish()
}

fn write_motion(path: &Path, rows: &[(u64, MotionReport)]) -> Result<(), FileError> {
    let mut writer = MotionWriter::create(path)?;
    let mut lines = rows.iter().flat_map(|(field, report)| MotionLine::from_report(*field, report));
    lines.try_for_each(|line| writer.line(&line))?;
    writer.finish()
}

pub(crate) fn parquet(sandbox: &Sandbox, bytes: &[u8]) {
    let path = sandbox.file("a.parquet", bytes);
    rows::<FrameTruthRow>(sandbox, &path);
    rows::<ObjectTruthRow>(sandbox, &path);
    rows::<FieldTruthRow>(sandbox, &path);
    rows::<FeatureRow>(sandbox, &path);
    rows::<FrameCluster>(sandbox, &path);
    let _ = CaseTable::columns_of(&path).and_then(|columns| columns.read(&path));
    let _ = read_parquet_table(&path);
}

fn rows<R: Row + Clone + Debug + PartialEq>(sandbox: &Sandbox, path: &Path) {
    if let Ok(rows) = read_rows::<R>(path) {
        let write = |path: &Path, rows: &Vec<R>| write_rows(path, rows);
        written::check(sandbox, "again.parquet", &rows, write, read_rows);
    }
}

fn read_rows<R: Row>(path: &Path) -> Result<Vec<R>, FileError> {
    let mut rows = Vec::new();
    for frame in TableReader::<R>::open(path)? {
        rows.extend(frame?.1);
    }
    Ok(rows)
}

fn write_rows<R: Row + Clone>(path: &Path, rows: &[R]) -> Result<(), FileError> {
    let mut writer = TableWriter::create(path)?;
    writer.write(rows.iter().cloned())?;
    writer.finish()
}

pub(crate) fn baseline(sandbox: &Sandbox, bytes: &[u8]) {
    sandbox.file("baseline.toml", bytes);
    sandbox.file("rows.parquet", BASELINE_ROWS);
    let _ = Baseline::read(sandbox.path());
}

/// Inserts the hash of the given rows into the header, so that the rows pass the hash check and are read.
pub(crate) fn baseline_rows(sandbox: &Sandbox, bytes: &[u8]) {
    let sha256 =
        |bytes: &[u8]| Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    let header = BASELINE.replace(&sha256(BASELINE_ROWS), &sha256(bytes));
    sandbox.file("baseline.toml", header.as_bytes());
    sandbox.file("rows.parquet", bytes);
    let _ = Baseline::read(sandbox.path());
}

/// A table that names images, in a directory with one image.
pub(crate) fn dataset(sandbox: &Sandbox, bytes: &[u8]) {
    sandbox.file("camera.toml", include_bytes!("../corpus/camera/small.toml"));
    sandbox.file("000000.png", include_bytes!("../corpus/png/small.png"));
    sandbox.file("telemetry.csv", bytes);
    let Ok(dataset) = Dataset::open(sandbox.path()) else { return };
    for frame in dataset.frames() {
        let inside = frame.path().canonicalize().is_ok_and(|path| path.starts_with(sandbox.path()));
        assert!(inside, "{} is outside the dataset", frame.path().display());
        let _ = dataset.read(frame);
    }
}
