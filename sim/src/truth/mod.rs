//! Truth: where everything is, and how it looks from the chaser.

mod apparent;
pub mod clock;
pub mod ephemeris;
pub mod shadow;
mod table;

pub use apparent::{Observer, StarMotion, aberrate, deflect, unaberrate};
pub use table::{FrameTruth, ObjectKind, ObjectTruth, Shadow, Visibility};
