//! Truth: where everything is, and how it looks from the chaser.

pub mod apparent;
pub mod attitude;
pub mod clock;
pub mod ephemeris;
pub mod orbit;
pub mod relative;
pub mod schedule;
pub mod shadow;
mod table;

pub use table::{FrameTruth, ObjectKind, ObjectTruth, Shadow, Visibility};
