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

pub use docking::PreparedDocking;
pub use far_range::{Prepared, SceneTruth};
pub use world::{
    Expectation, FirstFailure, Flight, Processed, ProcessedFrame, Ran, Scored, World, process, process_into,
};
