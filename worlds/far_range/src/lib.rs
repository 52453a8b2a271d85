//! The far-range world: star fields with a distant spacecraft.
//!
//! - [`FarRangeScenario`]: what a scenario file says.
//! - [`rows`]: the files of a run and of a dataset: telemetry, stars, truth, outcomes, clusters.
//! - [`scoring`]: the verdict of each frame, its cause, and the figures.
//! - [`CameraSource`]: cameras, built in or from files; [`SkyView`]: one picture of the sky by a camera.
//! - [`FarRangeMission`]: the world ([`run::World`]) with its simulator.

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

mod camera_preset;
pub mod rows;
mod scenario;
#[allow(clippy::indexing_slicing, reason = "arithmetic on values in memory; no input is read")]
pub mod scoring;
mod sky;
mod world;

pub use self::camera_preset::{CameraPreset, CameraSource};
pub use self::scenario::{
    FarRangeScenario, FarRangeWorld, ScoreConfig, StarListConfig, TrajectoryConfig, is_argon,
};
pub use self::sky::{SkyPicture, SkyView, star_name};
pub use self::world::star_list::star_list;
pub use self::world::{FarRangeMission, SceneTruth, limits, simulator};

/// The built-in scenario `starting-point`: small, with a comment on every line.
pub const STARTING_POINT: &str = include_str!("../../../scenarios/starting-point.toml");
