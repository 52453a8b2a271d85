//! The oracle: it knows the truth, hears what a pipeline says, and tells how good the pipeline is and why it
//! failed where it failed. The command `boresight` stands on it.

pub mod command;
pub mod dataset_writer;
pub mod docking_renderer;
pub mod docking_run;
pub mod docking_table;
pub mod docking_writer;
pub mod failure;
pub mod files;
pub mod flight;
pub mod gate;
pub mod gate_table;
pub mod inject;
pub mod mitsuba;
pub mod monitor;
pub mod pipeline_choice;
pub mod report;
pub mod run;
pub mod run_file;
pub mod scenario;
pub mod score;
pub mod sha256;
pub mod star_list;
pub mod statistics;
pub mod study;
pub mod study_engine;
pub mod study_table;
pub mod table;
pub mod toml_file;
pub mod visibility;
pub mod visibility_table;
