//! Region of interest, and processing before the search for the target (docking paper, section 2, steps 1 and
//! 2).

pub(super) mod binarise;
pub(super) mod edges;
pub(super) mod histogram;
pub(super) mod region;
pub(super) mod view;
