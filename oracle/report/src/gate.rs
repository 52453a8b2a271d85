//! Report of a gate: the figures that changed, and the frames that flipped.

use run::figure_by_name;
use std::path::Path;

use files::Failure;
use gate::{FigureReport, FigureVerdict, Flip, FlipKind, GateReport, Pairing};

use crate::RunFiles;
use crate::charts::chart::{BESIDE, Chart, MEASURED, REFERENCE, WRONG, axes, intervals, line, rounded};
use crate::charts::plotly::{Layout, Trace};
use crate::figures::words::{capital, display_name};
use crate::figures::{cell, significant};
use crate::page::data_table::DataTable;
use crate::page::picture::Picture;
use crate::page::{Page, Section};
use crate::verdict::{Finding, Grade, Verdict, causes_sentence};
use crate::worlds::world_report;

/// Maximum number of flipped frames shown as pictures.
const MAX_PICTURES: usize = 12;
/// Maximum number of flipped frames listed.
const MAX_ROWS: usize = 200;

/// Pictures of flipped frames.
pub struct FlippedFrames {
    /// The pictures.
    pictures: Vec<Picture>,
    /// Reason why expected pictures are missing.
    reason: Option<String>,
}

impl FlippedFrames {
    /// Renders flipped frames of a result anew, from its directory: the first frame of every change from one
    /// verdict and cause to another, and then more of the lost frames. A study has no pictures: its frames
    /// belong to many scenarios.
    ///
    /// # Errors
    /// A [`Failure`] when the result cannot be read or a frame cannot be rendered.
    pub fn render(report: &GateReport, result: &Path) -> Result<Self, Failure> {
        let none = Self { pictures: Vec::new(), reason: None };
        let Some(flips) = &report.flips else { return Ok(none) };
        if report.units == "cases" || flips.units.is_empty() {
            return Ok(none);
        }
        let Some(world) = world_report(&report.world) else { return Ok(none) };
        let chosen = first_flip_of_each_kind(&flips.units);
        let numbers: Vec<u64> = chosen.iter().map(|flip| flip.number).collect();
        let (mut pictures, reason) = (world.pictures)(&RunFiles::of_directory(result), &numbers)?;
        for (picture, flip) in pictures.iter_mut().zip(&chosen) {
            picture.title = format!("{}: {}.", kind_words(flip.kind), change(flip));
        }
        Ok(Self { pictures, reason })
    }
}

/// Selects the first unit of every change, starting with lost ones, then further lost units.
fn first_flip_of_each_kind(flips: &[Flip]) -> Vec<&Flip> {
    let order = [FlipKind::Lost, FlipKind::Won, FlipKind::Other];
    let mut chosen: Vec<&Flip> = Vec::new();
    for kind in order {
        for flip in flips.iter().filter(|flip| flip.kind == kind) {
            if chosen.len() < MAX_PICTURES && !chosen.iter().any(|other| change(other) == change(flip)) {
                chosen.push(flip);
            }
        }
    }
    for flip in flips.iter().filter(|flip| flip.kind == FlipKind::Lost) {
        if chosen.len() < MAX_PICTURES && !chosen.iter().any(|other| other.number == flip.number) {
            chosen.push(flip);
        }
    }
    chosen
}

fn kind_words(kind: FlipKind) -> &'static str {
    match kind {
        FlipKind::Lost => "Lost",
        FlipKind::Won => "Won",
        FlipKind::Other => "Changed",
    }
}

/// Describes a change from one verdict to another.
fn change(flip: &Flip) -> String {
    let words = |verdict: &str, cause: &Option<String>| match cause {
        Some(cause) => format!("{} ({})", display_name(verdict), display_name(cause)),
        None => display_name(verdict),
    };
    format!("{} → {}", words(&flip.baseline, &flip.baseline_cause), words(&flip.result, &flip.result_cause))
}

