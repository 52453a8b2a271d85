//! Report of a study: figures with intervals, their sensitivities, the worst cases.

mod verdict;

use std::collections::BTreeSet;
use std::path::Path;

use files::{Failure, FileError};
use indexmap::IndexMap;
use run::figure_by_name;
use score::{Better, attitude_note, warm_up_note};
use study::{CaseTable, Estimate, FigureSummary, StoppingStatus, Summary};

use crate::charts::chart::{
    BESIDE, Chart, MEASURED, REFERENCE, TRUTH, WRONG, axes, cloud, intervals, intervals_across, plain,
    points, rounded,
};
use crate::charts::plotly::{Axis, ColourScale, Layout, Mode, Trace};
use crate::charts::thinning::{bins, summary as summed, thinning_caption};
use crate::figures::significant;
use crate::figures::words::{capital, display_name, setting_name};
use crate::page::data_table::DataTable;
use crate::page::{Page, Section};
use crate::read::read_json;
use crate::verdict::Verdict;

/// Upper limit on the number of rows of the tables behind the charts. Each row summarises the cases in a
/// range of the drawn value; cases.parquet has every case.
const TABLE_BINS: usize = 12;
/// Maximum number of drawn values with a separate chart.
const MAX_SCATTERS: usize = 24;
/// Maximum number of figures with a curve over the sweep.
const MAX_CURVES: usize = 24;
/// Colours of the curves of a figure, used in turn.
const CURVES: [&str; 5] = [MEASURED, BESIDE, TRUTH, WRONG, REFERENCE];

/// Results of a study, read from its directory.
pub struct StudyResult {
    /// Content of `summary.json`.
    pub summary: Summary,
    /// Content of `cases.parquet`; the only figure kept is the one that ranks the worst cases.
    pub table: CaseTable,
}

impl StudyResult {
    /// Reads the directory of a study.
    ///
    /// # Errors
    /// A [`Failure`] that names the file which is missing or cannot be read.
    pub fn read(directory: &Path) -> Result<Self, Failure> {
        let summary: Summary = read_json(&directory.join("summary.json"), "study summary")?;
        let path = directory.join("cases.parquet");
        if !path.is_file() {
            return Err(Failure::Usage(format!(
                "{}: is missing beside summary.json; `boresight study merge` writes both",
                path.display()
            )));
        }
        let mut columns = CaseTable::columns_of(&path)?;
        // The charts show only one figure case by case.
        columns.figures.retain(|figure| *figure == summary.worst_by);
        columns.causes.clear();
        let (table, _) = columns.read(&path)?;
        if table.rows.len() as u64 != summary.cases {
            let reason = format!("it has {} rows, summary.json {} cases", table.rows.len(), summary.cases);
            return Err(FileError::format(&path, "cases", reason).into());
        }
        Ok(Self { summary, table })
    }
}

/// Returns the page of a study.
pub fn study_page(study: &StudyResult) -> Page {
    let summary = &study.summary;
    let worst_by = &summary.worst_by;
    let by = figure_by_name(worst_by).words;
    let lead = match summary.figures.get(worst_by).and_then(|figure| figure.all) {
        Some(all) => format!(
            "{} cases; {by}, the figure that ranks the cases, is {}.",
            summary.cases,
            estimate_text(worst_by, &all)
        ),
        None => format!("{} cases.", summary.cases),
    };
    let mut sections = vec![worst(study), figures(study)];
    if !summary.requirements.is_empty() {
        sections.insert(0, requirements(summary));
    }
    if !summary.causes.is_empty() {
        sections.push(causes(summary));
    }
    if !summary.sweep.is_empty() {
        sections.push(sweep(study));
    }
    sections.push(sensitivities(study));
    if !summary.indices.is_empty() {
        sections.push(indices(study));
    }
    sections.push(scatter(study));
    sections.push(settings(study));
    Page {
        title: if summary.title.is_empty() {
            format!("Study {}", summary.study)
        } else {
            summary.title.clone()
        },
        kind: "Study",
        version: summary.version.clone(),
        lead: [lead]
            .into_iter()
            .chain(warm_up_note(summary.warm_up_frames, "frames of every case"))
            .chain(attitude_note(summary.attitude.as_deref()))
            .collect(),
        warnings: summary.notes(),
        verdict: Verdict::new(verdict::findings(summary)),
        facts: vec![
            ("Study", summary.study.clone()),
            ("Cases", format!("{} of {} at most", summary.cases, summary.of)),
            ("Draws", summary.draws.to_string()),
            ("Stopped by a figure", stopped(summary).to_owned()),
            ("Drawn values", study.table.drawn.len().to_string()),
            ("Figures", summary.figures.len().to_string()),
            ("Hash", summary.hash.chars().take(12).collect()),
            ("Boresight", summary.version.clone()),
        ],
        sections,
        names_paper: false,
        data: serde_json::json!({ "summary": summary }),
    }
}

