//! Rules of the verdict with their thresholds; docs/report.md has the same list.

use super::{Finding, Grade};
use crate::figures::significant;

/// Smallest number of values that a grade can rest on.
pub const MIN_COUNT: u64 = 20;
/// Largest rate of wrong answers that is fair; good is none.
pub const MAX_FAIR_WRONG_RATE: f64 = 0.01;
/// Smallest rate of correct answers that is good.
pub const MIN_GOOD_CORRECT_RATE: f64 = 0.99;
/// Smallest rate of correct answers that is fair.
pub const MIN_FAIR_CORRECT_RATE: f64 = 0.90;
/// Smallest rate of errors within one pixel that is good.
pub const MIN_GOOD_WITHIN_PIXEL: f64 = 0.95;
/// Smallest rate of errors within one pixel that is fair: that of a normal error with σ of one pixel.
pub const MIN_FAIR_WITHIN_PIXEL: f64 = 0.6827;
/// Largest RMS error in the image that is good, px.
pub const MAX_GOOD_RMS_PX: f64 = 0.5;
/// Largest RMS error in the image that is fair, px.
pub const MAX_FAIR_RMS_PX: f64 = 1.0;
/// Mean normalised errors squared (NEES) for which σ is honest: its scale is right within 12 %.
pub const HONEST_NEES: [f64; 2] = [0.8, 1.25];
/// Largest NEES that is fair: errors of twice σ.
pub const MAX_FAIR_NEES: f64 = 4.0;
/// Smallest rate of errors within 3 σ that is good; 99.73 % for normal errors.
pub const MIN_GOOD_WITHIN_3_SIGMA: f64 = 0.99;
/// Smallest rate of errors within 3 σ that is fair.
pub const MIN_FAIR_WITHIN_3_SIGMA: f64 = 0.95;
/// Smallest ratio of a mean error to the RMS at which a bias is named: a quarter of the mean square.
pub const MIN_BIAS_SHARE: f64 = 0.5;
/// Relative difference from which a result differs from that of its baseline.
pub const BASELINE_MARGIN: f64 = 0.1;

/// A measured figure: value, 95 % interval and number of values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// Value.
    pub value: f64,
    /// Lower limit of the interval.
    pub low: Option<f64>,
    /// Upper limit of the interval.
    pub high: Option<f64>,
    /// Numerator of a rate; `None` if it is not stated, as in a study of many cases.
    pub count: Option<u64>,
    /// Number of values.
    pub of: u64,
}

impl Measured {
    /// Returns the measured figure of a score; `None` if it has no value.
    pub fn from_figure(figure: Option<&score::Figure>) -> Option<Self> {
        let figure = figure?;
        Some(Self {
            value: figure.value?,
            low: figure.low,
            high: figure.high,
            count: Some(figure.count),
            of: figure.of,
        })
    }

    /// Formats a rate with its counts and interval: `84.2 % (505 of 600; 95 % interval 71.4 to 91.9 %)`.
    fn rate_text(&self) -> String {
        let interval = self.low.zip(self.high);
        let interval = interval.map(|(low, high)| {
            format!("; 95\u{a0}% interval {:.1} to {:.1}\u{a0}%", 100.0 * low, 100.0 * high)
        });
        let counts = match self.count {
            Some(count) => format!("{count} of {}", self.of),
            None => format!("over {} cases", self.of),
        };
        format!("{} ({counts}{})", percent(self.value), interval.unwrap_or_default())
    }

    /// Formats an amount with its interval: `1.84 (95 % interval 1.52 to 2.20)`.
    fn amount_text(&self) -> String {
        let interval = self.low.zip(self.high);
        let interval = interval.map(|(low, high)| {
            format!(" (95\u{a0}% interval {} to {})", significant_3(low), significant_3(high))
        });
        format!("{}{}", significant_3(self.value), interval.unwrap_or_default())
    }
}

