//! Verdict on a study: its requirements, its figures over all cases, and the spread between the cases.

use indexmap::IndexMap;
use run::figure_by_name;
use score::Better;
use study::{Estimate, FigureSummary, RequirementResult, RequirementVerdict, Summary};

use super::{label, number};
use crate::figures::words::display_name;
use crate::verdict::figures::judge;
use crate::verdict::rules::Measured;
use crate::verdict::{Finding, Grade, causes_sentence};

/// Returns the findings on a study.
pub(super) fn findings(summary: &Summary) -> Vec<Finding> {
    let mut findings: Vec<Finding> = summary.requirements.iter().map(requirement).collect();
    let all = summary.figures.iter().map(|(key, figure)| {
        let measured = figure.all.as_ref().map(|estimate| measured(estimate, figure.cases));
        (key.clone(), measured)
    });
    findings.extend(with_causes(judge(&all.collect()), summary));
    findings.extend(spread(summary));
    if summary.error_cases > 0 {
        let text = format!(
            "{} of {} cases cannot be run; the figures are without them.",
            summary.error_cases, summary.of
        );
        findings.push(Finding::not_judged("cases that cannot be run", text));
    }
    findings
}

/// Returns an estimate over cases in the form of the rules.
fn measured(estimate: &Estimate, cases: u64) -> Measured {
    Measured { value: estimate.value, low: estimate.low, high: estimate.high, count: None, of: cases }
}

/// Returns the finding on a requirement, whose bounds the study has decided.
fn requirement(result: &RequirementResult) -> Finding {
    let name = &result.requirement.figure;
    let words = result.requirement_words(&label(name), |value| number(name, value));
    let cell = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| number(name, value));
    let text = format!(
        "{}: found {}, bounds {} to {}.",
        result.verdict_words(),
        cell(result.value),
        cell(result.low),
        cell(result.high)
    );
    let grade = match result.verdict {
        RequirementVerdict::Met => Grade::Good,
        RequirementVerdict::NotMet => Grade::Poor,
        RequirementVerdict::NotDecided => Grade::NotJudged,
    };
    Finding::new(grade, format!("requirement {words}"), text)
}

/// Adds the causes of wrong and of missing answers over all cases.
fn with_causes(findings: Vec<Finding>, summary: &Summary) -> Vec<Finding> {
    let of = |kind: &str| -> IndexMap<String, u64> {
        let counted = summary.causes.iter().filter(|(name, _)| name.starts_with(kind));
        counted.map(|(name, cause)| (name.replacen(kind, "", 1), cause.frames)).collect()
    };
    let wrong = causes_sentence(&of("wrong."), display_name);
    let missed = causes_sentence(&of("missed."), display_name);
    let mut of_missed = Some(missed);
    findings
        .into_iter()
        .map(|finding| match finding.is_about_wrong_answers {
            true => finding.and(&wrong),
            // The first finding on other than wrong answers is that on correct ones.
            false => finding.and(&of_missed.take().unwrap_or_default()),
        })
        .collect()
}

/// Returns the finding on the worst twentieth of the cases, by the figure that ranks them; `None` if the
/// figure has no scale.
fn spread(summary: &Summary) -> Option<Finding> {
    let name = &summary.worst_by;
    let figure: &FigureSummary = summary.figures.get(name)?;
    let spec = figure_by_name(name);
    let worst = match spec.sense.better {
        Better::More => figure.p05.as_ref()?,
        Better::Less | Better::Near(_) => figure.p95.as_ref()?,
    };
    let one: IndexMap<String, Option<Measured>> =
        [(name.clone(), Some(measured(worst, figure.cases)))].into();
    let graded = judge(&one).pop()?;
    let subject = format!("{} in the worst cases", spec.words);
    if graded.grade == Grade::NotJudged {
        return Some(Finding { subject, ..graded });
    }
    let side = if spec.sense.better == Better::More { "below" } else { "above" };
    let text = format!(
        "5\u{a0}% of the cases are {side} {}; the scale is that of the figure over all cases.",
        number(name, worst.value)
    );
    let finding = Finding { subject, text, is_about_wrong_answers: false, ..graded };
    let case = summary
        .worst
        .first()
        .map(|worst| format!("The worst is case {} with {}.", worst.case, number(name, worst.value)));
    Some(finding.and(&case.unwrap_or_default()))
}
