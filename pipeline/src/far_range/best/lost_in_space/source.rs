//! Source in the image.

use contract::{CameraFrame, Direction, PixelPoint};

/// Standard deviation of a source about its predicted star along an axis, px: centroid, star list,
/// distortion, and distortion of the image by aberration (10⁻⁴ of its half size).
pub(super) const SOURCE_SIGMA_PX: f64 = 0.4;

/// Source in the image.
#[derive(Debug, Clone, Copy)]
pub(super) struct ImageSource {
    /// Index in the argument of `LostInSpace::solve`.
    pub(super) index: usize,
    pub(super) position: PixelPoint,
    pub(super) direction: Direction<CameraFrame>,
}
