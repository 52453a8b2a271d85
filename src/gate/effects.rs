//! What each block adds to the difference of a figure.
//!
//! A rate, a mean and a mean square are a sum over a count, r = Σ s/Σ n. With r₀ of both runs together, block k of a run with the sums
//! s, n adds s − r₀ n to it, and the difference of two runs is, exactly, Σ [(s − r₀ n) of the result − the same of the baseline] / N with N
//! the harmonic mean of their counts. Exchanging a block of the two changes the sign of its term and nothing else. A root mean square is
//! the root of the mean square, and a median counts on which side of the median of both runs together values lie.

use super::blocks::Blocks;
use crate::score::{Better, FigureTerms, Kind, Reduction, Sense, Term};
use crate::statistics::{BlockEffects, Interval, median};

/// Share of an amount's own size by which it may differ and be as good: what a change of the last digits or of a compiler does is
/// no worsening, however surely it is seen.
const TOLERANCE: f64 = 0.01;

/// One figure of two runs, by blocks.
#[derive(Debug, Clone)]
pub(super) struct FigureEffect {
    pub(super) sense: Sense,
    /// Its value in the baseline and in the result; `None` when counted over nothing.
    pub(super) baseline: Option<f64>,
    pub(super) result: Option<f64>,
    /// What they are counted over.
    pub(super) baseline_of: u64,
    pub(super) result_of: u64,
    /// Blocks in which either has a value.
    pub(super) blocks: usize,
    /// By how much each block makes the result worse, in the unit of the figure.
    pub(super) worse: BlockEffects,
    /// Standard error of the difference, by the scatter of the blocks.
    pub(super) standard_error: f64,
    /// By how much the result may be worse and no worse be said.
    pub(super) tolerance: f64,
}

/// One run's sums for a figure.
struct Sums {
    /// Per unit: sum and count, linearised.
    units: Vec<(f64, f64)>,
    sum: f64,
    of: f64,
}

impl Sums {
    fn new(terms: &[Term], reduction: Reduction, centre: f64) -> Self {
        let linear = |term: &Term| match reduction {
            Reduction::Rate | Reduction::Mean => term.sum,
            Reduction::Rms => term.sum * term.sum,
            Reduction::Median if term.of == 0 => 0.0,
            Reduction::Median => f64::from(i8::from(term.sum > centre) - i8::from(term.sum < centre)),
        };
        let units: Vec<(f64, f64)> = terms.iter().map(|term| (linear(term), f64::from(term.of))).collect();
        let (sum, of) = units.iter().fold((0.0, 0.0), |(sum, of), unit| (sum + unit.0, of + unit.1));
        Self { units, sum, of }
    }

    fn ratio(&self) -> Option<f64> {
        (self.of > 0.0).then(|| self.sum / self.of)
    }
}

/// The values of a figure that has at most one a unit.
fn values(terms: &[Term]) -> Vec<f64> {
    terms.iter().filter(|term| term.of > 0).map(|term| term.sum).collect()
}

/// The value of a figure over some terms.
pub(super) fn value(reduction: Reduction, terms: &[Term]) -> Option<f64> {
    match reduction {
        Reduction::Median => median(&[values(terms)]),
        _ => {
            let ratio = Sums::new(terms, reduction, 0.0).ratio();
            if reduction == Reduction::Rms { ratio.map(f64::sqrt) } else { ratio }
        }
    }
}

impl FigureEffect {
    /// Of a figure of two runs whose units go together one by one; `tolerance` replaces the default one.
    pub(super) fn new(
        sense: Sense,
        baseline: &FigureTerms,
        result: &FigureTerms,
        blocks: &Blocks,
        tolerance: Option<f64>,
    ) -> Self {
        let reduction = baseline.reduction;
        let pooled = [values(&baseline.terms), values(&result.terms)];
        let centre = if reduction == Reduction::Median { median(&pooled).unwrap_or(0.0) } else { 0.0 };
        let [a, b] = [baseline, result].map(|run| Sums::new(&run.terms, reduction, centre));
        let [of_baseline, of_result] = [baseline, result].map(|run| value(reduction, &run.terms));

        let together = if a.of + b.of > 0.0 { (a.sum + b.sum) / (a.of + b.of) } else { 0.0 };
        let count = if a.of > 0.0 && b.of > 0.0 { 2.0 * a.of * b.of / (a.of + b.of) } else { f64::INFINITY };
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
            let block = blocks.of(i);
            let difference = (of_b.0 - together * of_b.1) - (of_a.0 - together * of_a.1);
            effects[block] += scale * difference / count;
            has_data[block] |= of_a.1 + of_b.1 > 0.0;
        }

