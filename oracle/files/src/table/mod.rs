//! Tables in memory with a single declaration: their columns, and the conversion of a row's fields to cells.

pub(crate) mod batch;
pub(crate) mod column;
pub(crate) mod declaration;
pub(crate) mod declarations;
pub(crate) mod field;
pub(crate) mod time;
pub(crate) mod unit;
pub mod windows;

pub use batch::Columns;
pub use column::{Cell, Cells, Column, ColumnType, ColumnValues, Nanoseconds, TextCells};
pub use declaration::{ColumnNames, nullable, optional, without_dictionary};
pub use declarations::{FieldDeclaration, Table};
pub use field::{Atom, Field, Value};
pub use time::{format_utc, parse_utc};
