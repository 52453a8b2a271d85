//! Runs: frames are exposed, processed, scored and written in order, the same way in every world ([`world::World`]).

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

mod by_number;
pub mod docking;
pub mod far_range;
pub mod flight;
pub mod pipeline_choice;
pub mod world;

use std::path::{Path, PathBuf};

use files::{Failure, FileError};

pub use docking::PreparedDocking;
pub use far_range::{Prepared, SceneTruth};
pub use world::{
    Expectation, FirstFailure, Flight, Processed, ProcessedFrame, Ran, Scored, World, process, process_into,
};

fn unscorable(error: score::ScoreError) -> Failure {
    Failure::Usage(format!("the truth cannot be scored: {error}"))
}

/// As many files as a writer of answers has.
fn paths<const N: usize>(files: &[PathBuf]) -> Result<[&Path; N], FileError> {
    let paths: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    let count = paths.len();
    let first = files.first().map_or_else(PathBuf::new, Clone::clone);
    paths.try_into().map_err(|_| FileError::format(&first, "answers", format!("{count} files, expected {N}")))
}
