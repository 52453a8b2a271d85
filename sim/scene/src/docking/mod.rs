//! Docking scene: a station's end with its docking unit and target, as flat facets, and its illumination.
//!
//! All coordinates are in the target frame (origin at the disk's centre, y3 along its normal away from the
//! station, m). The two renderers, `render::vector` and Mitsuba, draw the same facets.

mod blankets;
mod body;
mod built_in;
mod checks;
mod cross;
mod docking_unit;
mod lighting;
mod plate;
mod shapes;
mod solid;
mod station;
mod target_file;

#[cfg(test)]
mod order_tests;
#[cfg(test)]
mod target_tests;

pub use blankets::BlanketsTable;
pub use body::{Bodies, Body};
pub use cross::CrossTable;
pub use docking_unit::{BlockRing, DockingUnitTable};
pub use lighting::{Floodlight, Lighting, Sun};
pub use plate::{MarkQuad, MarkRing, MarksTable, PlateTable};
pub use solid::{Assembly, DockingScene, Facet, Part};
pub use station::StationTable;
pub use target_file::{ContactTable, TargetFile};
