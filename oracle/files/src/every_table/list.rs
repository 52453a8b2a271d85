//! All tables that are declared, for whoever describes them or hands their columns on.

use sim::truth::{FrameTruth, ObjectTruth};

use crate::docking::telemetry::FieldTelemetryLine;
use crate::docking::{FeatureRow, FieldMeasurementLine, FieldTruthRow, MotionLine};
use crate::far_range::clusters::ClusterRow;
use crate::far_range::measurements::MeasurementLine;
use crate::far_range::stars::StarRow;
use crate::far_range::telemetry::TelemetryLine;
use crate::table::declared::{Declared, Table};

/// The fields of each CSV table, by its name in `docs/formats.md`.
pub fn csv_tables() -> [(&'static str, Vec<Declared>); 6] {
    [
        ("stars.csv", StarRow::declared()),
        ("telemetry.csv", TelemetryLine::declared()),
        ("measurements.csv", MeasurementLine::declared()),
        ("telemetry.csv of docking", FieldTelemetryLine::declared()),
        ("measurements.csv of docking", FieldMeasurementLine::declared()),
        ("motion.csv", MotionLine::declared()),
    ]
}

/// The fields of each Parquet table whose columns are always the same, by its name in `docs/formats.md`.
pub fn parquet_tables() -> [(&'static str, Vec<Declared>); 5] {
    [
        ("truth/frames.parquet", FrameTruth::declared()),
        ("truth/objects.parquet", ObjectTruth::declared()),
        ("clusters.parquet", ClusterRow::declared()),
        ("truth/fields.parquet", FieldTruthRow::declared()),
        ("features.parquet", FeatureRow::declared()),
    ]
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;
    use std::path::Path;

    use super::*;
    use crate::ColumnType;

    /// A row of the page: names, type, and what the columns are.
    fn line(field: &Declared, is_csv: bool) -> String {
        let names: Vec<String> = field.names.iter().map(|name| format!("`{name}`")).collect();
        let names = match names.as_slice() {
            [first, .., last] if names.len() > 9 => format!("{first} … {last}: {} columns", names.len()),
            names => names.join(", "),
        };
        let column_type = match field.column_type {
            ColumnType::UInt32 | ColumnType::UInt64 if is_csv => "whole number".to_owned(),
            ColumnType::Float64 if is_csv => "number".to_owned(),
            ColumnType::Utf8 if is_csv => "text".to_owned(),
            other => other.to_string(),
        };
        let empty = match (field.is_nullable, is_csv) {
            (false, _) => "",
            (true, false) => " or null",
            (true, true) => " or empty",
        };
        let optional = if field.is_optional { "optional: " } else { "" };
        format!("| {names} | {column_type}{empty} | {optional}{} |\n", field.meaning)
    }

    /// The page with the tables that are declared between its marks.
    fn page(old: &str) -> String {
        let csv = csv_tables().map(|(name, fields)| (name, fields, true));
        let parquet = parquet_tables().map(|(name, fields)| (name, fields, false));
        let mut page = old.to_owned();
        for (name, fields, is_csv) in csv.into_iter().chain(parquet) {
            let mark = format!("<!-- columns of {name} -->\n");
            let start = page.find(&mark).unwrap_or_else(|| panic!("no {mark}")) + mark.len();
            let end = start + page[start..].find("<!-- end -->").unwrap();
            let mut table = "\n| column | type | is |\n| --- | --- | --- |\n".to_owned();
            fields.iter().for_each(|field| table.write_str(&line(field, is_csv)).unwrap());
            page.replace_range(start..end, &(table + "\n"));
        }
        page
    }

    /// `REMAKE=1 cargo test -p boresight-files the_page` writes the page anew.
    #[test]
    fn the_page_of_formats_has_every_column() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/formats.md");
        let old = std::fs::read_to_string(&path).unwrap();
        let new = page(&old);
        if std::env::var_os("REMAKE").is_some() {
            std::fs::write(&path, &new).unwrap();
        } else {
            let other = old.lines().zip(new.lines()).find(|(old, new)| old != new);
            assert!(
                old == new,
                "remake docs/formats.md: REMAKE=1 cargo test -p boresight-files the_page; {other:#?}"
            );
        }
    }

    /// [`crate::read_csv_table`] knows a column by its name alone.
    #[test]
    fn a_name_is_a_text_in_all_csv_tables_or_in_none() {
        let fields: Vec<Declared> = csv_tables().into_iter().flat_map(|(_, fields)| fields).collect();
        for field in &fields {
            let same_name = |other: &&Declared| other.names.iter().any(|name| field.names.contains(name));
            let is_text = |field: &Declared| field.column_type == ColumnType::Utf8;
            assert!(
                fields.iter().filter(same_name).all(|other| is_text(other) == is_text(field)),
                "{field:?}"
            );
        }
    }
}
