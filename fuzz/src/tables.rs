//! Fuzz targets for tables: CSV and Parquet, and the directories that contain them.

use std::path::Path;

use boresight::files::docking::{FeatureRow, read_field_measurements, read_motion};
use boresight::files::{
    Dataset, FrameCluster, Row, TableReader, read_column, read_csv_table, read_field_telemetry,
    read_measurements, read_parquet_table, read_stars, read_telemetry,
};
use boresight::gate::Baseline;
use boresight::navigate::read_navigation;
use boresight::study::CaseTable;
use boresight::visibility::read_sky;
use contract::Camera;
use sha2::{Digest, Sha256};
use sim::docking::FieldTruth;
use sim::truth::{FrameTruth, ObjectTruth};

use crate::Sandbox;

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
    let _ = read_telemetry(&path);
    let _ = read_field_telemetry(&path);
    let _ = read_measurements(&path, &CAMERA);
    let _ = read_field_measurements(&path);
    let _ = read_motion(&path);
    let _ = read_stars(&path);
    let _ = read_sky(&path);
    let _ = read_navigation(&path);
    let _ = read_column(&path, "value");
    let _ = read_csv_table(&path);
}

pub(crate) fn parquet(sandbox: &Sandbox, bytes: &[u8]) {
    let path = sandbox.file("a.parquet", bytes);
    rows::<FrameTruth>(&path);
    rows::<ObjectTruth>(&path);
    rows::<FieldTruth>(&path);
    rows::<FeatureRow>(&path);
    rows::<FrameCluster>(&path);
    let _ = CaseTable::columns_of(&path).and_then(|columns| columns.read(&path));
    let _ = read_parquet_table(&path);
}

fn rows<R: Row>(path: &Path) {
    if let Ok(table) = TableReader::<R>::open(path) {
        table.for_each(drop);
    }
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
