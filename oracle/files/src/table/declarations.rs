//! What a table says of its rows.

use super::column::ColumnType;

/// What a table says of one field of its row.
#[derive(Debug, Clone)]
pub struct FieldDeclaration {
    /// Names of its columns.
    pub names: Vec<&'static str>,
    /// Their type.
    pub column_type: ColumnType,
    /// Whether a cell may be empty, or null.
    pub is_nullable: bool,
    /// Whether a CSV may lack the columns.
    pub is_optional: bool,
    /// What they are.
    pub meaning: String,
}

/// A row of a table.
pub trait Table: Sized {
    /// What the table says of its fields, in the order of the columns.
    fn declarations() -> Vec<FieldDeclaration>;
}
