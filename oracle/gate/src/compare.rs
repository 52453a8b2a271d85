//! A result against a baseline.
use files::{Failure, toml_file};
use indexmap::IndexMap;
use run::figure_called;
use score::{Better, FigureTerms, Kind, Sense, UnitVerdict, attitude_note};
use statistics::{BlockEffects, Exchanges, JointTest, Tested, joint_test, normal_quantile};

use super::baseline::Baseline;
use super::effects::{FigureEffect, interval, neighbour_correlation};
use super::flips::Flips;
use super::identity::Pairing;
use super::report::{FigureReport, FigureVerdict, GateReport};
use super::sample::Sample;

/// The 95 % quantile of the standard normal law: the power at which the smallest visible change is told.
const Z_POWER: f64 = 1.644_853_626_951_472_2;
/// A figure that the result lacks is gone when that would be chance with no more than this probability.
const GONE_BY_CHANCE: f64 = 1e-3;
/// The cause, in either world, of a unit without a row.
const NOT_REPORTED: &str = "not_reported";

/// What a comparison is asked.
#[derive(Debug, Clone, PartialEq)]
pub struct CompareOptions {
    /// Probability of shutting the gate when no figure is worse, above 0 and below 0.5.
    pub alpha: f64,
    /// Names of the figures to compare; empty: all of the baseline.
    pub figures: Vec<String>,
    /// By how much figures may be worse and pass, in their units, where it is not the default.
    pub tolerances: IndexMap<String, f64>,
    /// Why figures with a best value may change; absent: a change shuts the gate.
    pub accept_changed: Option<String>,
}

impl Default for CompareOptions {
    fn default() -> Self {
        Self { alpha: 0.05, figures: Vec::new(), tolerances: IndexMap::new(), accept_changed: None }
    }
}

/// Compares a result with a baseline.
///
/// # Errors
/// [`Failure::Usage`] for options that are not allowed, for two samples that cannot be compared (with what differs), and when no figure
/// has enough data to be found worse whatever happens: a gate that cannot shut must not pass for one.
pub fn compare(
    baseline: &Baseline,
    result: &Sample,
    options: &CompareOptions,
) -> Result<GateReport, Failure> {
    let alpha = options.alpha;
    if !(alpha > 0.0 && alpha < 0.5) {
        return Err(Failure::Usage(format!("--alpha is {alpha}, expected a number above 0 and below 0.5")));
    }
    let identity = &baseline.sample.identity;
    let pairing = identity.pairing(&result.identity)?;
    let units = identity.kind.units(&identity.world);
    check_units(baseline, result, &units)?;
    check_reported(baseline, result, &units)?;
    let pairs = pairs(baseline, result, options)?;

    let blocks = &baseline.blocks;
    let exchanges = Exchanges::new(blocks.count());
    let effects: Vec<FigureEffect> = pairs
        .iter()
        .map(|(before, after)| {
            let tolerance = options.tolerances.get(&before.name).copied();
            FigureEffect::of_runs(figure_called(&before.name).sense, before, after, blocks, tolerance)
        })
        .collect();
    // What shuts the gate is tested together: every worsening, and of figures with a best value the change to the other side too.
    let with_best_value: Vec<usize> = (0..effects.len()).filter(|i| effects[*i].has_best_value()).collect();
    let other_side = with_best_value.iter().map(|i| effects[*i].better());
    let worse: Vec<BlockEffects> =
        effects.iter().map(|effect| effect.worse.clone()).chain(other_side).collect();
    let for_the_better = |effect: &FigureEffect| {
        let mut better = effect.better();
        if effect.has_best_value() {
            better.effects.fill(0.0);
        }
        better
    };
    let better: Vec<BlockEffects> = effects.iter().map(for_the_better).collect();
    let (worse, better) = (joint_test(&worse, &exchanges, alpha), joint_test(&better, &exchanges, alpha));

    let mut figures = IndexMap::new();
    let mut correlation: f64 = 0.0;
    for (index, ((before, after), effect)) in pairs.iter().zip(&effects).enumerate() {
        let other_side = with_best_value.iter().position(|i| *i == index).map(|place| effects.len() + place);
        let judge = Judge { effect, worse: &worse, better: &better, index, other_side, alpha };
        let interval = interval(before, after, blocks, &exchanges);
        correlation = correlation.max(neighbour_correlation(&effect.worse.effects));
        figures.insert(before.name.clone(), judge.report(interval.map(|i| (i.low, i.high))));
    }
    if figures.values().all(|figure| figure.verdict == FigureVerdict::TooLittleData) {
        return Err(Failure::Usage(format!(
            "cannot compare: {} {units} in {} blocks leave no figure that could be found worse at alpha = {alpha}, expected more of them",
            baseline.header.units,
            blocks.count()
        )));
    }
    let any = |is: fn(FigureVerdict) -> bool| figures.values().any(|figure| is(figure.verdict));
    Ok(GateReport {
        verdict: if any(FigureVerdict::is_worse) {
            FigureVerdict::Worse
        } else if any(|verdict| verdict == FigureVerdict::Changed) {
            FigureVerdict::Changed
        } else {
            FigureVerdict::NoWorse
        },
        accepted: options.accept_changed.clone(),
        name: identity.name.clone(),
        world: identity.world.clone(),
        reason: baseline.header.reason.clone(),
        units,
        count: baseline.header.units,
        pairing,
        baseline_seed: identity.seed,
        result_seed: result.identity.seed,
        baseline_version: identity.version.clone(),
        result_version: result.identity.version.clone(),
        alpha,
        blocks: blocks.count() as u64,
        block_length: blocks.mean_length(),
        neighbour_correlation: correlation,
        notes: notes(baseline, result, pairing, (correlation, pairs.len())),
        figures,
        flips: (pairing == Pairing::Frames)
            .then(|| Flips::of(&baseline.sample.table.units, &result.table.units)),
    })
}

