//! Contribution of each block to the difference of a figure.
//!
//! A rate, a mean and a mean square are a sum divided by a count, r = Σ s/Σ n. Let r₀ be this ratio for both
//! runs together. Block k of a run with the sums s, n then contributes s − r₀ n, and the difference of two
//! runs is exactly Σ [(s − r₀ n) of the result − (s − r₀ n) of the baseline] / N, where N is the harmonic
//! mean of their counts. Exchanging a block between the runs changes only the sign of its term. A root mean
//! square is the root of the mean square, and a median is treated by counting the values on each side of the
//! common median of both runs.
use score::{Better, FigureTerms, Reduction, Sense, Term};
use statistics::{BlockEffects, Interval, SETS, median};

use super::blocks::Blocks;
use super::influence::{Sums, values};

/// One figure of two runs, divided into blocks.
#[derive(Debug, Clone)]
pub(crate) struct FigureEffect {
    pub(crate) sense: Sense,
    /// Value of the figure, in the baseline and in the result; `None` if no unit has a value.
    pub(crate) baseline: Option<f64>,
    pub(crate) result: Option<f64>,
    /// Number of values from which the figure is computed, in the baseline and in the result.
    pub(crate) baseline_of: u64,
    pub(crate) result_of: u64,
    /// Number of blocks in which either run has a value.
    pub(crate) blocks: usize,
    /// Contribution of each block to the worsening of the result, in the unit of the figure; for a figure
    /// with a best value, contribution to its increase.
    pub(crate) worse: BlockEffects,
    /// Standard error of the difference, from the scatter of the blocks.
    pub(crate) standard_error: f64,
    /// Largest worsening that still counts as no worse.
    pub(crate) tolerance: f64,
    /// True if the difference is correlated for longer than the blocks allow: the figure then has no verdict.
    pub(crate) is_beyond_blocks: bool,
}

/// Returns the value of a figure for some terms.
pub(crate) fn value(reduction: Reduction, terms: &[Term]) -> Option<f64> {
    match reduction {
        Reduction::Median => median(&[values(terms)]),
        _ => {
            let ratio = Sums::from_terms(terms, reduction, 0.0).ratio();
            if reduction == Reduction::Rms { ratio.map(f64::sqrt) } else { ratio }
        }
    }
}

impl FigureEffect {
    /// Creates the effect for a figure of two runs whose units correspond one by one.
    pub(crate) fn from_runs(
        sense: Sense,
        baseline: &FigureTerms,
        result: &FigureTerms,
        blocks: &Blocks,
        tolerance: f64,
    ) -> Self {
        let reduction = baseline.reduction;
        let pooled = [values(&baseline.terms), values(&result.terms)];
        let centre = if reduction == Reduction::Median { median(&pooled).unwrap_or(0.0) } else { 0.0 };
        let [a, b] = [baseline, result].map(|run| Sums::from_terms(&run.terms, reduction, centre));
        let [of_baseline, of_result] = [baseline, result].map(|run| value(reduction, &run.terms));

        let together =
            Sums { units: Vec::new(), sum: a.sum + b.sum, count: a.count + b.count }.ratio().unwrap_or(0.0);
        let count = if a.count > 0.0 && b.count > 0.0 {
            2.0 * a.count * b.count / (a.count + b.count)
        } else {
            f64::INFINITY
        };
        let scale = match reduction {
            Reduction::Rate | Reduction::Mean => 1.0,
            Reduction::Rms => match (of_baseline, of_result) {
                (Some(a), Some(b)) if a + b > 0.0 => 1.0 / (a + b),
                _ => 0.0,
            },
            Reduction::Median => half_width_of_a_side(&pooled),
        };
        let mut effects = vec![0.0; blocks.count()];
        let mut has_data = vec![false; blocks.count()];
        for (i, (of_a, of_b)) in a.units.iter().zip(&b.units).enumerate() {
            let block = blocks.block_of(i);
            let difference = (of_b.0 - together * of_b.1) - (of_a.0 - together * of_a.1);
            effects[block] += scale * difference / count;
            has_data[block] |= of_a.1 + of_b.1 > 0.0;
        }

        if sense.better == Better::More {
            effects.iter_mut().for_each(|effect| *effect = -*effect);
        }
        Self {
            sense,
            baseline: of_baseline,
            result: of_result,
            baseline_of: a.count as u64,
            result_of: b.count as u64,
            blocks: has_data.iter().filter(|has| **has).count(),
            standard_error: standard_error(&effects),
            worse: BlockEffects {
                effects,
                has_value: has_data,
                is_two_sided: matches!(sense.better, Better::Near(_)),
            },
            tolerance,
            is_beyond_blocks: false,
        }
    }

