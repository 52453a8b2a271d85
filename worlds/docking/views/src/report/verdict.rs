//! Verdict on a docking run.

use ::report::figures::words::display_name;
use ::report::verdict::rules::{self, Measured};
use ::report::verdict::{Finding, causes_sentence};
use docking::scoring::{DockingScore, names};

/// Errors that are compared with those of the paper's formulas: subject, figure, unit, and the factor from
/// the figure to the unit.
const COMPARED: [(&str, &str, &str, f64); 4] = [
    ("range", names::RANGE_RMS_M, "mm", 1000.0),
    ("position across the line of sight", names::LATERAL_RMS_M, "mm", 1000.0),
    ("attitude", names::ATTITUDE_RMS_DEG, "°", 1.0),
    ("range rate of the motion", "motion_range_rate_rms_m_s", "mm/s", 1000.0),
];

/// Returns the findings on a score: wrong poses, measured fields, errors against the paper's formulas, σ.
pub fn findings(score: &DockingScore) -> Vec<Finding> {
    let measured = |name: &str| Measured::from_figure(score.figures.get(name));
    let wrong = rules::wrong_answers("grossly wrong poses", measured(names::WRONG_RATE));
    let success = rules::correct_answers("measured poses", measured(names::SUCCESS_RATE));
    let mut findings = vec![
        wrong.and(&causes_sentence(&score.wrong, display_name)),
        success
            .and("Of the fields in which the target is resolved.")
            .and(&counted("Missed", &score.misses))
            .and(&counted("Doubtful by the pipeline's own tests", &score.doubtful)),
    ];
    for (subject, name, unit, factor) in COMPARED {
        let error = measured(name).map(|error| scaled(error, factor));
        let baseline = measured(&paper_name(name)).map(|error| factor * error.value);
        findings.push(rules::against_baseline(
            subject,
            error,
            baseline.map(|baseline| ("the RMS of the paper's formulas", baseline)),
            unit,
        ));
    }
    findings.push(rules::nees("σ of single fields", measured(names::NEES_MEAN)));
    findings
        .push(rules::nees("σ of the motion", measured(&format!("{}{}", names::MOTION, names::NEES_MEAN))));
    findings
}

/// Returns the key of the same figure of the paper's formulas.
fn paper_name(name: &str) -> String {
    format!("{}{name}", names::PAPER)
}

/// Returns a figure in another unit.
fn scaled(measured: Measured, factor: f64) -> Measured {
    let by = |value: Option<f64>| value.map(|value| factor * value);
    Measured { value: factor * measured.value, low: by(measured.low), high: by(measured.high), ..measured }
}

/// Returns a sentence with a number of fields and their causes; empty if there is none.
fn counted(what: &str, causes: &indexmap::IndexMap<String, u64>) -> String {
    match causes.values().sum::<u64>() {
        0 => String::new(),
        total => format!("{what}: {total}. {}", causes_sentence(causes, display_name)),
    }
}
