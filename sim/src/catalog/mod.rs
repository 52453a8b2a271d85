//! Star catalogues: the embedded Hipparcos-2, a user's file, and the search in a cone.

mod star;

pub use star::CatalogStar;
