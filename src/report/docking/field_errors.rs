//! Errors of single fields against the truth.

use contract::docking::DockingOutcome;

use super::limits;
use super::run::DockingRun;
use crate::report::chart::{Chart, MEASURED, Panel, WRONG, crosses, points, rounded, stacked};
use crate::report::page::{DataTable, Section};
use crate::report::thin::{bins, summary, thinned};

/// Rows of the table behind the chart.
const TABLE_BINS: usize = 60;

/// Errors of every measured field.
pub(super) fn field_errors(run: &DockingRun) -> Section {
    let section = Section::new("field-errors", "Errors of single fields");
    let rows: Vec<usize> = (0..run.truths.len())
        .filter(|&row| run.outcomes[row].as_ref().is_some_and(|outcome| outcome.measurement().is_some()))
        .collect();
    if rows.is_empty() {
        return section.text("No field was measured.");
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
    let panels = names.iter().enumerate().map(|(i, title)| {
        let of = |wrong: bool| {
            let rows: Vec<usize> = rows.iter().copied().filter(|&row| is_wrong(row) == wrong).collect();
            let kept = thinned(rows.len(), &[&|k| error(rows[k], i)]);
            let x: Vec<f64> = kept.iter().map(|&k| rounded(run.truths[rows[k]].time_s, 3)).collect();
            let y: Vec<f64> = kept.iter().map(|&k| rounded(error(rows[k], i), 5)).collect();
            (x, y)
        };
        let ((x, y), (wx, wy)) = (of(false), of(true));
        let range = limits(rows.iter().filter(|&&row| !is_wrong(row)).map(|&row| error(row, i)));
        let traces = vec![points("right", x, y, MEASURED), crosses("grossly wrong", wx, wy, WRONG)];
        Panel { range: Some(range), ..Panel::new(*title, traces) }
    });
    let (traces, layout) = stacked("time, s", panels.collect());
    let mut head = vec!["from, s".to_owned()];
    for name in names {
        head.extend(["number", "smallest", "mean", "largest"].map(|what| format!("{name}: {what}")));
    }
    let mut data =
        DataTable::new(head).caption("By stretches of measured fields; measurements.csv has every field.");
    for bin in bins(rows.len(), TABLE_BINS) {
        let mut cells = vec![format!("{:.2}", run.truths[rows[bin.start]].time_s)];
        for i in 0..6 {
            cells.extend(summary(bin.clone().map(|k| error(rows[k], i)), 4));
        }
        data.push(cells);
    }
    section.chart(Chart::new(
        "Measured minus true. The axes leave out the wildest hundredth; zoom out (double click) for it. Of many fields so many are \
         drawn as a screen can show, extremes always among them.",
        900,
        data,
        traces,
        layout,
    ))
}
