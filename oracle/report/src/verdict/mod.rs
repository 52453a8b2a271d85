//! Verdict of a report: which results are good, which are not, why, and against what.
//!
//! Every finding comes from a rule of [`rules`], which holds all thresholds.

pub mod figures;
pub mod rules;

use indexmap::IndexMap;

use crate::figures::words::capital;

/// Number of causes that a finding names; the others are counted together.
const NAMED_CAUSES: usize = 4;

/// Grade of a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Grade {
    /// Worse than the limit of a fair result.
    Poor,
    /// Between the limits.
    Fair,
    /// As expected, or better.
    Good,
    /// Not measured, measured too rarely for a grade, or without a scale.
    NotJudged,
}

impl Grade {
    /// All grades, in the order of a page.
    pub const ALL: [Self; 4] = [Self::Poor, Self::Fair, Self::Good, Self::NotJudged];

    /// Returns the grade in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Poor => "poor",
            Self::Fair => "fair",
            Self::Good => "good",
            Self::NotJudged => "not judged",
        }
    }

    /// Returns the class of the grade in the style sheet.
    pub fn class(self) -> &'static str {
        match self {
            Self::Poor => "poor",
            Self::Fair => "fair",
            Self::Good => "good",
            Self::NotJudged => "unjudged",
        }
    }
}

/// A graded result.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// Grade.
    pub grade: Grade,
    /// Result that is graded, in words.
    pub subject: String,
    /// Value, scale and reason, as sentences.
    pub text: String,
    /// True if the finding is about wrong answers, which come first.
    pub is_about_wrong_answers: bool,
}

impl Finding {
    /// Creates a finding.
    pub fn new(grade: Grade, subject: impl Into<String>, text: impl Into<String>) -> Self {
        Self { grade, subject: subject.into(), text: text.into(), is_about_wrong_answers: false }
    }

    /// Creates a finding on a result without a grade, with the reason.
    pub fn not_judged(subject: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::new(Grade::NotJudged, subject, reason)
    }

    /// Marks the finding as one about wrong answers.
    #[must_use]
    pub fn about_wrong_answers(mut self) -> Self {
        self.is_about_wrong_answers = true;
        self
    }

    /// Appends a sentence; an empty one changes nothing.
    #[must_use]
    pub fn and(mut self, sentence: &str) -> Self {
        if !sentence.is_empty() {
            self.text.push(' ');
            self.text.push_str(sentence);
        }
        self
    }
}

/// Findings on a result, in the order of a page: wrong answers first, then from poor to not judged.
#[derive(Debug, Clone, Default)]
pub struct Verdict {
    findings: Vec<Finding>,
}

impl Verdict {
    /// Orders findings; within a grade they keep their order.
    pub fn new(mut findings: Vec<Finding>) -> Self {
        findings.sort_by_key(|finding| (!finding.is_about_wrong_answers, finding.grade));
        Self { findings }
    }

    /// Returns the findings in order.
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// Returns one line per grade that occurs: the grade and its subjects, such as `Wrong answers; errors
    /// across rows`.
    pub fn summary(&self) -> Vec<(Grade, String)> {
        let mut lines = Vec::new();
        for grade in Grade::ALL {
            let subjects: Vec<&str> = self
                .findings
                .iter()
                .filter(|finding| finding.grade == grade)
                .map(|finding| finding.subject.as_str())
                .collect();
            if !subjects.is_empty() {
                lines.push((grade, capital(&subjects.join("; "))));
            }
        }
        lines
    }
}

/// Returns a sentence that names the most frequent causes with their counts; empty without causes. `words`
/// returns the words of a cause.
pub fn causes_sentence(counts: &IndexMap<String, u64>, words: fn(&str) -> String) -> String {
    let mut sorted: Vec<(&String, u64)> = counts.iter().map(|(cause, count)| (cause, *count)).collect();
    sorted.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let named: Vec<String> = sorted
        .iter()
        .take(NAMED_CAUSES)
        .map(|(cause, count)| format!("{} ({count})", words(cause)))
        .collect();
    let others: u64 = sorted.iter().skip(NAMED_CAUSES).map(|(_, count)| count).sum();
    match (named.as_slice(), others) {
        ([], _) => String::new(),
        ([only], 0) => format!("Cause: {only}."),
        (_, 0) => format!("Causes: {}.", named.join(", ")),
        _ => format!("Causes: {}, others ({others}).", named.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_answers_come_first_and_then_the_poorest() {
        let verdict = Verdict::new(vec![
            Finding::new(Grade::Good, "a", ""),
            Finding::new(Grade::Poor, "b", ""),
            Finding::new(Grade::Good, "wrong", "").about_wrong_answers(),
            Finding::not_judged("c", ""),
        ]);
        let order: Vec<&str> = verdict.findings().iter().map(|finding| finding.subject.as_str()).collect();
        assert_eq!(order, ["wrong", "b", "a", "c"]);
        let summary = verdict.summary();
        assert_eq!(summary[1], (Grade::Good, "Wrong; a".to_owned()));
    }

    #[test]
    fn the_most_frequent_causes_are_named_with_counts() {
        let counts: IndexMap<String, u64> =
            [("a", 1), ("b", 9), ("c", 3), ("d", 2), ("e", 1)].map(|(name, n)| (name.to_owned(), n)).into();
        let words = |code: &str| code.to_uppercase();
        assert_eq!(causes_sentence(&counts, words), "Causes: B (9), C (3), D (2), A (1), others (1).");
        assert_eq!(causes_sentence(&IndexMap::new(), words), "");
    }
}