/// Describes whether the stopping rule ended the study.
fn stopped(summary: &Summary) -> &'static str {
    match summary.waited {
        Some(StoppingStatus::NarrowEnough) => "yes",
        Some(StoppingStatus::TooWide) => "no: interval wider than required",
        Some(StoppingStatus::NearlyConstant) => "no: equal in nearly every draw, scatter unknown",
        None => "no",
    }
}

/// Factor from a figure's value to its displayed value: 100 for rates, shown in percent, and 1 for other
/// figures.
fn scale(name: &str) -> f64 {
    if figure_by_name(name).is_rate() { 100.0 } else { 1.0 }
}

/// Formats a value of a figure.
fn number(name: &str, value: f64) -> String {
    if figure_by_name(name).is_rate() { format!("{:.2}\u{a0}%", 100.0 * value) } else { significant(value) }
}

/// Formats a value with its interval; a narrow column may break the line between them.
fn estimate_text(name: &str, estimate: &Estimate) -> String {
    let bound = |value: f64| number(name, value).replace("\u{a0}%", "");
    let interval = estimate.low.zip(estimate.high);
    let interval = interval.map(|(low, high)| format!(" ({}\u{a0}to\u{a0}{})", bound(low), bound(high)));
    format!("{}{}", number(name, estimate.value), interval.unwrap_or_default())
}

/// Returns the label of a figure in a table.
fn label(key: &str) -> String {
    figure_by_name(key).label_without_percent()
}

/// Returns the section on all figures: the value over all cases, and the quantiles over the cases.
fn figures(study: &StudyResult) -> Section {
    let summary = &study.summary;
    let mut section = Section::new("figures", "Figures");
    if let Some(chart) = rate_chart(summary) {
        section = section.chart(chart);
    }
    section = section.table(table_of_figures(summary));
    let without = summary.figures.iter().filter(|(_, figure)| figure.cases == 0);
    let without: Vec<String> = without.map(|(name, _)| figure_by_name(name).words).collect();
    match without.as_slice() {
        [] => section,
        names => section.text(format!("Without a value in any case: {}.", names.join(", "))),
    }
}

/// Returns the table of the figures that have a value in a case.
fn table_of_figures(summary: &Summary) -> DataTable {
    let head = ["figure", "cases", "all", "5 % of cases below", "median", "95 % of cases below"];
    let mut table = DataTable::new(head)
        .caption(
            "With 95 % intervals. All: for a rate, all frames of all cases together; for other figures, the mean \
             of the cases.",
        )
        .narrow();
    for (name, figure) in summary.figures.iter().filter(|(_, figure)| figure.cases > 0) {
        let estimate = |estimate: &Option<Estimate>| {
            estimate.as_ref().map_or_else(|| "–".to_owned(), |e| estimate_text(name, e))
        };
        table.push([
            label(name),
            figure.cases.to_string(),
            estimate(&figure.all),
            estimate(&figure.p05),
            estimate(&figure.median),
            estimate(&figure.p95),
        ]);
    }
    table
}

