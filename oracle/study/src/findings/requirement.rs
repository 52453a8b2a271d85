//! Requirements on a study: decides whether a figure is on the required side of its limit, with the requested
//! confidence.

use indexmap::IndexMap;
use run::figure_by_name;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use statistics::{Bounds, ClusterValue, cluster_mean_bounds, cluster_quantile_bounds, cluster_rate_bounds};

use super::estimate::{ratio, sorted_quantile, sums};
use crate::cases::CaseFigure;

/// Largest number of cases for which the number needed for a decision is computed.
const MAX_CASES: f64 = 1e9;

/// Requirement on a figure. It is decided separately at each point of the sweep. It is not part of the
/// study's hash, since the rows do not depend on requirements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudyRequirement {
    /// Name of a figure of the score, as in `correct_rate`.
    pub figure: String,
    /// Lower limit, in the figure's unit; for a rate the fraction, not percent. Exactly one of `at_least` and
    /// `at_most` is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -1e18, max = 1e18))]
    pub at_least: Option<f64>,
    /// Upper limit, as `at_least`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -1e18, max = 1e18))]
    pub at_most: Option<f64>,
    /// Statistic that has the limit: all cases together (a rate over all frames, the mean over the cases for
    /// another figure), or a quantile of the cases.
    #[serde(default)]
    pub of: RequiredStatistic,
    /// Confidence of the decision, one-sided.
    #[serde(default = "default_confidence")]
    #[schemars(range(min = 0.5, max = 0.9999))]
    pub confidence: f64,
}

const fn default_confidence() -> f64 {
    0.95
}

/// Statistic of a figure's cases that has a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RequiredStatistic {
    /// All cases together.
    #[default]
    All,
    /// The value below which 5 % of the cases lie.
    P05,
    /// The median of the cases.
    Median,
    /// The value below which 95 % of the cases lie.
    P95,
}

impl RequiredStatistic {
    fn quantile(self) -> Option<f64> {
        match self {
            Self::All => None,
            Self::P05 => Some(0.05),
            Self::Median => Some(0.5),
            Self::P95 => Some(0.95),
        }
    }

    /// Returns the words that precede the figure's label: empty for all cases together.
    pub fn words(self) -> &'static str {
        match self {
            Self::All => "",
            Self::P05 => "5 % quantile of ",
            Self::Median => "median of ",
            Self::P95 => "95 % quantile of ",
        }
    }
}

/// Limit of a figure, and the side on which it is allowed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Limit {
    /// The figure is at least this value.
    AtLeast(f64),
    /// The figure is at most this value.
    AtMost(f64),
}

impl StudyRequirement {
    /// Returns the limit of the requirement.
    ///
    /// # Errors
    /// The wrong field, and the expected value.
    pub fn limit(&self) -> Result<Limit, (&'static str, &'static str)> {
        match (self.at_least, self.at_most) {
            (Some(limit), None) => Ok(Limit::AtLeast(limit)),
            (None, Some(limit)) => Ok(Limit::AtMost(limit)),
            (Some(_), Some(_)) => Err(("at_most", "is given beside at_least, expected only one of the two")),
            (None, None) => Err(("figure", "has no limit, expected at_least or at_most")),
        }
    }

    /// Checks that the limit of a rate is a fraction: a limit in percent would never be met, or always.
    ///
    /// # Errors
    /// The wrong field, and the expected value.
    pub(crate) fn check_unit(&self) -> Result<(), (&'static str, String)> {
        if !figure_by_name(&self.figure).is_rate() {
            return Ok(());
        }
        let limits = [("at_least", self.at_least), ("at_most", self.at_most)];
        let wrong = limits.iter().find_map(|(field, limit)| {
            limit.filter(|limit| !(0.0..=1.0).contains(limit)).map(|limit| (*field, limit))
        });
        wrong.map_or(Ok(()), |(field, limit)| Err((field, fraction_words(&self.figure, limit, 1.0))))
    }
}

/// Verdict on a requirement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RequirementVerdict {
    /// Both bounds are on the allowed side of the limit.
    Met,
    /// Both bounds are on the wrong side of the limit.
    NotMet,
    /// The limit lies between the bounds, or a bound is missing: no decision at the requested confidence.
    NotDecided,
}

