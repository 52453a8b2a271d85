//! Report of a docking run: verdict, worst fields, figures by range, motion, errors against the truth.

mod colours;
mod field_detail;
mod field_errors;
mod motion;
mod run;
mod verdict;
mod worst_fields;

use indexmap::IndexMap;

pub use field_detail::FieldDetail;
pub use run::{DockingRun, PortionReport};
pub use verdict::findings;

use ::report::charts::chart::{BESIDE, Chart, MEASURED, bars, rounded, stacked_bars};
use ::report::charts::plotly::Trace;
use ::report::figures::words::display_name;
use ::report::figures::{cell, figure_table, least_to_most, percent_cell, shown_percent};
use ::report::page::data_table::DataTable;
use ::report::page::picture::RenderedPictures;
use ::report::page::{Page, Section};
use ::report::verdict::Verdict;
use ::report::verdict::rules::honesty_words;
use ::report::{RunFiles, WorldReport};
use ::run::{AnyJudgement, WorldScenario as _};
use docking::DockingMission;
use docking::scoring::{DockingGroup, DockingScore};
use files::{Checksums, Failure};
use score::{Figure, UnitVerdict, warm_up_note};

use self::colours::colour_of;

/// Returns the report of the world's runs.
pub(crate) fn world_report() -> WorldReport {
    WorldReport { code: DockingMission::CODE, page, pictures, budget: None }
}

/// Reads the files of a run and returns its page.
fn page(files: &RunFiles, _: Option<&mut dyn AnyJudgement>) -> Result<Page, Failure> {
    let page = docking_page(&DockingRun::read(files)?, &FieldDetail::open(files)?)?;
    Checksums::check(&files.directory, |_| true)?;
    Ok(page)
}

/// Returns pictures of the given fields of a run.
fn pictures(files: &RunFiles, fields: &[u64]) -> Result<RenderedPictures, Failure> {
    let run = DockingRun::read(files)?;
    let row = |field: &u64| run.truths.binary_search_by_key(field, |truth| truth.field).ok();
    let sheet = FieldDetail::open(files)?;
    let pictures = sheet.pictures(&run, &fields.iter().filter_map(row).collect::<Vec<_>>())?;
    Ok((pictures, sheet.reason().map(str::to_owned)))
}

/// Returns the page of a docking run; `sheet` draws its fields anew.
///
/// # Errors
/// A [`Failure`] when a field cannot be drawn.
pub fn docking_page(run: &DockingRun, sheet: &FieldDetail) -> Result<Page, Failure> {
    let (first, last) = (&run.truths[0], &run.truths[run.truths.len() - 1]);
    let scenario = &run.run_file.scenario;
    let figure = |name: &str| run.score.figures.get(name).map_or_else(String::new, shown_percent);
    let mut sections = vec![worst_fields::fields(run, sheet)?, figures_section(run), verdicts(run)];
    sections.extend(motion::sections(run));
    sections.push(field_errors::field_errors(run));
    sections.push(fields(run, sheet)?);
    Ok(Page {
        title: scenario.title.clone(),
        kind: "Docking: a run",
        version: run.run_file.version.clone(),
        lead: vec![format!(
            "{} fields: the pose was measured in {} of the fields in which it can be required; of all \
             fields, {} were doubtful by the pipeline's own tests, and {} were grossly wrong but not \
             doubtful.",
            run.score.frames,
            figure("success_rate"),
            figure("doubtful_rate"),
            figure("wrong_rate")
        )]
        .into_iter()
        .chain(warm_up_note(run.score.warm_up_frames, "fields"))
        .collect(),
        warnings: Vec::new(),
        verdict: Verdict::new(findings(&run.score)),
        facts: vec![
            ("Scenario", run.run_file.name.clone()),
            ("Seed", scenario.seed.to_string()),
            ("Fields", format!("{} to {}", first.field, last.field)),
            ("Time", format!("{:.2} to {:.2} s", first.time_s, last.time_s)),
            ("Range", least_to_most(run.truths.iter().map(|truth| truth.range_m), "m")),
            ("Reports of motion", run.score.portions.to_string()),
            ("Renderer", run.score.renderer.clone()),
            ("Boresight", run.run_file.version.clone()),
        ],
        sections,
        names_paper: false,
        data: serde_json::json!({ "score": run.score }),
    })
}

