//! Declaration of a table's rows.

use super::column::ColumnType;

/// Declaration of one field of a table row.
#[derive(Debug, Clone)]
pub struct FieldDeclaration {
    /// Names of the field's columns.
    pub names: Vec<&'static str>,
    /// Type of the columns.
    pub column_type: ColumnType,
    /// True if a cell may be empty or null.
    pub is_nullable: bool,
    /// True if a CSV may omit the columns.
    pub is_optional: bool,
    /// Meaning of the columns.
    pub meaning: String,
}

/// A row of a table.
pub trait Table: Sized {
    /// Returns the declarations of the fields, in the order of the columns.
    fn declarations() -> Vec<FieldDeclaration>;
}
