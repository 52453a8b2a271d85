//! Tables in Parquet format. Claimed sizes are checked before the crate `parquet` allocates memory for them.

mod claims;
mod column_type;
mod digest;
pub(crate) mod file;
pub(crate) mod table;
mod thrift;
mod writer;

pub use digest::table_sha256;
pub use file::ParquetFile;
pub use table::{Row, TableReader, TableWriter};
pub use writer::{ParquetWriter, TableOptions, write_table};
