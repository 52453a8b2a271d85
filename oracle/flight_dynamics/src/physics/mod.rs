//! Physical plausibility of orbits and attitudes: checks of values whose form is valid.
//!
//! A finding is an error if no spacecraft moves like that, and a remark if only an unusual one does.

mod attitude;
mod findings;
mod gravity;
mod motion;
mod slip;

pub(crate) use attitude::{PointingNode, check_pointing, check_pointing_border};
pub use motion::check_samples;
pub(crate) use motion::{MotionSegment, check_motion, implausible_state};