    /// Returns the figure without an effect, because its difference is correlated for so long that blocks are
    /// not independent of one another.
    pub(crate) fn beyond_blocks(mut self) -> Self {
        self.worse.effects.fill(0.0);
        self.is_beyond_blocks = true;
        self
    }

    /// Returns the worsening of the result, in the unit of the figure; negative if it is better.
    pub(crate) fn worsening(&self) -> Option<f64> {
        let (baseline, result) = (self.baseline?, self.result?);
        Some(match self.sense.better {
            Better::More => baseline - result,
            Better::Less => result - baseline,
            Better::Near(best) => (result - best).abs() - (baseline - best).abs(),
        })
    }

    /// Returns true if the figure has a best value. Such a figure is compared with the baseline, not with the
    /// best value, and a change to either side is found: a bias that a change of the pipeline causes may be
    /// directed towards zero, because the baseline has a bias of its own.
    pub(crate) fn has_best_value(&self) -> bool {
        matches!(self.sense.better, Better::Near(_))
    }

    /// Returns the change of the result: for a figure with a best value to either side, for other figures the
    /// worsening.
    pub(crate) fn change(&self) -> Option<f64> {
        if self.has_best_value() { Some((self.result? - self.baseline?).abs()) } else { self.worsening() }
    }

    /// Returns the effect with the opposite sign: an improvement, or for a figure with a best value a
    /// decrease.
    pub(crate) fn better(&self) -> BlockEffects {
        self.worse.opposite()
    }
}

/// Returns the change of a median per unit change in the difference between the shares of values on its two
/// sides: 1/(2 f) with the density f at the median, estimated from the middle fifth of the values.
fn half_width_of_a_side(values: &[Vec<f64>]) -> f64 {
    let mut all = values.concat();
    all.sort_by(f64::total_cmp);
    let at = |share: f64| all.get((share * all.len() as f64) as usize);
    at(0.6).zip(at(0.4)).map_or(0.0, |(high, low)| (high - low) / 0.4)
}

/// Returns the standard error of a sum of independent terms.
fn standard_error(terms: &[f64]) -> f64 {
    let n = terms.len() as f64;
    if n < 2.0 {
        return 0.0;
    }
    let mean = terms.iter().sum::<f64>() / n;
    let off = terms.iter().map(|term| term - mean);
    (off.map(|off| off * off).sum::<f64>() * n / (n - 1.0)).sqrt()
}

/// Returns the 95 % interval of the difference, result minus baseline.
pub(crate) fn interval(
    baseline: &FigureTerms,
    result: &FigureTerms,
    blocks: &Blocks,
    exchanges: &statistics::Exchanges,
) -> Option<Interval> {
    let reduction = baseline.reduction;
    let sides = [baseline, result].map(|run| Side::from_run(reduction, &run.terms, blocks));
    statistics::interval_by_sets(exchanges, |weights| {
        let [baseline, result] = [&sides[0], &sides[1]].map(|side| side.values(weights));
        std::array::from_fn(|set| Some(result[set]? - baseline[set]?))
    })
}