/// Grades the rate of wrong answers: good if there is none, fair up to [`MAX_FAIR_WRONG_RATE`].
pub fn wrong_answers(subject: &str, measured: Option<Measured>) -> Finding {
    let Some(rate) = measured else {
        return Finding::not_judged(subject, "No frame was counted.").about_wrong_answers();
    };
    let scale = format!("Good is none, fair up to {}.", limit(MAX_FAIR_WRONG_RATE));
    let finding = if rate.value == 0.0 && rate.of < MIN_COUNT {
        too_few(subject, rate.of)
    } else if rate.value == 0.0 {
        let most = rate.high.map_or_else(String::new, |high| {
            format!(" The 95\u{a0}% interval does not exclude a rate of {}.", percent(high))
        });
        Finding::new(Grade::Good, subject, format!("None of {}.{most}", rate.of))
    } else {
        let grade = if rate.value <= MAX_FAIR_WRONG_RATE { Grade::Fair } else { Grade::Poor };
        Finding::new(grade, subject, format!("{}. {scale}", rate.rate_text()))
    };
    finding.about_wrong_answers()
}

/// Grades a rate of correct answers against [`MIN_GOOD_CORRECT_RATE`] and [`MIN_FAIR_CORRECT_RATE`].
pub fn correct_answers(subject: &str, measured: Option<Measured>) -> Finding {
    rate_at_least(subject, measured, [MIN_GOOD_CORRECT_RATE, MIN_FAIR_CORRECT_RATE])
}

/// Grades a rate of errors within one pixel against [`MIN_GOOD_WITHIN_PIXEL`] and [`MIN_FAIR_WITHIN_PIXEL`].
pub fn within_one_pixel(subject: &str, measured: Option<Measured>) -> Finding {
    rate_at_least(subject, measured, [MIN_GOOD_WITHIN_PIXEL, MIN_FAIR_WITHIN_PIXEL])
}

/// Grades a rate of errors within three σ against [`MIN_GOOD_WITHIN_3_SIGMA`] and
/// [`MIN_FAIR_WITHIN_3_SIGMA`].
pub fn within_three_sigma(subject: &str, measured: Option<Measured>) -> Finding {
    rate_at_least(subject, measured, [MIN_GOOD_WITHIN_3_SIGMA, MIN_FAIR_WITHIN_3_SIGMA])
        .and("Expected of normal errors with an honest σ: 99.7\u{a0}%.")
}

/// Grades a rate by its smallest good and its smallest fair value, and notes an interval that reaches a lower
/// grade.
fn rate_at_least(subject: &str, measured: Option<Measured>, [good, fair]: [f64; 2]) -> Finding {
    let Some(rate) = measured else { return Finding::not_judged(subject, "No frame was counted.") };
    if rate.of < MIN_COUNT {
        return too_few(subject, rate.of);
    }
    let grade_of = |value: f64| match value {
        value if value >= good => Grade::Good,
        value if value >= fair => Grade::Fair,
        _ => Grade::Poor,
    };
    let grade = grade_of(rate.value);
    let text = format!("{}. Good is {} or more, fair {}.", rate.rate_text(), limit(good), limit(fair));
    let lowest = grade_of(rate.low.unwrap_or(rate.value));
    let doubt = if lowest < grade {
        format!("The interval does not exclude \u{201c}{}\u{201d}: more frames would decide.", lowest.words())
    } else {
        String::new()
    };
    Finding::new(grade, subject, text).and(&doubt)
}

/// Grades an RMS error in the image against the pixel.
pub fn image_error(subject: &str, rms_px: Option<Measured>, mean_px: Option<Measured>) -> Finding {
    let Some(rms) = rms_px else {
        return Finding::not_judged(subject, "No correct measurement has a position in the image.");
    };
    if rms.of < MIN_COUNT {
        return too_few(subject, rms.of);
    }
    let grade = match rms.value {
        value if value <= MAX_GOOD_RMS_PX => Grade::Good,
        value if value <= MAX_FAIR_RMS_PX => Grade::Fair,
        _ => Grade::Poor,
    };
    let text = format!(
        "RMS {}\u{a0}px. Good is {MAX_GOOD_RMS_PX}\u{a0}px or less, fair {MAX_FAIR_RMS_PX}\u{a0}px.",
        rms.amount_text()
    );
    Finding::new(grade, subject, text).and(&bias_sentence(rms.value, mean_px.map(|mean| mean.value), "px"))
}

