//! The oracle: it knows the truth, hears what a pipeline says, and tells how good the pipeline is and why it
//! failed where it failed. The command `boresight` stands on it.

pub mod files;
pub mod score;
pub mod statistics;
pub mod table;
pub mod toml_file;