/// Returns the tables of figures by range: accuracy, consistency of σ, rates of doubtful and wrong fields,
/// and rates of measured fields; then all figures.
fn figures_section(run: &DockingRun) -> Section {
    let score = &run.score;
    let groups = || {
        let groups = score
            .groups
            .iter()
            .map(|(name, group)| (name.as_str(), group.frames, group.portions, &group.figures));
        groups.chain([("all", score.frames, score.portions, &score.figures)])
    };
    let rms = ["range_rms_m", "lateral_rms_m", "attitude_rms_deg", "motion_range_rate_rms_m_s"];
    let mut accuracy = DataTable::new([
        "range",
        "range error, m",
        "across, m",
        "attitude, °",
        "range rate, m/s",
        "doubtful",
        "wrong",
    ])
    .caption(
        "RMS errors of measured fields and of the reported range rate; doubtful and grossly wrong poses in \
         percent of the fields, with 95 % intervals; by true range and lens.",
    );
    for (name, _, _, figures) in groups() {
        let number = |key: &str| cell(figures.get(key).and_then(|figure| figure.value));
        let percent = |key: &str| percent_cell(figures.get(key));
        let mut cells = vec![name.to_owned()];
        cells.extend(rms.map(number));
        cells.extend(["doubtful_rate", "wrong_rate"].map(percent));
        accuracy.push(cells);
    }
    let mut answers =
        DataTable::new(["range", "fields", "reports", "success", "of clear ones", "range only", "missed"])
            .caption("Percent, with 95 % intervals, by true range and lens.");
    for (name, frames, portions, figures) in groups() {
        let mut cells = vec![name.to_owned(), frames.to_string(), portions.to_string()];
        let rates = ["success_rate", "clear_success_rate", "range_only_rate", "miss_rate"];
        cells.extend(rates.map(|rate| percent_cell(figures.get(rate))));
        answers.push(cells);
    }
    Section::new("figures", "Figures")
        .table(accuracy)
        .table(honesty(score))
        .table(answers)
        .folded("All figures", figure_table(&score.figures))
}

/// Returns the table of the consistency of σ by range and lens, in numbers and in words.
fn honesty(score: &DockingScore) -> DataTable {
    let head = [
        "range",
        "within 3 σ",
        "NEES",
        "σ of fields is",
        "motion within 3 σ",
        "motion NEES",
        "σ of the motion is",
    ];
    let mut table = DataTable::new(head).narrow().caption(
        "Consistency of σ: percent of errors within 3 σ, with 95 % intervals (99.73 for normal errors), and NEES \
         (mean 1 if σ is correct).",
    );
    let groups = score.groups.iter().map(|(name, group)| (name.as_str(), &group.figures));
    for (name, figures) in groups.chain([("all", &score.figures)]) {
        let mut cells = vec![name.to_owned()];
        for (within, nees) in [("within_3_sigma", "nees_mean"), ("motion_within_3_sigma", "motion_nees_mean")]
        {
            let value = figures.get(nees).and_then(|figure| figure.value);
            let words = value.map_or_else(|| "–".to_owned(), honesty_words);
            cells.extend([percent_cell(figures.get(within)), cell(value), words]);
        }
        table.push(cells);
    }
    table
}