/// Returns the chart of the rates over all frames and of their spread over the cases; `None` without a rate.
fn rate_chart(summary: &Summary) -> Option<Chart> {
    let is_rate = |(name, _): &(&String, &FigureSummary)| figure_by_name(name).is_rate();
    let rates = summary.figures.iter().filter(is_rate);
    let rates: Vec<(&String, Estimate, &FigureSummary)> =
        rates.filter_map(|(name, figure)| Some((name, figure.all?, figure))).collect();
    if rates.is_empty() {
        return None;
    }
    // In reverse order, since the axis runs upwards: the first rate is on top.
    let column = |pick: &dyn Fn(&Estimate, &FigureSummary) -> f64| -> Vec<f64> {
        rates.iter().rev().map(|(_, all, figure)| rounded(100.0 * pick(all, figure), 4)).collect()
    };
    let names: Vec<String> = rates.iter().rev().map(|(name, _, _)| figure_by_name(name).words).collect();
    let quantile = |estimate: Option<Estimate>| estimate.map_or(f64::NAN, |estimate| estimate.value);
    let traces = vec![
        intervals_across(
            "cases: median, 5 and 95 %",
            column(&|_, figure| quantile(figure.median)),
            &column(&|_, figure| quantile(figure.p05)),
            &column(&|_, figure| quantile(figure.p95)),
            names.clone(),
            BESIDE,
        ),
        intervals_across(
            "all frames, 95 % interval",
            column(&|all, _| all.value),
            &column(&|all, _| all.low.unwrap_or(all.value)),
            &column(&|all, _| all.high.unwrap_or(all.value)),
            names,
            MEASURED,
        ),
    ];
    let layout = Layout::new(Axis::titled("%"), Axis::new());
    let mut data = DataTable::new(["rate", "all", "low", "high"]);
    for (name, all, _) in &rates {
        let bound = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| number(name, value));
        data.push([figure_by_name(name).words, number(name, all.value), bound(all.low), bound(all.high)]);
    }
    let height = 110 + 30 * rates.len() as u32;
    let caption = "Rates over all frames, and their spread over the cases.";
    Some(Chart::new(caption, height, data, traces, layout))
}

/// Returns the section on the requirements with their verdicts.
fn requirements(summary: &Summary) -> Section {
    let mut table = DataTable::new(["requirement", "at", "found", "lower bound", "upper bound", "verdict"])
        .caption(
            "Each bound holds individually with the confidence of its requirement. Met: the worse bound is \
             within the limit; not met: the better bound is beyond it.",
        );
    for result in &summary.requirements {
        let name = &result.requirement.figure;
        let cell = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| number(name, value));
        table.push([
            result.requirement_words(&label(name), |value| number(name, value)),
            if result.at.is_empty() { "–".to_owned() } else { at_words(&result.at) },
            cell(result.value),
            cell(result.low),
            cell(result.high),
            result.verdict_words(),
        ]);
    }
    Section::new("requirements", "Requirements").table(table.wordy())
}

/// Returns swept values in words: `sensor read noise, e⁻ = 5`.
fn at_words(at: &IndexMap<String, String>) -> String {
    let pairs: Vec<String> =
        at.iter().map(|(path, value)| format!("{} = {value}", setting_name(path))).collect();
    pairs.join("; ")
}

/// Returns the section on the causes of missed and wrong frames.
fn causes(summary: &Summary) -> Section {
    let mut table = DataTable::new(["cause", "frames", "share of all, %", "cases"])
        .caption("Frames of all counted cases; shares with 95 % intervals.");
    let percent = |value: f64| format!("{:.2}", 100.0 * value);
    for (name, cause) in &summary.causes {
        let share = cause.share.as_ref().map_or_else(String::new, |share| {
            let interval = share.low.zip(share.high);
            let interval = interval.map(|(low, high)| format!(" ({} to {})", percent(low), percent(high)));
            format!("{}{}", percent(share.value), interval.unwrap_or_default())
        });
        let words = cause_words(name);
        table.push([words, cause.frames.to_string(), share, cause.cases.to_string()]);
    }
    Section::new("causes", "Misses and wrong measurements by cause").table(table)
}

/// Returns the words for a cause such as `missed.cut_by_roi`.
fn cause_words(name: &str) -> String {
    display_name(&name.replacen('.', ": ", 1))
}

/// Returns the section on the sweep: a curve of each figure, starting with the figure that ranks the worst
/// cases, and the change at each step of the sweep.
fn sweep(study: &StudyResult) -> Section {
    let summary = &study.summary;
    let has_value = |name: &&String| {
        let mut points = summary.sweep.iter();
        points.any(|point| point.figures.get(*name).is_some_and(|figure| figure.all.is_some()))
    };
    let mut names: Vec<&String> = summary.figures.keys().filter(has_value).collect();
    names.sort_by_key(|name| *name != &summary.worst_by);
    let left_out = names.len().saturating_sub(MAX_CURVES);
    names.truncate(MAX_CURVES);
    let charts = names.iter().map(|name| curve(summary, name)).collect();
    let mut section = Section::new("sweep", "Sweep");
    if left_out > 0 {
        section = section.text(format!(
            "The charts show the first {MAX_CURVES} figures; summary.json has all figures at every point."
        ));
    }
    section.charts(charts).table(differences(summary))
}

/// Values of a swept parameter, each with the figure at that value.
type Curve = Vec<(String, Estimate)>;

