//! What is in the field: stars and the target, as sources with a place and a rate of electrons.

mod background;
mod spacecraft;
mod star_field;

pub use background::{Background, BackgroundConfig, BackgroundField, EarthLightConfig, StrayLightConfig};
pub use spacecraft::TargetConfig;
pub use star_field::StarField;

use contract::{Direction, Icrs, PixelPoint};

use crate::truth::ObjectKind;

/// A point-like source of electrons on the detector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Source {
    /// What it is.
    pub kind: ObjectKind,
    /// Number within its kind.
    pub id: u32,
    /// Centre of its image; may lie off the detector by as much as its image reaches.
    pub position: PixelPoint,
    /// Direction without aberration; for the target its geometric line of sight; `None` for what is no light of the
    /// sky.
    pub astrometric: Option<Direction<Icrs>>,
    /// Visual magnitude.
    pub magnitude: Option<f64>,
    /// Photoelectrons per second.
    pub electrons_per_s: f64,
}
