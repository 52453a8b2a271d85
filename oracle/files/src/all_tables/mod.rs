//! List of all declared tables, and tables as columns in memory.

mod list;
mod loaded_table;

pub use list::{csv_tables, parquet_tables};
pub use loaded_table::{LoadedTable, read_csv_table, read_parquet_table};
