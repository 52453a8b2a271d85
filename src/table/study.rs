//! Text output of a study for a user.
use std::collections::HashMap;

use comfy_table::{Attribute, Cell};
use run::figure_by_name;
use score::{attitude_note, warm_up_note};
use study::{
    CaseFigure, CaseRow, Estimate, RankCorrelation, RequirementVerdict, StoppingStatus, Study, Summary,
    overall,
};
use view::terminal::{finish, percent, plain_table, wrapped};

/// Maximum number of parameters in the sensitivity table.
const MAX_PARAMETERS: usize = 12;
/// Maximum number of figures with a column in the tables of sweep and sensitivities.
const SHOWN_FIGURES: usize = 4;

/// Returns a summary as text: figures, sweep, sensitivities, the worst cases. Ends with a line feed.
pub fn study_table(summary: &Summary, styled: bool) -> String {
    let mut table = plain_table(styled);
    let bold = |text: &str| Cell::new(text).add_attribute(Attribute::Bold);
    table.set_header(
        ["figure", "cases", "all cases together", "5 % of cases below", "median", "95 % below"].map(bold),
    );
    for (name, figure) in &summary.figures {
        if figure.cases == 0 {
            continue;
        }
        let show = |estimate: &Option<Estimate>| estimate_text(name, estimate.as_ref());
        table.add_row([
            label(name),
            figure.cases.to_string(),
            show(&figure.all),
            show(&figure.p05),
            show(&figure.median),
            show(&figure.p95),
        ]);
    }
    let stopped = match summary.waited {
        Some(StoppingStatus::NarrowEnough) => ", stopped at the required precision",
        _ => "",
    };
    let draws = if summary.sweep.is_empty() { String::new() } else { format!(" ({} draws)", summary.draws) };
    let mut text = format!("{}: {} cases of {}{draws}{stopped}\n", summary.study, summary.cases, summary.of);
    for note in summary.notes() {
        text.push_str(&wrapped(&format!("{note}\n")));
    }
    text.push_str(&finish(table));
    text.push_str(&wrapped(
        "95 % intervals, over independent draws. All cases together: rates over all frames (Wilson, with the \
         scatter between draws), other figures as mean of the cases (Student's t). Quantiles are over the cases \
         (order statistics; none for too few draws).\n",
    ));
    if let Some(note) = warm_up_note(summary.warm_up_frames, "frames of every case") {
        text.push_str(&wrapped(&format!("{note}\n")));
    }
    if let Some(note) = attitude_note(summary.attitude.as_deref()) {
        text.push_str(&wrapped(&format!("{note}\n")));
    }
    text.push_str(&requirements(summary, styled));
    if !summary.causes.is_empty() {
        let mut table = plain_table(styled);
        table.set_header(
            ["misses and wrong measurements by cause", "frames", "share of all", "cases"].map(bold),
        );
        for (name, cause) in &summary.causes {
            let share = cause.share.as_ref().map_or_else(|| "–".to_owned(), percents);
            table.add_row([cause_words(name), cause.frames.to_string(), share, cause.cases.to_string()]);
        }
        text.push('\n');
        text.push_str(&finish(table));
    }
    let figures = shown_figures(summary);
    if let Some(first) = summary.sweep.first() {
        let mut table = plain_table(styled);
        let labels: Vec<String> = figures.iter().map(|name| label(name)).collect();
        let paths = first.at.keys().map(String::as_str);
        table.set_header(paths.chain(["cases"]).chain(labels.iter().map(String::as_str)).map(bold));
        for point in &summary.sweep {
            let figure = |name: &&String| {
                estimate_text(name, point.figures.get(*name).and_then(|figure| figure.all.as_ref()))
            };
            let cells = point.at.values().cloned().chain([point.cases.to_string()]);
            table.add_row(cells.chain(figures.iter().map(figure)));
        }
        text.push('\n');
        text.push_str(&finish(table));
        text.push_str(&differences(summary, styled));
    }
    text.push_str(&correlations(summary, &figures, styled));
    text.push_str(&indices(summary, &figures, styled));
    text.push_str(&worst_cases(summary, styled));
    text
}

/// Returns the worst cases with the commands that repeat them as text; empty if there are none.
fn worst_cases(summary: &Summary, styled: bool) -> String {
    if summary.worst.is_empty() {
        return String::new();
    }
    let by = &summary.worst_by;
    let mut table = plain_table(styled);
    let bold = |text: &str| Cell::new(text).add_attribute(Attribute::Bold);
    table.set_header(["worst cases", &label(by)].map(bold));
    for case in &summary.worst {
        table.add_row([format!("case {}", case.case), number(by, case.value)]);
    }
    let mut text = format!("\n{}", finish(table));
    // A command has its own line, which can be copied.
    text.push_str("Commands to repeat them:\n");
    for case in &summary.worst {
        text.push_str(&format!("{}\n", case.replay));
    }
    let more = summary.worst_of.saturating_sub(summary.worst.len() as u64);
    if more > 0 {
        text.push_str(&format!("{more} more cases have the same value as the last one listed.\n"));
    }
    text
}

