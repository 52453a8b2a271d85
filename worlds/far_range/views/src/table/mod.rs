//! Tables for the terminal, one module per kind of result.

mod likeness;
mod navigation;
mod score;
mod visibility;

pub use likeness::likeness_table;
#[cfg(feature = "report")]
pub(crate) use likeness::{likeness_cells, whole_words};
pub use navigation::{bound_table, budget_table, navigation_table};
pub use score::{TableStyle, far_range_table};
pub use visibility::{visibility_markdown, visibility_table};
