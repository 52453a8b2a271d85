//! Data types and interfaces shared by the simulator and the pipelines.
//!
//! Camera data, frames, telemetry, star lists, outcomes and the trait [`Pipeline`]: the types that cross the
//! boundary between the simulator (which has access to the truth) and a pipeline under test (which must not).
//! The crate contains conventions and parameters, but no mathematics of projection or aberration: an error in
//! shared mathematics would cancel, and the oracle could not detect it.
//!
//! A crate with a pipeline depends on this one alone. It implements [`Pipeline`] for an [`Interface`],
//! [`FarRange`] or [`docking::Docking`], and [`PipelineFactory`], which Boresight receives;
//! [`conformance::check`] tests the rules that hold for every pipeline.
//!
//! ```
//! use boresight_contract::{
//!     ContractError, FarRange, Frame, Measurement, NoSolution, Outcome, Pipeline, PipelineFactory, PixelPoint,
//!     Setup, Solution, Telemetry,
//! };
//!
//! /// Reports the brightest pixel as the target.
//! struct Brightest;
//!
//! impl Pipeline<FarRange> for Brightest {
//!     fn process(&mut self, frame: &Frame, _: &Telemetry) -> Outcome {
//!         let brightest = frame.dn().iter().enumerate().max_by_key(|(_, dn)| **dn);
//!         let Some((index, _)) = brightest.filter(|(_, dn)| **dn > 0) else {
//!             return Outcome::without_solution(NoSolution::EmptyFrame);
//!         };
//!         let (x, y) = (index % frame.columns(), index / frame.columns());
//!         let measurement = Measurement::new(PixelPoint::new(x as f64, y as f64), None);
//!         let solution = Solution::Detected(measurement);
//!         Outcome { solution, ..Outcome::without_solution(NoSolution::NoTarget) }
//!     }
//! }
//!
//! struct BrightestFactory;
//!
//! impl PipelineFactory<FarRange> for BrightestFactory {
//!     fn name(&self) -> String {
//!         "brightest".to_owned()
//!     }
//!
//!     fn build(&self, _: &Setup) -> Result<Box<dyn Pipeline<FarRange>>, ContractError> {
//!         Ok(Box::new(Brightest))
//!     }
//! }
//!
//! let factory: &dyn PipelineFactory<FarRange> = &BrightestFactory;
//! assert_eq!(factory.name(), "brightest");
//! ```

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
