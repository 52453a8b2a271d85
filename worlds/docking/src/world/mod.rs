//! Docking: the approach to a target, imaged by a television camera.
//!
//! Fields are drawn in parallel, as video signals. They are digitised sequentially, because a pipeline may
//! request another contrast and brightness of the digitiser, which take effect from the next field on.

pub(crate) mod answers;
mod dataset;
mod files;
mod frames;
mod labels;
mod mission;
mod picture;
mod pipelines;
pub(crate) mod renderer;
mod scenario;
mod score;

pub use self::mission::{DockingMission, simulator};
pub use self::score::DockingJudgement;
