//! Figures of a score, as text and as a table.

pub mod run_page;
pub mod words;
use indexmap::IndexMap;
use run::figure_by_name;
use score::Figure;

use crate::page::data_table::DataTable;

/// Formats a rate in percent with its interval: `93.86 (92.1–95.2)`; a dash if its denominator is 0.
pub fn shown_percent(figure: &Figure) -> String {
    let Some(value) = figure.value else { return "–".to_owned() };
    let interval = figure.low.zip(figure.high);
    let interval = interval.map(|(low, high)| format!(" ({:.1}–{:.1})", 100.0 * low, 100.0 * high));
    format!("{:.2} %{}", 100.0 * value, interval.unwrap_or_default())
}

/// Formats a rate with its interval for a table whose caption states percent.
pub fn percent_cell(figure: Option<&Figure>) -> String {
    figure.map_or_else(String::new, |figure| shown_percent(figure).replacen(" %", "", 1))
}

/// Formats a number with four significant digits, or exactly if it is an integer.
pub fn significant(value: f64) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    if value.fract() == 0.0 && value.abs() < 1e9 {
        return format!("{value:.0}");
    }
    // The exponent is taken from the rounded text: 9.999 97 gains a digit before the point by rounding.
    let written = format!("{value:.3e}");
    let exponent = written.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    let places = 3 - exponent.unwrap_or(0);
    match places {
        0..=9 => format!("{value:.*}", places as usize),
        _ if places < 0 => format!("{value:.0}"),
        _ => format!("{value:.3e}"),
    }
}

/// Formats a probability in percent. A probability close to 0 or 1 is not rounded to 0 or 100 %.
pub fn probability(value: f64) -> String {
    if value > 0.0 && value < 0.000_5 {
        "<\u{a0}0.1\u{a0}%".to_owned()
    } else if value < 1.0 && value > 0.999_5 {
        ">\u{a0}99.9\u{a0}%".to_owned()
    } else {
        format!("{:.1}\u{a0}%", 100.0 * value)
    }
}

/// Formats the minimum and the maximum of some values: `2.94 to 30.83 km`.
pub fn least_to_most(values: impl Iterator<Item = f64>, unit: &str) -> String {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    format!("{low:.2} to {high:.2} {unit}")
}

/// Formats a value, or a dash for `None`.
pub fn cell(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), significant)
}

/// Returns a table of all figures with count and interval. Rates are fractions, as in `score.json`.
pub fn figure_table(figures: &IndexMap<String, Figure>) -> DataTable {
    let head = ["figure", "value", "95 % low", "95 % high", "count", "of", "independent"];
    let mut table = DataTable::new(head).caption(
        "All figures of score.json; rates are fractions from 0 to 1. Independent: effective number of \
         independent frames, as neighbouring frames are correlated.",
    );
    for (name, figure) in figures {
        let is_rate = figure_by_name(name).is_rate();
        let number = |value: Option<f64>| match value {
            Some(value) if is_rate => format!("{value:.4}"),
            value => cell(value),
        };
        table.push([
            figure_by_name(name).label_without_percent(),
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
    use score::{Better, FigureSpec, Kind, Sense};

    use super::*;

    #[test]
    fn numbers_have_four_significant_digits() {
        let shown = [0.0, 1.0, 12.345_67, 0.001_234_56, 123_456.0, -2.0e-12, f64::NAN].map(significant);
        assert_eq!(shown, ["0", "1", "12.35", "0.001235", "123456", "-2.000e-12", "–"]);
        assert_eq!([9.999_97, 999.97, -89.998].map(significant), ["10.00", "1000", "-90.00"]);
    }

    #[test]
    fn only_0_and_1_are_printed_as_certain_probabilities() {
        let shown = [0.0, 0.000_02, 0.9, 0.999_9, 1.0].map(|p| probability(p).replace('\u{a0}', " "));
        assert_eq!(shown, ["0.0 %", "< 0.1 %", "90.0 %", "> 99.9 %", "100.0 %"]);
    }

    #[test]
    fn every_figure_is_read_with_its_unit() {
        let sense = Sense { kind: Kind::Rate, better: Better::More };
        run::register_figures(vec![
            FigureSpec {
                unit: Some("°"),
                ..FigureSpec::amount("ra_rms_deg", "RMS across columns", Better::Less)
            },
            FigureSpec { unit: Some("%"), sense, ..FigureSpec::amount("hit_rate", "hit rate", Better::More) },
        ]);
        let figures = ["ra_rms_deg", "hit_rate", "stars_mean"];
        let figures = figures.map(|name| (name.to_owned(), Figure::mean(&[vec![0.5, 1.0]])));
        let labels: Vec<String> =
            figure_table(&figures.into()).rows.into_iter().filter_map(|row| row.into_iter().next()).collect();
        assert_eq!(labels, ["RMS across columns, °", "hit rate", "stars mean"]);
    }

    #[test]
    fn a_range_is_from_the_least_to_the_most() {
        assert_eq!(least_to_most([30.33, 29.2, 30.8].into_iter(), "km"), "29.20 to 30.80 km");
    }
}
