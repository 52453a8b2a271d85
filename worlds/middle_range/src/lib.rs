//! The middle range: a body that the camera resolves, at kilometres to tens of metres; its image is a disk in
//! sunlight. The exposure of a frame depends on the answers before it, a closed loop.
//!
//! The body is a Lambert sphere and the imager has no optics but a pinhole with distortion: a seam for a
//! world with meshes, point-spread functions and poses, complete in everything around it: scenario, pipelines
//! built in and external, scores, studies, gates, report and monitor.

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

mod imager;
#[cfg(feature = "monitor")]
mod monitor;
#[allow(clippy::indexing_slicing, reason = "indices of points, which have two coordinates")]
mod pipeline;
#[cfg(feature = "report")]
mod report;
mod rows;
mod scenario;
mod world;

use ::run::ErasedWorld;
use ::run::plain::Plain;

pub use self::pipeline::{LimbConfig, MiddleRangeSetup};
pub use self::rows::{Answer, Truth, csv_tables, parquet_tables};
pub use self::scenario::{ApproachConfig, BodyConfig, ExposureConfig, MiddleRangeScenario, MiddleRangeWorld};
pub use self::world::MiddleRange;

/// The built-in scenario `middle-range`, with a comment on every line.
pub const STARTING_POINT: &str = include_str!("../../../scenarios/middle-range.toml");

/// Registers the world, its report and its page of the monitor for the rest of the process.
pub fn register() {
    run::register(&ErasedWorld::<Plain<MiddleRange>>::NEW);
    #[cfg(feature = "report")]
    ::report::register(report::world_report());
    #[cfg(feature = "monitor")]
    ::monitor::register(<Plain<MiddleRange> as run::WorldScenario>::CODE, monitor::cast);
}