/// One run, prepared for reductions over sets of blocks.
enum Side {
    /// Sum and count of each block; `is_root` is true if the figure is the root of their ratio.
    Ratio { blocks: Vec<(f64, f64)>, is_root: bool },
    /// Values in ascending order, the block of each value, and the number of values in each block.
    Sorted { values: Vec<f64>, blocks: Vec<u32>, counts: Vec<usize> },
}

impl Side {
    fn from_run(reduction: Reduction, terms: &[Term], blocks: &Blocks) -> Self {
        if reduction == Reduction::Median {
            let with_value = terms.iter().enumerate().filter(|(_, term)| term.count > 0);
            let mut sorted: Vec<(f64, u32)> =
                with_value.map(|(unit, term)| (term.sum, blocks.block_of(unit) as u32)).collect();
            sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut counts = vec![0; blocks.count()];
            sorted.iter().for_each(|(_, block)| counts[*block as usize] += 1);
            let (values, blocks) = sorted.into_iter().unzip();
            return Self::Sorted { values, blocks, counts };
        }
        let mut sums = vec![(0.0, 0.0); blocks.count()];
        for (unit, (sum, of)) in Sums::from_terms(terms, reduction, 0.0).units.into_iter().enumerate() {
            let block = &mut sums[blocks.block_of(unit)];
            *block = (block.0 + sum, block.1 + of);
        }
        Self::Ratio { blocks: sums, is_root: reduction == Reduction::Rms }
    }

    /// Returns the figure over the blocks of each set, if it has a value there.
    fn values(&self, weights: &[[f64; SETS]]) -> [Option<f64>; SETS] {
        match self {
            Self::Ratio { blocks, is_root } => {
                // All sets side by side: their sums do not wait for each other.
                let (mut sums, mut counts) = ([0.0; SETS], [0.0; SETS]);
                for (block, weights) in blocks.iter().zip(weights) {
                    for set in 0..SETS {
                        sums[set] += weights[set] * block.0;
                        counts[set] += weights[set] * block.1;
                    }
                }
                std::array::from_fn(|set| {
                    let ratio = (counts[set] > 0.0).then(|| sums[set] / counts[set])?;
                    Some(if *is_root { ratio.max(0.0).sqrt() } else { ratio })
                })
            }
            Self::Sorted { values, blocks, counts } => std::array::from_fn(|set| {
                let taken: Vec<bool> = weights.iter().map(|weights| weights[set] > 0.0).collect();
                let count: usize =
                    counts.iter().zip(&taken).map(|(count, taken)| count * usize::from(*taken)).sum();
                let mut before = count.checked_sub(1)? / 2;
                let is_taken = |block: &u32| taken[*block as usize];
                // Complete chunks before the median are counted without branches.
                let mut first = 0;
                for part in blocks.chunks(64) {
                    let of_part: usize = part.iter().map(|block| usize::from(is_taken(block))).sum();
                    if of_part > before {
                        break;
                    }
                    before -= of_part;
                    first += part.len();
                }
                let rest = values[first..].iter().zip(&blocks[first..]);
                let mut middle =
                    rest.filter(|(_, block)| is_taken(block)).map(|(value, _)| *value).skip(before);
                let lower = middle.next()?;
                Some(if count % 2 == 1 { lower } else { f64::midpoint(lower, middle.next()?) })
            }),
        }
    }
}

