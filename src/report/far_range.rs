//! The report of a far-range run: the figures of the far-range paper by name, its Table 2, causes, frames.

use std::path::Path;

use contract::{Outcome, Rotation};
use indexmap::IndexMap;
use plotly::layout::{Axis, AxisConstrain, AxisRange};
use plotly::{Layout, Trace};
use sim::truth::{FrameTruth, Observer};

use super::budget::{InjectedRun, budget};
use super::chart::{
    BESIDE, Chart, MEASURED, Panel, REFERENCE, TRUTH, WRONG, axes, bars, crosses, dashed, line, points,
    rounded, stacked, stacked_bars,
};
use super::figures::{figure_table, percent_cell, shown_percent};
use super::frame_sheet::FrameSheet;
use super::page::{DataTable, Page, Section};
use super::read::{missing, read_json};
use super::thin::{bins, summary, thinned};
use crate::failure::Failure;
use crate::files::{TableReader, TelemetryRow, format_utc, read_measurements, read_telemetry};
use crate::run;
use crate::run_file::RunFile;
use crate::scenario::{FarRangeScenario, is_argon};
use crate::score::{ARGON_TABLE_2, Cause, FrameVerdict, Score, Verdict};

/// Rows of the table behind a long series.
const TABLE_BINS: usize = 60;
/// Images that the mean of Fig. 7 is taken over.
const MEAN_OF: usize = 100;
/// Speed of light, km/s.
const LIGHT_KM_S: f64 = 299_792.458;

/// What a far-range run left in its directory.
pub struct FarRangeRun {
    /// `run.toml`.
    pub run_file: RunFile<FarRangeScenario>,
    /// `score.json`.
    pub score: Score,
    /// A verdict a frame, from truth and measurements.
    pub verdicts: Vec<FrameVerdict>,
    /// `truth/frames.parquet`, in the order of the verdicts.
    pub truths: Vec<FrameTruth>,
    /// `measurements.csv`, of the same frames; `None` where there is no row.
    pub outcomes: Vec<Option<Outcome>>,
    /// `telemetry.csv`, of the same frames.
    pub telemetry: Vec<TelemetryRow>,
    /// Runs of the same frames with the truth for a stage each; empty where there is no error budget.
    pub budget: Vec<InjectedRun>,
}

impl FarRangeRun {
    /// Reads a run directory.
    ///
    /// # Errors
    /// A [`Failure`] that names the file which is missing, cannot be read, or is not of the same frames as the others.
    pub fn read(directory: &Path) -> Result<Self, Failure> {
        check_files(directory)?;
        let clusters = Some(directory.join("clusters.parquet")).filter(|path| path.is_file());
        let scored = run::score(directory, &directory.join("measurements.csv"), clusters.as_deref())?;
        Self::with_verdicts(directory, scored.verdicts)
    }

    /// Reads the directory of a run whose verdicts are at hand: the table of objects, by far the longest, is then left alone.
    ///
    /// # Errors
    /// As [`FarRangeRun::read`].
    pub fn with_verdicts(directory: &Path, verdicts: Vec<FrameVerdict>) -> Result<Self, Failure> {
        check_files(directory)?;
        let run_file = RunFile::<FarRangeScenario>::read(&directory.join("run.toml"))?;
        let score: Score = read_json(&directory.join("score.json"), "score")?;
        let measurements = directory.join("measurements.csv");
        let mut truths = Vec::with_capacity(verdicts.len());
        for frame in TableReader::<FrameTruth>::open(&directory.join("truth/frames.parquet"))? {
            truths.extend(frame?.1);
        }
        let mut answers = read_measurements(&measurements)?.into_iter().peekable();
        let mut rows = read_telemetry(&directory.join("telemetry.csv"))?.into_iter().peekable();
        let mut telemetry = Vec::with_capacity(verdicts.len());
        let mut outcomes = Vec::with_capacity(verdicts.len());
        for truth in &truths {
            outcomes.push(answers.next_if(|(frame, _)| *frame == truth.frame).map(|(_, outcome)| outcome));
            telemetry.push(rows.next_if(|row| row.frame == truth.frame).ok_or_else(|| {
                Failure::Usage(format!(
                    "{}: there is no row of frame {}, expected one for every frame of the truth",
                    directory.join("telemetry.csv").display(),
                    truth.frame
                ))
            })?);
        }
        if verdicts.is_empty() || score.frames != verdicts.len() as u64 || truths.len() != verdicts.len() {
            return Err(Failure::Usage(format!(
                "{}: `frames` is {}, expected the {} of truth/frames.parquet, at least 1",
                directory.join("score.json").display(),
                score.frames,
                truths.len()
            )));
        }
        Ok(Self { run_file, score, verdicts, truths, outcomes, telemetry, budget: Vec::new() })
    }

