//! Report of a far-range run: verdict, worst frames, figures by day, errors, causes, what the pipeline saw.

mod approach;
mod attitude;
mod budget;
mod camera_fit;
mod colours;
mod covariances;
mod error_budget;
mod frame_detail;
mod image;
mod likeness;
mod navigation;
mod run;
mod series;
mod sky_map;
mod thresholds;
mod verdict;
mod visibility;
mod worst_frames;

use std::path::{Path, PathBuf};

use indexmap::IndexMap;

pub use camera_fit::camera_fit_page;
pub use error_budget::{InjectedRun, kept_budget};
pub use frame_detail::FrameDetail;
pub use likeness::likeness_page;
pub use run::FarRangeRun;
pub use verdict::findings;
pub use visibility::{read_visibility, visibility_page};

use ::report::charts::chart::{Chart, axes, bars, bars_across, rounded, stacked_bars};
use ::report::charts::plotly::Trace;
use ::report::figures::words::display_name;
use ::report::figures::{figure_table, least_to_most, percent_cell, shown_percent};
use ::report::page::data_table::DataTable;
use ::report::page::picture::RenderedPictures;
use ::report::page::{Page, Section};
use ::report::verdict::Verdict;
use ::report::{BudgetPlan, BudgetReport, OtherReport, RunFiles, WorldReport};
use ::run::{AnyJudgement, WorldScenario as _};
use far_range::scoring::{ARGON_TABLE_2, AttitudeUsed, FarRangeJudgement, GroupScore, Score};
use far_range::{FarRangeMission, is_argon};
use files::{Checksums, Failure};
use scenario::Stage;
use score::{angle, attitude_note, warm_up_note};

use self::colours::colour_of;
use self::run::shown_time;

/// Labels of the published rates, in their order.
const RATE_LABELS: [&str; 5] =
    ["hit rate", "error across columns", "error across columns", "error across rows", "error across rows"];

/// Returns the report of visibility requirements.
pub(crate) fn visibility_report() -> OtherReport {
    OtherReport {
        file: "visibility.json",
        results: "`boresight visibility --out`",
        page: |directory| Ok(visibility_page(&read_visibility(directory)?)),
    }
}

/// Returns the report of the world's runs.
pub(crate) fn world_report() -> WorldReport {
    WorldReport {
        code: FarRangeMission::CODE,
        page,
        pictures,
        budget: Some(BudgetReport { plan, page: page_with_budget }),
    }
}

/// Returns the frames of a run and the stages of its pipeline whose result can be replaced by the truth.
fn plan(directory: &Path) -> Result<BudgetPlan, Failure> {
    let run = FarRangeRun::read(&RunFiles::of_directory(directory))?;
    if run.run_file.inject.is_some() {
        return Err(Failure::Usage(
            "--budget is all, which applies only to the report of a run without --inject".to_owned(),
        ));
    }
    let (Some(first), Some(last)) = (run.truths.first(), run.truths.last()) else {
        return Err(Failure::Usage(format!(
            "{}: the run has no frames, expected at least one",
            directory.display()
        )));
    };
    let has_regions = run.run_file.scenario.roi.is_some();
    // A camera without regions transmits whole images anyway.
    let can_be_replaced = |stage: &Stage| *stage != Stage::Roi || has_regions;
    let stages = Stage::ALL.into_iter().filter(can_be_replaced).collect();
    Ok(BudgetPlan { frames: first.frame..last.frame + 1, stages })
}

/// Returns the page of a run with its error budget; `budget` lists directories of runs on the same frames,
/// each with the truth in place of one stage's result.
fn page_with_budget(directory: &Path, budget: &[PathBuf]) -> Result<Page, Failure> {
    let files = RunFiles::of_directory(directory);
    let mut run = FarRangeRun::read(&files)?;
    run.budget = InjectedRun::read_all(budget, &run.run_file, &run.score)?;
    far_range_page(&run, &FrameDetail::open(&files)?)
}

/// Returns the page of a run with its stored error budget; if `scored` holds the verdicts, they are used, and
/// the page has no error budget.
fn page(files: &RunFiles, scored: Option<&mut dyn AnyJudgement>) -> Result<Page, Failure> {
    let run = match scored.and_then(|scored| scored.typed_mut::<FarRangeJudgement>()) {
        Some(scored) => FarRangeRun::with_verdicts(files, std::mem::take(&mut scored.verdicts))?,
        None => {
            let mut run = FarRangeRun::read(files)?;
            // An error budget is that of the run's own measurements.
            if files.score().is_some() {
                let budget = kept_budget(&files.directory);
                run.budget = InjectedRun::read_all(&budget, &run.run_file, &run.score)?;
            }
            Checksums::check(&files.directory, |_| true)?;
            run
        }
    };
    far_range_page(&run, &FrameDetail::open(files)?)
}