/// Returns the chart of a figure over the swept parameter with the most values; each combination of the other
/// parameters has a curve.
fn curve(summary: &Summary, name: &str) -> Chart {
    let label_of = |path: &str, value: &str| format!("{} = {value}", setting_name(path));
    let values_of = |path: &String| {
        let values: BTreeSet<&String> = summary.sweep.iter().filter_map(|point| point.at.get(path)).collect();
        values.len()
    };
    let paths = summary.sweep.first().map(|point| point.at.keys().collect::<Vec<_>>()).unwrap_or_default();
    let across = paths.iter().max_by_key(|path| values_of(path)).map_or("", |path| path.as_str());
    let mut data = DataTable::new(["point", "cases", &label(name)]);
    let mut curves: IndexMap<String, Curve> = IndexMap::new();
    for point in &summary.sweep {
        let estimate = point.figures.get(name).and_then(|figure| figure.all);
        let all = point.at.iter().map(|(path, value)| label_of(path, value)).collect::<Vec<_>>().join(", ");
        let text = estimate.as_ref().map_or_else(|| "–".to_owned(), |estimate| estimate_text(name, estimate));
        data.push([all, point.cases.to_string(), text]);
        let others = point.at.iter().filter(|(path, _)| *path != across);
        let others = others.map(|(path, value)| label_of(path, value)).collect::<Vec<_>>().join(", ");
        if let Some((x, estimate)) = point.at.get(across).zip(estimate) {
            curves.entry(others).or_default().push((x.clone(), estimate));
        }
    }
    let trace = |(place, (others, points)): (usize, (&String, &Curve))| {
        let of = |pick: fn(&Estimate) -> f64| -> Vec<f64> {
            points.iter().map(|(_, estimate)| rounded(scale(name) * pick(estimate), 9)).collect()
        };
        let x: Vec<String> = points.iter().map(|(x, _)| plain(x)).collect();
        let title = if others.is_empty() { figure_by_name(name).words } else { others.clone() };
        let (low, high) = (of(|e| e.low.unwrap_or(e.value)), of(|e| e.high.unwrap_or(e.value)));
        intervals(&title, x, of(|e| e.value), &low, &high, CURVES[place % CURVES.len()])
            .mode(Mode::LinesAndMarkers)
    };
    let traces: Vec<Trace> = curves.iter().enumerate().map(trace).collect();
    let has_legend = traces.len() > 1;
    Chart::new(
        format!("{} over the sweep, with 95 % intervals.", capital(&figure_by_name(name).words)),
        320,
        data,
        traces,
        axes(&plain(&setting_name(across)), &plain(&figure_by_name(name).to_string())).legend(has_legend),
    )
}

/// Returns a table of the changes of all figures at each step of the sweep.
fn differences(summary: &Summary) -> DataTable {
    let mut table = DataTable::new(["figure", "of", "from", "to", "difference", "draws"]).caption(
        "Sweep points that differ in one value, compared draw by draw; with 95 % intervals. Differences of \
         rates are in percentage points.",
    );
    for step in &summary.differences {
        let changed = step.from.iter().find(|(path, from)| step.to.get(*path) != Some(from));
        let Some((path, from)) = changed else { continue };
        let others = step.from.iter().filter(|(other, _)| *other != path);
        let at: String = others.map(|(path, value)| format!(", {} = {value}", setting_name(path))).collect();
        let number = |value: f64| significant(scale(&step.figure) * value);
        let interval = step.difference.low.zip(step.difference.high);
        let interval =
            interval.map_or(String::new(), |(low, high)| format!(" ({} to {})", number(low), number(high)));
        table.push([
            label(&step.figure),
            format!("{}{at}", setting_name(path)),
            from.clone(),
            step.to.get(path).cloned().unwrap_or_default(),
            format!("{}{interval}", number(step.difference.value)),
            step.draws.to_string(),
        ]);
    }
    table
}

