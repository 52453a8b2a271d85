//! Star catalogues: the embedded Hipparcos-2, a catalogue file of the user, and the search in a cone.

#[allow(clippy::module_inception, reason = "the file of the type `Catalog`, which the module is named after")]
mod catalog;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod cone;
mod config;
mod contents;
mod error;
mod hex;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod hipparcos;
pub mod photometry;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod radial_velocity;
mod read;
mod star;

pub use catalog::Catalog;
pub use cone::ConeIndex;
pub use config::{CatalogConfig, CatalogSource, ConeConfig};
pub use contents::Exclusion;
pub use error::CatalogError;
pub use star::CatalogStar;
