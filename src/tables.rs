//! Tables of the worlds of this program.

use std::path::Path;

use files::{Column, FieldDeclaration, FileError};

/// Returns the fields of each CSV table of the worlds with its name in `docs/formats.md`.
pub fn csv_tables() -> Vec<(&'static str, Vec<FieldDeclaration>)> {
    let mut tables = far_range::rows::csv_tables();
    tables.extend(docking::rows::csv_tables());
    tables.extend(middle_range::csv_tables());
    tables
}

/// Returns the fields of each Parquet table of the worlds with a fixed set of columns, with its name in
/// `docs/formats.md`.
pub fn parquet_tables() -> Vec<(&'static str, Vec<FieldDeclaration>)> {
    let mut tables = far_range::rows::parquet_tables();
    tables.extend(docking::rows::parquet_tables());
    tables.extend(middle_range::parquet_tables());
    tables
}

/// Reads a CSV table of a world ([`files::read_csv_table`]).
///
/// # Errors
/// [`FileError`] for a file that cannot be read, or a cell that is not a number in a column of numbers.
pub fn read_csv_table(path: &Path) -> Result<Vec<Column>, FileError> {
    let fields: Vec<FieldDeclaration> = csv_tables().into_iter().flat_map(|(_, fields)| fields).collect();
    files::read_csv_table(path, &fields)
}

#[cfg(test)]
mod tests {
    use super::*;
    use files::ColumnType;

    /// [`read_csv_table`] identifies a column only by its name.
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