/// Returns the section on the correlations of figures with drawn values.
fn sensitivities(study: &StudyResult) -> Section {
    let correlations = &study.summary.correlations;
    let section = Section::new("sensitivities", "Sensitivities");
    if correlations.is_empty() {
        return section.absent(
            "No correlations: too few cases, no drawn value is a number, or every figure is equal in nearly \
             all cases.",
        );
    }
    let mut figures: Vec<&String> = Vec::new();
    let mut parameters: Vec<&String> = Vec::new();
    for correlation in correlations {
        if !figures.contains(&&correlation.figure) {
            figures.push(&correlation.figure);
        }
        if !parameters.contains(&&correlation.parameter) {
            parameters.push(&correlation.parameter);
        }
    }
    parameters.sort();
    let of = |figure: &str, parameter: &str| {
        let same = correlations.iter().find(|c| c.figure == figure && c.parameter == parameter);
        same.map_or(f64::NAN, |c| rounded(c.correlation, 3))
    };
    let z: Vec<Vec<f64>> = figures
        .iter()
        .rev()
        .map(|figure| parameters.iter().map(|parameter| of(figure, parameter)).collect())
        .collect();
    let names: Vec<String> = parameters.iter().map(|name| plain(&setting_name(name))).collect();
    let labels: Vec<String> =
        figures.iter().rev().map(|name| plain(&figure_by_name(name).to_string())).collect();
    let map = Trace::heat_map(names, labels, &z)
        .colour_range([-1.0, 1.0])
        .colour_scale(ColourScale::BlueToRed)
        .hover_template("%{y}<br>with %{x}: %{z}<extra></extra>");
    let mut data = DataTable::new(["figure", "drawn value", "correlation", "low", "high", "cases"]);
    let bound = |bound: Option<f64>| bound.map_or("–".to_owned(), |bound| format!("{bound:.3}"));
    for c in correlations {
        data.push([
            label(&c.figure),
            setting_name(&c.parameter),
            format!("{:.3}", c.correlation),
            bound(c.low),
            bound(c.high),
            c.cases.to_string(),
        ]);
    }
    section.chart(Chart::new(
        "Spearman's rank correlation of figures with drawn values: 1 if the figure always grows with the \
         value, −1 if it always falls. The table has the 95 % intervals.",
        140 + 24 * figures.len() as u32,
        data,
        vec![map],
        Layout::new(Axis::new(), Axis::new()),
    ))
}

/// Returns the section on the Sobol indices: a chart for the figure that ranks the worst cases, and a table
/// for all figures.
fn indices(study: &StudyResult) -> Section {
    let summary = &study.summary;
    let mut data = DataTable::new(["figure", "drawn value", "first", "low", "high", "total", "low", "high"]);
    for index in &summary.indices {
        let numbers = [
            index.first,
            index.first_interval[0],
            index.first_interval[1],
            index.total,
            index.total_interval[0],
            index.total_interval[1],
        ];
        let mut cells = vec![label(&index.figure), setting_name(&index.parameter)];
        cells.extend(numbers.map(|number| format!("{number:.3}")));
        data.push(cells);
    }
    let own: Vec<_> = summary.indices.iter().filter(|index| index.figure == summary.worst_by).collect();
    let trace = |name: &str, value: fn(&study::SobolIndex) -> (f64, [f64; 2]), colour| {
        let names: Vec<String> = own.iter().map(|index| plain(&setting_name(&index.parameter))).collect();
        let values: Vec<(f64, [f64; 2])> = own.iter().map(|index| value(index)).collect();
        let low: Vec<f64> = values.iter().map(|(_, interval)| interval[0]).collect();
        let high: Vec<f64> = values.iter().map(|(_, interval)| interval[1]).collect();
        intervals(
            name,
            names,
            values.iter().map(|(value, _)| rounded(*value, 4)).collect(),
            &low,
            &high,
            colour,
        )
    };
    let traces = vec![
        trace("first order", |index| (index.first, index.first_interval), MEASURED),
        trace("total", |index| (index.total, index.total_interval), BESIDE),
    ];
    Section::new("indices", "Sobol indices").chart(Chart::new(
        format!(
            "Variance of {}: part due to each value by itself (first order), and part that includes all \
             interactions of the value (total).",
            figure_by_name(&summary.worst_by).words
        ),
        400,
        data,
        traces,
        axes("", "part of the variance"),
    ))
}

