//! Tables for the terminal.

use comfy_table::{CellAlignment, ContentArrangement, LineStyle, Table};

/// Formats a fraction in percent with one decimal. Exactly 100 has no decimal: it means all frames, and is
/// never reached by rounding.
pub fn percent(fraction: f64) -> String {
    if fraction == 1.0 { "100".to_owned() } else { format!("{:.1}", (100.0 * fraction).min(99.9)) }
}

/// Formats a count with its fraction of the frames, percent.
pub fn share(count: u64, frames: u64) -> String {
    format!("{count} ({})", percent(count as f64 / frames as f64))
}

/// Creates a table with rules above, below and under its header.
pub fn plain_table(styled: bool) -> Table {
    let mut table = Table::new();
    let rule = LineStyle::none().fill('─').junction('─');
    let rules = comfy_table::TableStyle::new().top_border(rule).header_separator(rule).bottom_border(rule);
    table.load_style(rules).set_content_arrangement(ContentArrangement::Disabled);
    if styled {
        table.enforce_styling();
    } else {
        table.force_no_tty();
    }
    table
}

/// Aligns numbers to the right, without spaces at the edges; ends with a line feed.
pub fn finish(mut table: Table) -> String {
    for (index, column) in table.column_iter_mut().enumerate() {
        if index == 0 {
            column.set_padding((0, 0));
        } else {
            column.set_padding((1, 0)).set_cell_alignment(CellAlignment::Right);
        }
    }
    table.trim_fmt() + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_whole_is_printed_as_100_percent() {
        assert_eq!([1.0, 0.99999, 0.9394, 0.0].map(percent), ["100", "99.9", "93.9", "0.0"]);
    }
}