/// Returns a sentence on the bias of an error whose mean is at least [`MIN_BIAS_SHARE`] of its RMS.
pub fn bias_sentence(rms: f64, mean: Option<f64>, unit: &str) -> String {
    match mean {
        Some(mean) if rms > 0.0 && mean.abs() >= MIN_BIAS_SHARE * rms => {
            format!("Part of it is a bias: the mean error is {}.", with_unit(&significant_3(mean), unit))
        }
        _ => String::new(),
    }
}

/// Grades a mean normalised error squared per dimension (NEES) and states in words whether σ is honest.
pub fn nees(subject: &str, measured: Option<Measured>) -> Finding {
    let Some(nees) = measured else {
        return Finding::not_judged(subject, "No measurement states a σ.");
    };
    if nees.of < MIN_COUNT {
        return too_few(subject, nees.of);
    }
    let [low, high] = HONEST_NEES;
    let grade = match nees.value {
        value if (low..=high).contains(&value) => Grade::Good,
        value if value > MAX_FAIR_NEES => Grade::Poor,
        _ => Grade::Fair,
    };
    let words = format!("σ is {}", honesty_words(nees.value));
    // An interval that reaches the honest range leaves the judgement open.
    let reaches = nees.low.unwrap_or(nees.value) <= high && nees.high.unwrap_or(nees.value) >= low;
    let doubt =
        if grade != Grade::Good && reaches { "The interval does not exclude an honest σ." } else { "" };
    let text = format!(
        "NEES {}: {words}. Expected 1, honest from {low} to {high}, poor above {MAX_FAIR_NEES}.",
        nees.amount_text()
    );
    Finding::new(grade, subject, text).and(doubt)
}

/// States in words whether σ is honest, by the mean normalised error squared per dimension: `honest`, `too
/// small by a factor of 1.50`.
pub fn honesty_words(nees: f64) -> String {
    let [low, high] = HONEST_NEES;
    if (low..=high).contains(&nees) {
        "honest".to_owned()
    } else if nees < low {
        let factor = 1.0 / nees.max(f64::MIN_POSITIVE).sqrt();
        format!("too large by a factor of {factor:.2}")
    } else {
        format!("too small by a factor of {:.2}", nees.sqrt())
    }
}

/// Grades an error against that of a baseline on the same frames: good if it is smaller by
/// [`BASELINE_MARGIN`], fair within this margin, poor above.
pub fn against_baseline(
    subject: &str,
    error: Option<Measured>,
    baseline: Option<(&str, f64)>,
    unit: &str,
) -> Finding {
    let Some(error) = error else { return Finding::not_judged(subject, "No frame was measured.") };
    let value = significant_3(error.value);
    let Some((name, baseline)) = baseline.filter(|(_, baseline)| *baseline > 0.0) else {
        let value = with_unit(&value, unit);
        let reason = format!("RMS {value}; there is no baseline or requirement to grade it by.");
        return Finding::not_judged(subject, reason);
    };
    if error.of < MIN_COUNT {
        return too_few(subject, error.of);
    }
    let ratio = error.value / baseline;
    let (grade, words) = if ratio < 1.0 - BASELINE_MARGIN {
        (Grade::Good, format!("{} times smaller than", significant_3(1.0 / ratio.max(f64::MIN_POSITIVE))))
    } else if ratio <= 1.0 + BASELINE_MARGIN {
        (Grade::Fair, "within 10\u{a0}% of".to_owned())
    } else {
        (Grade::Poor, format!("{} times larger than", significant_3(ratio)))
    };
    let text = format!(
        "RMS {}: {words} {name} on the same images ({}).",
        with_unit(&value, unit),
        with_unit(&significant_3(baseline), unit)
    );
    Finding::new(grade, subject, text)
}

/// Returns the finding on a result with too few values.
fn too_few(subject: &str, of: u64) -> Finding {
    Finding::not_judged(subject, format!("Only {of} values; a grade needs {MIN_COUNT}."))
}

/// Formats a rate in percent. A rate close to 0 or 1 is not rounded to 0 or 100 %.
fn percent(rate: f64) -> String {
    crate::figures::probability(rate)
}

/// Formats a threshold in percent, without a zero after the point.
fn limit(rate: f64) -> String {
    crate::figures::probability(rate).replace(".0\u{a0}", "\u{a0}")
}