/// Returns charts of the figure that ranks the worst cases against every drawn value.
fn scatter(study: &StudyResult) -> Section {
    let (summary, table) = (&study.summary, &study.table);
    let name = &summary.worst_by;
    let section =
        Section::new("scatter", format!("{} against drawn values", capital(&figure_by_name(name).words)));
    let Some(values) = table.figure(name) else { return section.absent("No case has the figure.") };
    let mut found = values.iter().filter_map(|value| value.value);
    let first = found.next();
    if found.all(|value| Some(value) == first) {
        return section.absent("The figure is equal in all cases.");
    }
    let mut charts = Vec::new();
    for parameter in table.drawn.keys() {
        let Some(numbers) = table.numbers(parameter) else { continue };
        let rows: Vec<usize> = (0..numbers.len()).filter(|&row| values[row].value.is_some()).collect();
        let value = |row: usize| scale(name) * values[row].value.unwrap_or(f64::NAN);
        let traces = cloud(&figure_by_name(name).words, &rows, Some(&value), MEASURED, |rows| {
            let x: Vec<f64> = rows.iter().map(|&row| numbers[row]).collect();
            let y = rows.iter().map(|&row| rounded(value(row), 9)).collect();
            let cases: Vec<u64> = rows.iter().map(|&row| table.rows[row].case).collect();
            let hover = "case %{customdata}<br>%{x}<br>%{y}<extra></extra>";
            points("", x, y, MEASURED).custom_data(cases).hover_template(hover)
        });
        let is_drawn_whole = traces.len() == 1;
        let mut sorted = rows.clone();
        sorted.sort_by(|&a, &b| numbers[a].total_cmp(&numbers[b]).then(a.cmp(&b)));
        let mut data = DataTable::new(["from", "to", "cases", "smallest", "mean", "largest"])
            .caption("By interval of the drawn value; cases.parquet has every case.");
        for bin in bins(sorted.len(), TABLE_BINS) {
            let (first, last) = (sorted[bin.start], sorted[bin.end - 1]);
            let mut cells = vec![significant(numbers[first]), significant(numbers[last])];
            cells.extend(summed(bin.map(|i| value(sorted[i])), 4));
            data.push(cells);
        }
        charts.push(Chart::new(
            format!(
                "{} against {}, one point per case. {}",
                figure_by_name(name),
                setting_name(parameter),
                thinning_caption(&[(rows.len(), "cases")], true)
            ),
            260,
            data,
            traces,
            axes(&plain(&setting_name(parameter)), &plain(&figure_by_name(name).to_string()))
                .legend(!is_drawn_whole),
        ));
    }
    let left_out = charts.len().saturating_sub(MAX_SCATTERS);
    charts.truncate(MAX_SCATTERS);
    let section = if left_out > 0 {
        section.text(format!("First {MAX_SCATTERS} drawn values; cases.parquet has all."))
    } else {
        section
    };
    if charts.is_empty() { section.absent("No drawn value is a number.") } else { section.charts(charts) }
}

/// Returns the table of the varied settings: words, key in the scenario, and smallest and largest value.
fn settings(study: &StudyResult) -> Section {
    let mut data = DataTable::new(["setting", "key in the scenario", "smallest", "largest"])
        .caption("Values that differ between the cases; the key is that of the scenario and of `[[vary]]`.");
    for parameter in study.table.drawn.keys() {
        let numbers = study.table.numbers(parameter).unwrap_or_default();
        let finite = || numbers.iter().copied().filter(|number| number.is_finite());
        let (least, most) =
            (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
        data.push([setting_name(parameter), format!("`{parameter}`"), significant(least), significant(most)]);
    }
    let section = Section::new("settings", "Varied settings");
    if data.rows.is_empty() {
        section.absent("The study varies no value but the seed.")
    } else {
        section.table(data)
    }
}

/// Returns the table of the worst cases, with the commands that repeat them.
fn worst(study: &StudyResult) -> Section {
    let summary = &study.summary;
    let way = match figure_by_name(&summary.worst_by).sense.better {
        Better::More => "the smallest",
        Better::Less => "the largest",
        Better::Near(_) => "the farthest from the best value",
    };
    let section = Section::new("worst", "Worst cases");
    if summary.worst.is_empty() {
        return section.absent("No case has the figure that ranks the cases.");
    }
    let drawn: Vec<&String> = summary.worst[0].drawn.keys().collect();
    let mut head = vec!["case".to_owned(), label(&summary.worst_by)];
    head.extend(drawn.iter().map(|name| setting_name(name)));
    head.push("command to repeat the case".to_owned());
    let mut table = DataTable::new(head).wordy();
    for case in &summary.worst {
        let mut cells = vec![case.case.to_string(), number(&summary.worst_by, case.value)];
        cells.extend(drawn.iter().map(|name| match case.drawn.get(*name) {
            Some(text) => text.parse::<f64>().map_or_else(|_| text.clone(), significant),
            None => String::new(),
        }));
        cells.push(format!("`{}`", case.replay));
        table.push(cells);
    }
    let more = match summary.worst_of.saturating_sub(summary.worst.len() as u64) {
        0 => String::new(),
        more => format!(" {more} more cases have the same value as the last one listed."),
    };
    let words = figure_by_name(&summary.worst_by).words;
    section.text(format!("Cases whose {words} is {way}.{more}")).table(table)
}
