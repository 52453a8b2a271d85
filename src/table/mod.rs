//! Tables for the terminal, one module per kind of result.

mod docking;
mod far_range;
mod figures;
mod gate;
mod navigation;
mod study;
mod visibility;

pub use docking::docking;
pub use far_range::{TableStyle, far_range};
pub use figures::score_table;
pub use gate::{baseline_text, gate_table};
pub use navigation::{bound_table, budget_table, navigation_table};
pub use study::{LiveFigure, study_table};
pub use visibility::{visibility_markdown, visibility_table};
