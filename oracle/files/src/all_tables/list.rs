//! List of all declared tables, used to document them and to export their columns.

use sim::truth::{FrameTruth, ObjectTruth};

use crate::docking::telemetry::FieldTelemetryLine;
use crate::docking::{FeatureRow, FieldMeasurementLine, FieldTruthRow, MotionLine};
use crate::far_range::clusters::ClusterRow;
use crate::far_range::manoeuvres::ManoeuvreRow;
use crate::far_range::measurements::MeasurementLine;
use crate::far_range::stars::StarRow;
use crate::far_range::telemetry::TelemetryLine;
use crate::table::declarations::{FieldDeclaration, Table};

/// Returns the fields of each CSV table with its name in `docs/formats.md`.
pub fn csv_tables() -> [(&'static str, Vec<FieldDeclaration>); 7] {
    [
        ("stars.csv", StarRow::declarations()),
        ("telemetry.csv", TelemetryLine::declarations()),
        ("measurements.csv", MeasurementLine::declarations()),
        ("truth/manoeuvres.csv", ManoeuvreRow::declarations()),
        ("telemetry.csv of docking", FieldTelemetryLine::declarations()),
        ("measurements.csv of docking", FieldMeasurementLine::declarations()),
        ("motion.csv", MotionLine::declarations()),
    ]
}

/// Returns the fields of each Parquet table with a fixed set of columns, with its name in `docs/formats.md`.
pub fn parquet_tables() -> [(&'static str, Vec<FieldDeclaration>); 5] {
    [
        ("truth/frames.parquet", FrameTruth::declarations()),
        ("truth/objects.parquet", ObjectTruth::declarations()),
        ("clusters.parquet", ClusterRow::declarations()),
        ("truth/fields.parquet", FieldTruthRow::declarations()),
        ("features.parquet", FeatureRow::declarations()),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ColumnType;

    /// [`crate::read_csv_table`] identifies a column only by its name.
    #[test]
    fn a_name_is_a_text_in_all_csv_tables_or_in_none() {
        let fields: Vec<FieldDeclaration> = csv_tables().into_iter().flat_map(|(_, fields)| fields).collect();
        for field in &fields {
            let same_name =
                |other: &&FieldDeclaration| other.names.iter().any(|name| field.names.contains(name));
            let is_text = |field: &FieldDeclaration| field.column_type == ColumnType::Utf8;
            assert!(
                fields.iter().filter(same_name).all(|other| is_text(other) == is_text(field)),
                "{field:?}"
            );
        }
    }
}
