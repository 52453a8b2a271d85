//! Features of a field, and checks that they have the structure of the scene (docking paper, section 2, step
//! 3).

pub(super) mod candidates;
pub(super) mod components;
pub(super) mod contour;
pub(super) mod docking_unit;
pub(super) mod evidence;
pub(super) mod orientation;
pub(super) mod outline;
pub(super) mod range_memory;
pub(super) mod recognise;
pub(super) mod self_check;
pub(super) mod votes;