/// Returns the chart of the verdicts on the fields, by range.
fn verdicts(run: &DockingRun) -> Section {
    let score = &run.score;
    let groups: Vec<String> = score.groups.keys().cloned().collect();
    let mut data = DataTable::new(
        ["what", "cause"]
            .map(str::to_owned)
            .into_iter()
            .chain(groups.iter().cloned())
            .chain(["all".to_owned()]),
    );
    let mut traces: Vec<Trace> = Vec::new();
    let mut add = |what: &str, cause: &str, counts: Vec<u64>, all: u64| {
        if all == 0 {
            return;
        }
        let mut cells = vec![what.to_owned(), display_name(cause)];
        cells.extend(counts.iter().map(u64::to_string));
        cells.push(all.to_string());
        data.push(cells);
        let frames = score.groups.values().map(|group| group.frames.max(1) as f64);
        let percent = counts.iter().zip(frames).map(|(count, of)| rounded(100.0 * *count as f64 / of, 3));
        let name =
            if cause.is_empty() { what.to_owned() } else { format!("{what}: {}", display_name(cause)) };
        let colour = match what {
            "success" => MEASURED,
            "range only" => BESIDE,
            _ => colour_of(cause),
        };
        let bars = bars(&name, &groups, percent.collect(), colour);
        traces.push(bars.hover_template("%{x}: %{y} %"));
    };
    let counted = |of: &dyn Fn(&DockingGroup) -> u64| score.groups.values().map(of).collect::<Vec<u64>>();
    for name in ["success_rate", "range_only_rate"] {
        let count = |figures: &IndexMap<String, Figure>| figures.get(name).map_or(0, |figure| figure.count);
        let what = if name == "success_rate" { "success" } else { "range only" };
        add(what, "", counted(&|group| count(&group.figures)), count(&score.figures));
    }
    for (test, all) in &score.doubtful {
        add("doubtful", test, counted(&|group| group.doubtful.get(test).copied().unwrap_or(0)), *all);
    }
    for (cause, all) in &score.wrong {
        add("wrong", cause, counted(&|group| group.wrong.get(cause).copied().unwrap_or(0)), *all);
    }
    for (cause, all) in &score.misses {
        add("missed", cause, counted(&|group| group.misses.get(cause).copied().unwrap_or(0)), *all);
    }
    let section = Section::new("verdicts", "Outcomes of the fields");
    if traces.is_empty() {
        return section.absent("The run has no field outside its warm-up.");
    }
    section.chart(Chart::new(
        "Percent of the fields at each range and lens.",
        420,
        data,
        traces,
        stacked_bars("", "% of fields"),
    ))
}

/// Returns pictures of typical fields: successes of every range, and a field with a range only.
fn fields(run: &DockingRun, sheet: &FieldDetail) -> Result<Section, Failure> {
    let mut chosen: Vec<usize> = Vec::new();
    let mut evenly = |count: usize, is: &dyn Fn(&UnitVerdict) -> bool| {
        let rows: Vec<usize> = (0..run.verdicts.len()).filter(|&row| is(&run.verdicts[row])).collect();
        let count = count.min(rows.len());
        chosen.extend((0..count).map(|k| rows[(2 * k + 1) * rows.len() / (2 * count)]));
    };
    // An approach through few ranges shows more successes of each.
    let successes = if run.score.groups.len() <= 3 { 3 } else { 1 };
    for group in run.score.groups.keys() {
        evenly(successes, &|unit| unit.verdict == "success" && unit.group == *group);
    }
    evenly(1, &|unit| unit.verdict == "range_only");
    let section = Section::new("fields", "Typical fields of every range");
    if let Some(reason) = sheet.reason() {
        return Ok(section.absent(format!("The fields cannot be rendered again: {reason}")));
    }
    if chosen.is_empty() {
        return Ok(section.absent("No field has a measured pose or range."));
    }
    let text = format!(
        "Measured fields, rendered again from `run.toml`. {}{}",
        worst_fields::KEY,
        renderer_note(run)
    );
    Ok(section.text(text).pictures(sheet.pictures(run, &chosen)?))
}

/// Returns the sentence on the renderer of the pictures, with a space before it; empty if it is the run's.
fn renderer_note(run: &DockingRun) -> String {
    match run.score.renderer.as_str() {
        "fast" => String::new(),
        other => format!(
            " The run used {other}; these pictures are from the fast renderer: the same scene with other shading."
        ),
    }
}
