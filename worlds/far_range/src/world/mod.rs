//! Far range: star fields with a distant spacecraft.

mod answers;
mod dataset;
mod files;
mod frames;
mod inject;
mod labels;
mod mission;
mod pipelines;
mod scenario;
mod score;
pub(crate) mod star_list;

pub(crate) use self::dataset::write_image;
pub use self::mission::{FarRangeMission, SceneTruth, simulator};
pub use self::score::limits;