/// Formats a number with its unit; signs of angles have no space before them.
fn with_unit(number: &str, unit: &str) -> String {
    let space = if matches!(unit, "°" | "″") { "" } else { "\u{a0}" };
    format!("{number}{space}{unit}")
}

/// Formats a number with three significant digits.
fn significant_3(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    let text = significant(rounded).replace('-', "−");
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rate(count: u64, of: u64) -> Option<Measured> {
        let figure = score::Figure::rate(&[(0..of).map(|i| i < count).collect()]);
        Measured::from_figure(Some(&figure))
    }

    fn amount(value: f64, low: f64, high: f64) -> Option<Measured> {
        Some(Measured { value, low: Some(low), high: Some(high), count: None, of: 100 })
    }

    #[test]
    fn wrong_answers_are_good_only_if_there_is_none() {
        assert_eq!(wrong_answers("wrong answers", rate(0, 600)).grade, Grade::Good);
        assert_eq!(wrong_answers("wrong answers", rate(3, 600)).grade, Grade::Fair);
        assert_eq!(wrong_answers("wrong answers", rate(57, 600)).grade, Grade::Poor);
        assert_eq!(wrong_answers("wrong answers", rate(1, 3)).grade, Grade::Poor);
    }

    #[test]
    fn nothing_is_good_that_was_not_judged() {
        assert_eq!(wrong_answers("w", None).grade, Grade::NotJudged);
        assert_eq!(wrong_answers("w", rate(0, 5)).grade, Grade::NotJudged);
        assert_eq!(correct_answers("c", None).grade, Grade::NotJudged);
        assert_eq!(correct_answers("c", rate(5, 5)).grade, Grade::NotJudged);
        assert_eq!(nees("σ", None).grade, Grade::NotJudged);
        assert_eq!(image_error("e", None, None).grade, Grade::NotJudged);
        assert_eq!(against_baseline("e", amount(1.0, 0.9, 1.1), None, "m").grade, Grade::NotJudged);
    }

    #[test]
    fn a_rate_has_its_grade_and_the_doubt_of_its_interval() {
        assert_eq!(correct_answers("c", rate(600, 600)).grade, Grade::Good);
        let few = correct_answers("c", rate(60, 60));
        assert!(
            few.grade == Grade::Good && few.text.contains("does not exclude \u{201c}fair\u{201d}"),
            "{few:?}"
        );
        assert_eq!(correct_answers("c", rate(570, 600)).grade, Grade::Fair);
        assert_eq!(correct_answers("c", rate(300, 600)).grade, Grade::Poor);
    }

    #[test]
    fn nees_is_judged_in_words() {
        let check = |value: f64, grade: Grade, words: &str| {
            let finding = nees("σ", amount(value, 0.95 * value, 1.05 * value));
            assert!(finding.grade == grade && finding.text.contains(words), "{finding:?}");
        };
        check(1.02, Grade::Good, "σ is honest");
        check(2.25, Grade::Fair, "σ is too small by a factor of 1.50");
        check(9.0, Grade::Poor, "σ is too small by a factor of 3.00");
        check(0.25, Grade::Fair, "σ is too large by a factor of 2.00");
        assert!(nees("σ", amount(1.5, 1.0, 2.0)).text.contains("does not exclude an honest σ"));
    }

    #[test]
    fn an_error_in_the_image_names_its_bias() {
        let finding = image_error("e", amount(1.44, 0.7, 1.9), amount(-1.19, -1.3, -1.1));
        assert_eq!(finding.grade, Grade::Poor);
        assert!(finding.text.contains("the mean error is −1.19\u{a0}px"), "{}", finding.text);
        assert!(!image_error("e", amount(0.03, 0.02, 0.04), amount(0.0, 0.0, 0.0)).text.contains("bias"));
    }

    #[test]
    fn an_error_is_compared_with_its_baseline() {
        let grade = |value: f64| against_baseline("e", amount(value, 0.0, 1.0), Some(("it", 1.0)), "m").grade;
        assert_eq!([0.5, 0.95, 1.05, 2.0].map(grade), [Grade::Good, Grade::Fair, Grade::Fair, Grade::Poor]);
    }
}
