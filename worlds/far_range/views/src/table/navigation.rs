//! Text output of relative navigation for a user.
use comfy_table::Cell;
use navigate::{Axis, BoundReport, NavigationBudget, NavigationResult};
use view::terminal::{finish, percent, plain_table, wrapped};

/// Number of characters of a time to the second.
const TIME_LENGTH: usize = 19;

/// Returns the figures of a relative orbit determination as text. Ends with a line feed.
pub fn navigation_table(result: &NavigationResult, styled: bool) -> String {
    let score = &result.score;
    let mut text = wrapped(&format!(
        "{}, {}: {} lines of sight, {} manoeuvres; {} of {} times have an estimate\n",
        result.scenario,
        result.estimator,
        result.lines_of_sight,
        result.manoeuvres,
        score.estimates,
        score.requested
    ));
    if !score.position_m.is_empty() {
        let mut table = plain_table(styled);
        table.set_header(["error", "unit", "rms", "mean", "largest", "σ (rms)", "within 3 σ"]);
        let mut add = |name: String, unit: &str, axis: &Axis| {
            let cells = [axis.rms, axis.mean, axis.largest, axis.sigma_rms].map(number);
            let mut row = vec![name, unit.to_owned()];
            row.extend(cells);
            row.push(format!("{} %", percent(axis.within_3_sigma)));
            table.add_row(row.into_iter().map(Cell::new));
        };
        for (name, axis) in &score.position_m {
            add(name.to_uppercase(), "m", axis);
        }
        for (name, axis) in &score.velocity_m_s {
            add(format!("velocity {}", name.to_uppercase()), "m/s", axis);
        }
        for (name, axis) in &score.elements_m {
            add(element(name), "m", axis);
        }
        text.push_str(&finish(table));
    }
    let shown = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), number);
    let mut lines = format!(
        "NEES per dimension: position {}, position and velocity {}, elements {} (1 is consistent)\n",
        shown(score.nees_position_per_dimension),
        shown(score.nees_state_per_dimension),
        shown(score.nees_elements_per_dimension)
    );
    if let Some(before) = &score.before_report {
        lines.push_str(&format!(
            "Between a manoeuvre and its report: {} estimates; NEES per dimension of the others: position {}, \
             position and velocity {}\n",
            before.estimates,
            shown(before.others_nees_position_per_dimension),
            shown(before.others_nees_state_per_dimension)
        ));
    }
    lines.push_str(&format!(
        "Distance: error {} % rms, {} % at the end; below 1 % after {}\n",
        shown(score.range_error_rms_percent),
        shown(score.range_error_end_percent),
        score.convergence_s.map_or_else(|| "–".to_owned(), |seconds| format!("{:.1} h", seconds / 3600.0))
    ));
    for (name, counts) in [("Measurements", &score.measurements), ("No estimate", &score.unanswered)] {
        if !counts.is_empty() {
            let counts: Vec<String> =
                counts.iter().map(|(name, count)| format!("{count} {}", name.replace('_', " "))).collect();
            lines.push_str(&format!("{name}: {}\n", counts.join(", ")));
        }
    }
    text.push_str(&wrapped(&lines));
    text
}

/// Returns the bound of a campaign as text. Ends with a line feed.
pub fn bound_table(report: &BoundReport, styled: bool) -> String {
    let undetermined = |value: Option<f64>, unit: &str| {
        value.map_or_else(|| "undetermined".to_owned(), |value| format!("{}{unit}", number(value)))
    };
    let mut text = format!(
        "{}: {} lines of sight, {} manoeuvres\n\
         Without a prior: condition number {}, σ of aδλ {}\n\
         Smallest standard deviation along R, T, N (posterior Cramér–Rao bound), m\n",
        report.scenario,
        report.lines_of_sight,
        report.manoeuvres,
        undetermined(report.condition, ""),
        undetermined(report.range_sigma_percent, " %")
    );
    let mut table = plain_table(styled);
    table.set_header(["time, UTC", "distance, m", "R until then", "T", "N", "R from all", "T", "N"]);
    for bound in &report.bounds {
        let mut row: Vec<String> =
            vec![bound.time_utc.chars().take(TIME_LENGTH).collect(), format!("{:.0}", bound.range_m)];
        for sigmas in [bound.filter_m, bound.batch_m] {
            match sigmas {
                Some(sigmas) => row.extend(sigmas.map(number)),
                None => row.extend(["–"; 3].map(str::to_owned)),
            }
        }
        table.add_row(row.into_iter().map(Cell::new));
    }
    text.push_str(&finish(table));
    text
}

/// Returns the error budget of a navigation as text. Ends with a line feed.
pub fn budget_table(budget: &NavigationBudget, styled: bool) -> String {
    let mut text = format!(
        "{}, {}: {} estimates; parts of the error along R, T, N\n",
        budget.scenario, budget.navigator, budget.estimates
    );
    let mut table = plain_table(styled);
    table.set_header(["cause", "R rms, m", "T", "N", "R share, %", "T", "N"]);
    for part in &budget.parts {
        let mut row = vec![part.cause.replace('_', " ")];
        row.extend(part.rms_m.map(number));
        row.extend(part.share.map(|share| format!("{:.1}", 100.0 * share)));
        table.add_row(row.into_iter().map(Cell::new));
    }
    let mut row = vec!["error".to_owned()];
    row.extend(budget.rms_m.map(number));
    row.extend(["100.0"; 3].map(str::to_owned));
    table.add_row(row.into_iter().map(Cell::new));
    text.push_str(&finish(table));
    text
}

/// Returns the notation of an element, from its name in files.
fn element(name: &str) -> String {
    let greek = name.trim_end_matches("_m").replace("a_dlambda", "aδλ");
    greek.replace("a_d", "aδ")
}

/// Formats a number with three significant digits, or all digits before the decimal point.
fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-4..1e7).contains(&size) {
        let digits = (2 - libm::log10(size).floor() as i32).max(0) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.2e}")
    }
}
