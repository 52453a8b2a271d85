//! Runs of both worlds: frames are exposed, processed, scored and written in order.

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

pub mod dataset_writer;
pub mod docking_renderer;
pub mod docking_run;
pub mod docking_writer;
mod far_range_run;
pub mod flight;
pub mod inject;
pub mod pipeline_choice;
pub mod star_list;

pub use far_range_run::*;
