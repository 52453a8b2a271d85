//! Charts: traces, layouts, thinned series, and a map of the sky.

#[allow(clippy::indexing_slicing, reason = "indices are rows of tables that the readers have checked")]
pub(crate) mod chart;
pub(crate) mod plotly;
#[allow(clippy::indexing_slicing, reason = "indices are rows of tables that the readers have checked")]
pub(crate) mod sky_map;
pub(crate) mod thinning;
