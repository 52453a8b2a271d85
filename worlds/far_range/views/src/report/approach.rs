//! Position of the chaser: the relative orbit.

use ::report::charts::chart::{Chart, MEASURED, Panel, line, rounded, stacked};
use ::report::charts::plotly::Axis;
use ::report::charts::thinning::{bins, evenly};
use ::report::page::Section;
use ::report::page::data_table::DataTable;
use files::Failure;

use super::run::{FarRangeRun, shown_time};

/// Number of rows of the table behind the chart.
const TABLE_BINS: usize = 60;

/// Returns the section on the chaser in the orbital frame of the target.
pub(super) fn relative_position(run: &FarRangeRun) -> Result<Section, Failure> {
    let trajectory = run.run_file.scenario.trajectory()?;
    let rtn_km: Vec<[f64; 3]> =
        run.truths.iter().map(|truth| trajectory.states_at(truth.time).chaser_rtn_km().into()).collect();
    let rows = evenly(rtn_km.len());
    let panel = |title: &str, component: usize| {
        let (mut along, mut values, mut frames) = (Vec::new(), Vec::new(), Vec::new());
        let mut last: Option<usize> = None;
        for &row in &rows {
            // Groups are separated in time and not joined by a line.
            if last.is_some_and(|last| run.verdicts[last].group != run.verdicts[row].group) {
                along.push(f64::NAN);
                values.push(f64::NAN);
                frames.push(run.truths[row].frame);
            }
            along.push(rounded(rtn_km[row][1], 4));
            values.push(rounded(rtn_km[row][component], 4));
            frames.push(run.truths[row].frame);
            last = Some(row);
        }
        let hover = "frame %{customdata}<br>along-track %{x} km<br>%{y} km";
        Panel::new(
            title,
            vec![line("chaser", along, values, MEASURED).custom_data(frames).hover_template(hover)],
        )
    };
    let panels = vec![panel("radial, km", 0), panel("cross-track, km", 2)];
    let (traces, layout) = stacked(Axis::titled("along-track, km"), panels);
    let mut data = DataTable::new([
        "time (UTC)",
        "frame",
        "radial, km",
        "along-track, km",
        "cross-track, km",
        "range, km",
    ])
    .caption("A regular selection of the frames; the trajectory is that of run.toml.");
    for bin in bins(rtn_km.len(), TABLE_BINS) {
        let (truth, [radial, along, cross]) = (&run.truths[bin.start], rtn_km[bin.start]);
        let mut cells = vec![shown_time(truth), truth.frame.to_string()];
        cells.extend([radial, along, cross, truth.range_km].map(|value| format!("{value:.4}")));
        data.push(cells);
    }
    let title = "Position of the chaser in the orbital frame of the target";
    Ok(Section::new("relative-position", title).in_paper("Fig. 4").chart(Chart::new(
        "True position. The radial, along-track and cross-track axes move with the target, which is at \
             (0, 0).",
        460,
        data,
        traces,
        layout,
    )))
}
