//! Data types and interfaces shared by the simulator and the pipelines.
//!
//! Camera data, frames, telemetry, star lists, outcomes and the trait [`Pipeline`]: the types that cross the
//! boundary between the simulator (which has access to the truth) and a pipeline under test (which must not).
//! The crate contains conventions and parameters, but no mathematics of projection or aberration: an error in
//! shared mathematics would cancel, and the oracle could not detect it.

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

mod angle;
pub mod bounds;
mod calibration;
mod camera;
#[allow(
    clippy::indexing_slicing,
    clippy::expect_used,
    reason = "the images are made here, in the size of the camera"
)]
pub mod conformance;
mod covariance;
mod direction;
pub mod docking;
mod error;
mod far_range;
mod frame;
mod measurement;
pub mod navigation;
mod pipeline;
mod pixel;
mod readout;
mod rotation;
mod star;
mod telemetry;

pub use angle::Angle;
pub use bounds::OutOfRange;
pub use calibration::{AttitudeKnowledge, Calibration, PsfCalibration, TargetCalibration};
pub use camera::{Camera, Mounting};
pub use covariance::Covariance2;
pub use direction::{Body, CameraFrame, Direction, Icrs, Target};
pub use error::ContractError;
pub use far_range::{FarRange, Setup};
pub use frame::{Frame, Window};
pub use measurement::{AttitudeSource, Cluster, Label, Measurement, NoSolution, Outcome, Solution};
pub use pipeline::{FailedStarts, Interface, MachineFault, Pipeline, PipelineFactory};
pub use pixel::PixelPoint;
pub use readout::Readout;
pub use rotation::Rotation;
pub use star::ListedStar;
pub use telemetry::Telemetry;