    /// Times of some frames, as the charts' axes take them.
    fn times(&self, rows: &[usize]) -> Vec<String> {
        rows.iter().map(|&row| time_word(&self.truths[row])).collect()
    }
}

/// Refuses a directory without the files of a run.
fn check_files(directory: &Path) -> Result<(), Failure> {
    let names =
        ["score.json", "measurements.csv", "telemetry.csv", "truth/frames.parquet", "truth/objects.parquet"];
    match names.into_iter().find(|name| !directory.join(name).is_file()) {
        Some(name) => Err(missing(directory, name)),
        None => Ok(()),
    }
}

/// A line through some rows of a run, in order, that breaks where another group begins: days are apart.
fn broken(run: &FarRangeRun, rows: impl Iterator<Item = (usize, f64)>) -> (Vec<String>, Vec<f64>) {
    let (mut times, mut values) = (Vec::new(), Vec::new());
    let mut last: Option<usize> = None;
    for (row, value) in rows {
        if last.is_some_and(|last| run.verdicts[last].group != run.verdicts[row].group) {
            times.push(time_word(&run.truths[row]));
            values.push(f64::NAN);
        }
        times.push(time_word(&run.truths[row]));
        values.push(value);
        last = Some(row);
    }
    (times, values)
}

/// The time of a frame to the second, for people.
fn shown_time(truth: &FrameTruth) -> String {
    time_word(truth).get(..19).unwrap_or_default().replace('T', " ")
}

/// The time of a frame to the millisecond, without the `Z` that the charting library has no use for.
fn time_word(truth: &FrameTruth) -> String {
    let text = format_utc(truth.time);
    let text = text.trim_end_matches('Z');
    text.get(..23).unwrap_or(text).to_owned()
}

/// The page of a far-range run; `sheet` renders its frames anew.
///
/// # Errors
/// A [`Failure`] when a frame cannot be drawn, or the truth is of no moment that there is.
pub fn far_range_page(run: &FarRangeRun, sheet: &FrameSheet) -> Result<Page, Failure> {
    let scenario = &run.run_file.scenario;
    let (first, last) = (&run.truths[0], &run.truths[run.truths.len() - 1]);
    let mut warnings = Vec::new();
    if let Some(stage) = run.run_file.inject {
        warnings.push(format!(
            "The truth was injected for {stage}: this is no result of the pipeline, but of all its other stages."
        ));
    }
    let fact = |name, value: String| (name, value);
    let shown = |name: &str| run.score.figures.get(name).map_or_else(String::new, shown_percent);
    let lead = format!(
        "{} frames: the target was found in {} of them, {} of them rightly and {} wrongly.",
        run.score.frames,
        shown("hit_rate"),
        shown("correct_rate"),
        shown("wrong_rate")
    );
    let mut sections = vec![
        figures_section(run),
        track(run),
        errors(run),
        regions(run, sheet)?,
        stars(run),
        mounting(run),
        aberration(run)?,
        causes(run),
        budget(run),
        frames(run, sheet)?,
    ];
    sections.retain(|section| !section.blocks.is_empty());
    Ok(Page {
        title: scenario.title.clone(),
        kind: "Far range: a run",
        version: run.run_file.version.clone(),
        lead: vec![lead],
        warnings,
        facts: vec![
            fact("Scenario", run.run_file.name.clone()),
            fact("Seed", scenario.seed.to_string()),
            fact("Frames", format!("{} to {}", first.frame, last.frame)),
            fact("From (UTC)", shown_time(first)),
            fact("To (UTC)", shown_time(last)),
            fact("Range", format!("{:.2} to {:.2} km", first.range_km, last.range_km)),
            fact("Camera", format!("{} × {} px", scenario.camera.columns, scenario.camera.rows)),
            fact("Boresight", run.run_file.version.clone()),
        ],
        sections,
        data: serde_json::json!({ "score": run.score }),
    })
}

