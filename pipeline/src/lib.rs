//! Image-processing pipelines under test.
//!
//! A pipeline receives a [`contract::Frame`], its [`contract::Telemetry`] and the [`contract::Setup`], never
//! the truth. Its mathematics are independent: the camera model and the aberration share nothing with the
//! simulator.
//!
//! - [`far_range`]: the far-range method of the ARGON experiment (star identification, tracking, motion
//!   segmentation);
//! - [`docking`]: the monitoring of a docking approach by the cross and marks of its target;
//! - [`external`]: an external pipeline, run as a process.

mod camera_model;
pub mod docking;
mod error;
pub mod external;

pub mod far_range;

pub use camera_model::CameraModel;
pub use error::PipelineError;
