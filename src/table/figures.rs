//! Table of a scored run of any world.

use comfy_table::Cell;
use run::docking::DockingJudgement;
use run::{AnyJudgement, figure_by_name};
use score::FarRangeJudgement;

use crate::table::far_range::{finish, percent, plain_table};
use crate::table::{TableStyle, docking, far_range};

/// Function that returns the table of a scored run, or `None` if the run is from another world.
type Table = fn(&dyn AnyJudgement, bool) -> Option<String>;

/// Worlds with dedicated tables: one line each.
const TABLES: [Table; 2] = [
    |scored, styled| {
        let scored = scored.as_any().downcast_ref::<FarRangeJudgement>()?;
        let best_mode = scored.best_mode.as_deref();
        let style = TableStyle { styled, reference: scored.published, best_mode, ..TableStyle::default() };
        Some(far_range(&scored.score, style))
    },
    |scored, styled| Some(docking(&scored.as_any().downcast_ref::<DockingJudgement>()?.score, styled)),
];

/// Returns the score of a run as text: the table of its world or, if the world has none, the figures. Ends
/// with a line feed.
pub fn score_table(scored: &dyn AnyJudgement, styled: bool) -> String {
    TABLES.iter().find_map(|table| table(scored, styled)).unwrap_or_else(|| figures(scored, styled))
}

fn figures(scored: &dyn AnyJudgement, styled: bool) -> String {
    let mut table = plain_table(styled);
    table.set_header(["figure", "value", "count", "of"]);
    for (name, figure) in scored.figures() {
        let spec = figure_by_name(name);
        let value = figure.value.map(|value| match spec.is_rate() {
            true => format!("{} %", percent(value)),
            false => format!("{value:.4}"),
        });
        table.add_row([
            Cell::new(spec.label_without_percent()),
            Cell::new(value.unwrap_or_else(|| "–".to_owned())),
            Cell::new(figure.count),
            Cell::new(figure.of),
        ]);
    }
    finish(table)
}