/// Table 2, beside the paper's where the frames are those of the paper, and all figures.
fn figures_section(run: &FarRangeRun) -> Section {
    let score = &run.score;
    let published = is_argon(&run.run_file.scenario).then_some(&ARGON_TABLE_2);
    let groups: Vec<&String> = score.groups.keys().collect();
    let is_whole = published.is_some_and(|table| score.frames == u64::from(table.images[5]));
    let mut head = vec![String::new()];
    head.extend(groups.iter().map(|group| (*group).clone()));
    head.push("all".to_owned());
    let mut table = DataTable::new(head).caption(
        "Percent, with 95 % intervals; rates of the errors are of the frames with a detected target.",
    );
    let columns = || {
        score
            .groups
            .values()
            .map(|group| (group.frames, &group.figures))
            .chain([(score.frames, &score.figures)])
    };
    let row = |name: &str, cells: Vec<String>| [name.to_owned()].into_iter().chain(cells).collect::<Vec<_>>();
    table.push(row("images", columns().map(|(frames, _)| frames.to_string()).collect()));
    let labels =
        ["hit rate", "RA error < 0.024°", "RA error < 0.048°", "Dec error < 0.024°", "Dec error < 0.048°"];
    for ((name, rates), label) in ARGON_TABLE_2.rates().into_iter().zip(labels) {
        let ours = columns().map(|(_, figures)| percent_cell(figures.get(name)));
        table.push(row(label, ours.collect()));
        if published.is_some() {
            // A group is the paper's day of the same name; all is the paper's only where every frame was flown.
            let day = |group: &&String| {
                let number = group.strip_prefix("day ").and_then(|number| number.parse::<usize>().ok());
                number.filter(|number| (1..=5).contains(number)).map(|number| rates[number - 1])
            };
            let cells = groups.iter().map(day).chain([is_whole.then_some(rates[5])]);
            let cells = cells.map(|rate| rate.map_or_else(|| "–".to_owned(), |rate| format!("{rate:.2}")));
            table.push(row("— published", cells.collect()));
        }
    }
    let title = if published.is_some() { "Table 2, beside the published one" } else { "Table 2" };
    let mut section = Section::new("table-2", title);
    if published.is_some() {
        section = section.text(
            "Published: Benninghoff, Tzschichholz, Boge and Gaias, the ARGON experiment of PRISMA, 23–27 April 2012, their Table 2; its figures are of whole days.",
        );
    }
    if let Some(distance) = published.and_then(|table| table.distance(score)) {
        section = section.text(format!(
            "The 30 cells differ from the published ones by {:.1} points in the mean, {:.1} at worst.",
            distance.mean_points, distance.worst_points
        ));
    }
    section.table(table).folded("All figures", figure_table(&score.figures))
}