        // The value of both runs together, of which it is known on which side of the best one it lies whatever is exchanged.
        let middle = match reduction {
            Reduction::Median => centre,
            Reduction::Rms => together.sqrt(),
            _ => together,
        };
        let (sign, most) = match sense.better {
            Better::More => (-1.0, f64::INFINITY),
            Better::Less => (1.0, f64::INFINITY),
            Better::Near(best) => (if middle < best { -1.0 } else { 1.0 }, 2.0 * (middle - best).abs()),
        };
        effects.iter_mut().for_each(|effect| *effect *= sign);
        let by_default = match sense.kind {
            Kind::Rate => 0.0,
            Kind::Amount => {
                let best = if let Better::Near(best) = sense.better { best } else { 0.0 };
                let all = pooled.concat();
                let squares: f64 = all.iter().map(|x| (x - best) * (x - best)).sum();
                if all.is_empty() { 0.0 } else { TOLERANCE * (squares / all.len() as f64).sqrt() }
            }
        };
        Self {
            sense,
            baseline: of_baseline,
            result: of_result,
            baseline_of: a.of as u64,
            result_of: b.of as u64,
            blocks: has_data.into_iter().filter(|has| *has).count(),
            standard_error: standard_error(&effects),
            worse: BlockEffects { effects, most },
            tolerance: tolerance.unwrap_or(by_default),
        }
    }

    /// By how much the result is worse, in the unit of the figure; negative where it is better.
    pub(super) fn worsening(&self) -> Option<f64> {
        let (baseline, result) = (self.baseline?, self.result?);
        Some(match self.sense.better {
            Better::More => baseline - result,
            Better::Less => result - baseline,
            Better::Near(best) => (result - best).abs() - (baseline - best).abs(),
        })
    }

    /// The same as an effect for the better.
    pub(super) fn better(&self) -> BlockEffects {
        let effects = self.worse.effects.iter().map(|effect| -effect).collect();
        BlockEffects { effects, most: self.worse.most }
    }
}

/// By how much a median moves when a share of the values changes sides by one: 1/(2 f) with the density f at the median, from the middle
/// fifth of the values.
fn half_width_of_a_side(values: &[Vec<f64>]) -> f64 {
    let mut all = values.concat();
    all.sort_by(f64::total_cmp);
    let at = |share: f64| all.get((share * all.len() as f64) as usize);
    at(0.6).zip(at(0.4)).map_or(0.0, |(high, low)| (high - low) / 0.4)
}

/// Of a sum of independent terms.
fn standard_error(terms: &[f64]) -> f64 {
    let n = terms.len() as f64;
    if n < 2.0 {
        return 0.0;
    }
    let mean = terms.iter().sum::<f64>() / n;
    (terms.iter().map(|term| (term - mean) * (term - mean)).sum::<f64>() * n / (n - 1.0)).sqrt()
}

/// An interval of 95 % for the difference, result minus baseline.
pub(super) fn interval(
    baseline: &FigureTerms,
    result: &FigureTerms,
    blocks: &Blocks,
    exchanges: &crate::statistics::Exchanges,
) -> Option<Interval> {
    let reduction = baseline.reduction;
    let sides = [baseline, result].map(|run| Side::new(reduction, &run.terms, blocks));
    crate::statistics::interval_by_sets(exchanges, |taken| {
        let [baseline, result] = [&sides[0], &sides[1]].map(|side| side.value(taken));
        Some(result? - baseline?)
    })
}

/// One run, ready to be summed up over sets of blocks.
enum Side {
    /// Sum and count of each block; whether the figure is the root of their ratio.
    Ratio { blocks: Vec<(f64, f64)>, is_root: bool },
    /// Values in order, each with its block; and how many each block has.
    Sorted { values: Vec<(f64, usize)>, counts: Vec<usize> },
}

impl Side {
    fn new(reduction: Reduction, terms: &[Term], blocks: &Blocks) -> Self {
        if reduction == Reduction::Median {
            let with_value = terms.iter().enumerate().filter(|(_, term)| term.of > 0);
            let mut sorted: Vec<(f64, usize)> =
                with_value.map(|(unit, term)| (term.sum, blocks.of(unit))).collect();
            sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut counts = vec![0; blocks.count()];
            sorted.iter().for_each(|(_, block)| counts[*block] += 1);
            return Self::Sorted { values: sorted, counts };
        }
        let mut sums = vec![(0.0, 0.0); blocks.count()];
        for (unit, (sum, of)) in Sums::new(terms, reduction, 0.0).units.into_iter().enumerate() {
            let block = &mut sums[blocks.of(unit)];
            *block = (block.0 + sum, block.1 + of);
        }
        Self::Ratio { blocks: sums, is_root: reduction == Reduction::Rms }
    }

    fn value(&self, taken: &[bool]) -> Option<f64> {
        match self {
            Self::Ratio { blocks, is_root } => {
                let (sum, of) = blocks
                    .iter()
                    .enumerate()
                    .filter(|(block, _)| taken[*block])
                    .fold((0.0, 0.0), |(sum, of), (_, block)| (sum + block.0, of + block.1));
                let ratio = (of > 0.0).then(|| sum / of)?;
                Some(if *is_root { ratio.max(0.0).sqrt() } else { ratio })
            }
            Self::Sorted { values, counts } => {
                let count: usize =
                    counts.iter().zip(taken).filter(|(_, taken)| **taken).map(|(count, _)| count).sum();
                let chosen = values.iter().filter(|(_, block)| taken[*block]).map(|(value, _)| *value);
                let mut middle = chosen.skip(count.checked_sub(1)? / 2);
                let lower = middle.next()?;
                Some(if count % 2 == 1 { lower } else { f64::midpoint(lower, middle.next()?) })
            }
        }
    }
}

