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
    let component = |row: usize, index: usize| {
        let error = run.verdicts[row].verdict.line_of_sight_error();
        error.map_or(f64::NAN, |error| [error.ra, error.dec][index].degrees())
    };
    let rows_of = |is_wrong: bool| -> Vec<usize> {
        (0..run.verdicts.len())
            .filter(|&row| component(row, 0).is_finite())
            .filter(|&row| match run.verdicts[row].verdict {
                Verdict::Correct { .. } => !is_wrong,
                Verdict::Wrong { .. } => is_wrong,
                Verdict::Missed { .. } => false,
            })
            .collect()
    };
    let (right, wrong) = (rows_of(false), rows_of(true));
    if right.is_empty() && wrong.is_empty() {
        return section.absent("No measurement has a line of sight.");
    }
    // The errors of wrong measurements are distances to another object; on the same axis they would hide the
    // other errors.
    let scaled = if right.is_empty() { &wrong } else { &right };
    let ranges = [0, 1].map(|index| axis_limits(scaled.iter().map(|&row| component(row, index))));
    let ends = [&run.truths[0], &run.truths[run.truths.len() - 1]].map(|truth| axis_time(truth.time));
    let limits = far_range::limits(&run.run_file.scenario);
    let panel = |index: usize, title: &str| {
        let of = |rows: &[usize]| -> (Vec<f64>, Vec<f64>, Vec<u64>) {
            let y = rows.iter().map(|&row| rounded(component(row, index), 5)).collect();
            (run.times(rows), y, rows.iter().map(|&row| run.truths[row].frame).collect())
        };
        let hover = "frame %{customdata}<br>%{x}<br>%{y}°";
        let mut traces = cloud("correct", &right, Some(&|row| component(row, index)), MEASURED, |rows| {
            let (x, y, frames) = of(rows);
            points("", x, y, MEASURED).custom_data(frames).hover_template(hover)
        });
        let kept: Vec<usize> = sampled(wrong.len()).into_iter().map(|i| wrong[i]).collect();
        let (x, y, frames) = of(&kept);
        traces.push(crosses("wrong", x, y, WRONG).custom_data(frames).hover_template(hover));
        let pixel = [limits.ra_deg, limits.dec_deg][index][0];
        let name = angle(pixel);
        for (name, at) in [(format!("{name} (1 px)"), pixel), (format!("−{name}"), -pixel)] {
            let limit = dashed(&name, ends.to_vec(), vec![at; 2], BESIDE);
            traces.push(if at > 0.0 { limit } else { limit.not_in_legend() });
        }
        Panel { range: Some(ranges[index]), ..Panel::new(title, traces) }
    };
    let (traces, layout) =
        stacked(time_axis(run), vec![panel(0, "across columns, °"), panel(1, "across rows, °")]);
    let is_outside = |row: &&usize| {
        (0..2).any(|index| outside(ranges[index], std::iter::once(component(**row, index))) > 0)
    };
    let beyond = [&right, &wrong].map(|rows| rows.iter().filter(is_outside).count());
    let right_only = |row: usize, index: usize| match run.verdicts[row].verdict {
        Verdict::Correct { .. } => component(row, index),
        _ => f64::NAN,
    };
    let pixel_words = format!(
        "One pixel is {} across columns and {} across rows (dashed, where it is within the axes).",
        angle(limits.ra_deg[0]),
        angle(limits.dec_deg[0])
    );
    let data = by_bins(
        run,
        &[
            ("across columns, correct, °", &|row| right_only(row, 0), 4),
            ("across rows, correct, °", &|row| right_only(row, 1), 4),
        ],
    );
    section.chart(Chart::new(
        format!(
            "Angles of the line of sight in the camera system, across columns and across rows, measured minus \
             true. {pixel_words} Outside the axes: {} of {} correct and {} of {} wrong measurements; double-click to \
             zoom out. {}",
            beyond[0],
            right.len(),
            beyond[1],
            wrong.len(),
            thinning_caption(&[(right.len(), "correct measurements"), (wrong.len(), "wrong ones")], true)
        ),
        560,
        data,
        traces,
        layout,
    ))
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
