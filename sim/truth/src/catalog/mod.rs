//! Star catalogues: the embedded Hipparcos-2, a catalogue file of the user, and the search in a cone.

#[allow(clippy::module_inception, reason = "the file of the type `Catalog`, which the module is named after")]
mod catalog;
mod cone;
mod config;
mod contents;
mod error;
mod hex;
mod hipparcos;
pub mod photometry;
mod radial_velocity;
mod read;
mod star;

pub use catalog::Catalog;
pub use cone::ConeIndex;
pub use config::{CatalogConfig, CatalogSource, ConeConfig};
pub use contents::Exclusion;
pub use error::CatalogError;
pub use hipparcos::HIPPARCOS_BYTES;
pub use star::CatalogStar;
