//! Verdict on a far-range run.

use ::report::figures::words::display_name;
use ::report::verdict::rules::{self, Measured};
use ::report::verdict::{Finding, causes_sentence};
use far_range::scoring::{Cause, Score, names};

/// Arcseconds in a degree.
const ARCSEC: f64 = 3600.0;

/// Returns the findings on a score: wrong answers, misses, errors of direction and image, σ.
pub fn findings(score: &Score) -> Vec<Finding> {
    let measured = |name: &str| Measured::from_figure(score.figures.get(name));
    let mut findings = vec![
        wrong_answers(score),
        rules::correct_answers("correct answers", measured(names::CORRECT_RATE)).and(&misses(score)),
    ];
    findings.push(match measured(names::FALSE_ALARM_RATE) {
        None => Finding::not_judged("false alarms", "No frame is without a visible target."),
        found => rules::wrong_answers("false alarms", found),
    });
    findings.push(direction(score, "columns", [names::RA_WITHIN_1PX, names::RA_RMS_DEG, names::RA_MEAN_DEG]));
    findings.push(direction(score, "rows", [names::DEC_WITHIN_1PX, names::DEC_RMS_DEG, names::DEC_MEAN_DEG]));
    for (axis, rms, mean) in [
        ("columns", names::CENTROID_X_RMS_PX, names::CENTROID_X_MEAN_PX),
        ("rows", names::CENTROID_Y_RMS_PX, names::CENTROID_Y_MEAN_PX),
    ] {
        let subject = format!("position in the image across {axis}");
        findings.push(rules::image_error(&subject, measured(rms), measured(mean)));
    }
    findings.extend(honesty(score));
    findings
}

/// Returns the finding on wrong measurements, with what was taken for the target.
fn wrong_answers(score: &Score) -> Finding {
    let measured = Measured::from_figure(score.figures.get(names::WRONG_RATE));
    let taken: Vec<String> = score
        .wrong_taken
        .iter()
        .map(|(object, count)| format!("{} ({count})", display_name(object)))
        .collect();
    let taken = match taken.is_empty() {
        true => String::new(),
        false => format!("Taken for the target: {}.", taken.join(", ")),
    };
    rules::wrong_answers("wrong answers", measured)
        .and(&taken)
        .and(&causes_sentence(&score.wrong, display_name))
}

/// Returns the sentences on misses: their causes, and how many of them no pipeline could avoid.
fn misses(score: &Score) -> String {
    let total: u64 = score.misses.values().sum();
    if total == 0 {
        return "No frame is missed.".to_owned();
    }
    let is_undetectable = |code: &str| Cause::parse(code).is_some_and(Cause::is_undetectable);
    let unavoidable: u64 =
        score.misses.iter().filter(|(code, _)| is_undetectable(code)).map(|(_, count)| count).sum();
    let unavoidable = match unavoidable {
        0 => String::new(),
        count => format!(" The image has too little of the target in {count} of them."),
    };
    format!("{total} missed. {}{unavoidable}", causes_sentence(&score.misses, display_name))
}

/// Returns the finding on the error of the direction across columns or rows, against one pixel.
fn direction(score: &Score, axis: &str, [within, rms, mean]: [&str; 3]) -> Finding {
    let subject = format!("direction across {axis}");
    let figure = score.figures.get(within);
    let Some(measured) = Measured::from_figure(figure) else {
        return Finding::not_judged(subject, "No measurement has a line of sight.");
    };
    let value = |name: &str| score.figures.get(name).and_then(|figure| figure.value);
    let limit = figure.and_then(|figure| figure.limit_deg).map_or_else(String::new, |limit| {
        format!("Rate of errors below one pixel ({}).", score::angle(limit))
    });
    let bias = match value(rms) {
        Some(rms) => rules::bias_sentence(ARCSEC * rms, value(mean).map(|mean| ARCSEC * mean), "″"),
        None => String::new(),
    };
    rules::within_one_pixel(&subject, Some(measured)).and(&limit).and(&bias)
}

/// Returns the findings on the covariances, or the reason why there are none.
fn honesty(score: &Score) -> Vec<Finding> {
    let measured = |name: &str| Measured::from_figure(score.figures.get(name));
    let kinds = [
        ("σ of the position in the image", names::CENTROID_NEES_MEAN),
        ("σ of the direction", names::LINE_OF_SIGHT_NEES_MEAN),
    ];
    let stated: Vec<Finding> = kinds
        .into_iter()
        .filter_map(|(subject, name)| Some(rules::nees(subject, Some(measured(name)?))))
        .collect();
    if stated.is_empty() {
        return vec![Finding::not_judged("σ", "No correct measurement states a covariance.")];
    }
    stated
}