/// Returns the page of a gate.
pub fn gate_page(report: &GateReport, frames: FlippedFrames) -> Page {
    let worse: Vec<String> = report.worse_figures().map(|name| figure_by_name(name).words).collect();
    let names: Vec<String> = report.changed_figures().map(|name| figure_by_name(name).words).collect();
    let lead = if worse.is_empty() && !names.is_empty() {
        let accepted = report.accepted.as_ref().map(|reason| format!(" Accepted: {reason}"));
        format!(
            "Changed from the baseline, but no farther from the best value: {}.{}",
            names.join(", "),
            accepted.unwrap_or_default()
        )
    } else if worse.is_empty() {
        let is_judged = |figure: &&FigureReport| figure.verdict != FigureVerdict::TooLittleData;
        let judged = report.figures.values().filter(is_judged).count();
        match report.figures.len() - judged {
            0 => format!("None of the {judged} compared figures is worse than in the baseline."),
            others => format!(
                "None of the {judged} figures with enough data is worse than in the baseline; {others} have too \
                 little data."
            ),
        }
    } else {
        format!("Worse than in the baseline: {}.", worse.join(", "))
    };
    let mut figures = report.figures.clone();
    figures.sort_by(|_, a, _, b| a.adjusted_p.total_cmp(&b.adjusted_p));
    let pairing = match report.pairing {
        Pairing::Frames => "the same frames",
        Pairing::Blocks => "time blocks, different seed",
    };
    Page {
        title: format!("{}: {}", report.name, report.verdict.words()),
        kind: "Gate: a result against a baseline",
        version: report.result_version.clone(),
        lead: vec![lead, format!("Reason for the baseline: {}", report.reason)],
        warnings: report.notes.clone(),
        verdict: verdict(report),
        facts: vec![
            ("Compared", format!("{} {}", report.count, report.units)),
            ("Pairs", pairing.to_owned()),
            ("Blocks", format!("{} of about {:.0} {}", report.blocks, report.block_length, report.units)),
            ("Probability of a false alarm", format!("{}\u{a0}%", significant(100.0 * report.alpha))),
            ("Seeds", format!("{} and {}", report.baseline_seed, report.result_seed)),
            ("Versions", format!("{} and {}", report.baseline_version, report.result_version)),
        ],
        sections: vec![flipped_units(report, frames), effects(report)],
        names_paper: false,
        data: data(report),
    }
}

/// Returns the verdict: the worse figures, the better ones, those that are neither, those with too little
/// data, and the changed frames with their causes. The gate itself grades the figures.
fn verdict(report: &GateReport) -> Verdict {
    let mut findings = Vec::new();
    for (name, figure) in &report.figures {
        let grade = match figure.verdict {
            verdict if verdict.is_worse() => Grade::Poor,
            FigureVerdict::Changed => Grade::Fair,
            FigureVerdict::Better => Grade::Good,
            _ => continue,
        };
        findings.push(Finding::new(grade, figure_by_name(name).words, change_text(name, figure)));
    }
    let count =
        |wanted: FigureVerdict| report.figures.values().filter(|figure| figure.verdict == wanted).count();
    match count(FigureVerdict::NoWorse) {
        0 => {}
        others => findings.push(Finding::new(
            Grade::Good,
            format!("{others} figures no worse"),
            "No worsening beyond the tolerance and beyond chance; the table has the smallest worsening that \
             would have been visible.",
        )),
    }
    match count(FigureVerdict::TooLittleData) {
        0 => {}
        others => findings.push(Finding::not_judged(
            format!("{others} figures with too little data"),
            "Too few frames have them in the baseline or in the result.",
        )),
    }
    findings.extend(flips_finding(report));
    Verdict::new(findings)
}

/// Describes the change of a figure: both values, the difference with its interval, and the tolerance.
fn change_text(name: &str, figure: &FigureReport) -> String {
    let spec = figure_by_name(name);
    let is_rate = spec.is_rate();
    let unit = if is_rate {
        "\u{a0}%".to_owned()
    } else {
        spec.unit.map_or(String::new(), |u| format!("\u{a0}{u}"))
    };
    let number = |value: Option<f64>| match value {
        Some(value) if is_rate => format!("{:.2}", 100.0 * value),
        value => cell(value),
    };
    let points = if is_rate { "\u{a0}points".to_owned() } else { unit.clone() };
    let interval = match (figure.low, figure.high) {
        (Some(_), Some(_)) => {
            format!(" (95\u{a0}% interval {} to {})", number(figure.low), number(figure.high))
        }
        _ => String::new(),
    };
    format!(
        "{}{unit} in the baseline, {}{unit} now: difference {}{points}{interval}, tolerance {}{points}.",
        number(figure.baseline),
        number(figure.result),
        number(figure.difference),
        number(Some(figure.tolerance))
    )
}

