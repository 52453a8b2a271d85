//! Measurements over time: errors, stars.

use ::report::charts::axis_limits::{limits as axis_limits, outside};
use ::report::charts::chart::{
    BESIDE, Chart, MEASURED, Panel, REFERENCE, WRONG, cloud, crosses, dashed, line, points, rounded, stacked,
};
use ::report::charts::thinning::{sampled, thinned, thinning_caption};
use ::report::page::Section;
use far_range::scoring::Verdict;
use score::angle;

use super::run::{FarRangeRun, axis_time, broken, by_bins, time_axis};

/// Number of images in the moving mean of the stars.
const MEAN_OF: usize = 100;

/// Returns the section on errors over time.
pub(super) fn errors(run: &FarRangeRun) -> Section {
    let section = Section::new("errors", "Errors of the direction over time").in_paper("Fig. 5");
    if run.score.attitude.as_deref() == Some("none") {
        return section.absent(
            "No line of sight was reported: the list of all figures has the errors of the centroid, in pixels.",
        );
    }
    let errors = DirectionErrors::from_run(run);
    if errors.right.is_empty() && errors.wrong.is_empty() {
        return section.absent("No measurement has a line of sight.");
    }
    let panels = vec![errors.panel(0, "across columns, °"), errors.panel(1, "across rows, °")];
    let (traces, layout) = stacked(time_axis(run), panels);
    let data = by_bins(
        run,
        &[
            ("across columns, correct, °", &|row| errors.of_correct(row, 0), 4),
            ("across rows, correct, °", &|row| errors.of_correct(row, 1), 4),
        ],
    );
    section.chart(Chart::new(errors.caption(), 560, data, traces, layout))
}

/// Errors of the direction of a run, across columns (0) and across rows (1), degrees.
struct DirectionErrors<'a> {
    run: &'a FarRangeRun,
    /// Rows of the correct measurements with a line of sight.
    right: Vec<usize>,
    /// Rows of the wrong ones.
    wrong: Vec<usize>,
    /// Angles of one pixel, degrees.
    pixel_deg: [f64; 2],
    /// Limits of the axes.
    ranges: [[f64; 2]; 2],
}

impl<'a> DirectionErrors<'a> {
    /// Collects the errors of a run.
    fn from_run(run: &'a FarRangeRun) -> Self {
        let limits = far_range::limits(&run.run_file.scenario);
        let pixel_deg = [limits.ra_deg[0], limits.dec_deg[0]];
        let mut errors =
            Self { run, right: Vec::new(), wrong: Vec::new(), pixel_deg, ranges: [[-1.0, 1.0]; 2] };
        for row in (0..run.verdicts.len()).filter(|&row| error_deg(run, row, 0).is_finite()) {
            match run.verdicts[row].verdict {
                Verdict::Correct { .. } => errors.right.push(row),
                Verdict::Wrong { .. } => errors.wrong.push(row),
                Verdict::Missed { .. } => {}
            }
        }
        // The errors of wrong measurements are distances to another object; on the same axis they would hide
        // the other errors.
        let scaled = if errors.right.is_empty() { &errors.wrong } else { &errors.right };
        errors.ranges = [0, 1].map(|index| axis_limits(scaled.iter().map(|&row| error_deg(run, row, index))));
        errors
    }

    /// Returns the error of a correct measurement; NaN for any other row.
    fn of_correct(&self, row: usize, index: usize) -> f64 {
        match self.run.verdicts[row].verdict {
            Verdict::Correct { .. } => error_deg(self.run, row, index),
            _ => f64::NAN,
        }
    }

    /// Returns the panel of one component, with the angles of one pixel.
    fn panel(&self, index: usize, title: &str) -> Panel {
        let run = self.run;
        let value = |row: usize| error_deg(run, row, index);
        let of = |rows: &[usize]| -> (Vec<f64>, Vec<f64>, Vec<u64>) {
            let y = rows.iter().map(|&row| rounded(value(row), 5)).collect();
            (run.times(rows), y, rows.iter().map(|&row| run.truths[row].frame).collect())
        };
        let hover = "frame %{customdata}<br>%{x}<br>%{y}°";
        let mut traces = cloud("correct", &self.right, Some(&value), MEASURED, |rows| {
            let (x, y, frames) = of(rows);
            points("", x, y, MEASURED).custom_data(frames).hover_template(hover)
        });
        let kept: Vec<usize> = sampled(self.wrong.len()).into_iter().map(|i| self.wrong[i]).collect();
        let (x, y, frames) = of(&kept);
        traces.push(crosses("wrong", x, y, WRONG).custom_data(frames).hover_template(hover));
        let ends = [&run.truths[0], &run.truths[run.truths.len() - 1]].map(|truth| axis_time(truth.time));
        let pixel = self.pixel_deg[index];
        let name = angle(pixel);
        for (name, at) in [(format!("{name} (1 px)"), pixel), (format!("−{name}"), -pixel)] {
            let limit = dashed(&name, ends.to_vec(), vec![at; 2], BESIDE);
            traces.push(if at > 0.0 { limit } else { limit.not_in_legend() });
        }
        Panel { range: Some(self.ranges[index]), ..Panel::new(title, traces) }
    }

