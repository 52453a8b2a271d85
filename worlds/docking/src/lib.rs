//! The docking world: the last 500 m to a docking target, imaged by a television camera.
//!
//! - [`DockingScenario`]: what a scenario file says.
//! - [`rows`]: the files of a run: telemetry, truth, outcomes, features. [`video`]: the images.
//! - [`scoring`]: the verdict of each field, its cause, and the figures.
//! - [`DockingMission`]: the world ([`run::World`]) with its simulator.

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

pub mod rows;
mod scenario;
#[allow(clippy::indexing_slicing, reason = "arithmetic on values in memory; no input is read")]
pub mod scoring;
pub mod video;
mod world;

pub use self::scenario::{DockingScenario, DockingScoreConfig, DockingWorld};
pub use self::world::answers::FieldAnswers;
pub use self::world::renderer::DockingRenderer;
pub use self::world::{DockingJudgement, DockingMission, simulator};

/// The built-in scenario `docking`: an approach to the station, with a comment on every line.
pub const STARTING_POINT: &str = include_str!("../../../scenarios/docking.toml");