/// The same units, by number.
fn check_units(baseline: &Baseline, result: &Sample, what: &str) -> Result<(), Failure> {
    let (before, after) = (&baseline.sample.table.units, &result.table.units);
    let differs = before.iter().zip(after).find(|(before, after)| before.number != after.number);
    let (of_baseline, of_result) = match differs {
        Some((before, after)) => (format!("number {}", before.number), format!("number {}", after.number)),
        None if before.len() != after.len() => (before.len().to_string(), after.len().to_string()),
        None => return Ok(()),
    };
    Err(Failure::Usage(format!(
        "cannot compare: `{what}` is `{of_baseline}` in the baseline and `{of_result}` in the result, expected the same {what}"
    )))
}

/// A result that is silent about units of which the baseline is not is not complete: no solution is a row, too.
fn check_reported(baseline: &Baseline, result: &Sample, what: &str) -> Result<(), Failure> {
    let silent = |units: &[UnitVerdict]| {
        let is_silent = |unit: &&UnitVerdict| unit.cause.as_deref() == Some(NOT_REPORTED);
        (units.iter().filter(is_silent).count(), units.iter().find(is_silent).map(|unit| unit.number))
    };
    let (before, _) = silent(&baseline.sample.table.units);
    match silent(&result.table.units) {
        (after, Some(first)) if after > before => Err(Failure::Usage(format!(
            "cannot compare: the result has no measurement of {after} of {} {what} (the first is number {first}), the baseline of {before}; \
             expected a row of each, `no solution` included",
            result.table.units.len()
        ))),
        _ => Ok(()),
    }
}

/// The figures to compare, of either sample.
fn pairs<'a>(
    baseline: &'a Baseline,
    result: &'a Sample,
    options: &CompareOptions,
) -> Result<Vec<(&'a FigureTerms, &'a FigureTerms)>, Failure> {
    let known = &baseline.sample.table.figures;
    let check = |option: &str, name: &String| {
        if known.iter().any(|figure| &figure.name == name) {
            return Ok(());
        }
        let names = || known.iter().map(|figure| figure.name.as_str());
        let hint = toml_file::nearest(name, names())
            .map_or_else(|| names().collect::<Vec<_>>().join(", "), |name| format!("did you mean `{name}`?"));
        Err(Failure::Usage(format!("{option} names `{name}`, expected a figure of the baseline; {hint}")))
    };
    options.figures.iter().try_for_each(|name| check("--figures", name))?;
    options.tolerances.keys().try_for_each(|name| check("--tolerance", name))?;
    let is_asked =
        |figure: &&FigureTerms| options.figures.is_empty() || options.figures.contains(&figure.name);
    // In the order of the result, which is that of the score.
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
                    "cannot compare: `{}` is a `{}` in the baseline and a `{}` in the result, expected the same",
                    before.name,
                    before.reduction.code(),
                    after.reduction.code()
                ))),
                None => Err(Failure::Usage(format!(
                    "cannot compare: `{}` is a figure of the baseline and not of the result; --figures chooses others",
                    before.name
                ))),
            }
        })
        .collect()
}

