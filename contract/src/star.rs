//! Star list that a pipeline receives.

use crate::{Direction, Icrs};

/// A star of the uploaded list, with direction and magnitude.
///
/// The direction is catalogued: proper motion is applied up to the epoch of the scenario, aberration is not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ListedStar {
    /// Number in the catalogue (HIP for Hipparcos).
    pub id: u32,
    /// Direction without aberration.
    pub direction: Direction<Icrs>,
    /// Visual magnitude (Johnson V).
    pub magnitude: f64,
}
