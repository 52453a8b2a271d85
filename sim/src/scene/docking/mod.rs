//! The docking scene: a station's end with its docking unit and target, as flat facets, and the light on it.
//!
//! Everything is in the target frame (origin at the disk's centre, y3 along its normal away from the station, m). Both
//! renderers, [`crate::vector`] and Mitsuba, draw the same facets.

mod lighting;
mod solid;

pub use lighting::{Floodlight, Lighting, Sun};
pub use solid::{DockingScene, Facet, Part};
