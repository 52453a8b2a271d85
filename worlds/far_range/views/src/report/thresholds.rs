//! Rates by a threshold on the odds that the measurements state.

use ::report::charts::chart::{BESIDE, Chart, MEASURED, WRONG, axes, line};
use ::report::charts::plotly::Trace;
use ::report::page::Section;
use ::report::page::data_table::DataTable;
use far_range::scoring::{Score, ThresholdPoint};

/// Rate of a point of the curve.
type Rate = fn(&ThresholdPoint) -> Option<f64>;

/// Rates with their names and colours.
const RATES: [(&str, Rate, &str); 3] = [
    ("correct, of frames with a visible target", |point| point.correct_rate, MEASURED),
    ("wrong, of frames with a visible target", |point| point.wrong_rate, WRONG),
    ("false alarms, of frames without one", |point| point.false_alarm_rate, BESIDE),
];

/// Returns the section of the curve; empty if a measurement states no odds.
pub(super) fn thresholds(score: &Score) -> Section {
    let section = Section::new("thresholds", "Hits and false alarms by threshold");
    let curve = &score.threshold_curve;
    if curve.is_empty() {
        return section.absent("No measurement states the odds that it is right.");
    }
    let mut table = DataTable::new(["smallest ln(odds)"].into_iter().chain(RATES.map(|(name, ..)| name)));
    for point in curve {
        let rates = RATES.map(|(_, rate, _)| rate(point).map_or("–".to_owned(), percent));
        table.push([format!("{:.0}", point.min_log_odds)].into_iter().chain(rates));
    }
    let caption = "Rates if a measurement counts only from these odds on. The curve begins at the smallest \
                   stated odds; the key `min_log_odds` of the best mode sets them.";
    let layout = axes("smallest natural logarithm of the odds", "rate, %");
    section.chart(Chart::new(caption, 320, table, traces(curve), layout))
}

/// Returns a line per rate that has values.
fn traces(curve: &[ThresholdPoint]) -> Vec<Trace> {
    let mut traces = Vec::new();
    for (name, rate, colour) in RATES {
        let points = || curve.iter().filter_map(|point| Some((point.min_log_odds, 100.0 * rate(point)?)));
        let (x, y): (Vec<f64>, Vec<f64>) = points().unzip();
        if !x.is_empty() {
            traces.push(line(name, x, y, colour));
        }
    }
    traces
}

fn percent(rate: f64) -> String {
    format!("{:.2}", 100.0 * rate)
}
