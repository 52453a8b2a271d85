//! A result against a baseline.

use indexmap::IndexMap;

use super::baseline::Baseline;
use super::effects::{FigureEffect, interval, neighbour_correlation};
use super::flips::Flips;
use super::identity::Pairing;
use super::report::{FigureReport, FigureVerdict, GateReport};
use super::sample::Sample;
use crate::failure::Failure;
use crate::score::{Better, FigureTerms, Kind, Sense, UnitVerdict, sense};
use crate::statistics::{BlockEffects, Exchanges, JointTest, joint_test, normal_quantile};
use crate::toml_file;

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
}

impl Default for CompareOptions {
    fn default() -> Self {
        Self { alpha: 0.05, figures: Vec::new(), tolerances: IndexMap::new() }
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
    check_units(baseline, result, units)?;
    check_reported(baseline, result, units)?;
    let pairs = pairs(baseline, result, options)?;

    let blocks = &baseline.blocks;
    let exchanges = Exchanges::new(blocks.count());
    let effects: Vec<FigureEffect> = pairs
        .iter()
        .map(|(before, after)| {
            let tolerance = options.tolerances.get(&before.name).copied();
            FigureEffect::new(sense(&before.name), before, after, blocks, tolerance)
        })
        .collect();
    let worse: Vec<BlockEffects> = effects.iter().map(|effect| effect.worse.clone()).collect();
    let better: Vec<BlockEffects> = effects.iter().map(FigureEffect::better).collect();
    let (worse, better) = (joint_test(&worse, &exchanges, alpha), joint_test(&better, &exchanges, alpha));

    let mut figures = IndexMap::new();
    let mut correlation: f64 = 0.0;
    for (index, ((before, after), effect)) in pairs.iter().zip(&effects).enumerate() {
        let judge = Judge { effect, worse: &worse, better: &better, index, alpha, figures: pairs.len() };
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
    let is_worse = figures.values().any(|figure| figure.verdict.is_worse());
    Ok(GateReport {
        verdict: if is_worse { FigureVerdict::Worse } else { FigureVerdict::NoWorse },
        name: identity.name.clone(),
        world: identity.world.clone(),
        reason: baseline.header.reason.clone(),
        units: units.to_owned(),
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
                Some(after) if after.reduction == before.reduction => Ok((before, after)),
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

/// What a reader must know. `correlation` is the largest of neighbouring blocks, and of how many figures it is that.
fn notes(
    baseline: &Baseline,
    result: &Sample,
    pairing: Pairing,
    (correlation, figures): (f64, usize),
) -> Vec<String> {
    let mut notes = Vec::new();
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
    alpha: f64,
    figures: usize,
}

impl Judge<'_> {
    fn report(&self, interval: Option<(f64, f64)>) -> FigureReport {
        let effect = self.effect;
        let difference = effect.result.zip(effect.baseline).map(|(result, baseline)| result - baseline);
        let tested = self.worse.figures[self.index];
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

    fn verdict(&self) -> FigureVerdict {
        let effect = self.effect;
        if effect.baseline.is_some() && effect.result.is_none() {
            let by_chance = self.figures as f64 * libm::exp2(-(effect.blocks as f64));
            return if by_chance <= GONE_BY_CHANCE {
                FigureVerdict::Gone
            } else {
                FigureVerdict::TooLittleData
            };
        }
        let Some(worsening) = effect.worsening() else { return FigureVerdict::TooLittleData };
        if !self.can_be_seen() {
            FigureVerdict::TooLittleData
        } else if self.worse.figures[self.index].adjusted_p <= self.alpha && worsening > effect.tolerance {
            FigureVerdict::Worse
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
        let bonferroni = normal_quantile(1.0 - self.alpha / self.figures as f64);
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
