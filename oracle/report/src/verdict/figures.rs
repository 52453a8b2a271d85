//! Verdict on figures of any world, by the rule that the key of a figure selects.

use indexmap::IndexMap;
use run::figure_by_name;

use super::rules::{self, Measured};
use super::{Finding, Grade};

/// Rule of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rule {
    /// Rate of wrong answers.
    Wrong,
    /// Rate of correct answers.
    Correct,
    /// Rate of errors within one pixel.
    WithinPixel,
    /// Mean normalised error squared.
    Nees,
    /// Rate of errors within three σ.
    ThreeSigma,
}

impl Rule {
    /// All rules, in the order of their findings.
    const ALL: [Self; 5] = [Self::Wrong, Self::Correct, Self::WithinPixel, Self::Nees, Self::ThreeSigma];

    /// Returns the rule for the key of a figure; `None` for a figure without a general scale. Figures of a
    /// paper's formulas, which are a baseline, have none.
    fn from_key(key: &str) -> Option<Self> {
        let is_baseline = key.starts_with("paper_");
        match key {
            _ if is_baseline => None,
            "wrong_rate" | "false_alarm_rate" => Some(Self::Wrong),
            "correct_rate" | "success_rate" => Some(Self::Correct),
            key if key.ends_with("within_1px") => Some(Self::WithinPixel),
            key if key.ends_with("nees_mean") => Some(Self::Nees),
            key if key.contains("within_3") && key.contains("sigma") => Some(Self::ThreeSigma),
            _ => None,
        }
    }

    /// Grades a figure.
    fn finding(self, subject: &str, measured: Measured) -> Finding {
        match self {
            Self::Wrong => rules::wrong_answers(subject, Some(measured)),
            Self::Correct => rules::correct_answers(subject, Some(measured)),
            Self::WithinPixel => rules::within_one_pixel(subject, Some(measured)),
            Self::Nees => rules::nees(subject, Some(measured)),
            Self::ThreeSigma => rules::within_three_sigma(subject, Some(measured)),
        }
    }
}

/// Grades every figure that has a value and a general scale: wrong answers, correct answers, errors within a
/// pixel, σ. Of several figures of one rule, the poorest is returned with the number of the others.
pub fn judge(figures: &IndexMap<String, Option<Measured>>) -> Vec<Finding> {
    let mut findings = Vec::new();
    for rule in Rule::ALL {
        let of_rule = figures.iter().filter(|(key, _)| Rule::from_key(key) == Some(rule));
        let mut graded: Vec<Finding> = of_rule
            .filter_map(|(key, measured)| Some(rule.finding(&figure_by_name(key).words, (*measured)?)))
            .collect();
        graded.sort_by_key(|finding| finding.grade);
        let others = graded.len().saturating_sub(1);
        if matches!(rule, Rule::Wrong | Rule::Correct) {
            findings.extend(graded);
        } else if let Some(poorest) = graded.into_iter().next() {
            findings.push(with_others(poorest, others));
        }
    }
    findings
}

/// Adds the number of figures of the same rule that are no poorer.
fn with_others(poorest: Finding, others: usize) -> Finding {
    match (others, poorest.grade) {
        (0, _) => poorest,
        (1, Grade::Good) => poorest.and("Another figure of this kind is good too."),
        (1, _) => poorest.and("Another figure of this kind is no poorer."),
        (count, Grade::Good) => poorest.and(&format!("{count} other figures of this kind are good too.")),
        (count, _) => poorest.and(&format!("{count} other figures of this kind are no poorer.")),
    }
}

/// Returns the figures of a score in the form that [`judge`] takes.
pub fn measured(figures: &IndexMap<String, score::Figure>) -> IndexMap<String, Option<Measured>> {
    figures.iter().map(|(key, figure)| (key.clone(), Measured::from_figure(Some(figure)))).collect()
}

#[cfg(test)]
mod tests {
    use score::Figure;

    use super::*;

    #[test]
    fn the_key_of_a_figure_selects_its_rule() {
        let rules =
            ["wrong_rate", "success_rate", "x_within_1px", "motion_nees_mean", "range_within_3_sigma"];
        let found: Vec<Option<Rule>> = rules.iter().map(|key| Rule::from_key(key)).collect();
        assert_eq!(found, Rule::ALL.map(Some));
        assert_eq!(Rule::from_key("paper_nees_mean"), None);
        assert_eq!(Rule::from_key("range_rms_m"), None);
    }

    #[test]
    fn the_poorest_of_several_figures_of_a_rule_is_shown() {
        let figures: IndexMap<String, Figure> = [
            ("a_nees_mean".to_owned(), Figure::mean(&[vec![1.0; 30]])),
            ("b_nees_mean".to_owned(), Figure::mean(&[vec![9.0; 30]])),
            ("c_nees_mean".to_owned(), Figure::mean(&[vec![]])),
        ]
        .into();
        let findings = judge(&measured(&figures));
        assert_eq!(findings.len(), 1);
        let poorest = &findings[0];
        assert!(poorest.grade == Grade::Poor && poorest.text.ends_with("is no poorer."), "{poorest:?}");
    }
}
