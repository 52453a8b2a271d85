//! Table of a scored run of any world.

use comfy_table::Cell;
use run::{AnyJudgement, figure_by_name};

use crate::terminal::{finish, percent, plain_table};
use crate::world_views::registered;

/// Returns the score of a run as text: the table of its world or, if the world has none, the figures. Ends
/// with a line feed.
pub fn score_table(scored: &dyn AnyJudgement, styled: bool) -> String {
    let of_world = registered().into_iter().find_map(|views| (views.table)(scored, styled));
    of_world.unwrap_or_else(|| figures(scored, styled))
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
