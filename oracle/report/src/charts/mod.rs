//! Charts: traces, layouts, thinned series, and a map of the sky.

#[allow(clippy::indexing_slicing, reason = "indices are rows of tables that the readers have checked")]
pub mod chart;
pub mod plotly;
#[allow(clippy::indexing_slicing, reason = "indices are rows of tables that the readers have checked")]
pub mod sky_map;
pub mod thinning;