/// Fig. 3: the target in the image.
fn track(run: &FarRangeRun) -> Section {
    let camera = &run.run_file.scenario.camera;
    let at = |row: usize| run.truths[row].target_position.map_or([f64::NAN; 2], |p| [p.x, p.y]);
    let answer = |row: usize| {
        let measured = run.outcomes[row].as_ref().and_then(Outcome::measurement);
        measured.map_or([f64::NAN; 2], |m| [m.position.x, m.position.y])
    };
    let count = run.truths.len();
    let is = |row: usize, code: &str| run.verdicts[row].verdict.code() == code;
    let xy = |rows: &[usize], of: &dyn Fn(usize) -> [f64; 2]| -> (Vec<f64>, Vec<f64>) {
        rows.iter().map(|&row| of(row)).map(|[x, y]| (rounded(x, 2), rounded(y, 2))).unzip()
    };
    let true_rows = thinned(count, &[&|row| at(row)[0], &|row| at(row)[1]]);
    let right: Vec<usize> = (0..count).filter(|&row| is(row, "correct")).collect();
    let right: Vec<usize> = thinned(right.len(), &[&|i| answer(right[i])[0], &|i| answer(right[i])[1]])
        .into_iter()
        .map(|i| right[i])
        .collect();
    let wrong: Vec<usize> = (0..count).filter(|&row| is(row, "wrong")).collect();
    let wrong: Vec<usize> = thinned(wrong.len(), &[&|i| answer(wrong[i])[0], &|i| answer(wrong[i])[1]])
        .into_iter()
        .map(|i| wrong[i])
        .collect();
    let (tx, ty) = xy(&true_rows, &at);
    let (rx, ry) = xy(&right, &answer);
    let (wx, wy) = xy(&wrong, &answer);
    let numbered = |rows: &[usize]| rows.iter().map(|&row| run.truths[row].frame).collect::<Vec<_>>();
    let hover = "frame %{customdata}<br>x %{x} px, y %{y} px";
    let traces: Vec<Box<dyn Trace>> = vec![
        points("true", tx, ty, REFERENCE)
            .custom_data(numbered(&true_rows))
            .hover_template(hover)
            .opacity(0.5),
        points("measured, right", rx, ry, MEASURED).custom_data(numbered(&right)).hover_template(hover),
        crosses("measured, wrong", wx, wy, WRONG).custom_data(numbered(&wrong)).hover_template(hover),
    ];
    let (columns, rows) = (camera.columns as f64, camera.rows as f64);
    let layout = Layout::new()
        .x_axis(
            Axis::new()
                .title("x, px (columns)")
                .range(vec![-0.5, columns - 0.5])
                .constrain(AxisConstrain::Domain),
        )
        .y_axis(
            Axis::new()
                .title("y, px (rows, downwards)")
                .range(AxisRange::from(vec![rows - 0.5, -0.5]))
                .scale_anchor("x")
                .constrain(AxisConstrain::Domain),
        );
    let data = by_bins(run, &[("true x, px", &|row| at(row)[0], 1), ("true y, px", &|row| at(row)[1], 1)]);
    Section::new("fig-3", "Fig. 3: track of the target in pixels").chart(Chart::new(
        format!("Where the target is and where it was measured, whole detector. {}", thinning(count)),
        620,
        data,
        traces,
        layout,
    ))
}

/// What is told of a chart of so many frames.
fn thinning(count: usize) -> String {
    if thinned(count, &[&|row| row as f64]).len() < count {
        format!(
            "Of {count} frames so many are drawn as a screen can show, extremes always among them; measurements.csv and \
             truth/frames.parquet have every frame."
        )
    } else {
        "Every frame is drawn.".to_owned()
    }
}

/// A column of a table behind a chart: its name, its value in a row, and decimals.
type BinColumn<'a> = (&'a str, &'a dyn Fn(usize) -> f64, usize);