/// Returns the finding on the changed units; `None` if none is lost or changed otherwise.
fn flips_finding(report: &GateReport) -> Option<Finding> {
    let flips = report.flips.as_ref()?;
    let mut causes: indexmap::IndexMap<String, u64> = indexmap::IndexMap::new();
    for flip in flips.units.iter().filter(|flip| flip.kind == FlipKind::Lost) {
        *causes.entry(change(flip)).or_default() += 1;
    }
    let text = format!(
        "{} correct only in the baseline, {} only in the result, {} changed otherwise, of {}.",
        flips.lost, flips.won, flips.other, report.count
    );
    let grade = match (flips.lost, flips.won + flips.other) {
        (0, 0) => return None,
        (0, _) => Grade::Good,
        (lost, _) if lost > flips.won => Grade::Poor,
        _ => Grade::Fair,
    };
    let words = |change: &str| change.to_owned();
    Some(Finding::new(grade, format!("changed {}", report.units), text).and(&causes_sentence(&causes, words)))
}

/// Returns the report without its list of units, which may be as long as the run.
fn data(report: &GateReport) -> serde_json::Value {
    let counts = report.flips.as_ref();
    serde_json::json!({
        "verdict": report.verdict,
        "figures": report.figures,
        "flips": counts.map(|flips| serde_json::json!({ "lost": flips.lost, "won": flips.won, "other": flips.other })),
    })
}

/// Returns true if a figure has a value in the baseline or in the result.
fn has_value(figure: &FigureReport) -> bool {
    figure.baseline.or(figure.result).is_some()
}

/// Returns the table of the figures that have a value, with their differences.
fn table_of_effects(report: &GateReport) -> DataTable {
    let mut table = DataTable::new([
        "figure",
        "verdict",
        "baseline",
        "result",
        "difference",
        "low",
        "high",
        "tolerance",
        "adjusted p",
        "smallest visible",
        "blocks",
    ])
    .caption(
        "Result minus baseline, with 95 % intervals; rates in percent, their differences in percentage \
         points; p of a worsening, adjusted for all figures.",
    )
    .narrow();
    for (name, figure) in report.figures.iter().filter(|(_, figure)| has_value(figure)) {
        let is_rate = figure_by_name(name).is_rate();
        let number = |value: Option<f64>| match value {
            Some(value) if is_rate => format!("{:.2}", 100.0 * value),
            value => cell(value),
        };
        table.push([
            figure_by_name(name).to_string(),
            figure.verdict.words().to_owned(),
            number(figure.baseline),
            number(figure.result),
            number(figure.difference),
            number(figure.low),
            number(figure.high),
            number(Some(figure.tolerance)),
            significant(figure.adjusted_p),
            number(figure.smallest_visible),
            figure.blocks.to_string(),
        ]);
    }
    table
}

/// Returns the section on the differences with their intervals.
fn effects(report: &GateReport) -> Section {
    let table = table_of_effects(report);
    let (rates, amounts): (Vec<Compared<'_>>, Vec<Compared<'_>>) = report
        .figures
        .iter()
        .filter(|(_, figure)| figure.difference.is_some())
        .partition(|(name, _)| figure_by_name(name).is_rate());
    let mut section = Section::new("effects", "Changes of the figures");
    if !rates.is_empty() {
        let (traces, layout) = differences(&rates, |_| 0.01, "difference, points");
        let caption = "Rates: result minus baseline with 95 % intervals, in percentage points, and the \
            tolerance. The table states which direction is better.";
        section = section.chart(Chart::new(caption, 440, table.clone(), traces, layout));
    }
    // Amounts have different units; on one axis they are shown in units of their tolerances.
    let amounts: Vec<_> = amounts.into_iter().filter(|(_, figure)| figure.tolerance > 0.0).collect();
    if !amounts.is_empty() {
        let (traces, layout) = differences(&amounts, |figure| figure.tolerance, "difference ÷ tolerance");
        let caption = "Other figures: result minus baseline with 95 % intervals, in units of each figure's \
            tolerance.";
        section = section.chart(Chart::new(caption, 440, table.clone(), traces, layout));
    }
    let section = section.table(table);
    let without = report.figures.iter().filter(|(_, figure)| !has_value(figure));
    let without: Vec<String> = without.map(|(name, _)| figure_by_name(name).words).collect();
    match without.as_slice() {
        [] => section,
        names => section.text(format!("Without a value in baseline and result: {}.", names.join(", "))),
    }
}

