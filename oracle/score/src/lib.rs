//! Figures of a score, in every world: definition, value with its interval, words and better direction.
//!
//! A world judges each unit (a frame, a field) by a verdict of its own; a [`Definition`] counts the verdicts
//! to a [`Figure`]. Every unit is counted exactly once, and no number is ever NaN.

mod attitude_note;
mod definition;
mod figure;
mod figure_spec;
mod groups;
mod normalised_error;
mod score_error;

pub use attitude_note::{LINE_OF_SIGHT_RATE, attitude_note, attitude_word};
pub use definition::{Definition, FigureTerms, Reduction, Term, UnitTable, UnitVerdict};
pub use figure::{Figure, is_zero, warm_up_note};
pub use figure_spec::navigation::{figures as navigation_figures, is_of_navigation};
pub use figure_spec::{Better, FigureSpec, Kind, Sense, angle};
pub use groups::{WARM_UP, counts};
pub use normalised_error::NormalisedError;
pub use score_error::ScoreError;
