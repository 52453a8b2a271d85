//! The table of a scored run of any world.

use comfy_table::Cell;
use run::docking::ScoredFields;
use run::{AnyScored, figure_called};
use score::{Kind, Scored};

use crate::table::far_range::{finish, percent, plain_table};
use crate::table::{TableStyle, docking, far_range};

/// The score of a run as text: the table of its world, or its figures where it has none. Ends with a line feed.
pub fn score_table(scored: &dyn AnyScored, styled: bool) -> String {
    let any = scored.as_any();
    if let Some(scored) = any.downcast_ref::<Scored>() {
        far_range(&scored.score, TableStyle { styled, reference: scored.published, ..TableStyle::default() })
    } else if let Some(scored) = any.downcast_ref::<ScoredFields>() {
        docking(&scored.score, styled)
    } else {
        figures(scored, styled)
    }
}

fn figures(scored: &dyn AnyScored, styled: bool) -> String {
    let mut table = plain_table(styled);
    table.set_header(["figure", "value", "count", "of"]);
    for (name, figure) in scored.figures() {
        let value = match figure_called(name).sense.kind {
            Kind::Rate => figure.value.map(|value| format!("{} %", percent(value))),
            _ => figure.value.map(|value| format!("{value:.4}")),
        };
        table.add_row([
            Cell::new(figure_called(name).beside_percent()),
            Cell::new(value.unwrap_or_else(|| "–".to_owned())),
            Cell::new(figure.count),
            Cell::new(figure.of),
        ]);
    }
    finish(table)
}