/// Refuses a figure that counts other things under the same name: within another limit, or of lines of sight by another attitude. Where
/// nothing was detected there is no attitude, and nothing to be confused.
fn check_alike(before: &FigureTerms, after: &FigureTerms) -> Result<(), Failure> {
    let cannot = |is: &str, of_baseline: String, of_result: String, hint: &str| {
        Err(Failure::Usage(format!(
            "cannot compare: `{}` {is} {of_baseline} in the baseline and {of_result} in the result, expected the same ({hint}); --figures \
             chooses others",
            before.name
        )))
    };
    if before.limit_deg != after.limit_deg {
        let shown =
            |limit: Option<f64>| limit.map_or("a limit that is not recorded".to_owned(), |l| format!("{l}°"));
        let (before, after) = (shown(before.limit_deg), shown(after.limit_deg));
        return cannot("counts errors below", before, after, "`within_deg` of the scenario's [score]");
    }
    match (&before.attitude, &after.attitude) {
        (Some(before), Some(after)) if before != after => {
            let [before, after] = [before, after].map(|attitude| format!("`{attitude}`"));
            cannot("is of lines of sight by the attitude", before, after, "--attitude")
        }
        _ => Ok(()),
    }
}

/// What a reader must know. `correlation` is the largest of neighbouring blocks, and of how many figures it is that.
fn notes(
    baseline: &Baseline,
    result: &Sample,
    pairing: Pairing,
    (correlation, figures): (f64, usize),
) -> Vec<String> {
    let mut notes = Vec::new();
    let attitude = result.table.figures.iter().find_map(|figure| figure.attitude.as_deref());
    notes.extend(attitude_note(attitude));
    let (before, after) = (&baseline.sample.identity, &result.identity);
    if pairing == Pairing::Blocks && before.seed == after.seed {
        notes.push(format!(
            "The seed is the same and the frames are not: the simulator has changed (version {} then, {} now). Compared as with another seed.",
            before.version, after.version
        ));
    }
    // What the largest of so many independent correlations exceeds in one comparison of twenty.
    let by_chance = normal_quantile(1.0 - 0.05 / figures as f64) / (baseline.blocks.count() as f64).sqrt();
    if correlation > by_chance {
        notes.push(format!(
            "Neighbouring blocks go together (correlation {correlation:.2}, by chance at most {by_chance:.2}): they are too short, and \
             probabilities too small. A baseline with a longer --block-length cures it, as long as blocks are many."
        ));
    }
    notes
}

/// What is needed to judge one figure.
struct Judge<'a> {
    effect: &'a FigureEffect,
    worse: &'a JointTest,
    better: &'a JointTest,
    index: usize,
    /// Of a figure with a best value, where the change towards less was tested.
    other_side: Option<usize>,
    alpha: f64,
}

impl Judge<'_> {
    fn report(&self, interval: Option<(f64, f64)>) -> FigureReport {
        let effect = self.effect;
        let difference = effect.result.zip(effect.baseline).map(|(result, baseline)| result - baseline);
        let tested = self.tested();
        FigureReport {
            verdict: self.verdict(),
            better: match effect.sense.better {
                Better::More => "more".to_owned(),
                Better::Less => "less".to_owned(),
                Better::Near(best) => format!("near {best}"),
            },
            baseline: effect.baseline,
            baseline_of: effect.baseline_of,
            result: effect.result,
            result_of: effect.result_of,
            difference,
            // Of skewed values the difference may lie outside the quantiles of its own sets.
            low: interval.zip(difference).map(|((low, _), difference)| low.min(difference)),
            high: interval.zip(difference).map(|((_, high), difference)| high.max(difference)),
            worse_by: effect.worsening(),
            tolerance: effect.tolerance,
            p: tested.p,
            adjusted_p: tested.adjusted_p,
            better_adjusted_p: self.better.figures[self.index].adjusted_p,
            smallest_visible: self.smallest_visible(),
            blocks: effect.blocks as u64,
        }
    }

    /// What was found for the worse; of a figure with a best value on the side of the change, its own p for both sides.
    fn tested(&self) -> Tested {
        let up = self.worse.figures[self.index];
        let Some(down) = self.other_side.map(|place| self.worse.figures[place]) else { return up };
        let nearer = if up.p <= down.p { up } else { down };
        Tested { p: (2.0 * nearer.p).min(1.0), ..nearer }
    }

    fn verdict(&self) -> FigureVerdict {
        let effect = self.effect;
        if effect.baseline.is_some() && effect.result.is_none() {
            let by_chance = self.better.figures.len() as f64 * libm::exp2(-(effect.blocks as f64));
            return if by_chance <= GONE_BY_CHANCE {
                FigureVerdict::Gone
            } else {
                FigureVerdict::TooLittleData
            };
        }
        let (Some(worsening), Some(change)) = (effect.worsening(), effect.change()) else {
            return FigureVerdict::TooLittleData;
        };
        if !self.can_be_seen() {
            FigureVerdict::TooLittleData
        } else if self.tested().adjusted_p <= self.alpha && change > effect.tolerance {
            // Farther from the best value by what counts is worse; nearer to it, or across it, is another result.
            if worsening > effect.tolerance { FigureVerdict::Worse } else { FigureVerdict::Changed }
        } else if self.better.figures[self.index].adjusted_p <= self.alpha && -worsening > effect.tolerance {
            FigureVerdict::Better
        } else {
            FigureVerdict::NoWorse
        }
    }

    /// Whether a figure that differed alike in every block it has would be found.
    fn can_be_seen(&self) -> bool {
        (self.effect.blocks as f64).sqrt() > self.worse.critical + 1e-9
    }

    /// The worsening that is seen with a probability of 95 %: of which the statistic lies as far above the critical value as one in
    /// twenty falls short. A worsening of a rate brings scatter of its own: with δ of n more that are lost, at least δ/n. The critical
    /// value is that of this comparison, or of Bonferroni where few figures differ at all and it is less: a change brings differences.
    fn smallest_visible(&self) -> Option<f64> {
        let effect = self.effect;
        effect.worsening()?;
        if !self.can_be_seen() {
            return None;
        }
        let Sense { kind, .. } = effect.sense;
        let bonferroni = normal_quantile(1.0 - self.alpha / self.worse.figures.len() as f64);
        let z = self.worse.critical.max(bonferroni) + Z_POWER;
        let by_noise = match kind {
            Kind::Amount => z * effect.standard_error,
            Kind::Rate => {
                let own = z * z / effect.result_of.max(1) as f64;
                0.5 * (own + (own * own + 4.0 * z * z * effect.standard_error * effect.standard_error).sqrt())
            }
        };
        Some(by_noise.max(effect.tolerance + Z_POWER * effect.standard_error))
    }
}

