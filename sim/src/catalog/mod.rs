//! Star catalogues: the embedded Hipparcos-2, a user's file, and the search in a cone.

#[allow(clippy::module_inception, reason = "the file of the type `Catalog`, which the module is named after")]
mod catalog;
mod cone;
mod config;
mod error;
mod hipparcos;
pub mod photometry;
mod radial_velocity;
mod read;
mod star;

pub use catalog::{Catalog, Exclusion};
pub use cone::ConeIndex;
pub use config::{CatalogConfig, CatalogSource, ConeConfig};
pub use error::CatalogError;
pub use star::CatalogStar;
