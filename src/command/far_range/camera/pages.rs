//! Reports of a fit and of a comparison.

use std::path::Path;

use far_range_views::report::{camera_fit_page, likeness_page};
use files::Failure;
use twin::likeness::Comparison;
use twin::{FrameSet, TwinCamera};

/// Writes the report of a fitted camera.
///
/// # Errors
/// A [`Failure`] for a file that cannot be written.
pub(super) fn write_fit_page(
    set: &FrameSet,
    twin: &TwinCamera,
    directory: &Path,
    path: &Path,
) -> Result<(), Failure> {
    report::write_page(&camera_fit_page(set, twin, &name(directory))?, path).map(|_| ())
}

/// Writes the report of a comparison.
///
/// # Errors
/// A [`Failure`] for a file that cannot be written.
pub(super) fn write_likeness_page(
    camera: &FrameSet,
    twin: &FrameSet,
    found: &Comparison,
    directory: &Path,
    path: &Path,
) -> Result<(), Failure> {
    report::write_page(&likeness_page(camera, twin, found, &name(directory))?, path).map(|_| ())
}

/// Returns the last part of a path, or the whole where it has none.
fn name(directory: &Path) -> String {
    directory.file_name().unwrap_or(directory.as_os_str()).to_string_lossy().into_owned()
}
