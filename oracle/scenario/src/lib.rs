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

mod attitude;
mod builtin;
mod cameras;
mod coverage;
mod docking;
mod far_range;
pub mod identity;
pub mod run_file;
mod stage;
mod trajectory;
mod zero;

pub use builtin::{BUILT_IN, BuiltIn, DOCKING, STARTING_POINT, is_argon};
pub use cameras::CAMERAS;
pub use docking::{DockingScenario, DockingWorld};
pub use far_range::{AttitudeChoice, FarRangeScenario, FarRangeWorld, ScoreConfig, StarListConfig};
pub use stage::Stage;
pub use trajectory::TrajectoryConfig;
