//! Errors of single fields against the truth.

use ::report::charts::axis_limits::{limits, note_outside, outside};
use ::report::charts::chart::{Chart, MEASURED, Panel, WRONG, cloud, crosses, points, rounded, stacked};
use ::report::charts::plotly::Axis;
use ::report::charts::thinning::{bins, sampled, summary, thinning_caption};
use ::report::page::Section;
use ::report::page::data_table::DataTable;
use contract::docking::DockingOutcome;

use super::run::DockingRun;

/// Number of rows of the table behind the chart.
const TABLE_BINS: usize = 60;

/// Returns the section on the errors of all measured fields.
pub(super) fn field_errors(run: &DockingRun) -> Section {
    let section = Section::new("field-errors", "Errors of single fields");
    let rows: Vec<usize> = (0..run.truths.len())
        .filter(|&row| run.outcomes[row].as_ref().is_some_and(|outcome| outcome.measurement().is_some()))
        .collect();
    if rows.is_empty() {
        return section.absent("No field has a measured pose.");
    }
    let error = |row: usize, i: usize| {
        let measured = run.outcomes[row].as_ref().and_then(DockingOutcome::measurement);
        let (Some(measured), truth) = (measured, &run.truths[row].pose) else { return f64::NAN };
        let pose = &measured.best.pose;
        if i < 3 {
            pose.position_m[i] - truth.position_m[i]
        } else {
            (pose.phi_rad[i - 3] - truth.phi_rad[i - 3]).to_degrees()
        }
    };
    let is_wrong = |row: usize| run.verdicts[row].verdict == "wrong";
    let names = ["d1, m", "d2, m", "d3, m", "φ1, °", "φ2, °", "φ3, °"];
    let (wrong, right): (Vec<usize>, Vec<usize>) = rows.iter().partition(|&&row| is_wrong(row));
    let mut beyond = 0;
    let mut panels = Vec::new();
    for (i, title) in names.iter().enumerate() {
        let of = |rows: &[usize]| -> (Vec<f64>, Vec<f64>) {
            rows.iter().map(|&row| (rounded(run.truths[row].time_s, 3), rounded(error(row, i), 5))).unzip()
        };
        let scaled = if right.is_empty() { &wrong } else { &right };
        let range = limits(scaled.iter().map(|&row| error(row, i)));
        beyond += outside(range, rows.iter().map(|&row| error(row, i)));
        let mut traces = cloud("correct", &right, Some(&|row| error(row, i)), MEASURED, |rows| {
            let (x, y) = of(rows);
            points("", x, y, MEASURED)
        });
        let kept: Vec<usize> = sampled(wrong.len()).into_iter().map(|k| wrong[k]).collect();
        let (x, y) = of(&kept);
        traces.push(crosses("grossly wrong", x, y, WRONG));
        panels.push(Panel { range: Some(range), ..Panel::new(*title, traces) });
    }
    let (traces, layout) = stacked(Axis::titled("time, s"), panels);
    let mut head = vec!["from, s".to_owned()];
    for name in names {
        head.extend(["number", "smallest", "mean", "largest"].map(|what| format!("{name}: {what}")));
    }
    let mut data = DataTable::new(head)
        .caption("One row per group of consecutive measured fields; measurements.csv has every field.");
    for bin in bins(rows.len(), TABLE_BINS) {
        let mut cells = vec![format!("{:.2}", run.truths[rows[bin.start]].time_s)];
        for i in 0..6 {
            cells.extend(summary(bin.clone().map(|k| error(rows[k], i)), 4));
        }
        data.push(cells);
    }
    section.chart(Chart::new(
        format!(
            "Measured minus true. {} {}",
            note_outside(beyond, 6 * rows.len(), "errors"),
            thinning_caption(&[(right.len(), "correct fields"), (wrong.len(), "wrong ones")], true)
        ),
        900,
        data,
        traces,
        layout,
    ))
}
