//! Errors of the relative navigation over time.

use ::report::charts::chart::{BESIDE, Chart, MEASURED, Panel, TRUTH, band, line, rounded, stacked};
use ::report::charts::plotly::Trace;
use ::report::charts::thinning::{bins, evenly};
use ::report::page::Section;
use ::report::page::data_table::DataTable;
use navigate::NavigationRow;

use super::run::{FarRangeRun, axis_time, time_axis};

/// Number of rows of the table behind the chart.
const TABLE_BINS: usize = 60;

/// Fills of the bands, in the order R, T, N.
const FILLS: [&str; 3] = ["rgba(54, 134, 201, 0.16)", "rgba(224, 117, 45, 0.18)", "rgba(47, 158, 105, 0.16)"];

/// Colours of the lines, in the order R, T, N.
const COLOURS: [&str; 3] = [MEASURED, BESIDE, TRUTH];

/// Returns the section on the errors of the relative orbit determination; without a block if the run has
/// no `navigation.csv`.
pub(super) fn errors(run: &FarRangeRun) -> Section {
    let section = Section::new("navigation", "Errors of the relative navigation").in_paper("Fig. 10");
    let estimated: Vec<(&NavigationRow, [f64; 3], [f64; 3])> = run
        .navigation
        .iter()
        .filter_map(|row| Some((row, row.position_error_m?, row.position_sigma_m?)))
        .collect();
    if estimated.is_empty() {
        return match run.navigation.is_empty() {
            true => section.absent("The run has no navigation; `boresight navigate RUN` adds it."),
            false => section.absent("`navigation.csv` has no estimate."),
        };
    }
    let shown = evenly(estimated.len());
    let traces = |axis: usize, name: &str| -> Vec<Trace> {
        let (mut times, mut errors) = (Vec::new(), Vec::new());
        let (mut low, mut high) = (Vec::new(), Vec::new());
        for &place in &shown {
            let (row, error, sigma) = &estimated[place];
            times.push(row.time().map_or(f64::NAN, axis_time));
            errors.push(rounded(error[axis], 4));
            low.push(rounded(-3.0 * sigma[axis], 4));
            high.push(rounded(3.0 * sigma[axis], 4));
        }
        let mut traces: Vec<Trace> =
            band(&format!("±3 σ {name}"), times.clone(), low, high, FILLS[axis]).into();
        traces.push(line(&format!("e{name}"), times, errors, COLOURS[axis]));
        traces
    };
    let across: Vec<Trace> = traces(0, "R").into_iter().chain(traces(2, "N")).collect();
    let panels = vec![Panel::new("eR, eN, m", across), Panel::new("eT, m", traces(1, "T"))];
    let (traces, layout) = stacked(time_axis(run), panels);
    let mut data = DataTable::new(["time (UTC)", "eR, m", "eT, m", "eN, m", "σ R, m", "σ T, m", "σ N, m"])
        .caption("A regular selection of the estimates; navigation.csv has each of them.");
    for bin in bins(estimated.len(), TABLE_BINS) {
        let (row, error, sigma) = &estimated[bin.start];
        let time: String = row.time_utc.chars().take(19).collect();
        let mut cells = vec![time.replace('T', " ")];
        cells.extend(error.iter().chain(sigma).map(|value| format!("{value:.3}")));
        data.push(cells);
    }
    section.chart(Chart::new(
        "Estimated minus true position of the chaser along the target's R, T, N, with bands of ±3 standard \
         deviations: R and N above, T below.",
        520,
        data,
        traces,
        layout,
    ))
}
