//! Boresight as a library: the oracle's crates under one name, and the command `boresight` based on them.

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

pub mod command;
pub mod table;
mod tables;
mod worlds;

#[cfg(feature = "mitsuba")]
pub use ::mitsuba;
#[cfg(feature = "monitor")]
pub use ::monitor;
#[cfg(feature = "report")]
pub use ::report;
pub use config::toml_file;
pub use docking;
pub use docking_views;
pub use far_range;
pub use far_range_views;
pub use files::{self, failure, sha256};
pub use flight_dynamics;
pub use gate;
pub use middle_range;
pub use navigate;
pub use run::{self, frame_jobs, pipeline_choice};
pub use scenario::{self, run_file};
pub use score;
pub use show;
pub use statistics;
pub use study;
pub use tables::{csv_tables, parquet_tables, read_csv_table};
pub use view;
pub use visibility;
pub use worlds::register_worlds;
