//! Charts: traces, layouts, thinned series.

pub mod axis_limits;
#[allow(clippy::indexing_slicing, reason = "indices are rows of tables that the readers have checked")]
pub mod chart;
pub mod plotly;
pub mod thinning;
