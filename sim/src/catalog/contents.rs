//! What a file of stars gives.

use super::CatalogStar;

/// What a file holds: stars with the line each stands in, and the stars left out.
pub(super) type CatalogContents = (Vec<(usize, CatalogStar)>, Vec<Exclusion>);

/// A star that a file lists and that the catalogue does not hold.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Exclusion {
    /// Line in the file, counted from 1.
    pub line: usize,
    /// Number of the star.
    pub id: u32,
    /// Why it is left out.
    pub reason: &'static str,
}