#[cfg(test)]
mod tests {
    use super::super::hand_made::{figure, sample, unit};
    use super::*;
    use score::Reduction;
    use statistics::Tested;

    fn rate(name: &str, bits: &[u8]) -> FigureTerms {
        figure(name, Reduction::Rate, &bits.iter().map(|bit| Some(f64::from(*bit))).collect::<Vec<_>>())
    }

    fn hits(bits: &[u8]) -> Sample {
        sample(vec![rate("hit_rate", bits)])
    }

    /// A baseline of which each frame is a block.
    fn baseline(sample: Sample) -> Baseline {
        Baseline::new(sample, "a test", Some(1)).unwrap()
    }

    fn compared(before: Sample, after: &Sample) -> GateReport {
        compare(&baseline(before), after, &CompareOptions::default()).unwrap()
    }

    fn refusal(before: Sample, after: &Sample, options: &CompareOptions) -> String {
        compare(&baseline(before), after, options).unwrap_err().to_string()
    }

    /// Twelve frames, eight of them lost and one won.
    const BEFORE: [u8; 12] = [1, 1, 1, 1, 1, 1, 1, 1, 0, 1, 1, 0];
    const AFTER: [u8; 12] = [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 0];

    /// Of nine frames that changed eight were lost: that of a fair coin, (9 + 1)/2⁹, and of one that were won, (2⁹ − 1)/2⁹.
    #[test]
    fn of_hits_and_misses_the_probability_is_that_of_mcnemars_exact_test() {
        let report = compared(hits(&BEFORE), &hits(&AFTER));
        let found = &report.figures["hit_rate"];
        assert_eq!((report.verdict, found.verdict), (FigureVerdict::Worse, FigureVerdict::Worse));
        assert_eq!(
            (found.p, found.adjusted_p, found.better_adjusted_p),
            (10.0 / 512.0, 10.0 / 512.0, 511.0 / 512.0)
        );
        assert_eq!((found.baseline, found.result), (Some(10.0 / 12.0), Some(3.0 / 12.0)));
        assert_eq!((found.baseline_of, found.result_of, found.blocks), (12, 12, 12));
        assert!((found.worse_by.unwrap() - 7.0 / 12.0).abs() < 1e-12, "{found:?}");
        assert!((found.difference.unwrap() + 7.0 / 12.0).abs() < 1e-12, "{found:?}");
        assert_eq!((found.better.as_str(), found.tolerance), ("more", 0.0));
        assert_eq!(report.worse().collect::<Vec<_>>(), ["hit_rate"]);

        let report = compared(hits(&AFTER), &hits(&BEFORE));
        assert_eq!(report.verdict, FigureVerdict::NoWorse);
        assert_eq!(report.figures["hit_rate"].verdict, FigureVerdict::Better);
    }

