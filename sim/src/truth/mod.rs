//! Truth: where everything is, and how it looks from the chaser.

mod table;

pub use table::{FrameTruth, ObjectKind, ObjectTruth, Shadow, Visibility};