/// A requirement with its verdict, bounds and cases.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RequirementResult {
    /// The requirement.
    #[serde(flatten)]
    pub requirement: StudyRequirement,
    /// Swept values, by path, at which the requirement was decided; empty without a sweep.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub at: IndexMap<String, String>,
    /// The verdict.
    pub verdict: RequirementVerdict,
    /// Estimated value; absent if no case has the figure.
    pub value: Option<f64>,
    /// Lower bound: the value is at least this with the confidence of the requirement; absent if there are
    /// too few cases.
    pub low: Option<f64>,
    /// Upper bound: the value is at most this with the confidence of the requirement; absent if there are too
    /// few cases.
    pub high: Option<f64>,
    /// Number of cases used for the decision.
    pub cases: u64,
    /// Number of these cases in which the figure has no value (for a position error, a case without a hit).
    /// In a quantile they count as worse than the limit; with a mean they prevent a requirement from being
    /// met.
    pub without_value: u64,
    /// Approximate number of cases that would decide the requirement if further cases resembled these; absent
    /// when it is decided, or when no number would be enough.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cases_needed: Option<u64>,
}

impl RequirementResult {
    /// Returns the requirement in words, as in `5 % quantile of correct rate, % ≥ 95.0 % (confidence 95 %)`;
    /// `label` is the figure's name, `number` formats one of its values.
    pub fn requirement_words(&self, label: &str, number: impl Fn(f64) -> String) -> String {
        let StudyRequirement { at_least, at_most, of, confidence, .. } = &self.requirement;
        let limits = [("≥", at_least), ("≤", at_most)];
        let limits: String = limits
            .iter()
            .filter_map(|(sign, limit)| limit.map(|limit| format!(" {sign} {}", number(limit))))
            .collect();
        format!("{}{label}{limits} (confidence {} %)", of.words(), 100.0 * confidence)
    }

    /// Returns the swept values at which the requirement was decided, as in `sensor.read_noise_e = 5`; empty
    /// without a sweep.
    pub fn at_words(&self) -> String {
        swept_words(&self.at)
    }

    /// Returns the verdict in words, with the number of cases that are needed and of those without a value.
    pub fn verdict_words(&self) -> String {
        let mut words = match (self.verdict, self.cases_needed) {
            (RequirementVerdict::Met, _) => "met".to_owned(),
            (RequirementVerdict::NotMet, _) => "not met".to_owned(),
            (RequirementVerdict::NotDecided, Some(cases)) => {
                format!("not decided: needs about {cases} cases, has {}", self.cases)
            }
            (RequirementVerdict::NotDecided, None) if self.cases == 0 => {
                "not decided: no case can be run".to_owned()
            }
            (RequirementVerdict::NotDecided, None) => "not decided".to_owned(),
        };
        if self.without_value > 0 {
            words.push_str(&format!(" ({} of {} cases without a value)", self.without_value, self.cases));
        }
        words
    }
}

/// Returns the message about a number of a rate that is no fraction from 0 to `most`; percent are converted.
pub(crate) fn fraction_words(figure: &str, value: f64, most: f64) -> String {
    let remedy = if value > most && value <= 100.0 * most {
        // Rounded to the digits of a number that a user writes: 99.9 % is 0.999.
        format!("; write {} for {value} %", (1e10 * value).round() / 1e12)
    } else {
        String::new()
    };
    format!("is {value}, expected a fraction from 0 to {most}, because {figure} is a rate{remedy}")
}

/// Returns swept values in words, as in `sensor.read_noise_e = 5, psf.sigma_px = 0.8`.
pub(super) fn swept_words(at: &IndexMap<String, String>) -> String {
    at.iter().map(|(path, value)| format!("{path} = {value}")).collect::<Vec<_>>().join(", ")
}

/// Decides a requirement over the cases at one point of the sweep: `figures` has the figure of each case that
/// can be run, `draws` the number of its draw.
pub(crate) fn decide(
    requirement: &StudyRequirement,
    figures: &[CaseFigure],
    draws: &[usize],
    at: &IndexMap<String, String>,
) -> Option<RequirementResult> {
    let limit = requirement.limit().ok()?;
    let sample = Sample::new(requirement, limit, figures, draws);
    let without_value = figures.iter().filter(|figure| figure.value.is_none()).count() as u64;
    let bounds = sample.bounds(requirement.confidence, 1.0);
    let may_be_met = matches!(sample, Sample::Quantile { .. } | Sample::Rate(_)) || without_value == 0;
    let verdict = verdict(limit, bounds, may_be_met);
    let cases = figures.len() as u64;
    let is_open = verdict == RequirementVerdict::NotDecided && may_be_met;
    Some(RequirementResult {
        requirement: requirement.clone(),
        at: at.clone(),
        verdict,
        value: sample.value().filter(|value| value.is_finite()),
        low: bounds.and_then(|bounds| bounds.low).filter(|low| low.is_finite()),
        high: bounds.and_then(|bounds| bounds.high).filter(|high| high.is_finite()),
        cases,
        without_value,
        cases_needed: is_open.then(|| sample.cases_needed(limit, requirement.confidence, cases)).flatten(),
    })
}