/// Returns the figures that have a column: the figure by which cases are ranked, the required figures, then
/// the remaining ones in order.
fn shown_figures(summary: &Summary) -> Vec<&String> {
    let required = summary.requirements.iter().map(|result| &result.requirement.figure);
    let recorded = summary.figures.iter().filter(|(_, figure)| figure.cases > 0).map(|(name, _)| name);
    let mut names: Vec<&String> = Vec::new();
    for name in [&summary.worst_by].into_iter().chain(required).chain(recorded) {
        if names.len() < SHOWN_FIGURES && !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// Returns the requirements with their verdicts as text; empty if there are none.
fn requirements(summary: &Summary, styled: bool) -> String {
    let Some(verdict) = summary.verdict() else { return String::new() };
    let mut table = plain_table(styled);
    let has_sweep = !summary.sweep.is_empty();
    let bold = |text: &str| Cell::new(text).add_attribute(Attribute::Bold);
    let at = has_sweep.then_some("at");
    table.set_header(["requirement"].into_iter().chain(at).chain(["found", "bounds", "verdict"]).map(bold));
    for result in &summary.requirements {
        let name = &result.requirement.figure;
        let bound = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| number(name, value));
        table.add_row(
            [result.requirement_words(&label(name), |value| number(name, value))]
                .into_iter()
                .chain(has_sweep.then(|| result.at_words()))
                .chain([bound(result.value), format!("{} to {}", bound(result.low), bound(result.high))])
                .chain([result.verdict_words()]),
        );
    }
    let together = match verdict {
        RequirementVerdict::Met => "All requirements are met.",
        RequirementVerdict::NotMet => "Not all requirements are met.",
        RequirementVerdict::NotDecided => {
            "Not all requirements are decided: run more cases, or relax a limit."
        }
    };
    format!("\n{}{together}\n", finish(table))
}

/// Returns the correlations of the figures with the drawn parameters as text.
fn correlations(summary: &Summary, figures: &[&String], styled: bool) -> String {
    let (varied, constant): (Vec<&String>, Vec<&String>) =
        figures.iter().copied().partition(|name| correlations_with(summary, name).next().is_some());
    let mut text = String::new();
    if !varied.is_empty() {
        let mut parameters: Vec<&String> = Vec::new();
        for correlation in varied.iter().flat_map(|name| correlations_with(summary, name)) {
            if parameters.len() < MAX_PARAMETERS && !parameters.contains(&&correlation.parameter) {
                parameters.push(&correlation.parameter);
            }
        }
        let mut table = plain_table(styled);
        let labels: Vec<String> = varied.iter().map(|name| label(name)).collect();
        let header = ["rank correlation with"].into_iter().chain(labels.iter().map(String::as_str));
        table.set_header(header.map(|text| Cell::new(text).add_attribute(Attribute::Bold)));
        for parameter in parameters {
            let cell = |name: &&String| {
                correlations_with(summary, name).find(|c| &c.parameter == parameter).map_or_else(
                    || "–".to_owned(),
                    |c| {
                        let interval = c.low.zip(c.high);
                        let interval = interval.map(|(low, high)| format!(" ({low:+.2} to {high:+.2})"));
                        format!("{:+.2}{}", c.correlation, interval.unwrap_or_default())
                    },
                )
            };
            table.add_row([parameter.clone()].into_iter().chain(varied.iter().map(cell)));
        }
        text.push_str(&format!("\n{}", finish(table)));
    }
    if summary.worst.is_empty() {
        return text;
    }
    for name in constant {
        let values = summary
            .figures
            .get(name)
            .map(|figure| [figure.p05, figure.p95].map(|quantile| quantile.map(|quantile| quantile.value)));
        let reason = if values.is_some_and(|[low, high]| low.is_some() && low == high) {
            "the figure is equal in nearly all cases"
        } else {
            "there are too few cases, or no drawn value is a number"
        };
        let line = format!("\n{}: no correlation with drawn values, because {reason}.\n", label(name));
        text.push_str(&wrapped(&line));
    }
    text
}

fn correlations_with<'a>(summary: &'a Summary, figure: &'a str) -> impl Iterator<Item = &'a RankCorrelation> {
    summary.correlations.iter().filter(move |correlation| correlation.figure == figure)
}

/// Returns the Sobol indices of the figures as text.
fn indices(summary: &Summary, figures: &[&String], styled: bool) -> String {
    let mut text = String::new();
    let bold = |text: &str| Cell::new(text).add_attribute(Attribute::Bold);
    for name in figures {
        let indices: Vec<_> = summary.indices.iter().filter(|index| &&index.figure == name).collect();
        if indices.is_empty() {
            continue;
        }
        let mut table = plain_table(styled);
        let by = format!("variance of {} by", label(name));
        table.set_header([&by, "first order", "95 %", "total", "95 %"].map(bold));
        for index in indices {
            let interval = |[low, high]: [f64; 2]| format!("{low:.2} to {high:.2}");
            table.add_row([
                index.parameter.clone(),
                format!("{:.2}", index.first),
                interval(index.first_interval),
                format!("{:.2}", index.total),
                interval(index.total_interval),
            ]);
        }
        text.push_str(&format!("\n{}", finish(table)));
    }
    text
}

/// Returns the change of the figure by which cases are ranked, at each step of the sweep, as text; empty if
/// there is nothing to compare.
fn differences(summary: &Summary, styled: bool) -> String {
    let by = &summary.worst_by;
    let mut table = plain_table(styled);
    let bold = |text: &str| Cell::new(text).add_attribute(Attribute::Bold);
    table.set_header([&format!("change of {}", label(by)), "from", "to", "difference", "draws"].map(bold));
    let mut is_empty = true;
    for step in summary.differences.iter().filter(|step| &step.figure == by).take(MAX_PARAMETERS) {
        let changed = step.from.iter().find(|(path, from)| step.to.get(*path) != Some(from));
        let Some((path, from)) = changed else { continue };
        let to = step.to.get(path).map_or("", String::as_str);
        let others = step.from.iter().filter(|(other, _)| *other != path);
        let at: String = others.map(|(path, value)| format!(", {path} = {value}")).collect();
        table.add_row([
            format!("{path}{at}"),
            from.clone(),
            to.to_owned(),
            shown_difference(by, &step.difference),
            step.draws.to_string(),
        ]);
        is_empty = false;
    }
    if is_empty { String::new() } else { format!("\n{}", finish(table)) }
}

/// Formats a difference of two figures with its interval; for rates, in percentage points.
fn shown_difference(name: &str, estimate: &Estimate) -> String {
    let is_rate = figure_by_name(name).is_rate();
    let one = |value: f64| {
        if is_rate { format!("{:+.2}", 100.0 * value) } else { signed(name, value) }
    };
    let unit = if is_rate { " points" } else { "" };
    let interval = estimate.low.zip(estimate.high);
    let interval = interval.map_or(String::new(), |(low, high)| format!(" ({} to {})", one(low), one(high)));
    format!("{}{unit}{interval}", one(estimate.value))
}

fn signed(name: &str, value: f64) -> String {
    let sign = if value < 0.0 { "" } else { "+" };
    format!("{sign}{}", number(name, value))
}

/// Returns the words for a cause such as `missed.cut_by_roi`.
fn cause_words(name: &str) -> String {
    name.replacen('.', ": ", 1).replace('_', " ")
}

/// Formats a fraction with its interval, in percent.
fn percents(share: &Estimate) -> String {
    let bounds = share.low.zip(share.high);
    let bounds = bounds.map(|(low, high)| format!(" ({} %–{} %)", percent(low), percent(high)));
    format!("{} %{}", percent(share.value), bounds.unwrap_or_default())
}

/// Brief running estimate of a figure over the cases so far. The estimate is renewed whenever the number of
/// cases has grown by a twentieth, to keep its cost low for any number of cases.
pub struct LiveFigure {
    name: String,
    column: Option<usize>,
    cases: Vec<CaseFigure>,
    /// Index of each case's draw; cases with the same seed share a draw.
    draws: Vec<usize>,
    seeds: HashMap<u64, usize>,
    next: usize,
}

impl LiveFigure {
    /// Creates the running estimate of a study, before its first case.
    pub fn new(study: &Study, name: String) -> Self {
        let column = study.figures().iter().position(|figure| *figure == name);
        Self { name, column, cases: Vec::new(), draws: Vec::new(), seeds: HashMap::new(), next: 1 }
    }

    /// Adds a case, and returns the text to show if the estimate was renewed.
    pub fn add(&mut self, row: &CaseRow) -> Option<String> {
        self.cases.push(*row.figures.get(self.column?)?);
        let draw = self.seeds.len();
        self.draws.push(*self.seeds.entry(row.seed).or_insert(draw));
        if self.cases.len() < self.next {
            return None;
        }
        self.next = self.cases.len() + (self.cases.len() / 20).max(1);
        let estimate = overall(&self.name, &self.cases, &self.draws);
        Some(format!("{} {}", label(&self.name), estimate_text(&self.name, estimate.as_ref())))
    }
}

/// Returns the label of a figure beside its values.
fn label(key: &str) -> String {
    figure_by_name(key).label_without_percent()
}

fn estimate_text(name: &str, estimate: Option<&Estimate>) -> String {
    let Some(estimate) = estimate else { return "–".to_owned() };
    match (estimate.low, estimate.high) {
        (Some(low), Some(high)) => {
            format!("{} ({}–{})", number(name, estimate.value), number(name, low), number(name, high))
        }
        _ => number(name, estimate.value),
    }
}

fn number(name: &str, value: f64) -> String {
    if figure_by_name(name).is_rate() {
        return format!("{} %", percent(value));
    }
    let size = value.abs();
    if size == 0.0 || (0.01..1e5).contains(&size) {
        // Four significant digits.
        let digits = if size >= 1000.0 {
            0
        } else if size >= 100.0 {
            1
        } else if size >= 10.0 {
            2
        } else if size >= 1.0 {
            3
        } else {
            4
        };
        format!("{value:.digits$}")
    } else {
        format!("{value:.2e}")
    }
}