/// Returns pictures of the given frames of a run.
fn pictures(files: &RunFiles, frames: &[u64]) -> Result<RenderedPictures, Failure> {
    let run = FarRangeRun::read(files)?;
    let row = |frame: &u64| run.truths.binary_search_by_key(frame, |truth| truth.frame).ok();
    let sheet = FrameDetail::open(files)?;
    let pictures = sheet.pictures(&run, &frames.iter().filter_map(row).collect::<Vec<_>>())?;
    Ok((pictures, sheet.reason().map(str::to_owned)))
}

/// Returns the page of a far-range run; `sheet` renders its frames anew.
///
/// # Errors
/// A [`Failure`] when a frame cannot be drawn, or a time of the truth is invalid.
pub fn far_range_page(run: &FarRangeRun, sheet: &FrameDetail) -> Result<Page, Failure> {
    let scenario = &run.run_file.scenario;
    let (first, last) = (&run.truths[0], &run.truths[run.truths.len() - 1]);
    let mut warnings = Vec::new();
    if let Some(stage) = run.run_file.inject {
        warnings.push(format!(
            "The truth replaced {stage}: this is a result of the other stages, not of the whole pipeline."
        ));
    }
    let shown = |name: &str| run.score.figures.get(name).map_or_else(String::new, shown_percent);
    let lead = format!(
        "{} frames: the target was detected in {} of them, in {} correctly and in {} wrongly.",
        run.score.frames,
        shown("hit_rate"),
        shown("correct_rate"),
        shown("wrong_rate")
    );
    let sections = vec![
        worst_frames::frames(run, sheet)?,
        figures_section(run),
        series::errors(run),
        causes(run),
        covariances::covariances(&run.score),
        thresholds::thresholds(&run.score),
        budget::budget(run),
        image::track(run),
        image::sample(run, sheet)?,
        image::regions(run, sheet)?,
        series::stars(run),
        attitude::mounting(run),
        attitude::aberration(run)?,
        approach::relative_position(run)?,
        navigation::errors(run),
    ];
    Ok(Page {
        title: scenario.title.clone(),
        kind: "Far range: a run",
        version: run.run_file.version.clone(),
        lead: [lead]
            .into_iter()
            .chain(warm_up_note(run.score.warm_up_frames, "frames"))
            .chain(attitude_note(run.score.attitude.as_deref()))
            .collect(),
        warnings,
        verdict: Verdict::new(findings(&run.score)),
        facts: vec![
            ("Scenario", run.run_file.name.clone()),
            ("Seed", scenario.seed.to_string()),
            ("Frames", format!("{} to {}", first.frame, last.frame)),
            ("From (UTC)", shown_time(first)),
            ("To (UTC)", shown_time(last)),
            ("Range", least_to_most(run.truths.iter().map(|truth| truth.range_km), "km")),
            ("Camera", format!("{} × {} px", scenario.camera.columns, scenario.camera.rows)),
            ("Boresight", run.run_file.version.clone()),
        ],
        sections,
        names_paper: false,
        data: serde_json::json!({ "score": run.score }),
    })
}

