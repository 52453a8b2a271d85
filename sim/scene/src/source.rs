//! Light sources.

use contract::{Direction, Icrs, PixelPoint};
use truth::ObjectKind;

/// Source of photoelectrons on the detector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Source {
    /// Kind of object.
    pub kind: ObjectKind,
    /// Number of the object within its kind.
    pub id: u32,
    /// Pixel position at mid-exposure; may lie off the detector by as much as the extent of the image. For
    /// the target it is the origin of its body frame, for the Moon the centre of its disk.
    pub position: PixelPoint,
    /// Pixel positions at the start and end of the exposure.
    pub ends: [PixelPoint; 2],
    /// Direction without aberration; for the target, its geometric line of sight; `None` for sources that are
    /// not in the sky.
    pub astrometric: Option<Direction<Icrs>>,
    /// Visual magnitude.
    pub magnitude: Option<f64>,
    /// Photoelectrons per second.
    pub electrons_per_s: f64,
}