fn verdict(limit: Limit, bounds: Option<Bounds>, may_be_met: bool) -> RequirementVerdict {
    let (low, high) = bounds.map_or((None, None), |bounds| (bounds.low, bounds.high));
    let (is_met, is_missed) = match limit {
        Limit::AtLeast(limit) => (low.is_some_and(|low| low >= limit), high.is_some_and(|high| high < limit)),
        Limit::AtMost(limit) => (high.is_some_and(|high| high <= limit), low.is_some_and(|low| low > limit)),
    };
    match (is_met && may_be_met, is_missed) {
        (true, _) => RequirementVerdict::Met,
        (false, true) => RequirementVerdict::NotMet,
        (false, false) => RequirementVerdict::NotDecided,
    }
}

/// Statistic by which a requirement is decided, with its values.
enum Sample {
    Rate(Vec<statistics::ClusterSum>),
    Mean(Vec<statistics::ClusterSum>),
    Quantile { sorted: Vec<ClusterValue>, p: f64 },
}

impl Sample {
    fn new(requirement: &StudyRequirement, limit: Limit, figures: &[CaseFigure], draws: &[usize]) -> Self {
        let is_rate = figure_by_name(&requirement.figure).is_rate();
        match requirement.of.quantile() {
            None if is_rate => Self::Rate(sums(true, figures, draws)),
            None => Self::Mean(sums(false, figures, draws)),
            Some(p) => {
                let worse = match limit {
                    Limit::AtLeast(_) => f64::NEG_INFINITY,
                    Limit::AtMost(_) => f64::INFINITY,
                };
                let value = |figure: &CaseFigure| figure.value.unwrap_or(worse);
                let mut sorted: Vec<ClusterValue> =
                    draws.iter().copied().zip(figures.iter().map(value)).collect();
                sorted.sort_by(|a, b| a.1.total_cmp(&b.1));
                Self::Quantile { sorted, p }
            }
        }
    }

    fn value(&self) -> Option<f64> {
        match self {
            Self::Rate(sums) | Self::Mean(sums) => ratio(sums),
            Self::Quantile { sorted, p } => {
                let values: Vec<f64> = sorted.iter().map(|(_, value)| *value).collect();
                (!values.is_empty()).then(|| sorted_quantile(&values, *p))
            }
        }
    }

    fn bounds(&self, confidence: f64, size: f64) -> Option<Bounds> {
        match self {
            Self::Rate(sums) => cluster_rate_bounds(sums, confidence, size),
            Self::Mean(sums) => cluster_mean_bounds(sums, confidence, size),
            Self::Quantile { sorted, p } => cluster_quantile_bounds(sorted, *p, confidence, size),
        }
    }

