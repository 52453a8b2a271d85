//! Sources of light.

use contract::{Direction, Icrs, PixelPoint};

use crate::truth::ObjectKind;

/// A source of electrons on the detector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Source {
    /// What it is.
    pub kind: ObjectKind,
    /// Number within its kind.
    pub id: u32,
    /// Where it is in the middle of the exposure; may lie off the detector by as much as its image reaches. Of the target:
    /// where the origin of its body frame is; of the Moon: where the centre of its disk is.
    pub position: PixelPoint,
    /// Where it is at the begin and at the end of the exposure.
    pub ends: [PixelPoint; 2],
    /// Direction without aberration; for the target its geometric line of sight; `None` for what is no light of the
    /// sky.
    pub astrometric: Option<Direction<Icrs>>,
    /// Visual magnitude.
    pub magnitude: Option<f64>,
    /// Photoelectrons per second.
    pub electrons_per_s: f64,
}