    /// A bias of −1 that becomes one of −0.5, of +0.9 or of −1.5: the first two are nearer to nought and no improvement.
    #[test]
    fn a_bias_that_points_to_nought_has_changed_and_shuts_the_gate() {
        let bias = |bias: f64| {
            let values: Vec<_> = (0..12).map(|i| Some(bias + 0.01 * f64::from(i % 3))).collect();
            sample(vec![figure("ra_mean_deg", Reduction::Mean, &values), rate("hit_rate", &BEFORE)])
        };
        for (after, verdict) in [
            (-0.5, FigureVerdict::Changed),
            (0.9, FigureVerdict::Changed),
            (-1.5, FigureVerdict::Worse),
            (-1.001, FigureVerdict::NoWorse),
        ] {
            let report = compared(bias(-1.0), &bias(after));
            assert_eq!(
                (report.verdict, report.figures["ra_mean_deg"].verdict),
                (verdict, verdict),
                "{after}"
            );
            assert_eq!(report.is_shut(), verdict != FigureVerdict::NoWorse);
            let accepting = CompareOptions {
                accept_changed: Some("a new centroider".to_owned()),
                ..CompareOptions::default()
            };
            let report = compare(&baseline(bias(-1.0)), &bias(after), &accepting).unwrap();
            assert_eq!(report.verdict, verdict);
            assert_eq!(report.is_shut(), verdict == FigureVerdict::Worse);
        }
    }

    #[test]
    fn a_report_tells_what_was_compared_and_the_frames_that_changed() {
        let mut after = hits(&AFTER);
        after.identity.version = "0.2.0".to_owned();
        after.table.units[3] = unit(3, "missed", Some("not_linked"));
        let report = compared(hits(&BEFORE), &after);
        assert_eq!((report.name.as_str(), report.world.as_str()), ("made by hand", "far_range"));
        assert_eq!((report.reason.as_str(), report.units.as_str(), report.count), ("a test", "frames", 12));
        assert_eq!((report.baseline_seed, report.result_seed), (1, 1));
        assert_eq!((report.baseline_version.as_str(), report.result_version.as_str()), ("0.1.0", "0.2.0"));
        assert_eq!((report.alpha, report.blocks, report.block_length), (0.05, 12, 1.0));
        let flips = report.flips.unwrap();
        assert_eq!((report.pairing, flips.lost, flips.units[0].number), (Pairing::Frames, 1, 3));
        // Of other frames nobody can say which changed.
        after.identity.seed = 2;
        let report = compared(hits(&BEFORE), &after);
        assert_eq!((report.pairing, report.result_seed, report.flips), (Pairing::Blocks, 2, None));
    }

    #[test]
    fn the_same_result_is_no_worse() {
        let report = compared(hits(&BEFORE), &hits(&BEFORE));
        let found = &report.figures["hit_rate"];
        assert_eq!((report.verdict, found.verdict), (FigureVerdict::NoWorse, FigureVerdict::NoWorse));
        assert_eq!((found.p, found.better_adjusted_p), (1.0, 1.0));
        assert_eq!((found.difference, found.low, found.high), (Some(0.0), Some(0.0), Some(0.0)));
        assert_eq!(report.neighbour_correlation, 0.0);
        assert!(report.flips.unwrap().units.is_empty() && report.notes.is_empty());
    }

    /// Of two figures one rises from block to block, and one alternates.
    #[test]
    fn the_correlation_of_neighbours_is_the_largest_of_any_figure() {
        let errors = |name: &str, values: [f64; 8]| figure(name, Reduction::Mean, &values.map(Some));
        let nought = |name: &str| errors(name, [10.0; 8]);
        let before = sample(vec![nought("a_mean"), nought("b_mean")]);
        let after = sample(vec![
            errors("a_mean", [11.0, 11.0, 12.0, 12.0, 14.0, 14.0, 15.0, 15.0]),
            errors("b_mean", [11.0, 15.0, 11.0, 15.0, 11.0, 15.0, 11.0, 15.0]),
        ]);
        // About their mean the differences of the first are −2 −2 −1 −1 1 1 2 2: products 4 + 2 + 1 − 1 + 1 + 2 + 4 over squares of 20.
        assert!((compared(before, &after).neighbour_correlation - 0.65).abs() < 1e-12);
    }

    #[test]
    fn alpha_is_above_nought_and_below_a_half() {
        let with = |alpha| CompareOptions { alpha, ..CompareOptions::default() };
        for alpha in [0.0, 0.5, -0.05, 1.0, f64::NAN] {
            let message = refusal(hits(&BEFORE), &hits(&AFTER), &with(alpha));
            let expected = format!("--alpha is {alpha}, expected a number above 0 and below 0.5");
            assert!(message.contains(&expected), "{message}");
        }
        // 10/512 is what the test finds.
        for (alpha, verdict) in [(0.49, FigureVerdict::Worse), (0.015, FigureVerdict::NoWorse)] {
            let report = compare(&baseline(hits(&BEFORE)), &hits(&AFTER), &with(alpha)).unwrap();
            assert_eq!((report.verdict, report.alpha), (verdict, alpha));
        }
    }

