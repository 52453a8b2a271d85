//! The tables of the pages of formats, from the declarations of the crates.

use boresight::files::{ColumnType, FieldDeclaration};
use boresight::gate::row_columns;
use boresight::study::case_columns;
use boresight::{csv_tables, navigate, parquet_tables, visibility};

/// Row of a page: names, type, and meaning of the columns.
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

/// Inserts the declared tables into the pages, after their marks.
pub(super) fn fill(pages: &mut [String]) -> Result<(), String> {
    let csv = csv_tables()
        .into_iter()
        .chain(visibility::tables())
        .chain(navigate::tables())
        .map(|(name, fields)| (name, fields, true));
    let others = [("rows.parquet", row_columns()), ("cases.parquet", case_columns())];
    let parquet = parquet_tables().into_iter().chain(others).map(|(name, fields)| (name, fields, false));
    for (name, fields, is_csv) in csv.chain(parquet) {
        let mark = format!("<!-- columns of {name} -->\n");
        let found =
            pages.iter_mut().find_map(|page| page.find(&mark).map(|place| (page, place + mark.len())));
        let (page, place) = found.ok_or_else(|| format!("no page of formats has {mark}"))?;
        let rows: String = fields.iter().map(|field| line(field, is_csv)).collect();
        page.insert_str(place, &format!("\n| column | type | is |\n| --- | --- | --- |\n{rows}\n"));
    }
    Ok(())
}
