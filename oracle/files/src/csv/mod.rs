//! Tables as text (CSV), written by Boresight or by other programs.

pub(crate) mod column;
pub(crate) mod lines;
pub mod origin;
pub(crate) mod table;

pub use column::read_column;
pub use lines::Lines;
pub use origin::{AnswerOrigin, line_of, read_origins};
pub use table::{CsvLine, CsvReader, CsvRow, CsvWriter, read_csv, write_csv};
