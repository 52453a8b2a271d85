//! Files of docking: outcomes, features, truth, and the data that a pipeline receives before the first field.

mod covariance;
mod features;
mod measurements;
mod motion;
mod pose;
mod setup;
pub(crate) mod telemetry;
mod truth;

pub use features::FeatureRow;
pub use measurements::{
    FieldMeasurementLine, FieldMeasurementWriter, outcome_as_filed, read_field_measurements,
};
pub use motion::{MotionLine, MotionWriter, read_motion, report_as_filed};
pub use setup::SetupFile;
pub use telemetry::{FieldRow, FieldTelemetryLine, FieldTelemetryWriter, read_field_telemetry};
pub use truth::{FieldTruthRow, truth_as_filed};

use files::{FieldDeclaration, Table};

/// Returns the fields of each CSV table with its name in `docs/formats.md`.
pub fn csv_tables() -> Vec<(&'static str, Vec<FieldDeclaration>)> {
    vec![
        ("telemetry.csv of docking", FieldTelemetryLine::declarations()),
        ("measurements.csv of docking", FieldMeasurementLine::declarations()),
        ("motion.csv", MotionLine::declarations()),
    ]
}

/// Returns the fields of each Parquet table with its name in `docs/formats.md`.
pub fn parquet_tables() -> Vec<(&'static str, Vec<FieldDeclaration>)> {
    vec![
        ("truth/fields.parquet", FieldTruthRow::declarations()),
        ("features.parquet", FeatureRow::declarations()),
    ]
}
