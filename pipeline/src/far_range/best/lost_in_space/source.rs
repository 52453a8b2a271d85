//! Source in the image.

use contract::{CameraFrame, Direction, PixelPoint};
use nalgebra::Vector3;

/// Standard deviation of a source about its predicted star along an axis, px: centroid, star list,
/// distortion, and distortion of the image by aberration (10⁻⁴ of its half size).
pub(super) const SOURCE_SIGMA_PX: f64 = 0.4;

/// Source in the image.
#[derive(Debug, Clone, Copy)]
pub(super) struct ImageSource {
    /// Index in the argument of `LostInSpace::solve`.
    pub(super) index: usize,
    pub(super) position: PixelPoint,
    /// Direction at the stated focal length.
    pub(super) direction: Direction<CameraFrame>,
}

impl ImageSource {
    /// Returns the direction at a focal length, over the stated one. `None` if it is not finite.
    pub(super) fn direction_at(&self, focal_ratio: f64) -> Option<Direction<CameraFrame>> {
        if focal_ratio == 1.0 {
            return Some(self.direction);
        }
        let r = self.direction.vector();
        Direction::from_vector(Vector3::new(r.x, r.y, r.z * focal_ratio)).ok()
    }
}
