//! Scenarios: text files that describe a run. Each world has its own type.

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

mod attitude_choice;
mod builtin;
mod cameras;
pub mod identity;
pub mod run_file;
mod stage;

pub use attitude_choice::AttitudeChoice;
pub use builtin::{BUILT_IN, BuiltIn, built_in};
pub use cameras::CAMERAS;
pub use stage::Stage;