    /// Returns the number of rows with an error outside the axes.
    fn count_outside(&self, rows: &[usize]) -> usize {
        let is_outside = |row: usize| {
            (0..2).any(|index| {
                outside(self.ranges[index], std::iter::once(error_deg(self.run, row, index))) > 0
            })
        };
        rows.iter().filter(|&&row| is_outside(row)).count()
    }

    fn caption(&self) -> String {
        format!(
            "Angles of the line of sight in the camera system, across columns and across rows, measured minus \
             true. One pixel is {} across columns and {} across rows (dashed, where it is within the axes). \
             Outside the axes: {} of {} correct and {} of {} wrong measurements; double-click to zoom out. {}",
            angle(self.pixel_deg[0]),
            angle(self.pixel_deg[1]),
            self.count_outside(&self.right),
            self.right.len(),
            self.count_outside(&self.wrong),
            self.wrong.len(),
            thinning_caption(
                &[(self.right.len(), "correct measurements"), (self.wrong.len(), "wrong ones")],
                true
            )
        )
    }
}

/// Returns the error of the direction in a row, across columns (0) or rows (1), degrees; NaN without one.
fn error_deg(run: &FarRangeRun, row: usize, index: usize) -> f64 {
    let error = run.verdicts[row].verdict.line_of_sight_error();
    error.map_or(f64::NAN, |error| [error.ra, error.dec][index].degrees())
}

/// Returns the section on stars per image.
pub(super) fn stars(run: &FarRangeRun) -> Section {
    let count = run.verdicts.len();
    let number = |row: usize| run.verdicts[row].n_stars.map_or(f64::NAN, f64::from);
    let stated: Vec<usize> = (0..count).filter(|&row| number(row).is_finite()).collect();
    let section = Section::new("stars", "Stars identified in each image").in_paper("Fig. 7");
    if stated.is_empty() {
        return section.absent("The pipeline reports no number of identified stars.");
    }
    let mut sum = 0.0;
    let mut means = Vec::with_capacity(stated.len());
    for (place, &row) in stated.iter().enumerate() {
        sum += number(row);
        if place >= MEAN_OF {
            sum -= number(stated[place - MEAN_OF]);
        }
        means.push(sum / MEAN_OF.min(place + 1) as f64);
    }
    let mean_rows = thinned(stated.len(), &[&|i| means[i]]);
    let (mean_times, mean_values) =
        broken(run, mean_rows.into_iter().map(|i| (stated[i], rounded(means[i], 2))));
    let least = run.run_file.scenario.far_range.attitude.min_stars;
    let ends = [&run.truths[0], &run.truths[count - 1]].map(|truth| axis_time(truth.time));
    let mut traces = cloud("stars", &stated, Some(&number), MEASURED, |rows| {
        let frames: Vec<u64> = rows.iter().map(|&row| run.truths[row].frame).collect();
        points("", run.times(rows), rows.iter().map(|&row| number(row)).collect(), MEASURED)
            .custom_data(frames)
            .hover_template("frame %{customdata}<br>%{x}<br>%{y} stars")
    });
    traces.push(line("mean of the last 100 images", mean_times, mean_values, BESIDE));
    traces.push(dashed("minimum for an attitude", ends.to_vec(), vec![f64::from(least); 2], REFERENCE));
    let (traces, layout) = stacked(time_axis(run), vec![Panel::new("stars", traces)]);
    let data = by_bins(run, &[("stars", &number, 1)]);
    section.chart(Chart::new(
        format!(
            "Mean over the last {MEAN_OF} images. {}",
            thinning_caption(&[(stated.len(), "images")], true)
        ),
        380,
        data,
        traces,
        layout,
    ))
}
