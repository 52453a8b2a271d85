//! Text output of a gate for a user.
use comfy_table::{Attribute, Cell};
use gate::{Baseline, FigureReport, FigureVerdict, Flip, GateReport, Pairing};
use pipeline::external::protocol::harmless;
use run::figure_by_name;
use view::terminal::{finish, percent, plain_table, wrapped};

/// Maximum number of changed units that are printed; the JSON contains all of them.
const MAX_CHANGED_UNITS: usize = 10;

/// Maximum number of rows of the table, unless more figures are worse or better.
const MAX_ROWS: usize = 20;

/// The remedy for a changed figure, within 80 columns.
const HOW_TO_ACCEPT: &str = "If the change is intended, state it: --accept-changed --reason \"…\"\n";

/// Returns a report as text: one row per figure, then the changed units. Ends with a line feed.
pub fn gate_table(report: &GateReport, styled: bool) -> String {
    let mut table = plain_table(styled);
    let bold = |text: &str| Cell::new(text).add_attribute(Attribute::Bold);
    table.set_header(
        ["figure", "baseline", "result", "difference (95 %)", "adjusted p", "verdict", "visible"].map(bold),
    );
    let rows = rows(report);
    for (name, figure) in &rows {
        let value = |value: Option<f64>| value.map_or("–".to_owned(), |value| number(name, value));
        let verdict = Cell::new(figure.verdict.words());
        let is_plain = matches!(figure.verdict, FigureVerdict::NoWorse | FigureVerdict::TooLittleData);
        table.add_row([
            Cell::new(figure_by_name(name).label_without_percent()),
            Cell::new(value(figure.baseline)),
            Cell::new(value(figure.result)),
            Cell::new(difference(name, figure)),
            Cell::new(format!("{:.3}", figure.adjusted_p)),
            if is_plain { verdict } else { verdict.add_attribute(Attribute::Bold) },
            Cell::new(figure.smallest_visible.map_or("none".to_owned(), |size| number(name, size))),
        ]);
    }
    let worse: Vec<String> = report.worse_figures().map(|name| figure_by_name(name).words).collect();
    let differing: Vec<String> = report.changed_figures().map(|name| figure_by_name(name).words).collect();
    let verdict = match (worse.is_empty(), differing.is_empty(), &report.accepted) {
        (false, _, _) => format!("WORSE: {}", worse.join(", ")),
        (true, true, _) => "no worse".to_owned(),
        (true, false, None) => format!("CHANGED: {}", differing.join(", ")),
        (true, false, Some(reason)) => {
            format!("changed, accepted ({}): {}", harmless(reason), differing.join(", "))
        }
    };
    let paired = match report.pairing {
        Pairing::Frames => format!("the same {}", report.units),
        Pairing::Blocks => format!(
            "different noise (seeds {} and {}), compared by time span",
            report.baseline_seed, report.result_seed
        ),
    };
    let mut text = wrapped(&format!("{}: {verdict}\n", report.name));
    if report.verdict == FigureVerdict::Changed && report.accepted.is_none() {
        text.push_str(HOW_TO_ACCEPT);
    }
    text.push_str(&finish(table));
    text.push_str(&wrapped(&format!(
        "{} {} in {} blocks; {paired}. Worse: p, adjusted for all figures, is at most {}, and the worsening \
         exceeds the tolerance; or, for a rate on the same frames, losses in a row or an excess of losses that \
         chance does not explain. Changed: a figure with a best value (a bias) differs as significantly from the \
         baseline, but is no farther from that value. Visible: smallest worsening that is detected with a \
         probability of 95 % or more; none with too little data. Rates in percent.\n\
         Baseline: {}\n",
        report.count, report.units, report.blocks, report.alpha, report.reason,
    )));
    let left_out = report.figures.len() - rows.len();
    if left_out > 0 {
        text.push_str(&format!(
            "Not shown: {left_out} more figures, none worse or better; --json lists them.\n"
        ));
    }
    for note in &report.notes {
        text.push_str(&wrapped(&format!("Note: {note}\n")));
    }
    if let Some(flips) = &report.flips {
        let (lost, won, other) = (flips.lost, flips.won, flips.other);
        text.push_str(&format!("\n{} lost, {won} won, {other} changed otherwise", lost));
        if flips.units.is_empty() {
            text.push('\n');
        } else {
            text.push_str(if flips.units.len() > MAX_CHANGED_UNITS { ", the first ten:\n" } else { ":\n" });
            text.push_str(&flipped_units(&flips.units, styled));
        }
    }
    text
}