/// The correlation of the effects of neighbouring blocks, about their mean; 0 where no block differs. Of independent ones it scatters
/// by 1/√n about 0.
pub(super) fn neighbour_correlation(effects: &[f64]) -> f64 {
    let mean = effects.iter().sum::<f64>() / effects.len().max(1) as f64;
    let off: Vec<f64> = effects.iter().map(|effect| effect - mean).collect();
    let squares: f64 = off.iter().map(|off| off * off).sum();
    let products: f64 = off.windows(2).map(|pair| pair[0] * pair[1]).sum();
    if squares > 0.0 { products / squares } else { 0.0 }
}

/// What each unit of one run adds to a figure, about its value.
pub(super) fn influence(figure: &FigureTerms) -> Vec<f64> {
    let own = values(&figure.terms);
    let centre = if figure.reduction == Reduction::Median { median(&[own]).unwrap_or(0.0) } else { 0.0 };
    let sums = Sums::new(&figure.terms, figure.reduction, centre);
    let ratio = sums.ratio().unwrap_or(0.0);
    sums.units.iter().map(|(sum, of)| sum - ratio * of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::score::sense;

    fn terms(name: &str, reduction: Reduction, values: &[Option<f64>]) -> FigureTerms {
        let term = |value: &Option<f64>| value.map_or(Term::default(), |sum| Term { sum, of: 1 });
        FigureTerms { name: name.to_owned(), reduction, terms: values.iter().map(term).collect() }
    }

    fn effect(name: &str, reduction: Reduction, a: &[Option<f64>], b: &[Option<f64>]) -> FigureEffect {
        let blocks = Blocks::every(a.len(), 2);
        FigureEffect::new(sense(name), &terms(name, reduction, a), &terms(name, reduction, b), &blocks, None)
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
    fn the_blocks_of_a_rate_are_what_was_lost_less_what_was_won() {
        let rate = |bits: [u8; 6]| bits.map(|bit| Some(f64::from(bit)));
        let effect =
            effect("hit_rate", Reduction::Rate, &rate([1, 1, 1, 0, 1, 1]), &rate([0, 0, 1, 1, 1, 1]));
        for (got, expected) in effect.worse.effects.iter().zip([2.0, -1.0, 0.0]) {
            assert!((got - expected / 6.0).abs() < 1e-12, "{effect:?}");
        }
        assert!((effect.worsening().unwrap() - 1.0 / 6.0).abs() < 1e-12);
    }

    /// Exchanging a block of the two runs changes the sign of its effect and of no other.
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
            // Counts change hands too: all effects may be scaled alike, which no statistic sees.
            let scale = after.effects[0] / before.effects[0];
            for (block, (x, y)) in before.effects.iter().zip(&after.effects).enumerate() {
                let expected = if block == 1 { -scale * x } else { scale * x };
                assert!((y - expected).abs() < 1e-12, "{name}, block {block}: {before:?} {after:?}");
            }
        }
    }

    #[test]
    fn a_bias_on_the_other_side_of_nought_is_no_worse_than_its_size() {
        let bias = |bias: f64| [0.1, -0.1, 0.2, -0.2].map(|x| Some(x + bias));
        let turned = effect("ra_mean_deg", Reduction::Mean, &bias(0.05), &bias(-0.06));
        assert!((turned.worsening().unwrap() - 0.01).abs() < 1e-12);
        assert!((turned.worse.most - 0.01).abs() < 1e-12, "{turned:?}");
        let grown = effect("ra_mean_deg", Reduction::Mean, &bias(-0.05), &bias(-0.08));
        assert!((grown.worse.effects.iter().sum::<f64>() - 0.03).abs() < 1e-12, "{grown:?}");
    }

    #[test]
    fn the_interval_of_a_shift_of_every_value_is_the_shift() {
        let shifted = A.map(|value| value.map(|value| value + 0.25));
        for (name, reduction) in [("ra_mean_deg", Reduction::Mean), ("ra_median_deg", Reduction::Median)] {
            let [a, b] = [&A, &shifted].map(|values| terms(name, reduction, values));
            let blocks = Blocks::every(8, 2);
            let interval =
                interval(&a, &b, &blocks, &crate::statistics::Exchanges::new(blocks.count())).unwrap();
            assert!((interval.low - 0.25).abs() < 1e-12 && (interval.high - 0.25).abs() < 1e-12, "{name}");
        }
    }

    #[test]
    fn a_figure_that_is_counted_over_nothing_has_no_effect() {
        let none = effect("ra_rms_deg", Reduction::Rms, &A, &[None; 8]);
        assert_eq!((none.result, none.worsening()), (None, None));
        assert!(none.worse.effects.iter().all(|effect| *effect == 0.0));
    }
}
