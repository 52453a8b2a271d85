//! The far-range world as its users see it: the printed table, annotated pictures, the report and the page of
//! the monitor. [`register`] makes the world and its views known to all commands.

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

mod classes;
#[cfg(feature = "monitor")]
mod monitor;
mod panels;
#[cfg(feature = "report")]
#[allow(clippy::indexing_slicing, reason = "indices are rows of tables that the readers have checked")]
pub mod report;
mod table;

use far_range::FarRangeMission;
use far_range::scoring::FarRangeJudgement;
use run::{AnyJudgement, ErasedWorld, WorldScenario as _};
use view::terminal::terminal_width;
use view::{CloseUp, WorldViews};

pub use self::table::{
    TableStyle, bound_table, budget_table, far_range_table, likeness_table, navigation_table,
    visibility_markdown, visibility_table,
};

/// Registers the world and its views for the rest of the process.
pub fn register() {
    run::register(&ErasedWorld::<FarRangeMission>::NEW);
    navigate::register();
    let code = FarRangeMission::CODE;
    view::register(WorldViews {
        code,
        table: printed_table,
        panels: panels::panels,
        close_up: CloseUp::Inset,
    });
    #[cfg(feature = "report")]
    {
        ::report::register(report::world_report());
        ::report::register_other(report::visibility_report());
    }
    #[cfg(feature = "monitor")]
    ::monitor::register(code, monitor::cast);
}

/// Returns the printed table of a scored run of this world.
fn printed_table(scored: &dyn AnyJudgement, styled: bool) -> Option<String> {
    let scored = scored.typed::<FarRangeJudgement>()?;
    let best_mode = scored.best_mode.as_deref();
    let style = TableStyle { styled, width: terminal_width(styled), reference: scored.published, best_mode };
    Some(far_range_table(&scored.score, style))
}
