//! Docking: data types shared by the simulator of an approach and the pipelines that monitor it.
//!
//! The unit is the *field*: half of an interlaced television frame, with its own time. The target frame, the
//! pose and the angles are those of Boguslavsky et al. (ICINCO 2004); see `CONVENTIONS.md`.

mod digitiser;
mod features;
mod field;
mod interface;
mod motion;
mod outcome;
mod pose;
mod target;

pub use digitiser::Digitiser;
pub use features::{Circle, Cross, Features, Mark, MarkUse, PictureWarp};
pub use field::{Field, FieldTelemetry, Lines};
pub use interface::{Docking, DockingSetup};
pub use motion::{Motion, MotionReport};
pub use outcome::{DockingOutcome, DockingSolution, FailedCheck, FieldMeasurement, NoPose};
pub use pose::{Pose, PoseEstimate};
pub use target::{Outline, StandOffCross, TargetModel};
