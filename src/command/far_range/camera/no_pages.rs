//! Reports of a fit and of a comparison, in a build that has none.

use std::path::Path;

use files::Failure;
use twin::likeness::Comparison;
use twin::{FrameSet, TwinCamera};

pub(super) fn write_fit_page(_: &FrameSet, _: &TwinCamera, _: &Path, _: &Path) -> Result<(), Failure> {
    Err(crate::command::missing_feature("report"))
}

pub(super) fn write_likeness_page(
    _: &FrameSet,
    _: &FrameSet,
    _: &Comparison,
    _: &Path,
    _: &Path,
) -> Result<(), Failure> {
    Err(crate::command::missing_feature("report"))
}
