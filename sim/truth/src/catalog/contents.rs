//! Contents of a file of stars.

use super::CatalogStar;

/// Stars with the line of each star, and the stars left out.
pub(super) type CatalogContents = (Vec<(usize, CatalogStar)>, Vec<Exclusion>);

/// Star that a file lists and the catalogue omits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Exclusion {
    /// Line in the file, counted from 1.
    pub line: usize,
    /// Number of the star.
    pub id: u32,
    /// Reason for the omission.
    pub reason: &'static str,
}
