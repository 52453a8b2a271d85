//! Tables for the terminal.

use comfy_table::{CellAlignment, ColumnConstraint, ContentArrangement, LineStyle, Table};

/// Width of printed text, columns, where the terminal is not wider.
pub const WIDTH: usize = 80;

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

/// Returns the width of the terminal, columns, or [`WIDTH`] where it is narrower or the output is none.
pub fn terminal_width(styled: bool) -> usize {
    plain_table(styled).width().map_or(WIDTH, |width| usize::from(width).max(WIDTH))
}

/// Aligns numbers to the right, without spaces at the edges; ends with a line feed. A table that is wider
/// than the terminal, or than [`WIDTH`] where the output is none, is cut into tables below each other, each
/// with the first column.
pub fn finish(table: Table) -> String {
    let width = table.width().map_or(WIDTH, |width| usize::from(width).max(WIDTH));
    finish_within(table, width)
}

/// Does the same as [`finish`] for a given width, columns.
pub fn finish_within(mut table: Table, width: usize) -> String {
    for (index, column) in table.column_iter_mut().enumerate() {
        if index == 0 {
            column.set_padding((0, 0));
        } else {
            column.set_padding((1, 0)).set_cell_alignment(CellAlignment::Right);
        }
    }
    let parts = parts(&table.column_max_content_widths(), width);
    let texts: Vec<String> = parts.iter().map(|shown| with_columns(&table, shown)).collect();
    texts.join("\n")
}

/// Divides the columns of a table, given their widths, into parts that fit the width together with the first
/// column. A part has at least one column beside the first.
fn parts(widths: &[u16], width: usize) -> Vec<std::ops::Range<usize>> {
    // A space is before every column but the first; another one is between the last two columns.
    let first = widths.first().map_or(0, |first| usize::from(*first)) + 1;
    let mut parts = Vec::new();
    let (mut start, mut used) = (1, first);
    for (index, column) in widths.iter().enumerate().skip(1) {
        let needed = usize::from(*column) + 2;
        if used + needed > width && index > start {
            parts.push(start..index);
            (start, used) = (index, first);
        }
        used += needed;
    }
    parts.push(start..widths.len().max(start));
    parts
}

/// Returns the table with its first column and the given ones.
fn with_columns(table: &Table, shown: &std::ops::Range<usize>) -> String {
    let mut table = table.clone();
    for (index, column) in table.column_iter_mut().enumerate() {
        if index > 0 && !shown.contains(&index) {
            column.set_constraint(ColumnConstraint::Hidden);
        }
    }
    table.trim_fmt() + "\n"
}

/// Breaks the lines of a text between words, so that none is wider than [`WIDTH`]; a line keeps its
/// indentation. A longer word stands alone.
pub fn wrapped(text: &str) -> String {
    let mut lines = Vec::new();
    for line in text.split('\n') {
        let indent: String = line.chars().take_while(|letter| *letter == ' ').collect();
        let mut current = String::new();
        for word in line.split_whitespace() {
            let is_first = current.is_empty();
            if !is_first && current.chars().count() + 1 + word.chars().count() > WIDTH {
                lines.push(std::mem::take(&mut current));
            }
            current.push_str(if current.is_empty() { &indent } else { " " });
            current.push_str(word);
        }
        lines.push(current);
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn widest(text: &str) -> usize {
        text.lines().map(|line| line.chars().count()).max().unwrap_or(0)
    }

    fn table_of(columns: usize) -> Table {
        let mut table = plain_table(false);
        table.set_header((0..columns).map(|column| format!("heading {column}")));
        table.add_row((0..columns).map(|column| format!("{column}")));
        table
    }

    #[test]
    fn a_wide_table_is_cut_into_tables_with_the_same_first_column() {
        let text = finish(table_of(12));
        assert!(widest(&text) <= WIDTH, "{}\n{text}", widest(&text));
        assert_eq!(text.matches("heading 0").count(), 2, "{text}");
        for column in 1..12 {
            assert_eq!(text.matches(&format!("heading {column}")).count(), if column == 1 { 3 } else { 1 });
        }
        assert_eq!(finish_within(table_of(12), 200).matches("heading 0").count(), 1);
        assert_eq!(finish(table_of(3)).matches("heading 0").count(), 1);
    }

    #[test]
    fn text_is_broken_between_words_and_keeps_its_indentation() {
        let text = wrapped(&format!("    {}\nshort", "word ".repeat(40)));
        assert!(widest(&text) <= WIDTH && text.ends_with("\nshort"), "{text}");
        assert!(text.lines().take(3).all(|line| line.starts_with("    word")), "{text}");
        assert_eq!(wrapped("a\n"), "a\n");
    }

    #[test]
    fn only_a_whole_is_printed_as_100_percent() {
        assert_eq!([1.0, 0.99999, 0.9394, 0.0].map(percent), ["100", "99.9", "93.9", "0.0"]);
    }
}
