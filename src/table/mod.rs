//! Tables for the terminal, one module per kind of result.

mod gate;
mod study;

pub use gate::{baseline_text, gate_table};
pub use study::{LiveFigure, study_table};
pub use view::score_table;