/// Returns the figures to show, in the report's order: all figures with a notable verdict, and from the
/// remaining figures those nearest to one.
fn rows(report: &GateReport) -> Vec<(&String, &FigureReport)> {
    let is_silent = |figure: &FigureReport| {
        matches!(figure.verdict, FigureVerdict::NoWorse | FigureVerdict::TooLittleData)
    };
    let with_values = report.figures.iter().filter(|(_, figure)| figure.baseline.or(figure.result).is_some());
    let mut by_rank: Vec<(&String, &FigureReport)> = with_values.collect();
    by_rank.sort_by(|a, b| {
        let rank = |figure: &FigureReport| (is_silent(figure), figure.p.min(1.0 - figure.p));
        let (a, b) = (rank(a.1), rank(b.1));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let spoken = by_rank.iter().filter(|(_, figure)| !is_silent(figure)).count();
    by_rank.truncate(spoken.max(MAX_ROWS));
    by_rank.sort_by_key(|(name, _)| report.figures.get_index_of(*name));
    by_rank
}

fn flipped_units(flips: &[Flip], styled: bool) -> String {
    let mut table = plain_table(styled);
    let bold = |text: &str| Cell::new(text).add_attribute(Attribute::Bold);
    table.set_header(["number", "group", "baseline", "result"].map(bold));
    let shown = |verdict: &str, cause: &Option<String>| {
        cause
            .as_ref()
            .map_or_else(|| verdict.to_owned(), |cause| format!("{verdict}: {}", cause.replace('_', " ")))
    };
    for flip in flips.iter().take(MAX_CHANGED_UNITS) {
        table.add_row([
            flip.number.to_string(),
            flip.group.clone(),
            shown(&flip.baseline, &flip.baseline_cause),
            shown(&flip.result, &flip.result_cause),
        ]);
    }
    finish(table)
}

fn difference(name: &str, figure: &FigureReport) -> String {
    let Some(difference) = figure.difference else { return "–".to_owned() };
    match (figure.low, figure.high) {
        (Some(low), Some(high)) => {
            format!("{} ({} to {})", signed(name, difference), signed(name, low), signed(name, high))
        }
        _ => signed(name, difference),
    }
}

/// Returns a description of a baseline as text. Ends with a line feed.
pub fn baseline_text(baseline: &Baseline) -> String {
    let header = &baseline.header;
    let (run, rule) = (&header.run, &header.blocks);
    let units = run.kind.units(&run.world);
    let remembers = if rule.memory_of.is_empty() {
        "no figure is correlated in time".to_owned()
    } else {
        format!(
            "{} has the longest correlation, {} {units}",
            figure_by_name(&rule.memory_of).words,
            rule.memory
        )
    };
    wrapped(&format!(
        "{} with seed {}: {} {units} in {} blocks of about {}; {remembers}\n",
        run.name, run.seed, header.units, rule.count, rule.length
    ))
}

fn signed(name: &str, value: f64) -> String {
    let text = number(name, value);
    if value > 0.0 { format!("+{text}") } else { text }
}

fn number(name: &str, value: f64) -> String {
    if figure_by_name(name).is_rate() {
        return percent(value);
    }
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (0.01..1e5).contains(&size) {
        // Three significant digits, or all digits before the decimal point.
        let digits = (2 - libm::log10(size).floor() as i32).max(0) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.1e}")
    }
}