/// A summary of long series, stretch by stretch: number, smallest, mean and largest of each.
fn by_bins(run: &FarRangeRun, columns: &[BinColumn<'_>]) -> DataTable {
    let mut head = vec!["from (UTC)".to_owned(), "frames".to_owned()];
    for (name, _, _) in columns {
        head.extend(["number", "smallest", "mean", "largest"].map(|what| format!("{name}: {what}")));
    }
    let mut table = DataTable::new(head).caption(
        "A line is a stretch of frames; measurements.csv and truth/frames.parquet have every frame.",
    );
    for bin in bins(run.truths.len(), TABLE_BINS) {
        let first = &run.truths[bin.start];
        let mut cells = vec![shown_time(first), format!("{}–{}", first.frame, run.truths[bin.end - 1].frame)];
        for (_, value, decimals) in columns {
            cells.extend(summary(bin.clone().map(value), *decimals));
        }
        table.push(cells);
    }
    table
}

/// Fig. 5: errors over time.
fn errors(run: &FarRangeRun) -> Section {
    let component = |row: usize, index: usize| {
        let error = run.verdicts[row].verdict.error();
        error.map_or(f64::NAN, |error| [error.ra, error.dec][index].degrees())
    };
    let rows_of = |is_wrong: bool| -> Vec<usize> {
        (0..run.verdicts.len())
            .filter(|&row| match run.verdicts[row].verdict {
                Verdict::Correct { .. } => !is_wrong,
                Verdict::Wrong { .. } => is_wrong,
                Verdict::Missed { .. } => false,
            })
            .collect()
    };
    let (right, wrong) = (rows_of(false), rows_of(true));
    let largest = right.iter().flat_map(|&row| [component(row, 0).abs(), component(row, 1).abs()]);
    // Errors of wrong answers are those of another object: they would leave nothing to be seen of the others.
    let limit = (1.15 * largest.fold(0.0, f64::max)).max(0.06);
    let ends = [time_word(&run.truths[0]), time_word(&run.truths[run.truths.len() - 1])];
    let panel = |index: usize, title: &str| {
        let mut traces = Vec::new();
        for (name, rows, colour) in [("right", &right, MEASURED), ("wrong", &wrong, WRONG)] {
            let kept = thinned(rows.len(), &[&|i| component(rows[i], index)]);
            let rows: Vec<usize> = kept.into_iter().map(|i| rows[i]).collect();
            let y = rows.iter().map(|&row| rounded(component(row, index), 5)).collect();
            let frames: Vec<u64> = rows.iter().map(|&row| run.truths[row].frame).collect();
            let trace = if name == "right" {
                points(name, run.times(&rows), y, colour)
            } else {
                crosses(name, run.times(&rows), y, colour)
            };
            traces.push(trace.custom_data(frames).hover_template("frame %{customdata}<br>%{x}<br>%{y}°"));
        }
        for (name, at) in [("0.024° (1 px)", 0.024), ("−0.024°", -0.024)] {
            let limit = dashed(name, ends.to_vec(), vec![at; 2], BESIDE);
            traces.push(if at > 0.0 { limit } else { limit.show_legend(false) });
        }
        Panel { range: Some([-limit, limit]), ..Panel::new(title, traces) }
    };
    let (traces, layout) = stacked("time, UTC", vec![panel(0, "RA error, °"), panel(1, "Dec error, °")]);
    let right_only = |row: usize, index: usize| match run.verdicts[row].verdict {
        Verdict::Correct { .. } => component(row, index),
        _ => f64::NAN,
    };
    let data = by_bins(
        run,
        &[
            ("RA error of the right, °", &|row| right_only(row, 0), 4),
            ("Dec error of the right, °", &|row| right_only(row, 1), 4),
        ],
    );
    Section::new("fig-5", "Fig. 5: errors of right ascension and declination").chart(Chart::new(
        format!(
            "Angles of the line of sight in the camera system, measured minus true: RA across columns, Dec across rows. The axes \
             fit the right answers; wrong ones beyond them are seen by zooming out (double click). {}",
            thinning(run.truths.len())
        ),
        560,
        data,
        traces,
        layout,
    ))
}

/// Fig. 6: a whole and a truncated region.
fn regions(run: &FarRangeRun, sheet: &FrameSheet) -> Result<Section, Failure> {
    let section = Section::new("fig-6", "Fig. 6: a whole and a truncated region of interest");
    if run.run_file.scenario.roi.is_none() {
        return Ok(section.text("The camera of this scenario sends whole images: nothing is cut."));
    }
    let dec = |row: usize| match run.verdicts[row].verdict {
        Verdict::Correct { error } => Some(error.dec.degrees().abs()),
        _ => None,
    };
    let mut by_error: Vec<usize> = (0..run.verdicts.len()).filter(|&row| dec(row).is_some()).collect();
    by_error
        .sort_by(|&a, &b| dec(b).partial_cmp(&dec(a)).unwrap_or(std::cmp::Ordering::Equal).then(a.cmp(&b)));
    let truncated = sheet.first_region(run, by_error.iter().copied().take(12), |cut| cut > 0.05)?;
    // The nearest of some ranges from near to far: there the image is as large as that of the other.
    let mut near: Vec<usize> =
        by_error.iter().copied().filter(|&row| dec(row).is_some_and(|error| error < 0.012)).collect();
    near.sort_by(|&a, &b| run.truths[a].range_km.total_cmp(&run.truths[b].range_km).then(a.cmp(&b)));
    let step = near.len().div_ceil(30).max(1);
    let whole = sheet.first_region(run, near.into_iter().step_by(step), |cut| cut < 0.02)?;
    let note = match (&whole, &truncated) {
        (Some(_), Some(_)) => {
            "Left whole, right truncated: the camera keeps regions of a fixed size, and of a target larger than one the rest is lost."
        }
        (Some(_), None) => "No target of this run was cut by its region.",
        (None, Some(_)) => "No target of this run was found whole in its region.",
        (None, None) => "No frame of this run shows a region with the target alone.",
    };
    let pictures: Vec<_> = whole.into_iter().chain(truncated).collect();
    let section = section.text(note);
    Ok(if pictures.is_empty() { section } else { section.pictures(pictures) })
}

/// Fig. 7: stars per image.
fn stars(run: &FarRangeRun) -> Section {
    let count = run.verdicts.len();
    let number = |row: usize| run.verdicts[row].n_stars.map_or(f64::NAN, f64::from);
    let told: Vec<usize> = (0..count).filter(|&row| number(row).is_finite()).collect();
    let section = Section::new("fig-7", "Fig. 7: stars identified in each image");
    if told.is_empty() {
        return section.text("The pipeline does not tell how many stars it identified.");
    }
    let rows: Vec<usize> =
        thinned(told.len(), &[&|i| number(told[i])]).into_iter().map(|i| told[i]).collect();
    let mut sum = 0.0;
    let mut means = Vec::with_capacity(told.len());
    for (place, &row) in told.iter().enumerate() {
        sum += number(row);
        if place >= MEAN_OF {
            sum -= number(told[place - MEAN_OF]);
        }
        means.push(sum / MEAN_OF.min(place + 1) as f64);
    }
    let mean_rows = thinned(told.len(), &[&|i| means[i]]);
    let (mean_times, mean_values) =
        broken(run, mean_rows.into_iter().map(|i| (told[i], rounded(means[i], 2))));
    let least = run.run_file.scenario.far_range.attitude.min_stars;
    let ends = vec![time_word(&run.truths[0]), time_word(&run.truths[count - 1])];
    let frames: Vec<u64> = rows.iter().map(|&row| run.truths[row].frame).collect();
    let traces: Vec<Box<dyn Trace>> = vec![
        points("stars", run.times(&rows), rows.iter().map(|&row| number(row)).collect(), MEASURED)
            .opacity(0.5)
            .custom_data(frames)
            .hover_template("frame %{customdata}<br>%{x}<br>%{y} stars"),
        line("mean of the last 100 images", mean_times, mean_values, BESIDE),
        dashed("least for an attitude", ends, vec![f64::from(least); 2], REFERENCE),
    ];
    let data = by_bins(run, &[("stars", &number, 1)]);
    section.chart(Chart::new(
        format!("The mean is over the last {MEAN_OF} images. {}", thinning(count)),
        380,
        data,
        traces,
        axes("time, UTC", "stars"),
    ))
}

/// Fig. 8: the camera's attitude with respect to the chaser.
fn mounting(run: &FarRangeRun) -> Section {
    let count = run.truths.len();
    let degrees = |rotation: Rotation<contract::CameraFrame, contract::Body>| {
        let (phi, theta, psi) = rotation.euler_123();
        [phi.degrees(), theta.degrees(), psi.degrees()]
    };
    let measured: Vec<[f64; 3]> = (0..count)
        .map(|row| {
            let camera = run.outcomes[row].as_ref().and_then(|outcome| outcome.camera_from_icrs);
            camera.map_or([f64::NAN; 3], |camera| {
                degrees(camera * run.telemetry[row].telemetry.body_from_icrs.inverse())
            })
        })
        .collect();
    let section = Section::new("fig-8", "Fig. 8: attitude of the camera with respect to the chaser");
    let told: Vec<usize> = (0..count).filter(|&row| measured[row][0].is_finite()).collect();
    if told.is_empty() {
        return section.text("The pipeline does not tell the camera's attitude.");
    }
    let truth =
        |row: usize| degrees(run.truths[row].camera_from_icrs * run.truths[row].body_from_icrs.inverse());
    let every = thinned(count, &[]);
    let panels = ["φ, °", "θ, °", "ψ, °"].into_iter().enumerate().map(|(index, title)| {
        let rows: Vec<usize> =
            thinned(told.len(), &[&|i| measured[told[i]][index]]).into_iter().map(|i| told[i]).collect();
        let y = rows.iter().map(|&row| rounded(measured[row][index], 5)).collect();
        let (true_x, true_y) = broken(run, every.iter().map(|&row| (row, rounded(truth(row)[index], 5))));
        let traces =
            vec![points("measured", run.times(&rows), y, MEASURED), line("true", true_x, true_y, TRUTH)];
        Panel::new(title, traces)
    });
    let (traces, layout) = stacked("time, UTC", panels.collect());
    let data = by_bins(
        run,
        &[
            ("φ, °", &|row| measured[row][0], 4),
            ("θ, °", &|row| measured[row][1], 4),
            ("ψ, °", &|row| measured[row][2], 4),
        ],
    );
    section.chart(Chart::new(
        format!(
            "Euler angles 123 of the rotation from the chaser's body to the camera: the pipeline's attitude of the camera against \
             telemetry's of the body, so that the noise of both is in it. {}",
            thinning(count)
        ),
        600,
        data,
        traces,
        layout,
    ))
}

/// Fig. 9: the angles by which aberration is corrected.
fn aberration(run: &FarRangeRun) -> Result<Section, Failure> {
    let count = run.truths.len();
    // A smooth function of time: a point in a few is enough.
    let rows = thinned(count, &[]);
    let mut angles = Vec::with_capacity(rows.len());
    for &row in &rows {
        let truth = &run.truths[row];
        let observer = Observer::new(truth.time, truth.position_km, truth.velocity_km_s)?;
        let bore = truth.camera_from_icrs.inverse() * contract::Direction::z();
        let correction = observer.barycentric_velocity_km_s().cross(bore.vector()) / LIGHT_KM_S;
        let in_camera = truth.camera_from_icrs.rotate(&correction);
        angles.push([in_camera.x.to_degrees(), in_camera.y.to_degrees(), correction.norm().to_degrees()]);
    }
    let times = run.times(&rows);
    let component = |name: &str, index: usize, colour| -> Box<dyn Trace> {
        let values = rows.iter().zip(&angles).map(|(&row, angle)| (row, rounded(angle[index], 6)));
        let (x, y) = broken(run, values);
        line(name, x, y, colour)
    };
    let traces = vec![
        component("about x", 0, MEASURED),
        component("about y", 1, BESIDE),
        component("whole", 2, REFERENCE),
    ];
    let mut data = DataTable::new(["time (UTC)", "about x, °", "about y, °", "whole, °"]);
    for bin in bins(rows.len(), TABLE_BINS) {
        let angle = angles[bin.start];
        data.push([
            times[bin.start].replace('T', " "),
            format!("{:.6}", angle[0]),
            format!("{:.6}", angle[1]),
            format!("{:.6}", angle[2]),
        ]);
    }
    Ok(Section::new("fig-9", "Fig. 9: angles of the correction of aberration").chart(Chart::new(
        "The correction of Eqs. 20 to 24 about the camera's axes, of the true velocity about the Sun: along the orbit it swings \
         with the chaser's own velocity about the Earth's.",
        340,
        data,
        traces,
        axes("time, UTC", "angle, °"),
    )))
}

/// Misses and wrong answers by cause.
fn causes(run: &FarRangeRun) -> Section {
    let score = &run.score;
    let groups: Vec<&String> = score.groups.keys().collect();
    let mut section = Section::new("causes", "Causes of misses and of wrong answers");
    type Counts = fn(&crate::score::GroupScore) -> &IndexMap<String, u64>;
    let kinds: [(&str, &IndexMap<String, u64>, Counts); 2] = [
        ("Misses", &score.misses, |group| &group.misses),
        ("Wrong answers", &score.wrong, |group| &group.wrong),
    ];
    for (title, all, of) in kinds {
        if all.is_empty() {
            section = section.text(format!("{title}: none."));
            continue;
        }
        let mut head = vec!["cause".to_owned()];
        head.extend(groups.iter().map(|group| (*group).clone()));
        head.push("all".to_owned());
        let mut data = DataTable::new(head);
        let mut traces: Vec<Box<dyn Trace>> = Vec::new();
        for (cause, total) in all {
            let counts: Vec<u64> =
                score.groups.values().map(|group| of(group).get(cause).copied().unwrap_or(0)).collect();
            let mut cells = vec![cause.clone()];
            cells.extend(counts.iter().map(u64::to_string));
            cells.push(total.to_string());
            data.push(cells);
            let percent = counts
                .iter()
                .zip(score.groups.values())
                .map(|(count, group)| rounded(100.0 * *count as f64 / group.frames.max(1) as f64, 3));
            let names = groups.iter().map(|group| (*group).clone()).collect();
            traces.push(bars(cause, names, percent.collect()).hover_template("%{x}: %{y} %"));
        }
        section = section.chart(Chart::new(
            format!("{title} by cause, percent of the frames of a group."),
            340,
            data,
            traces,
            stacked_bars("", "% of frames"),
        ));
    }
    section
}

/// A sheet of frames: every kind of miss and of wrong answer, and right ones to compare with.
fn frames(run: &FarRangeRun, sheet: &FrameSheet) -> Result<Section, Failure> {
    let mut chosen: Vec<usize> = Vec::new();
    let mut middle = |is: &dyn Fn(&Verdict) -> bool| {
        let rows: Vec<usize> =
            (0..run.verdicts.len()).filter(|&row| is(&run.verdicts[row].verdict)).collect();
        chosen.extend(rows.get(rows.len() / 2));
    };
    middle(&|verdict| matches!(verdict, Verdict::Correct { .. }));
    for of in Cause::ALL {
        middle(&|verdict| matches!(verdict, Verdict::Missed { cause } if *cause == of));
        middle(&|verdict| matches!(verdict, Verdict::Wrong { cause, .. } if *cause == of));
    }
    let section = Section::new("frames", "Frames").text(
        "A right answer, then of every kind of miss and of wrong answer the frame in the middle of all of that kind, rendered anew \
         from run.toml. Green circle: the target's true place; orange cross: the answer; blue: true stars that can be detected, \
         violet: planets, the Moon, hot pixels, tracks of particles; yellow: clusters, with what the pipeline took them for; dashed: \
         transmitted regions. Brightness is stretched in every picture by itself.",
    );
    Ok(match sheet.reason() {
        Some(reason) => section.text(format!("There are no pictures: {reason}")),
        None => section.pictures(sheet.pictures(run, &chosen)?),
    })
}
