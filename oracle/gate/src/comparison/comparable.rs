//! Checks that a result is comparable with a baseline: identical units, and figures with identical
//! definitions.
use files::Failure;
use score::{FigureTerms, UnitVerdict};

use super::options::CompareOptions;
use crate::baseline::{Baseline, unknown_figure};
use crate::sample::Sample;

/// Cause, in all worlds, of a unit without a row.
const NOT_REPORTED: &str = "not_reported";

/// Checks that baseline and result have the same unit numbers.
pub(crate) fn check_units(baseline: &Baseline, result: &Sample, what: &str) -> Result<(), Failure> {
    let (before, after) = (&baseline.sample.table.units, &result.table.units);
    let differs = before.iter().zip(after).find(|(before, after)| before.number != after.number);
    let (of_baseline, of_result) = match differs {
        Some((before, after)) => (format!("number {}", before.number), format!("number {}", after.number)),
        None if before.len() != after.len() => (before.len().to_string(), after.len().to_string()),
        None => return Ok(()),
    };
    Err(Failure::Usage(format!(
        "cannot compare: `{what}` is `{of_baseline}` in the baseline and `{of_result}` in the result; both \
         need the same {what}"
    )))
}

/// Checks that the result does not lack rows for more units than the baseline. Otherwise it is incomplete: a
/// unit without a solution needs a row, too.
pub(crate) fn check_reported(baseline: &Baseline, result: &Sample, what: &str) -> Result<(), Failure> {
    let silent = |units: &[UnitVerdict]| {
        let is_silent = |unit: &&UnitVerdict| unit.cause.as_deref() == Some(NOT_REPORTED);
        (units.iter().filter(is_silent).count(), units.iter().find(is_silent).map(|unit| unit.number))
    };
    let (before, _) = silent(&baseline.sample.table.units);
    match silent(&result.table.units) {
        (after, Some(first)) if after > before => Err(Failure::Usage(format!(
            "cannot compare: {after} of {} {what} have no row in the result (the first is number {first}), \
             {before} in the baseline; expected one row each, also for `no solution`",
            result.table.units.len()
        ))),
        _ => Ok(()),
    }
}

/// Returns the figures to compare, as pairs from baseline and result.
pub(crate) fn pairs<'a>(
    baseline: &'a Baseline,
    result: &'a Sample,
    options: &CompareOptions,
) -> Result<Vec<(&'a FigureTerms, &'a FigureTerms)>, Failure> {
    let known = &baseline.sample.table.figures;
    let check = |option: &str, name: &String| {
        if known.iter().any(|figure| &figure.name == name) {
            return Ok(());
        }
        Err(unknown_figure(option, name, known.iter().map(|figure| &figure.name)))
    };
    options.figures.iter().try_for_each(|name| check("--figures", name))?;
    options.tolerances.keys().try_for_each(|name| check("--tolerance", name))?;
    let is_asked =
        |figure: &&FigureTerms| options.figures.is_empty() || options.figures.contains(&figure.name);
    // Sorted in the order of the result, which is that of the score.
    let place =
        |before: &FigureTerms| result.table.figures.iter().position(|figure| figure.name == before.name);
    let mut asked: Vec<&FigureTerms> = known.iter().filter(is_asked).collect();
    asked.sort_by_key(|before| place(before));
    asked
        .into_iter()
        .map(|before| {
            let after = result.table.figures.iter().find(|figure| figure.name == before.name);
            match after {
                Some(after) if after.reduction == before.reduction => {
                    check_alike(before, after).map(|()| (before, after))
                }
                Some(after) => Err(Failure::Usage(format!(
                    "cannot compare: `{}` is a `{}` in the baseline and a `{}` in the result; both need the \
                     same reduction",
                    before.name,
                    before.reduction.code(),
                    after.reduction.code()
                ))),
                None => Err(Failure::Usage(format!(
                    "cannot compare: the result has no figure `{}`, the baseline has; select other figures \
                     with --figures",
                    before.name
                ))),
            }
        })
        .collect()
}