    /// Of five blocks no exchange has a probability below 1/32: at 5 % they can be found different, at 3 % not.
    #[test]
    fn a_gate_that_cannot_shut_is_an_error() {
        let with = |alpha| CompareOptions { alpha, ..CompareOptions::default() };
        let (before, after) = (hits(&[1; 5]), hits(&[0; 5]));
        let report = compare(&baseline(before.clone()), &after, &with(0.05)).unwrap();
        assert_eq!(report.verdict, FigureVerdict::Worse);
        let message = refusal(before, &after, &with(0.03));
        let expected = "5 frames in 5 blocks leave no figure that could be found worse at alpha = 0.03";
        assert!(message.contains(expected), "{message}");
    }

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
        // Another cause is an answer.
        let mut answered = hits(&AFTER);
        answered.table.units[4] = unit(4, "missed", Some("not_linked"));
        compared(hits(&BEFORE), &answered);
        let message = refusal(silent(&BEFORE, &[1]), &silent(&AFTER, &[5, 7]), &CompareOptions::default());
        let expected =
            "the result has no measurement of 2 of 12 frames (the first is number 5), the baseline of 1;";
        assert!(message.contains(expected), "{message}");
    }

    #[test]
    fn figures_are_those_that_are_asked_for_in_the_order_of_the_result() {
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

    /// Seven of twelve are lost: no worse where as many may be, and worse where one less may.
    #[test]
    fn a_figure_may_be_worse_by_its_tolerance() {
        let with = |tolerance: f64| {
            let tolerances = IndexMap::from([("hit_rate".to_owned(), tolerance)]);
            let options = CompareOptions { tolerances, ..CompareOptions::default() };
            compare(&baseline(hits(&BEFORE)), &hits(&AFTER), &options).unwrap().verdict
        };
        assert_eq!(with(7.01 / 12.0), FigureVerdict::NoWorse);
        assert_eq!(with(6.99 / 12.0), FigureVerdict::Worse);
    }

    #[test]
    fn a_figure_must_count_within_the_same_limit_and_by_the_same_attitude() {
        let of = |limit_deg, attitude: Option<&str>| {
            let figure = FigureTerms { limit_deg, ..rate("ra_within_1px", &BEFORE) };
            let attitude = attitude.map(str::to_owned);
            sample(vec![
                figure.resting_on(&figure_called("ra_within_1px"), attitude.as_ref()),
                rate("hit_rate", &BEFORE),
            ])
        };
        let refused = |before: Sample, after: Sample, part: &str| {
            let message = refusal(before.clone(), &after, &CompareOptions::default());
            assert!(message.contains(part) && message.contains("--figures chooses others"), "{message}");
            let options =
                CompareOptions { figures: vec!["hit_rate".to_owned()], ..CompareOptions::default() };
            assert_eq!(compare(&baseline(before), &after, &options).unwrap().verdict, FigureVerdict::NoWorse);
        };
        refused(
            of(Some(0.024), None),
            of(Some(0.25), None),
            "`ra_within_1px` counts errors below 0.024° in the baseline and 0.25° in the result, expected the same (`within_deg`",
        );
        refused(of(None, None), of(Some(0.25), None), "a limit that is not recorded in the baseline");
        refused(
            of(Some(0.024), Some("true")),
            of(Some(0.024), Some("own")),
            "`ra_within_1px` is of lines of sight by the attitude `true` in the baseline and `own` in the result",
        );
        // What found nothing has no attitude: it is worse, and no other thing.
        let report = compared(of(None, Some("own")), &of(None, None));
        assert!(report.notes.is_empty(), "{:?}", report.notes);
        let report = compared(of(None, Some("true")), &of(None, Some("true")));
        assert!(report.notes[0].contains("by the attitude `true`"), "{:?}", report.notes);
    }

    #[test]
    fn a_figure_must_be_in_both_and_summed_up_alike() {
        let mean = |name: &str| figure(name, Reduction::Mean, &BEFORE.map(|bit| Some(f64::from(bit))));
        let both = |first| sample(vec![first, rate("hit_rate", &BEFORE)]);
        let message =
            refusal(both(mean("ra_mean_deg")), &both(mean("dec_mean_deg")), &CompareOptions::default());
        assert!(
            message.contains("`ra_mean_deg` is a figure of the baseline and not of the result"),
            "{message}"
        );
        let rms = FigureTerms { reduction: Reduction::Rms, ..mean("ra_mean_deg") };
        let message = refusal(both(mean("ra_mean_deg")), &both(rms), &CompareOptions::default());
        let expected =
            "`ra_mean_deg` is a `mean` in the baseline and a `rms` in the result, expected the same";
        assert!(message.contains(expected), "{message}");
        // What the result alone has is nothing to be held against.
        let report = compared(hits(&BEFORE), &both(mean("ra_mean_deg")));
        assert_eq!(report.figures.keys().collect::<Vec<_>>(), ["hit_rate"]);
    }

    #[test]
    fn another_simulator_is_noted_where_the_seed_is_the_same() {
        let note = |seed: u64, frames: &str| {
            let mut after = hits(&BEFORE);
            after.identity.seed = seed;
            after.identity.frames_sha256 = frames.to_owned();
            compared(hits(&BEFORE), &after).notes
        };
        let [changed] = &note(1, "g")[..] else { panic!("one note") };
        assert!(changed.contains("the simulator has changed (version 0.1.0 then, 0.1.0 now)"), "{changed}");
        assert_eq!(note(1, "f"), Vec::<String>::new());
        assert_eq!(note(2, "g"), Vec::<String>::new());
    }

    /// Of two figures in 25 blocks the 97.5 % quantile over 5, 0.392.
    #[test]
    fn blocks_that_go_together_more_than_by_chance_are_noted() {
        let baseline = baseline(hits(&[1; 25]));
        let notes = |correlation: f64| notes(&baseline, &baseline.sample, Pairing::Frames, (correlation, 2));
        let [short] = &notes(0.3921)[..] else { panic!("one note") };
        assert!(short.contains("(correlation 0.39, by chance at most 0.39): they are too short"), "{short}");
        for correlation in [0.3919, 0.0, -0.5, normal_quantile(0.975) / 5.0] {
            assert!(notes(correlation).is_empty(), "{correlation}");
        }
    }

    /// A figure best when less, of ten blocks, from 2 in the baseline to `result`.
    fn effect(result: f64) -> FigureEffect {
        FigureEffect {
            sense: figure_called("ra_rms_deg").sense,
            baseline: Some(2.0),
            result: Some(result),
            baseline_of: 100,
            result_of: 50,
            blocks: 10,
            worse: BlockEffects { effects: Vec::new() },
            standard_error: 0.25,
            tolerance: 0.5,
        }
    }

    /// What is reported of an effect that is the first of so many figures, at 5 %, with these adjusted probabilities of a worsening and of
    /// an improvement.
    fn judged(
        effect: &FigureEffect,
        [worse, better]: [f64; 2],
        critical: f64,
        figures: usize,
    ) -> FigureReport {
        let test = |adjusted_p| {
            let tested = Tested { statistic: 1.0, p: 0.5 * adjusted_p, adjusted_p };
            JointTest { figures: vec![tested; figures], critical }
        };
        let (worse, better) = (&test(worse), &test(better));
        Judge { effect, worse, better, index: 0, other_side: None, alpha: 0.05 }.report(Some((0.25, 0.75)))
    }

    #[test]
    fn worse_is_what_is_improbable_and_beyond_the_tolerance() {
        use FigureVerdict::{Better, NoWorse, Worse};
        let verdict = |result: f64, probabilities| judged(&effect(result), probabilities, 2.0, 1).verdict;
        // At most alpha; a worsening of more than 0.5.
        assert_eq!(verdict(2.75, [0.05, 1.0]), Worse);
        assert_eq!(verdict(2.75, [0.01, 1.0]), Worse);
        assert_eq!(verdict(2.75, [0.051, 1.0]), NoWorse);
        assert_eq!(verdict(2.5, [0.01, 1.0]), NoWorse);
        assert_eq!(verdict(2.25, [0.01, 1.0]), NoWorse);
        // The same the other way round.
        assert_eq!(verdict(1.25, [1.0, 0.05]), Better);
        assert_eq!(verdict(1.25, [1.0, 0.01]), Better);
        assert_eq!(verdict(1.25, [1.0, 0.051]), NoWorse);
        assert_eq!(verdict(1.5, [1.0, 0.01]), NoWorse);
        assert_eq!(verdict(1.75, [1.0, 0.01]), NoWorse);
        // Neither is said of the other's probability.
        assert_eq!(verdict(2.75, [1.0, 0.01]), NoWorse);
        assert_eq!(verdict(1.25, [0.01, 1.0]), NoWorse);
    }

    /// Ten blocks that all agree have a statistic of √10.
    #[test]
    fn what_cannot_exceed_the_critical_value_has_too_little_data() {
        let report = |critical: f64| judged(&effect(2.75), [0.01, 1.0], critical, 1);
        for critical in [10f64.sqrt(), 10f64.sqrt() - 1e-10, 4.0] {
            let found = report(critical);
            assert_eq!((found.verdict, found.smallest_visible), (FigureVerdict::TooLittleData, None));
        }
        for critical in [10f64.sqrt() - 1e-8, 0.0] {
            let found = report(critical);
            assert_eq!(found.verdict, FigureVerdict::Worse);
            assert!(found.smallest_visible.is_some());
        }
    }

    /// That all of ten blocks lose a figure by chance has a probability of 2⁻¹⁰, less than a thousandth; of nine, or of two figures, more.
    #[test]
    fn a_figure_that_the_result_lacks_is_gone_when_that_is_no_chance() {
        let verdict = |baseline, result, blocks, figures| {
            let effect = FigureEffect { baseline, result, blocks, ..effect(0.0) };
            let found = judged(&effect, [1.0, 1.0], 2.0, figures);
            assert_eq!((found.difference, found.low, found.high), (None, None, None));
            assert_eq!((found.worse_by, found.smallest_visible), (None, None));
            found.verdict
        };
        let too_little = FigureVerdict::TooLittleData;
        assert_eq!(verdict(Some(2.0), None, 10, 1), FigureVerdict::Gone);
        assert_eq!(verdict(Some(2.0), None, 9, 1), too_little);
        assert_eq!(verdict(Some(2.0), None, 10, 2), too_little);
        assert_eq!(verdict(Some(2.0), None, 11, 2), FigureVerdict::Gone);
        // What the baseline did not have cannot be worse.
        assert_eq!(verdict(None, Some(2.0), 100, 1), too_little);
        assert_eq!(verdict(None, None, 100, 1), too_little);
    }

    #[test]
    fn a_report_of_a_figure_has_its_difference_within_its_interval() {
        let report = |result| judged(&effect(result), [0.5, 0.75], 2.0, 1);
        for (result, low, high) in [(2.5, 0.25, 0.75), (3.0, 0.25, 1.0), (1.5, -0.5, 0.75)] {
            let found = report(result);
            assert_eq!(found.difference, Some(result - 2.0));
            assert_eq!((found.low, found.high), (Some(low), Some(high)));
        }
        let found = report(2.5);
        assert_eq!((found.p, found.adjusted_p, found.better_adjusted_p), (0.25, 0.5, 0.75));
        assert_eq!((found.baseline_of, found.result_of, found.blocks), (100, 50, 10));
        assert_eq!(found.better, "less");
        let near = FigureEffect { sense: figure_called("nees_mean").sense, ..effect(2.5) };
        assert_eq!(judged(&near, [1.0, 1.0], 2.0, 1).better, "near 1");
    }

    /// The statistic must lie 1.645 standard errors above the critical value, that of the comparison or of Bonferroni (0.05/2: 1.960).
    #[test]
    fn the_smallest_visible_amount_is_a_multiple_of_its_standard_error() {
        let seen = |critical, figures, tolerance| {
            let effect = FigureEffect { tolerance, ..effect(2.0) };
            judged(&effect, [1.0, 1.0], critical, figures).smallest_visible.unwrap()
        };
        let is = |got: f64, expected: f64| assert!((got - expected).abs() < 1e-6, "{got}, not {expected}");
        is(seen(3.0, 2, 0.0), 0.25 * (3.0 + 1.644_854));
        is(seen(1.0, 2, 0.0), 0.25 * (1.959_964 + 1.644_854));
        is(seen(1.0, 1, 0.0), 0.25 * (1.644_854 + 1.644_854));
        // A tolerance beyond what is found: it is exceeded with a probability of 95 %.
        is(seen(1.0, 2, 5.0), 5.0 + 0.25 * 1.644_854);
    }

    /// A loss of δ of n scatters by √(δ/n) of its own beside the standard error e: δ = z √(e² + δ/n).
    #[test]
    fn the_smallest_visible_loss_of_a_rate_brings_its_own_scatter() {
        for (standard_error, result_of) in [(0.25, 50), (0.01, 7), (0.0, 400)] {
            let effect = FigureEffect {
                sense: figure_called("hit_rate").sense,
                tolerance: 0.0,
                standard_error,
                result_of,
                ..effect(2.0)
            };
            let seen = judged(&effect, [1.0, 1.0], 3.0, 2).smallest_visible.unwrap();
            let z = 3.0 + 1.644_853_626_951_472_2;
            let expected = z * (standard_error * standard_error + seen / result_of as f64).sqrt();
            assert!(seen > 0.0 && (seen - expected).abs() < 1e-12, "{seen}, not {expected}");
        }
        // Of nothing it is that of one.
        let none = FigureEffect {
            sense: figure_called("hit_rate").sense,
            tolerance: 0.0,
            result_of: 0,
            ..effect(2.0)
        };
        let one = FigureEffect { result_of: 1, ..none.clone() };
        let [none, one] = [none, one].map(|effect| judged(&effect, [1.0, 1.0], 3.0, 2).smallest_visible);
        assert_eq!(none, one);
    }
}