/// Returns the correlation of the effects of neighbouring blocks, about their mean; 0 if no block differs.
/// For independent blocks it scatters about 0 by 1/√n.
pub(crate) fn neighbour_correlation(effects: &[f64]) -> f64 {
    let mean = effects.iter().sum::<f64>() / effects.len().max(1) as f64;
    let off: Vec<f64> = effects.iter().map(|effect| effect - mean).collect();
    let squares: f64 = off.iter().map(|off| off * off).sum();
    let products: f64 = off.windows(2).map(|pair| pair[0] * pair[1]).sum();
    if squares > 0.0 { products / squares } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand_made::figure as terms;
    use run::figure_by_name;
    use score::Kind;
    use statistics::Exchanges;

    fn effect(name: &str, reduction: Reduction, a: &[Option<f64>], b: &[Option<f64>]) -> FigureEffect {
        crate::hand_made::register_worlds();
        let blocks = Blocks::every(a.len(), 2);
        FigureEffect::from_runs(
            figure_by_name(name).sense,
            &terms(name, reduction, a),
            &terms(name, reduction, b),
            &blocks,
            0.0,
        )
    }

    const A: [Option<f64>; 8] =
        [Some(0.1), Some(-0.3), None, Some(0.4), Some(0.2), Some(-0.1), Some(0.5), None];
    const B: [Option<f64>; 8] =
        [Some(0.2), Some(-0.5), Some(0.9), None, Some(0.3), Some(0.1), Some(0.8), Some(0.3)];

    #[test]
    fn the_blocks_of_a_mean_and_of_a_root_mean_square_add_up_to_its_difference() {
        for (name, reduction) in [("ra_mean_deg", Reduction::Mean), ("ra_rms_deg", Reduction::Rms)] {
            let effect = effect(name, reduction, &A, &B);
            let difference = effect.result.unwrap() - effect.baseline.unwrap();
            assert!((effect.worse.effects.iter().sum::<f64>() - difference).abs() < 1e-12, "{name}");
            assert_eq!((effect.baseline_of, effect.result_of, effect.blocks), (6, 7, 4));
        }
    }

    #[test]
    fn the_block_effects_of_a_rate_are_losses_minus_gains() {
        let rate = |bits: [u8; 6]| bits.map(|bit| Some(f64::from(bit)));
        let effect =
            effect("hit_rate", Reduction::Rate, &rate([1, 1, 1, 0, 1, 1]), &rate([0, 0, 1, 1, 1, 1]));
        for (got, expected) in effect.worse.effects.iter().zip([2.0, -1.0, 0.0]) {
            assert!((got - expected / 6.0).abs() < 1e-12, "{effect:?}");
        }
        assert!((effect.worsening().unwrap() - 1.0 / 6.0).abs() < 1e-12);
    }

    /// Exchanging a block between the two runs changes only the sign of its effect.
    #[test]
    fn an_exchanged_block_has_the_opposite_effect() {
        for (name, reduction) in [
            ("ra_mean_deg", Reduction::Mean),
            ("ra_rms_deg", Reduction::Rms),
            ("ra_median_deg", Reduction::Median),
        ] {
            let (mut a, mut b) = (A, B);
            let before = effect(name, reduction, &a, &b).worse;
            a[2..4].swap_with_slice(&mut b[2..4]);
            let after = effect(name, reduction, &a, &b).worse;
            // The counts are exchanged too: this may scale all effects by a common factor, which does not
            // affect any statistic.
            let scale = after.effects[0] / before.effects[0];
            for (block, (x, y)) in before.effects.iter().zip(&after.effects).enumerate() {
                let expected = if block == 1 { -scale * x } else { scale * x };
                assert!((y - expected).abs() < 1e-12, "{name}, block {block}: {before:?} {after:?}");
            }
        }
    }

    /// Changes towards zero, across zero and away from zero are each measured by their own size.
    #[test]
    fn a_bias_is_held_against_the_baseline_and_not_against_nought() {
        let bias = |bias: f64| [0.1, -0.1, 0.2, -0.2].map(|x| Some(x + bias));
        for (before, after, worsening) in [(0.05, -0.06, 0.01), (-0.05, -0.08, 0.03), (-0.08, -0.05, -0.03)] {
            let effect = effect("ra_mean_deg", Reduction::Mean, &bias(before), &bias(after));
            assert!(
                (effect.worse.effects.iter().sum::<f64>() - (after - before)).abs() < 1e-12,
                "{effect:?}"
            );
            assert!((effect.change().unwrap() - (after - before).abs()).abs() < 1e-12, "{effect:?}");
            assert!((effect.worsening().unwrap() - worsening).abs() < 1e-12, "{effect:?}");
        }
    }

    #[test]
    fn the_interval_of_a_shift_of_every_value_is_the_shift() {
        let shifted = A.map(|value| value.map(|value| value + 0.25));
        for (name, reduction) in [("ra_mean_deg", Reduction::Mean), ("ra_median_deg", Reduction::Median)] {
            let [a, b] = [&A, &shifted].map(|values| terms(name, reduction, values));
            let blocks = Blocks::every(8, 1);
            let interval = interval(&a, &b, &blocks, &Exchanges::new(blocks.count())).unwrap();
            assert!((interval.low - 0.25).abs() < 1e-12 && (interval.high - 0.25).abs() < 1e-12, "{name}");
        }
    }

    #[test]
    fn a_figure_without_terms_has_no_effect() {
        for (a, b, blocks) in [(&A, &[None; 8], 4), (&[None; 8], &A, 4), (&[None; 8], &[None; 8], 0)] {
            for (name, reduction) in [
                ("ra_rms_deg", Reduction::Rms),
                ("ra_mean_deg", Reduction::Mean),
                ("ra_median_deg", Reduction::Median),
            ] {
                let none = effect(name, reduction, a, b);
                assert_eq!((none.baseline.and(none.result), none.worsening()), (None, None), "{name}");
                assert!(none.worse.effects.iter().all(|effect| *effect == 0.0), "{none:?}");
                assert_eq!(none.blocks, blocks);
            }
        }
    }

    /// Four blocks of one unit: both runs have a value, only the first, only the second, neither.
    #[test]
    fn a_block_counts_when_either_run_has_a_value_in_it() {
        let [a, b] = [[Some(1.0), Some(2.0), None, None], [Some(1.0), None, Some(3.0), None]]
            .map(|values| terms("ra_rms_deg", Reduction::Rms, &values));
        let effect =
            FigureEffect::from_runs(figure_by_name("ra_rms_deg").sense, &a, &b, &Blocks::every(4, 1), 0.0);
        assert_eq!((effect.blocks, effect.baseline_of, effect.result_of), (3, 2, 2));
    }

    #[test]
    fn errors_of_nought_may_grow_and_errors_that_stay_nought_do_not() {
        let [nought, half] = [0.0, 0.5].map(|error| [Some(error); 8]);
        let grown = effect("ra_rms_deg", Reduction::Rms, &nought, &half);
        assert!((grown.worse.effects.iter().sum::<f64>() - 0.5).abs() < 1e-12, "{grown:?}");
        let same = effect("ra_rms_deg", Reduction::Rms, &nought, &nought);
        assert!(same.worse.effects.iter().all(|effect| *effect == 0.0), "{same:?}");
    }

    /// Above the best value, below it or across it, the test uses the difference itself.
    #[test]
    fn a_figure_that_is_best_near_a_value_is_tested_by_its_distance_from_it() {
        for (reduction, a, b) in [
            (Reduction::Mean, 1.5, 2.0),
            (Reduction::Mean, 0.25, 0.5),
            (Reduction::Mean, 1.5, 0.75),
            (Reduction::Rms, 2.0, 4.0),
        ] {
            let [before, after] = [a, b].map(|value| terms("any", reduction, &[Some(value); 4]));
            let sense = Sense { kind: Kind::Amount, better: Better::Near(1.0) };
            let effect = FigureEffect::from_runs(sense, &before, &after, &Blocks::every(4, 1), 0.0);
            let sum = effect.worse.effects.iter().sum::<f64>();
            assert!((sum - (b - a)).abs() < 1e-12 && effect.has_best_value(), "{a} {b}: {effect:?}");
        }
    }

    #[test]
    fn a_side_is_summed_up_over_the_blocks_that_are_taken_alone() {
        let values = [Some(4.0), None, Some(1.0), Some(8.0), Some(-2.0), Some(5.0), None, None];
        let blocks = Blocks::every(8, 2);
        let of = |reduction, taken: [bool; 4]| {
            // The other sets take no block.
            let weights = taken.map(|taken| {
                let mut weights = [0.0; SETS];
                weights[3] = f64::from(u8::from(taken));
                weights
            });
            let side = Side::from_run(reduction, &terms("any", reduction, &values).terms, &blocks);
            let values = side.values(&weights);
            assert!(values.iter().enumerate().all(|(set, value)| set == 3 || value.is_none()));
            values[3]
        };
        let (all, some) = ([true; 4], [true, true, false, true]);
        // 4 + 1 + 8 − 2 + 5 = 16 for 5 values; without the third block 13 for 3.
        assert_eq!(of(Reduction::Mean, all), Some(16.0 / 5.0));
        assert_eq!(of(Reduction::Mean, some), Some(13.0 / 3.0));
        // 16 + 1 + 64 + 4 + 25 = 110 for 5 values; in the second block 65 for 2.
        assert_eq!(of(Reduction::Rms, all), Some(22f64.sqrt()));
        assert_eq!(of(Reduction::Rms, [false, true, false, false]), Some(32.5f64.sqrt()));
        // −2 1 4 5 8; 1 4 8; 1 8; −2 1 5 8; 4.
        assert_eq!(of(Reduction::Median, all), Some(4.0));
        assert_eq!(of(Reduction::Median, some), Some(4.0));
        assert_eq!(of(Reduction::Median, [false, true, false, false]), Some(4.5));
        assert_eq!(of(Reduction::Median, [false, true, true, false]), Some(3.0));
        assert_eq!(of(Reduction::Median, [true, false, false, false]), Some(4.0));
        for reduction in [Reduction::Mean, Reduction::Rms, Reduction::Median] {
            assert_eq!(of(reduction, [false, false, false, true]), None, "{reduction:?} of no value");
        }
    }

    /// A fortieth of the 127 sets of seven blocks is excluded at each end: the limit is the third set from
    /// the end.
    #[test]
    fn the_interval_is_that_of_the_differences_over_sets_of_blocks() {
        let nought = terms("ra_mean_deg", Reduction::Mean, &[Some(1.0); 7]);
        let powers = [0, 1, 2, 3, 4, 5, 6].map(|block| Some(1.0 + f64::from(1 << block)));
        let powers = terms("ra_mean_deg", Reduction::Mean, &powers);
        let interval = interval(&nought, &powers, &Blocks::every(7, 1), &Exchanges::new(7)).unwrap();
        // Means of sets in ascending order: 1, (1 + 2)/2, 2; in descending order: 64, (64 + 32)/2, (64 +
        // 16)/2.
        assert!((interval.low - 2.0).abs() < 1e-12, "{interval:?}");
        assert!((interval.high - 40.0).abs() < 1e-12, "{interval:?}");
    }

    #[test]
    fn a_figure_combines_its_units_by_its_reduction() {
        let values = [Some(1.0), None, Some(2.0), Some(-6.0)];
        let of = |reduction| value(reduction, &terms("any", reduction, &values).terms);
        assert_eq!(of(Reduction::Mean), Some(-1.0));
        // (1 + 4 + 36)/3.
        assert_eq!(of(Reduction::Rms), Some((41.0f64 / 3.0).sqrt()));
        assert_eq!(of(Reduction::Median), Some(1.0));
        let pooled = [Term { sum: 2.0, count: 3 }, Term::default(), Term { sum: 1.0, count: 1 }];
        assert_eq!(value(Reduction::Rate, &pooled), Some(0.75));
        for reduction in Reduction::ALL {
            assert_eq!(value(reduction, &[Term::default(); 2]), None, "{reduction:?} of nothing");
        }
    }

    #[test]
    fn worse_depends_on_the_better_direction() {
        let worsening = |name: &str, reduction, a: f64, b: f64| {
            effect(name, reduction, &[Some(a)], &[Some(b)]).worsening().unwrap()
        };
        let is = |got: f64, expected: f64| assert!((got - expected).abs() < 1e-12, "{got}, not {expected}");
        is(worsening("stars_mean", Reduction::Mean, 20.0, 17.0), 3.0);
        is(worsening("ra_rms_deg", Reduction::Rms, 0.5, 0.75), 0.25);
        is(worsening("ra_rms_deg", Reduction::Rms, 0.75, 0.5), -0.25);
        // A NEES is best at 1: from 0.7 to 1.5 its distance from 1 grows from 0.3 to 0.5.
        is(worsening("nees_mean", Reduction::Mean, 0.7, 1.5), 0.2);
        is(worsening("nees_mean", Reduction::Mean, 1.5, 0.7), -0.2);
    }

    /// Ten values, each increased by one. The middle fifth has a width of 2, so the density at the median is
    /// 1/10.
    #[test]
    fn the_blocks_of_a_median_are_the_values_that_change_sides() {
        let count = |from: usize| (from..from + 10).map(|x| Some(x as f64)).collect::<Vec<_>>();
        let effect = effect("ra_median_deg", Reduction::Median, &count(1), &count(2));
        // The common median is 6. One value rises to it and one value rises above it, both in the third
        // block: together, one of ten values changes sides, and the median changes by 1/10 divided by the
        // density.
        for (got, expected) in effect.worse.effects.iter().zip([0.0, 0.0, 1.0, 0.0, 0.0]) {
            assert!((got - expected).abs() < 1e-12, "{effect:?}");
        }
        assert_eq!(effect.worse.effects.len(), 5);
    }

    /// For 0, 1, 4 … 81 the middle fifth is from 16 to 36, with a density of 1/100.
    #[test]
    fn the_density_at_the_median_is_that_of_the_middle_fifth() {
        let squares: Vec<f64> = (0..10).map(|x| f64::from(x * x)).collect();
        let [low, high] = [squares[..3].to_vec(), squares[3..].to_vec()];
        assert!((half_width_of_a_side(&[high, low]) - 50.0).abs() < 1e-12);
        assert_eq!(half_width_of_a_side(&[vec![], vec![]]), 0.0);
    }

    /// For 1, 2, 4, 5 the sample variance is 10/3, and the variance of the sum of four terms 40/3.
    #[test]
    fn the_standard_error_of_a_sum_is_that_of_its_terms_scatter() {
        assert!((standard_error(&[1.0, 2.0, 4.0, 5.0]) - (40.0f64 / 3.0).sqrt()).abs() < 1e-12);
        // (1 + 1)/1 times two.
        assert!((standard_error(&[1.0, 3.0]) - 2.0).abs() < 1e-12);
        assert_eq!(standard_error(&[7.0]), 0.0);
        assert_eq!(standard_error(&[]), 0.0);
    }

    #[test]
    fn neighbouring_blocks_are_correlated_about_their_mean() {
        // Deviations from the mean 3: −2 −1 1 2. (2 − 1 + 2)/(4 + 1 + 1 + 4).
        assert!((neighbour_correlation(&[1.0, 2.0, 4.0, 5.0]) - 0.3).abs() < 1e-12);
        // Deviations from the mean 3: −1 1 −1 1.
        assert!((neighbour_correlation(&[2.0, 4.0, 2.0, 4.0]) + 0.75).abs() < 1e-12);
        assert_eq!(neighbour_correlation(&[2.0; 4]), 0.0);
        assert_eq!(neighbour_correlation(&[]), 0.0);
    }

    /// An improvement has the same effect with the opposite sign and the same size.
    #[test]
    fn an_improvement_is_a_worsening_with_the_other_sign() {
        let effect = effect("ra_mean_deg", Reduction::Mean, &A, &B);
        let better = effect.better();
        assert!(effect.worse.effects.iter().zip(&better.effects).all(|(worse, better)| *worse == -better));
        assert!(better.effects.iter().any(|effect| *effect != 0.0));
    }
}