/// Rejects a figure with the same name but another definition: another limit, or lines of sight based on
/// another attitude. A sample without detections has no attitude, which excludes confusion.
fn check_alike(before: &FigureTerms, after: &FigureTerms) -> Result<(), Failure> {
    let cannot = |is: &str, of_baseline: String, of_result: String, hint: &str| {
        Err(Failure::Usage(format!(
            "cannot compare: `{}` {is} {of_baseline} in the baseline and {of_result} in the result; set the \
             same {hint}, or select other figures with --figures",
            before.name
        )))
    };
    if before.limit_deg != after.limit_deg {
        let shown = |limit: Option<f64>| limit.map_or("an unrecorded limit".to_owned(), |l| format!("{l}°"));
        let (before, after) = (shown(before.limit_deg), shown(after.limit_deg));
        return cannot("counts errors below", before, after, "`within_deg` of the scenario's [score]");
    }
    match (&before.attitude, &after.attitude) {
        (Some(before), Some(after)) if before != after => {
            let [before, after] = [before, after].map(|attitude| format!("`{attitude}`"));
            cannot("uses lines of sight by the attitude", before, after, "--attitude")
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparison::compare::compare;
    use crate::hand_made::{AFTER, BEFORE, baseline, compared, figure, hits, rate, refusal, sample, unit};
    use crate::report::FigureVerdict;
    use indexmap::IndexMap;
    use run::figure_by_name;
    use score::Reduction;

    #[test]
    fn units_must_be_the_same_by_their_numbers() {
        let same = |before: &[u8], after: &Sample| {
            let message = refusal(hits(before), after, &CompareOptions::default());
            assert!(message.starts_with("cannot compare: `frames` is "), "{message}");
            message
        };
        let message = same(&BEFORE, &hits(&AFTER[..11]));
        assert!(message.contains("`12` in the baseline and `11` in the result"), "{message}");
        let message = same(&BEFORE[..11], &hits(&AFTER));
        assert!(message.contains("`11` in the baseline and `12` in the result"), "{message}");
        let mut other = hits(&AFTER);
        other.table.units[11].number = 12;
        let message = same(&BEFORE, &other);
        assert!(message.contains("`number 11` in the baseline and `number 12` in the result"), "{message}");
    }

    #[test]
    fn a_result_that_is_silent_about_more_units_than_the_baseline_is_not_complete() {
        let silent = |bits: &[u8], numbers: &[usize]| {
            let mut sample = hits(bits);
            numbers
                .iter()
                .for_each(|&n| sample.table.units[n] = unit(n as u64, "missed", Some("not_reported")));
            sample
        };
        for (before, after) in [(vec![], vec![]), (vec![1], vec![7]), (vec![1, 2], vec![3])] {
            compared(silent(&BEFORE, &before), &silent(&AFTER, &after));
        }
        // A unit with another cause has been reported.
        let mut answered = hits(&AFTER);
        answered.table.units[4] = unit(4, "missed", Some("not_linked"));
        compared(hits(&BEFORE), &answered);
        let message = refusal(silent(&BEFORE, &[1]), &silent(&AFTER, &[5, 7]), &CompareOptions::default());
        let expected = "2 of 12 frames have no row in the result (the first is number 5), 1 in the baseline;";
        assert!(message.contains(expected), "{message}");
    }

    #[test]
    fn figures_are_those_that_are_requested_in_the_order_of_the_result() {
        let figures = |names: [&str; 3], bits: &[u8]| sample(names.map(|name| rate(name, bits)).to_vec());
        let before = figures(["wrong_rate", "hit_rate", "correct_rate"], &BEFORE);
        let after = figures(["hit_rate", "correct_rate", "wrong_rate"], &AFTER);
        let names = |options: &CompareOptions| {
            let report = compare(&baseline(before.clone()), &after, options).unwrap();
            report.figures.keys().cloned().collect::<Vec<_>>()
        };
        assert_eq!(names(&CompareOptions::default()), ["hit_rate", "correct_rate", "wrong_rate"]);
        let some = |names: &[&str]| CompareOptions {
            figures: names.iter().map(|name| (*name).to_owned()).collect(),
            ..CompareOptions::default()
        };
        assert_eq!(names(&some(&["wrong_rate", "hit_rate"])), ["hit_rate", "wrong_rate"]);
        for (name, hint) in
            [("hit_rat", "did you mean `hit_rate`?"), ("zzz", "wrong_rate, hit_rate, correct_rate")]
        {
            let message = refusal(before.clone(), &after, &some(&["hit_rate", name]));
            let expected = format!("--figures names `{name}`, expected a figure of the baseline; {hint}");
            assert_eq!(message, expected);
            let tolerances = IndexMap::from([(name.to_owned(), 0.1)]);
            let options = CompareOptions { tolerances, ..CompareOptions::default() };
            let expected = expected.replace("--figures", "--tolerance");
            assert_eq!(refusal(before.clone(), &after, &options), expected);
        }
    }

    #[test]
    fn a_figure_must_count_within_the_same_limit_and_by_the_same_attitude() {
        let of = |limit_deg, attitude: Option<&str>| {
            let figure = FigureTerms { limit_deg, ..rate("ra_within_1px", &BEFORE) };
            let attitude = attitude.map(str::to_owned);
            sample(vec![
                figure.with_attitude(&figure_by_name("ra_within_1px"), attitude.as_ref()),
                rate("hit_rate", &BEFORE),
            ])
        };
        let refused = |before: Sample, after: Sample, part: &str| {
            let message = refusal(before.clone(), &after, &CompareOptions::default());
            assert!(
                message.contains(part) && message.contains("select other figures with --figures"),
                "{message}"
            );
            let options =
                CompareOptions { figures: vec!["hit_rate".to_owned()], ..CompareOptions::default() };
            assert_eq!(compare(&baseline(before), &after, &options).unwrap().verdict, FigureVerdict::NoWorse);
        };
        refused(
            of(Some(0.024), None),
            of(Some(0.25), None),
            "`ra_within_1px` counts errors below 0.024° in the baseline and 0.25° in the result; set the \
             same `within_deg`",
        );
        refused(of(None, None), of(Some(0.25), None), "an unrecorded limit in the baseline");
        refused(
            of(Some(0.024), Some("true")),
            of(Some(0.024), Some("own")),
            "`ra_within_1px` uses lines of sight by the attitude `true` in the baseline and `own` in the \
             result",
        );
        // A result without detections has no attitude: it is worse, but comparable.
        let report = compared(of(None, Some("own")), &of(None, None));
        assert!(report.notes.is_empty(), "{:?}", report.notes);
        let report = compared(of(None, Some("true")), &of(None, Some("true")));
        assert!(report.notes[0].contains("by the attitude `true`"), "{:?}", report.notes);
    }

    #[test]
    fn a_figure_must_be_in_both_with_the_same_reduction() {
        let mean = |name: &str| figure(name, Reduction::Mean, &BEFORE.map(|bit| Some(f64::from(bit))));
        let both = |first| sample(vec![first, rate("hit_rate", &BEFORE)]);
        let message =
            refusal(both(mean("ra_mean_deg")), &both(mean("dec_mean_deg")), &CompareOptions::default());
        assert!(message.contains("the result has no figure `ra_mean_deg`"), "{message}");
        let rms = FigureTerms { reduction: Reduction::Rms, ..mean("ra_mean_deg") };
        let message = refusal(both(mean("ra_mean_deg")), &both(rms), &CompareOptions::default());
        let expected = "`ra_mean_deg` is a `mean` in the baseline and a `rms` in the result; both need the \
            same reduction";
        assert!(message.contains(expected), "{message}");
        // A figure that only the result has is not compared.
        let report = compared(hits(&BEFORE), &both(mean("ra_mean_deg")));
        assert_eq!(report.figures.keys().collect::<Vec<_>>(), ["hit_rate"]);
    }
}
