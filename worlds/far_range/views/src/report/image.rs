//! Images of the report: whole images, the track of the target, regions.

use std::f64::consts::PI;
use std::ops::Range;

use ::report::charts::chart::{Chart, MEASURED, TRUTH, WRONG, cloud, crosses, line, points, rounded};
use ::report::charts::plotly::{Axis, Layout, Trace};
use ::report::charts::thinning::{bins, evenly, sampled, thinning_caption};
use ::report::page::Section;
use contract::Outcome;
use far_range::scoring::Verdict;
use files::Failure;
use sim::truth::{Elements, State};

use super::FrameDetail;
use super::run::{FarRangeRun, by_bins};

/// Margin around the detector, so that a mark at its edge is drawn completely, px.
const ROOM_PX: f64 = 8.0;
/// Legend of the marks in a picture.
pub(super) const KEY: &str = "Green: true position of the target; orange cross: measurement; blue: true stars that can \
    be detected; violet: planets, the Moon, hot pixels, cosmic-ray hits; yellow: clusters, with the \
    pipeline's classification; dashed: transmitted regions.";
/// Range of the whole image, km.
const SAMPLE_RANGE_KM: f64 = 16.0;
/// Number of overlaid images: ten degrees of an orbit between consecutive images.
const OVERLAID: usize = 36;

/// Returns the section with a whole image, and overlaid images of one orbit.
pub(super) fn sample(run: &FarRangeRun, sheet: &FrameDetail) -> Result<Section, Failure> {
    let section =
        Section::new("images", "A whole image, and the superimposed images of an orbit").in_paper("Fig. 2");
    if let Some(reason) = sheet.reason() {
        return Ok(section.absent(format!("The frames cannot be rendered again: {reason}")));
    }
    let away = |row: &usize| (run.truths[*row].range_km - SAMPLE_RANGE_KM).abs();
    let nearest = |rows: &mut dyn Iterator<Item = usize>| rows.min_by(|a, b| away(a).total_cmp(&away(b)));
    let is_right = |row: &usize| matches!(run.verdicts[*row].verdict, Verdict::Correct { .. });
    let right = nearest(&mut (0..run.verdicts.len()).filter(is_right));
    let Some(row) = right.or_else(|| nearest(&mut (0..run.verdicts.len()))) else { return Ok(section) };
    let orbit = one_orbit(run, row);
    let overlaid: Vec<usize> = bins(orbit.len(), OVERLAID).map(|bin| orbit.start + bin.start).collect();
    let pictures = [sheet.full_frame(run, row)?, sheet.overlaid(run, &overlaid)?];
    Ok(section
        .text(format!(
            "The frame nearest to {SAMPLE_RANGE_KM} km, with all detectable objects, and the maximum of each \
             pixel over the frames of the orbit around it: the target moves along its ellipse, stars along \
             their tracks. {KEY}"
        ))
        .pictures(pictures.into_iter().flatten().collect()))
}

/// Returns the rows within half an orbit of the given row, in the same group.
fn one_orbit(run: &FarRangeRun, row: usize) -> Range<usize> {
    let truth = &run.truths[row];
    let state = State { position_km: truth.position_km, velocity_km_s: truth.velocity_km_s };
    let half_s = Elements::from_state(&state).map_or(0.0, |orbit| PI / orbit.mean_motion_rad_s());
    let is_of = |other: &usize| {
        let other = &run.truths[*other];
        other.group == truth.group && (other.time - truth.time).to_seconds().abs() <= half_s
    };
    let first = (0..row).rev().take_while(is_of).last().unwrap_or(row);
    let last = (row..run.truths.len()).take_while(is_of).last().unwrap_or(row);
    first..last + 1
}

