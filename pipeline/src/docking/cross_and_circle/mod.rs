//! Cross and circle of the target, measured by least squares (docking paper, section 3).

pub(super) mod circle;
pub(super) mod cross;
pub(super) mod marks;
pub(super) mod profile;
