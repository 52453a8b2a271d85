//! Figures of a score as words and as a table.

use indexmap::IndexMap;

use super::page::DataTable;
use crate::score::{Figure, Kind, sense};

/// A rate in percent with its interval: `93.86 (92.1–95.2)`; a dash where it is counted over nothing.
pub(super) fn shown_percent(figure: &Figure) -> String {
    let Some(value) = figure.value else { return "–".to_owned() };
    let interval = figure.low.zip(figure.high);
    let interval = interval.map(|(low, high)| format!(" ({:.1}–{:.1})", 100.0 * low, 100.0 * high));
    format!("{:.2} %{}", 100.0 * value, interval.unwrap_or_default())
}

/// The same for a table that says percent above.
pub(super) fn percent_cell(figure: Option<&Figure>) -> String {
    figure.map_or_else(String::new, |figure| shown_percent(figure).replacen(" %", "", 1))
}

/// A number with four significant digits, or as it is when it is whole.
pub(super) fn significant(value: f64) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    if value.fract() == 0.0 && value.abs() < 1e9 {
        return format!("{value:.0}");
    }
    let places = 3 - libm::floor(libm::log10(value.abs())) as i32;
    match places {
        0..=9 => format!("{value:.*}", places as usize),
        _ if places < 0 => format!("{value:.0}"),
        _ => format!("{value:.3e}"),
    }
}

/// A value or nothing.
pub(super) fn cell(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), significant)
}

/// Every figure with its count and its interval. Rates are fractions, as in `score.json`.
pub(super) fn figure_table(figures: &IndexMap<String, Figure>) -> DataTable {
    let head = ["figure", "value", "95 % low", "95 % high", "count", "of", "independent"];
    let mut table = DataTable::new(head).caption(
        "All figures of score.json; rates are fractions from 0 to 1. Independent: what the frames are worth, neighbours being alike.",
    );
    for (name, figure) in figures {
        let is_rate = sense(name).kind == Kind::Rate;
        let number = |value: Option<f64>| match value {
            Some(value) if is_rate => format!("{value:.4}"),
            value => cell(value),
        };
        table.push([
            name.clone(),
            number(figure.value),
            number(figure.low),
            number(figure.high),
            figure.count.to_string(),
            figure.of.to_string(),
            format!("{:.0}", figure.effective),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_significant_digits() {
        let shown = [0.0, 1.0, 12.345_67, 0.001_234_56, 123_456.0, -2.0e-12, f64::NAN].map(significant);
        assert_eq!(shown, ["0", "1", "12.35", "0.001235", "123456", "-2.000e-12", "–"]);
    }
}