/// Returns a figure's name without its unit, because the axis of differences has another unit.
fn plain_label(name: &str) -> String {
    figure_by_name(name).words
}

/// A figure of the gate with its name.
type Compared<'a> = (&'a String, &'a FigureReport);

/// Returns traces of the differences of some figures with their intervals and tolerances, each divided by its
/// unit.
fn differences(shown: &[Compared<'_>], unit: fn(&FigureReport) -> f64, axis: &str) -> (Vec<Trace>, Layout) {
    let of = |is: &dyn Fn(FigureVerdict) -> bool, name: &str, colour| {
        let chosen: Vec<_> = shown.iter().filter(|(_, figure)| is(figure.verdict)).collect();
        let scaled = |value: fn(&FigureReport) -> Option<f64>| -> Vec<f64> {
            let of = |f: &FigureReport| value(f).or(f.difference).unwrap_or(f64::NAN) / unit(f);
            chosen.iter().map(|(_, figure)| rounded(of(figure), 4)).collect()
        };
        let (y, low, high) = (scaled(|f| f.difference), scaled(|f| f.low), scaled(|f| f.high));
        let names: Vec<String> = chosen.iter().map(|(name, _)| plain_label(name)).collect();
        intervals(name, names, y, &low, &high, colour)
    };
    let names: Vec<String> = shown.iter().map(|(name, _)| plain_label(name)).collect();
    let limit = |side: f64, name: &str| {
        let at = shown.iter().map(|(_, figure)| side * figure.tolerance / unit(figure)).collect();
        let trace = line(name, names.clone(), at, REFERENCE).opacity(0.6);
        if side > 0.0 { trace } else { trace.not_in_legend() }
    };
    let traces = vec![
        limit(1.0, "tolerance"),
        limit(-1.0, "−tolerance"),
        of(&|verdict| verdict.is_worse(), "worse", WRONG),
        of(&|verdict| verdict == FigureVerdict::Better, "better", crate::charts::chart::TRUTH),
        of(&|verdict| verdict == FigureVerdict::Changed, "changed", BESIDE),
        of(
            &|verdict| {
                !(verdict.is_worse() || matches!(verdict, FigureVerdict::Better | FigureVerdict::Changed))
            },
            "no worse",
            MEASURED,
        ),
    ];
    (traces, axes("", axis))
}

/// Returns the section on the units that flipped.
fn flipped_units(report: &GateReport, frames: FlippedFrames) -> Section {
    let section = Section::new("flips", format!("{} with changed verdict", capital(&report.units)));
    let Some(flips) = &report.flips else {
        return section.absent("The frames differ: blocks are compared, not single frames.");
    };
    if flips.units.is_empty() {
        return section.absent("No frame has another verdict than in the baseline.");
    }
    let section = section.text(format!(
        "{} lost (correct only in the baseline), {} won (correct only in the result), {} changed otherwise.",
        flips.lost, flips.won, flips.other
    ));
    let section = match frames.reason {
        Some(reason) => section.text(format!("There are no pictures: {reason}")),
        None if frames.pictures.is_empty() => section,
        None => section
            .text(
                "One frame for each kind of change, rendered again from the result's `run.toml`, with the \
                 result's measurement. Green: truth; orange: measurement; yellow: clusters or outlines, with \
                 the pipeline's classification.",
            )
            .pictures(frames.pictures),
    };
    let mut table = DataTable::new(["number", "group", "change", "from", "cause", "to", "cause"]);
    for flip in flips.units.iter().take(MAX_ROWS) {
        let cause = |cause: &Option<String>| cause.as_deref().map(display_name).unwrap_or_default();
        table.push([
            flip.number.to_string(),
            flip.group.clone(),
            kind_words(flip.kind).to_lowercase(),
            display_name(&flip.baseline),
            cause(&flip.baseline_cause),
            display_name(&flip.result),
            cause(&flip.result_cause),
        ]);
    }
    let section = if flips.units.len() > MAX_ROWS {
        section.text(format!("First {MAX_ROWS} of {}; `boresight gate --json` lists all.", flips.units.len()))
    } else {
        section
    };
    section.folded("List of changed verdicts", table)
}