/// Returns the section on the target in the image.
pub(super) fn track(run: &FarRangeRun) -> Section {
    let camera = &run.run_file.scenario.camera;
    let at = |row: usize| run.truths[row].target_position.map_or([f64::NAN; 2], |p| [p.x, p.y]);
    let answer = |row: usize| {
        let measured = run.outcomes[row].as_ref().and_then(Outcome::measurement);
        measured.map_or([f64::NAN; 2], |m| [m.position.x, m.position.y])
    };
    let count = run.truths.len();
    let is = |row: usize, code: &str| run.verdicts[row].verdict.code() == code;
    let rows_of = |code: &str| (0..count).filter(|&row| is(row, code)).collect::<Vec<usize>>();
    let (right, wrong) = (rows_of("correct"), rows_of("wrong"));
    let hover = "frame %{customdata}<br>x %{x} px, y %{y} px";
    let trace_of = |curve: fn(&str, Vec<f64>, Vec<f64>, &str) -> Trace, rows: &[usize]| {
        let answers = rows.iter().map(|&row| answer(row)).map(|[x, y]| (rounded(x, 2), rounded(y, 2)));
        let (x, y): (Vec<f64>, Vec<f64>) = answers.unzip();
        let frames: Vec<u64> = rows.iter().map(|&row| run.truths[row].frame).collect();
        curve("measured, wrong", x, y, WRONG).custom_data(frames).hover_template(hover)
    };
    let mut traces = cloud("measured, correct", &right, None, MEASURED, |rows| trace_of(points, rows));
    let kept: Vec<usize> = sampled(wrong.len()).into_iter().map(|i| wrong[i]).collect();
    traces.push(trace_of(crosses, &kept));
    traces.push(true_track(run, &at).hover_template(hover));
    let (columns, rows) = (camera.columns as f64, camera.rows as f64);
    let x_axis = Axis::titled("x, px (columns)").range([-0.5 - ROOM_PX, columns - 0.5 + ROOM_PX]);
    let y_axis = Axis::titled("y, px (rows, downwards)").range([rows - 0.5 + ROOM_PX, -0.5 - ROOM_PX]);
    let layout = Layout::new(x_axis.constrain_domain(), y_axis.same_scale_as("x").constrain_domain());
    let data = by_bins(run, &[("true x, px", &|row| at(row)[0], 1), ("true y, px", &|row| at(row)[1], 1)]);
    Section::new("track", "Track of the target in pixels").in_paper("Fig. 3").chart(Chart::new(
        format!(
            "True and measured position of the target, whole detector. {}",
            thinning_caption(&[(right.len(), "correct measurements"), (wrong.len(), "wrong ones")], false)
        ),
        620,
        data,
        traces,
        layout,
    ))
}

/// Returns the track of the target over the detector, broken where the target is outside the image and where
/// another group begins.
fn true_track(run: &FarRangeRun, at: &dyn Fn(usize) -> [f64; 2]) -> Trace {
    let (mut x, mut y, mut frames) = (Vec::new(), Vec::new(), Vec::new());
    let mut last: Option<usize> = None;
    for row in evenly(run.truths.len()) {
        let [column, line] = at(row);
        if last.is_some_and(|last| run.verdicts[last].group != run.verdicts[row].group) {
            x.push(f64::NAN);
            y.push(f64::NAN);
            frames.push(run.truths[row].frame);
        }
        x.push(rounded(column, 2));
        y.push(rounded(line, 2));
        frames.push(run.truths[row].frame);
        last = Some(row);
    }
    line("true", x, y, TRUTH).custom_data(frames).opacity(0.7)
}

/// Returns the section on a whole and a truncated region.
pub(super) fn regions(run: &FarRangeRun, sheet: &FrameDetail) -> Result<Section, Failure> {
    let section = Section::new("regions", "A whole and a truncated region of interest").in_paper("Fig. 6");
    if run.run_file.scenario.roi.is_none() {
        return Ok(
            section.absent("The camera of this scenario transmits whole images: nothing is truncated.")
        );
    }
    let dec = |row: usize| match run.verdicts[row].verdict {
        Verdict::Correct { error } => error.centroid_px.map(|[_, y]| y.abs()),
        _ => None,
    };
    let mut by_error: Vec<usize> = (0..run.verdicts.len()).filter(|&row| dec(row).is_some()).collect();
    by_error
        .sort_by(|&a, &b| dec(b).partial_cmp(&dec(a)).unwrap_or(std::cmp::Ordering::Equal).then(a.cmp(&b)));
    let truncated = sheet.first_region(run, by_error.iter().copied().take(12), |cut| cut > 0.05)?;
    // Searches from near to far: at short range the target is as large as in the truncated region.
    let mut near: Vec<usize> =
        by_error.iter().copied().filter(|&row| dec(row).is_some_and(|error| error < 0.5)).collect();
    near.sort_by(|&a, &b| run.truths[a].range_km.total_cmp(&run.truths[b].range_km).then(a.cmp(&b)));
    let step = near.len().div_ceil(30).max(1);
    let whole = sheet.first_region(run, near.into_iter().step_by(step), |cut| cut < 0.02)?;
    let note = match (&whole, &truncated) {
        (Some(_), Some(_)) => {
            "Left whole, right truncated: the camera transmits regions of a fixed size, and the part of the \
             target beyond its region is lost."
        }
        (Some(_), None) => "No target of this run was truncated by its region.",
        (None, Some(_)) => "No whole target of this run was detected in its region.",
        (None, None) => "No frame of this run has a region with only the target.",
    };
    let pictures: Vec<_> = whole.into_iter().chain(truncated).collect();
    if pictures.is_empty() {
        return Ok(section.absent(note));
    }
    let key = "Green: true centre of the target, and a circle around its image; orange: measurement; dashed: \
        transmitted region.";
    Ok(section.text(format!("{note} {key}")).pictures(pictures))
}
