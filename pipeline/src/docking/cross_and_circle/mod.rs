//! Least-squares measurement of the target's cross and circle (docking paper, section 3).

pub(super) mod circle;
pub(super) mod cross;
pub(super) mod marks;
pub(super) mod profile;
