//! The star list that a pipeline is given.

use crate::{Direction, Icrs};

/// A star of the list uploaded to a pipeline: where it is, how bright.
///
/// The direction is catalogued: proper motion is applied up to the scenario, aberration is not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ListedStar {
    /// Number in the catalogue (HIP for Hipparcos).
    pub id: u32,
    /// Direction without aberration.
    pub direction: Direction<Icrs>,
    /// Visual magnitude (Johnson V).
    pub magnitude: f64,
}