    /// Returns the number of cases that would decide the requirement if further cases resembled these.
    fn cases_needed(&self, limit: Limit, confidence: f64, cases: u64) -> Option<u64> {
        let decides =
            |size: f64| verdict(limit, self.bounds(confidence, size), true) != RequirementVerdict::NotDecided;
        // No number resembles cases that do not exist.
        if cases == 0 {
            return None;
        }
        let most = MAX_CASES / cases as f64;
        let mut high = 1.0;
        while !decides(high) {
            high *= 2.0;
            if high > most {
                return None;
            }
        }
        let mut low = 0.5 * high;
        for _ in 0..20 {
            let middle = 0.5 * (low + high);
            if decides(middle) { high = middle } else { low = middle }
        }
        Some((cases as f64 * high).ceil() as u64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn required(figure: &str, limit: Limit, of: RequiredStatistic) -> StudyRequirement {
        crate::figures_of_tests::register();
        let (at_least, at_most) = match limit {
            Limit::AtLeast(limit) => (Some(limit), None),
            Limit::AtMost(limit) => (None, Some(limit)),
        };
        StudyRequirement { figure: figure.to_owned(), at_least, at_most, of, confidence: 0.95 }
    }

    fn decided(
        requirement: StudyRequirement,
        figures: impl Iterator<Item = CaseFigure>,
    ) -> RequirementResult {
        let figures: Vec<CaseFigure> = figures.collect();
        let draws: Vec<usize> = (0..figures.len()).collect();
        decide(&requirement, &figures, &draws, &IndexMap::new()).unwrap()
    }

    /// Returns cases of one frame each.
    fn frames(hits: u64, of: u64) -> impl Iterator<Item = CaseFigure> {
        (0..of).map(move |frame| {
            let count = u64::from(frame < hits);
            CaseFigure { value: Some(count as f64), count, of: 1 }
        })
    }

    /// The textbook's success-run table: 59 trials without a failure show 95 % at a confidence of 95 %, 58 do
    /// not (0.95⁵⁸ = 0.051); 93 with one failure.
    #[test]
    fn the_number_of_trials_agrees_with_the_textbook() {
        let at_least = || required("correct_rate", Limit::AtLeast(0.95), RequiredStatistic::All);
        assert_eq!(decided(at_least(), frames(59, 59)).verdict, RequirementVerdict::Met);
        let short = decided(at_least(), frames(30, 30));
        assert_eq!((short.verdict, short.cases_needed), (RequirementVerdict::NotDecided, Some(59)));
        assert_eq!(decided(at_least(), frames(92, 93)).verdict, RequirementVerdict::Met);
        assert_eq!(decided(at_least(), frames(91, 92)).verdict, RequirementVerdict::NotDecided);
        assert_eq!(decided(at_least(), frames(80, 100)).verdict, RequirementVerdict::NotMet);
    }

    #[test]
    fn a_value_at_its_limit_is_not_decided_by_any_number() {
        for figure in ["correct_rate", "ra_rms_deg"] {
            let requirement = required(figure, Limit::AtLeast(0.9), RequiredStatistic::All);
            let at_limit = decided(requirement, frames(90, 100));
            assert_eq!((at_limit.verdict, at_limit.cases_needed), (RequirementVerdict::NotDecided, None));
        }
    }

    #[test]
    fn no_cases_decide_nothing() {
        for (figure, of) in [("correct_rate", RequiredStatistic::All), ("ra_rms_deg", RequiredStatistic::P95)]
        {
            let none = decided(required(figure, Limit::AtLeast(0.9), of), std::iter::empty());
            assert_eq!((none.verdict, none.cases_needed), (RequirementVerdict::NotDecided, None));
            assert_eq!(none.verdict_words(), "not decided: no case can be run");
        }
    }

    #[test]
    fn limits_of_rates_are_fractions() {
        let message =
            |figure: &str, limit| required(figure, limit, RequiredStatistic::All).check_unit().err();
        assert_eq!(message("correct_rate", Limit::AtLeast(0.0)), None);
        assert_eq!(message("correct_rate", Limit::AtMost(1.0)), None);
        assert_eq!(message("ra_rms_deg", Limit::AtMost(95.0)), None);
        let (field, percent) = message("correct_rate", Limit::AtMost(99.9)).unwrap();
        assert_eq!(field, "at_most");
        assert!(percent.ends_with("; write 0.999 for 99.9 %"), "{percent}");
        let (_, negative) = message("correct_rate", Limit::AtLeast(-0.5)).unwrap();
        assert!(!negative.contains("write"), "{negative}");
        let (_, large) = message("correct_rate", Limit::AtLeast(200.0)).unwrap();
        assert!(!large.contains("write"), "{large}");
    }

    #[test]
    fn cases_without_a_value_never_help() {
        let errors = |without: u64| {
            (0..200).map(move |case| {
                let value = (case >= without).then_some(1.0 + (case % 10) as f64 / 10.0);
                CaseFigure { value, count: 1, of: 1 }
            })
        };
        let quantile = || required("ra_rms_deg", Limit::AtMost(2.0), RequiredStatistic::P95);
        assert_eq!(decided(quantile(), errors(0)).verdict, RequirementVerdict::Met);
        let many = decided(quantile(), errors(30));
        assert_eq!((many.verdict, many.without_value), (RequirementVerdict::NotMet, 30));
        let mean = || required("ra_rms_deg", Limit::AtMost(2.0), RequiredStatistic::All);
        assert_eq!(decided(mean(), errors(0)).verdict, RequirementVerdict::Met);
        assert_eq!(decided(mean(), errors(1)).verdict, RequirementVerdict::NotDecided);
        assert_eq!(
            decided(required("ra_rms_deg", Limit::AtMost(1.0), RequiredStatistic::All), errors(1)).verdict,
            RequirementVerdict::NotMet
        );
    }
}
