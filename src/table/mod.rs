//! Tables for the terminal, one module per kind of result.

mod gate;
mod navigation;
mod study;
mod visibility;

pub use gate::{baseline_text, gate_table};
pub use navigation::{bound_table, budget_table, navigation_table};
pub use study::{LiveFigure, study_table};
pub use view::score_table;
pub use visibility::{visibility_markdown, visibility_table};
