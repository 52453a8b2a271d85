//! The oracle: it knows the truth, hears what a pipeline says, and tells how good the pipeline is and why it
//! failed where it failed.

pub mod score;
pub mod statistics;
pub mod table;
