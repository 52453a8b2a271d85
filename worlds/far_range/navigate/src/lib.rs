//! Relative navigation on a far-range run.
//!
//! A [`Campaign`] is the input of a navigator: measured lines of sight, reported manoeuvres, the chaser's
//! reported orbit, a prior. [`navigate_with`] runs a navigator on it and compares its answers with the truth
//! of the simulator; [`bound_of`] computes the smallest standard deviations that the measurements allow.

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

mod bound;
mod budget;
mod campaign;
mod estimator;
mod figures;
mod knowledge;
mod measurements;
mod navigator_choice;
mod result;
mod row;
mod score;
mod truth;

pub use bound::{BoundAt, BoundReport, bound_of};
pub use budget::{BudgetPart, NavigationBudget, navigation_budget};
pub use campaign::Campaign;
pub use estimator::{EVERY_S, Estimator, navigate, navigate_with};
pub use figures::after_run::register;
pub use figures::{navigation_figures, navigation_terms};
pub use knowledge::KnowledgeConfig;
pub use measurements::MeasurementSource;
pub use navigator_choice::NavigatorChoice;
pub use result::{FIGURES_FILE, NavigationResult, TABLE_FILE};
pub use row::{NavigationRow, read_navigation, tables};
pub use score::{Axis, BeforeReport, MeasurementUse, NavigationScore};
pub use truth::target_orbit::{TargetOrbit, TargetState};
