//! Files of the far range: dataset, telemetry, star list, truth, outcomes and clusters.

mod clusters;
mod dataset;
mod manoeuvres;
mod measurements;
mod stars;
mod telemetry;
mod truth;

pub use clusters::{ClusterRow, FrameCluster};
pub use dataset::{CameraFile, Dataset, DatasetFrame};
pub use manoeuvres::{ManoeuvreRow, write_manoeuvres};
pub use measurements::{MeasurementLine, MeasurementWriter, outcome_as_filed, read_measurements};
pub use stars::{StarRow, read_stars, write_stars};
pub use telemetry::{TelemetryLine, TelemetryRow, TelemetryWriter, read_telemetry};
pub use truth::{FrameTruthRow, ObjectTruthRow};

use files::{FieldDeclaration, Table};

/// Returns the fields of each CSV table with its name in `docs/formats.md`.
pub fn csv_tables() -> Vec<(&'static str, Vec<FieldDeclaration>)> {
    vec![
        ("stars.csv", StarRow::declarations()),
        ("telemetry.csv", TelemetryLine::declarations()),
        ("measurements.csv", MeasurementLine::declarations()),
        ("truth/manoeuvres.csv", ManoeuvreRow::declarations()),
    ]
}

/// Returns the fields of each Parquet table with its name in `docs/formats.md`.
pub fn parquet_tables() -> Vec<(&'static str, Vec<FieldDeclaration>)> {
    vec![
        ("truth/frames.parquet", FrameTruthRow::declarations()),
        ("truth/objects.parquet", ObjectTruthRow::declarations()),
        ("clusters.parquet", ClusterRow::declarations()),
    ]
}
