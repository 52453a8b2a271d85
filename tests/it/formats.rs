//! The tables of `docs/formats.md` agree with the tables that the crates declare.

use std::fmt::Write;
use std::path::Path;

use boresight::files::{ColumnType, FieldDeclaration, csv_tables, parquet_tables};
use boresight::gate::row_columns;
use boresight::navigate;
use boresight::study::case_columns;
use boresight::visibility;

use crate::support::check_page;

/// Row of the page: names, type, and meaning of the columns.
fn line(field: &FieldDeclaration, is_csv: bool) -> String {
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

/// Page with the declared tables inserted between its marks.
fn page(old: &str) -> String {
    let csv = csv_tables()
        .into_iter()
        .chain(visibility::tables())
        .chain(navigate::tables())
        .map(|(name, fields)| (name, fields, true));
    let others = [("rows.parquet", row_columns()), ("cases.parquet", case_columns())];
    let parquet = parquet_tables().into_iter().chain(others).map(|(name, fields)| (name, fields, false));
    let mut page = old.to_owned();
    for (name, fields, is_csv) in csv.chain(parquet) {
        let mark = format!("<!-- columns of {name} -->\n");
        let start = page.find(&mark).unwrap_or_else(|| panic!("no {mark}")) + mark.len();
        let end = start + page[start..].find("<!-- end -->").unwrap();
        let mut table = "\n| column | type | is |\n| --- | --- | --- |\n".to_owned();
        fields.iter().for_each(|field| table.write_str(&line(field, is_csv)).unwrap());
        page.replace_range(start..end, &(table + "\n"));
    }
    page
}

#[test]
fn the_page_of_formats_has_every_column() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/formats.md");
    check_page("formats.md", &page(&std::fs::read_to_string(path).unwrap()));
}