/// Returns the figures by group, with the paper's values if the frames are those of the paper, and all
/// figures.
fn figures_section(run: &FarRangeRun) -> Section {
    let score = &run.score;
    let published = is_argon(&run.run_file.scenario).then_some(&ARGON_TABLE_2);
    let attitude = score.attitude.as_deref().filter(|attitude| *attitude != AttitudeUsed::Own.code());
    let attitude = attitude.map_or_else(String::new, |attitude| format!(" (attitude: {attitude})"));
    let groups: Vec<&String> = score.groups.keys().collect();
    let is_whole = published.is_some_and(|table| score.frames == u64::from(table.images[5]));
    let mut head = vec![String::new()];
    head.extend(groups.iter().map(|group| (*group).clone()));
    head.push("all".to_owned());
    let mut table = DataTable::new(head).caption(
        "Percent, with 95 % intervals. Errors of the direction in the camera system, as a rate of the frames \
             with a detected target.",
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
    for ((name, rates), label) in ARGON_TABLE_2.rates().into_iter().zip(RATE_LABELS) {
        let ours = columns().map(|(_, figures)| percent_cell(figures.get(name)));
        let limit = score.figures.get(name).and_then(|figure| figure.limit_deg);
        let label =
            limit.map_or_else(|| label.to_owned(), |limit| format!("{label} < {}{attitude}", angle(limit)));
        table.push(row(&label, ours.collect()));
        if published.is_some() {
            // A group corresponds to the paper's day of the same name; the column `all` corresponds to the
            // paper's only if every frame was processed.
            let day = |group: &&String| {
                let number = group.strip_prefix("day ").and_then(|number| number.parse::<usize>().ok());
                number.filter(|number| (1..=5).contains(number)).map(|number| rates[number - 1])
            };
            let cells = groups.iter().map(day).chain([is_whole.then_some(rates[5])]);
            let cells = cells.map(|rate| rate.map_or_else(|| "–".to_owned(), |rate| format!("{rate:.2}")));
            table.push(row("— published", cells.collect()));
        }
    }
    let title = match (published.is_some(), groups.len()) {
        (true, _) => "Figures by day, with published values",
        (false, 0 | 1) => "Figures",
        (false, _) => "Figures by group",
    };
    let mut section = Section::new("figures", title).in_paper("Table 2");
    if published.is_some() {
        section = section.text(
            "Published: Benninghoff, Tzschichholz, Boge and Gaias, the ARGON experiment of PRISMA, 23–27 \
             April 2012; the published figures are for whole days.",
        );
    }
    if let Some(distance) = published.and_then(|table| table.distance(score)) {
        section = section.text(format!(
            "The 30 cells differ from the published values by {:.1} points on average, {:.1} at most.",
            distance.mean_points, distance.worst_points
        ));
    }
    section.table(table).folded("All figures", figure_table(&score.figures))
}

/// Returns the section on misses and wrong measurements by cause.
fn causes(run: &FarRangeRun) -> Section {
    let score = &run.score;
    let section = Section::new("causes", "Causes of misses and of wrong measurements");
    let wrong = CauseChart { title: "Wrong measurements", all: &score.wrong, of_group: |group| &group.wrong };
    let missed = CauseChart { title: "Misses", all: &score.misses, of_group: |group| &group.misses };
    let occurring: Vec<CauseChart<'_>> =
        [wrong, missed].into_iter().filter(|chart| !chart.all.is_empty()).collect();
    if occurring.is_empty() {
        return section.absent("Every frame has a correct measurement.");
    }
    occurring.iter().fold(section, |section, chart| section.chart(chart.chart(score)))
}

/// Counts by cause, of all frames and of every group.
struct CauseChart<'a> {
    title: &'static str,
    all: &'a IndexMap<String, u64>,
    of_group: fn(&GroupScore) -> &IndexMap<String, u64>,
}

impl CauseChart<'_> {
    /// Returns the chart: bars by group, or by cause if there is only one group.
    fn chart(&self, score: &Score) -> Chart {
        if score.groups.len() > 1 { self.by_group(score) } else { self.by_cause(score.frames) }
    }

    /// Returns stacked bars, one per group.
    fn by_group(&self, score: &Score) -> Chart {
        let groups: Vec<String> = score.groups.keys().cloned().collect();
        let mut data =
            DataTable::new([vec!["cause".to_owned()], groups.clone(), vec!["all".to_owned()]].concat());
        let mut traces: Vec<Trace> = Vec::new();
        for (cause, total) in self.all {
            let mut cells = vec![display_name(cause)];
            let mut percent = Vec::new();
            for group in score.groups.values() {
                let count = (self.of_group)(group).get(cause).copied().unwrap_or(0);
                cells.push(count.to_string());
                percent.push(rounded(100.0 * count as f64 / group.frames.max(1) as f64, 3));
            }
            cells.push(total.to_string());
            data.push(cells);
            let bars = bars(&display_name(cause), &groups, percent, colour_of(cause));
            traces.push(bars.hover_template("%{x}: %{y} %"));
        }
        let caption = format!("{} by cause, percent of the frames in each group.", self.title);
        Chart::new(caption, 340, data, traces, stacked_bars("", "% of frames"))
    }

    /// Returns one bar per cause, the most frequent on top.
    fn by_cause(&self, frames: u64) -> Chart {
        let mut counts: Vec<(&String, u64)> = self.all.iter().map(|(cause, count)| (cause, *count)).collect();
        counts.sort_by_key(|(_, count)| *count);
        let mut data = DataTable::new(["cause", "frames", "% of all frames"]);
        for (cause, count) in counts.iter().rev() {
            let percent = format!("{:.2}", 100.0 * *count as f64 / frames.max(1) as f64);
            data.push([display_name(cause), count.to_string(), percent]);
        }
        let names: Vec<String> = counts.iter().map(|(cause, _)| display_name(cause)).collect();
        let numbers: Vec<f64> = counts.iter().map(|(_, count)| *count as f64).collect();
        let colours = counts.iter().map(|(cause, _)| colour_of(cause)).collect();
        let height = 110 + 34 * counts.len() as u32;
        let caption = format!("{} by cause, of {frames} frames.", self.title);
        Chart::new(caption, height, data, vec![bars_across(&names, numbers, colours)], axes("frames", ""))
    }
}
