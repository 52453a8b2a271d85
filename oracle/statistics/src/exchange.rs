//! Tests and intervals by exchanging blocks: the difference between two runs that random variation explains.
//!
//! Both runs are cut into the same blocks. If neither run is worse, it is random which of the two results of
//! a block belongs to which run: exchanging the results changes the sign of the block's difference, but not
//! its distribution. The observed differences are therefore compared with the same differences under random
//! signs. This test is exact for any number of blocks and any distribution of the differences that is
//! symmetric under the null hypothesis, and asymptotically correct for many blocks otherwise (it is the wild
//! cluster bootstrap with the null imposed; Cameron, Gelbach & Miller 2008, Review of Economics and
//! Statistics 90, 414–427, who recommend it for few blocks). With blocks of one frame and hits as values it
//! is McNemar's exact test.

use draws::{Effect, Seed};
use rand::Rng;

/// Largest number of blocks for which all exchanges are evaluated.
const MAX_EXHAUSTED: usize = 13;
/// Number of random exchanges for more blocks, in addition to the identity, unless alpha is small.
const RANDOM_EXCHANGES: usize = 9_999;
/// Number of exchanges for each that a test at alpha may reject: the smallest p is a twentieth of alpha.
const EXCHANGES_PER_ALPHA: f64 = 20.0;
/// Largest number of random exchanges.
const MAX_EXCHANGES: usize = 1 << 20;
/// Largest number of blocks in all exchanges together, which limits time and memory.
const MAX_EXCHANGED_BLOCKS: usize = 1 << 28;
/// Smallest number of blocks whose sets have quantiles of 2.5 %, so that an interval of 95 % exists.
pub const MIN_BLOCKS_OF_INTERVAL: usize = 6;
/// Number of random sets used for an interval: its ends are quantiles with a standard deviation of a
/// twentieth of its width.
const FOR_AN_INTERVAL: usize = 1_999;
/// Tolerance within which two statistics are equal: sums of the same numbers with other signs are rounded
/// differently.
const TIE: f64 = 1e-9;

/// Sets of blocks: those that a test exchanges, or those that an interval includes. The first set is empty.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Exchanges {
    blocks: usize,
    words: usize,
    bits: Vec<u64>,
}

impl Exchanges {
    /// Creates all sets of up to 13 blocks. For more blocks, creates the empty set and 9999 random ones,
    /// which depend only on the number of blocks.
    pub fn new(blocks: usize) -> Self {
        Self::with_random(blocks, RANDOM_EXCHANGES)
    }

    /// Creates the sets for a test at `alpha`: those of [`Self::new`], or for a small `alpha` so many random
    /// ones that a p of a twentieth of it is resolved; a million at most, and fewer for more than 256 blocks.
    pub fn for_alpha(blocks: usize, alpha: f64) -> Self {
        let most = MAX_EXCHANGES.min(MAX_EXCHANGED_BLOCKS / blocks.max(1)).max(RANDOM_EXCHANGES + 1) - 1;
        let random = (EXCHANGES_PER_ALPHA / alpha).ceil().min(most as f64) as usize;
        Self::with_random(blocks, random.max(RANDOM_EXCHANGES))
    }

    fn with_random(blocks: usize, random: usize) -> Self {
        let words = blocks.div_ceil(64).max(1);
        if blocks <= MAX_EXHAUSTED {
            return Self { blocks, words, bits: (0..1u64 << blocks).collect() };
        }
        let mut stream = Seed { seed: blocks as u64, case: 0 }.stream(0, Effect::BlockExchange, 0);
        let mut bits = vec![0; words];
        bits.extend((0..random * words).map(|_| stream.next_u64()));
        Self { blocks, words, bits }
    }

    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.blocks
    }

    /// Returns the number of sets, besides the empty one, that an interval uses: all, or some of the random
    /// ones.
    fn for_an_interval(&self) -> usize {
        if self.blocks <= MAX_EXHAUSTED { self.bits.len() - 1 } else { FOR_AN_INTERVAL }
    }

    fn sets(&self) -> impl Iterator<Item = ExchangeSet<'_>> {
        self.bits.chunks_exact(self.words).map(|words| ExchangeSet { words })
    }
}

/// Set of blocks.
#[derive(Clone, Copy)]
struct ExchangeSet<'a> {
    words: &'a [u64],
}

impl ExchangeSet<'_> {
    fn has(self, block: usize) -> bool {
        self.words[block / 64] >> (block % 64) & 1 == 1
    }

    /// Returns true if the set has none of the blocks of `mask`.
    fn has_none_of(self, mask: &[u64]) -> bool {
        self.words.iter().zip(mask).all(|(words, mask)| words & mask == 0)
    }

    /// Returns true if the set has all blocks of `mask`.
    fn has_all_of(self, mask: &[u64]) -> bool {
        self.words.iter().zip(mask).all(|(words, mask)| words & mask == *mask)
    }
}

/// Effects of the blocks on one figure: the amount by which each block makes the second run worse than the
/// first.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockEffects {
    /// One effect per block; their sum is the total effect.
    pub effects: Vec<f64>,
    /// True for each block in which the figure has a value: in others, no data could make an effect.
    pub has_value: Vec<bool>,
    /// True if the opposite effects are tested too, as another figure.
    pub is_two_sided: bool,
}

impl BlockEffects {
    /// Creates the effects of a figure that has a value in every block and is tested for one side.
    pub fn one_sided(effects: Vec<f64>) -> Self {
        Self { has_value: vec![true; effects.len()], effects, is_two_sided: false }
    }

    /// Returns the effects with the opposite sign.
    pub fn opposite(&self) -> Self {
        Self { effects: self.effects.iter().map(|effect| -effect).collect(), ..self.clone() }
    }

    /// Returns the largest statistic that any effects of these blocks can have: that of equal effects.
    fn largest_statistic(&self) -> f64 {
        (self.has_value.iter().filter(|has| **has).count() as f64).sqrt()
    }

    /// Returns the blocks with a value, one bit per block.
    fn mask(&self) -> Vec<u64> {
        let mut mask = vec![0; self.has_value.len().div_ceil(64).max(1)];
        for block in (0..self.has_value.len()).filter(|block| self.has_value[*block]) {
            mask[block / 64] |= 1 << (block % 64);
        }
        mask
    }

    /// Returns the test statistic of an exchange's effect: the effect over the root of the sum of squares,
    /// which is the same for every exchange. For hits and misses it is the statistic of McNemar's test for
    /// blocks (Yang, Sun & Hardin 2010, Biometrical Journal 52, 638–652). 0 if no block differs.
    fn statistic(effect: f64, root_of_squares: f64) -> f64 {
        if root_of_squares > 0.0 { effect / root_of_squares } else { 0.0 }
    }

    fn root_of_squares(&self) -> f64 {
        self.effects.iter().map(|effect| effect * effect).sum::<f64>().sqrt()
    }
}

/// Test result of one figure among several.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FigureTest {
    /// Effect over the root of the sum of squares of the blocks' effects.
    pub statistic: f64,
    /// Probability under the null hypothesis of a statistic at least as large, for this figure only.
    pub p: f64,
    /// Probability under the null hypothesis of a statistic at least as large, adjusted for all figures
    /// together.
    pub adjusted_p: f64,
    /// Smallest `adjusted_p` that any data in the blocks of this figure could have, beside the given effects
    /// of the other figures: that of equal effects in all its blocks. 1 without a block.
    pub attainable_p: f64,
}

/// Joint test of several figures.
#[derive(Debug, Clone, PartialEq)]
pub struct JointTest {
    /// Test result of each figure, in the order of the figures.
    pub figures: Vec<FigureTest>,
    /// Critical value: the largest statistic of all figures exceeds it with a probability of at most `alpha`
    /// under the null hypothesis.
    pub critical: f64,
}

/// Tests each figure against "the effect is at most 0", by the largest statistic of all figures under common
/// exchanges, stepping down (Westfall & Young 1993; Romano & Wolf 2005, Journal of the American Statistical
/// Association 100, 94–108). The probability that any figure without an effect has an adjusted p ≤ `alpha` is
/// at most `alpha`, regardless of the effects on the remaining figures. Correlated figures need little
/// correction: two that always agree count as one, where Holm's correction would count two.
///
/// A p is the fraction of exchanges that give a statistic at least as large. The identity is among the random
/// exchanges, hence p is never 0 (Phipson & Smyth 2010, Statistical Applications in Genetics and Molecular
/// Biology 9, 39).
pub fn joint_test(figures: &[BlockEffects], exchanges: &Exchanges, alpha: f64) -> JointTest {
    let roots: Vec<f64> = figures.iter().map(BlockEffects::root_of_squares).collect();
    // Stored block by block, with all figures of a block together: one pass over the blocks computes all sums
    // of an exchange.
    let rows: Vec<f64> = (0..exchanges.blocks)
        .flat_map(|block| figures.iter().map(move |figure| figure.effects[block]))
        .collect();
    let statistics = |set: ExchangeSet<'_>, into: &mut [f64]| {
        into.fill(0.0);
        for (block, row) in rows.chunks_exact(figures.len().max(1)).enumerate() {
            let sign = 1.0 - 2.0 * f64::from(u8::from(set.has(block)));
            into.iter_mut().zip(row).for_each(|(sum, effect)| *sum += sign * effect);
        }
        for (value, root) in into.iter_mut().zip(&roots) {
            *value = BlockEffects::statistic(*value, *root);
        }
    };
    let mut observed = vec![0.0; figures.len()];
    statistics(ExchangeSet { words: &vec![0; exchanges.words] }, &mut observed);
    // Figures in descending order of their statistic: each is compared, at each exchange, with the largest
    // statistic of itself and those after it.
    let mut order: Vec<usize> = (0..figures.len()).collect();
    order.sort_by(|a, b| observed[*b].total_cmp(&observed[*a]).then(a.cmp(b)));
    let (mut alone, mut together) = (vec![0u64; figures.len()], vec![0u64; figures.len()]);
    let mut attainable: Vec<Attainable> = figures.iter().map(Attainable::new).collect();
    let mut largest = Vec::new();
    let mut exchanged = vec![0.0; figures.len()];
    for set in exchanges.sets() {
        statistics(set, &mut exchanged);
        let mut below = f64::NEG_INFINITY;
        for &figure in order.iter().rev() {
            below = below.max(exchanged[figure]);
            alone[figure] += u64::from(reaches(exchanged[figure], observed[figure]));
            together[figure] += u64::from(reaches(below, observed[figure]));
        }
        largest.push(below);
        for (figure, attainable) in attainable.iter_mut().enumerate() {
            attainable.count(figure, set, &exchanged);
        }
    }
    let count = largest.len() as f64;
    let mut tested: Vec<FigureTest> = (0..figures.len())
        .map(|figure| FigureTest {
            statistic: observed[figure],
            p: alone[figure] as f64 / count,
            adjusted_p: together[figure] as f64 / count,
            attainable_p: attainable[figure].exchanges as f64 / count,
        })
        .collect();
    let mut least: f64 = 0.0;
    for figure in order {
        least = least.max(tested[figure].adjusted_p);
        tested[figure].adjusted_p = least;
    }
    largest.sort_by(f64::total_cmp);
    // Only values just above the critical one are reached by at most alpha · count of the exchanges.
    let reached = (alpha * count).floor() as usize;
    let critical = largest.len().checked_sub(reached + 1).map_or(0.0, |place| largest[place].max(0.0));
    JointTest { figures: tested, critical }
}

/// Number of exchanges under which a figure with equal effects in all its blocks, or another figure with its
/// given effects, reaches the statistic of those equal effects.
struct Attainable {
    statistic: f64,
    blocks: Vec<u64>,
    is_two_sided: bool,
    exchanges: u64,
}

impl Attainable {
    fn new(figure: &BlockEffects) -> Self {
        Self {
            statistic: figure.largest_statistic(),
            blocks: figure.mask(),
            is_two_sided: figure.is_two_sided,
            exchanges: 0,
        }
    }

    /// Counts an exchange; `exchanged` has the statistics of all figures under it, and `figure` is the number
    /// of this figure among them.
    fn count(&mut self, figure: usize, set: ExchangeSet<'_>, exchanged: &[f64]) {
        let by_itself = set.has_none_of(&self.blocks) || self.is_two_sided && set.has_all_of(&self.blocks);
        let by_another = || {
            let others = exchanged.iter().enumerate().filter(|(other, _)| *other != figure);
            others.into_iter().any(|(_, statistic)| reaches(*statistic, self.statistic))
        };
        self.exchanges += u64::from(by_itself || by_another());
    }
}

/// Returns true if a statistic is at least as large as the observed one, within rounding.
fn reaches(statistic: f64, observed: f64) -> bool {
    statistic >= observed - TIE * (1.0 + observed.abs())
}

/// Number of sets of blocks that [`interval_by_sets`] passes to its function at a time.
pub const SETS: usize = 8;

/// Returns the 95 % interval for the difference of two runs: the 2.5 % and 97.5 % quantiles of the difference
/// over sets of blocks, each block in a set with probability ½ (typical values; Hartigan 1969, Journal of the
/// American Statistical Association 64, 1303–1317).
///
/// A bootstrap with weights 0 and 2 gives the same interval, as does the inversion of the test by exchanges.
/// It is exact for the mean of at least six symmetric independent differences
/// ([`MIN_BLOCKS_OF_INTERVAL`]). Fewer have no quantile of 2.5 %, and no interval: even the whole range of
/// their sets has a confidence below 95 %.
///
/// `differences` receives for each block its weight, 0 or 1, in each of [`SETS`] sets, and returns the
/// difference of each set, if it has one. Returns `None` for fewer than six blocks, and if most sets have no
/// difference.
pub fn interval_by_sets(
    exchanges: &Exchanges,
    differences: impl Fn(&[[f64; SETS]]) -> [Option<f64>; SETS],
) -> Option<super::Interval> {
    let count = exchanges.for_an_interval();
    let sets: Vec<ExchangeSet<'_>> = exchanges.sets().skip(1).take(count).collect();
    let mut weights = vec![[0.0; SETS]; exchanges.blocks];
    let mut values: Vec<f64> = Vec::with_capacity(count);
    for sets in sets.chunks(SETS) {
        for (block, weights) in weights.iter_mut().enumerate() {
            for (weight, set) in weights.iter_mut().zip(sets) {
                *weight = f64::from(u8::from(set.has(block)));
            }
        }
        values.extend(differences(&weights).into_iter().take(sets.len()).flatten());
    }
    if exchanges.blocks < MIN_BLOCKS_OF_INTERVAL || values.len() * 2 < count {
        return None;
    }
    values.sort_by(f64::total_cmp);
    // n values divide the line into n + 1 intervals, each equally likely to contain the truth.
    let part = 0.025 * (values.len() + 1) as f64;
    let low = (part.floor() as usize).clamp(1, values.len()) - 1;
    Some(super::Interval { low: values[low], high: values[values.len() - 1 - low] })
}

#[cfg(test)]
mod tests {
    use draws::{normal, uniform};

    use super::*;

    fn effects(effects: &[f64]) -> BlockEffects {
        BlockEffects::one_sided(effects.to_vec())
    }

    fn test_of(figures: &[BlockEffects], alpha: f64) -> JointTest {
        joint_test(figures, &Exchanges::new(figures[0].effects.len()), alpha)
    }

    /// The interval of a difference that is given for one set at a time, by the blocks in it.
    fn interval_one_by_one(
        exchanges: &Exchanges,
        difference: impl Fn(&[bool]) -> Option<f64>,
    ) -> Option<crate::Interval> {
        interval_by_sets(exchanges, |weights| {
            std::array::from_fn(|set| {
                difference(&weights.iter().map(|weights| weights[set] > 0.0).collect::<Vec<bool>>())
            })
        })
    }

    /// With seven powers of two every set has a different sum, 1 to 127: the limits are the third sums from
    /// either end.
    #[test]
    fn an_interval_by_sets_leaves_a_fortieth_at_either_end() {
        let sum = |taken: &[bool]| {
            taken
                .iter()
                .enumerate()
                .filter(|(_, taken)| **taken)
                .map(|(block, _)| f64::from(1 << block))
                .sum::<f64>()
        };
        let interval = interval_one_by_one(&Exchanges::new(7), |taken| Some(sum(taken))).unwrap();
        assert_eq!((interval.low, interval.high), (3.0, 125.0));
        // Six blocks have an interval, the whole range; for five, that range has a confidence of 15/16.
        let interval = interval_one_by_one(&Exchanges::new(6), |taken| Some(sum(taken))).unwrap();
        assert_eq!((interval.low, interval.high), (1.0, 63.0));
        for blocks in 0..6 {
            assert_eq!(interval_one_by_one(&Exchanges::new(blocks), |taken| Some(sum(taken))), None);
        }
        // A difference without a value for most sets has no interval: values for 63 of 127 sets are too few,
        // 64 are enough.
        let below = |limit: f64| {
            interval_one_by_one(&Exchanges::new(7), |taken| Some(sum(taken)).filter(|sum| *sum < limit))
        };
        assert!(below(64.0).is_none() && below(65.0).is_some());
    }

    /// The limits of 1999 random sets are the fiftieth values from either end.
    #[test]
    fn an_interval_by_drawn_sets_leaves_fifty_less_one_at_either_end() {
        let calls = std::cell::Cell::new(0.0);
        let interval = interval_one_by_one(&Exchanges::new(14), |_| {
            calls.set(calls.get() + 1.0);
            Some(calls.get())
        });
        let interval = interval.unwrap();
        assert_eq!((interval.low, interval.high), (50.0, 1950.0));
    }

    #[test]
    fn few_blocks_have_all_their_sets_and_many_have_drawn_ones() {
        for blocks in [1, 2, 13] {
            let exchanges = Exchanges::new(blocks);
            assert_eq!((exchanges.blocks(), exchanges.sets().count()), (blocks, 1 << blocks));
            assert_eq!(exchanges.for_an_interval(), (1 << blocks) - 1);
        }
        for blocks in [14, 200] {
            let exchanges = Exchanges::new(blocks);
            assert_eq!((exchanges.blocks(), exchanges.sets().count()), (blocks, RANDOM_EXCHANGES + 1));
            assert_eq!(exchanges.for_an_interval(), FOR_AN_INTERVAL);
            assert!(exchanges.sets().next().is_some_and(|empty| (0..blocks).all(|block| !empty.has(block))));
        }
    }

    /// Eight of nine discordant pairs were lost: McNemar's exact test is that of a fair coin, (9 + 1)/2⁹.
    #[test]
    fn with_single_frames_it_is_mcnemars_exact_test() {
        let mut pairs = vec![1.0; 8];
        pairs.extend([-1.0, 0.0, 0.0, 0.0]);
        let test = test_of(&[effects(&pairs)], 0.05);
        assert!((test.figures[0].p - 10.0 / 512.0).abs() < 1e-12, "{test:?}");
        assert_eq!(test.figures[0].p, test.figures[0].adjusted_p);
    }

    /// scipy 1.17.1, `permutation_test((x,), mean, permutation_type="samples", alternative="greater")`, all
    /// 2¹⁰ signs.
    #[test]
    fn few_blocks_are_exchanged_in_every_way() {
        let x = [0.31, -0.12, 0.45, 0.08, 0.27, -0.05, 0.36, 0.11, 0.02, 0.19];
        let test = test_of(&[effects(&x)], 0.05);
        assert!((test.figures[0].p - SCIPY_P).abs() < 1e-12, "{}", test.figures[0].p);
    }

    const SCIPY_P: f64 = 0.013_671_875;

    #[test]
    fn blocks_that_all_agree_reach_the_smallest_p_there_is() {
        let test = test_of(&[effects(&[0.2; 6])], 0.05);
        assert_eq!(test.figures[0].p, 1.0 / 64.0);
        assert!((test.figures[0].statistic - 6f64.sqrt()).abs() < 1e-12);
        let nothing = test_of(&[effects(&[0.0; 6])], 0.05);
        let attainable_p = 1.0 / 64.0;
        assert_eq!(nothing.figures[0], FigureTest { statistic: 0.0, p: 1.0, adjusted_p: 1.0, attainable_p });
    }

    /// Of n blocks with values, one exchange in 2ⁿ keeps all of them; where both sides are tested, one more
    /// exchanges all of them. Uneven effects attain no less.
    #[test]
    fn no_data_have_a_smaller_p_than_equal_effects() {
        for blocks in 1..=13 {
            let uneven: Vec<f64> = (0..blocks).map(|block| f64::from(block) - 3.2).collect();
            let test = test_of(&[effects(&uneven)], 0.05);
            assert_eq!(test.figures[0].attainable_p, libm::exp2(-f64::from(blocks)));
            let up = BlockEffects { is_two_sided: true, ..effects(&uneven) };
            let test = test_of(&[up.clone(), up.opposite()], 0.05);
            for figure in &test.figures {
                assert_eq!(figure.attainable_p, libm::exp2(1.0 - f64::from(blocks)));
            }
        }
        // Values in five of twelve blocks; another figure with equal effects in six of them reaches more.
        let mut five = effects(&[1.0; 12]);
        (5..12).for_each(|block| five.has_value[block] = false);
        assert_eq!(test_of(std::slice::from_ref(&five), 0.05).figures[0].attainable_p, 1.0 / 32.0);
        let mut six = [0.0; 12];
        (6..12).for_each(|block| six[block] = 1.0);
        let both = test_of(&[five, effects(&six)], 0.05);
        let either = 1.0 - (31.0 / 32.0) * (63.0 / 64.0);
        assert!((both.figures[0].attainable_p - either).abs() < 1e-12, "{both:?}");
    }

    /// A test at 1e-6 of twenty blocks needs their 2²⁰ exchanges, and one at 1e-4 more than 9999.
    #[test]
    fn a_small_alpha_has_as_many_exchanges_as_it_needs() {
        for (blocks, alpha, count) in [
            (13, 1e-6, 1 << 13),
            (14, 0.05, 10_000),
            (14, 0.002, 10_001),
            (200, 1e-4, 200_001),
            (20, 1e-9, 1 << 20),
            (100_000, 1e-9, 10_000),
        ] {
            assert_eq!(Exchanges::for_alpha(blocks, alpha).sets().count(), count, "{blocks} {alpha}");
        }
    }

    /// With effects that are powers of two every exchange has a different sum: 31, 29, 27, … for five blocks.
    #[test]
    fn the_critical_value_is_reached_by_more_than_alpha_and_exceeded_by_no_more() {
        let powers = effects(&[1.0, 2.0, 4.0, 8.0, 16.0]);
        for (alpha, sum) in [(0.05, 29.0), (0.0625, 27.0), (0.02, 31.0)] {
            let critical = test_of(std::slice::from_ref(&powers), alpha).critical;
            assert!((critical - sum / 341f64.sqrt()).abs() < 1e-12, "{alpha}: {critical}");
        }
    }

    /// 0.1 + 0.2 - 0.3 is 0 apart from rounding, and so is its negative: five of the eight exchanges reach
    /// it.
    #[test]
    fn exchanges_that_rounding_alone_separates_are_equal() {
        let test = test_of(&[effects(&[0.1, 0.2, -0.3])], 0.05);
        assert_eq!(test.figures[0].p, 5.0 / 8.0);
        assert!(test.figures[0].statistic > 0.0);
    }

    #[test]
    fn statistics_that_differ_by_a_billionth_count_as_equal() {
        assert!(reaches(3.0 - 3e-9, 3.0) && !reaches(3.0 - 5e-9, 3.0));
        assert!(reaches(-0.9e-9, 0.0) && !reaches(-1.1e-9, 0.0));
    }

    /// A figure that is a multiple of another one needs no further correction.
    #[test]
    fn figures_that_agree_count_as_one() {
        let x = [0.31, -0.12, 0.45, 0.08, 0.27, -0.05, 0.36, 0.11, 0.02, 0.19];
        let alone = test_of(&[effects(&x)], 0.05);
        let double = x.map(|x| 2.0 * x);
        let both = test_of(&[effects(&x), effects(&double), effects(&[0.0; 10])], 0.05);
        assert_eq!(both.figures[0].adjusted_p, alone.figures[0].adjusted_p);
        assert_eq!(both.critical, alone.critical);
    }

    #[test]
    fn adjusted_probabilities_are_no_smaller_and_keep_the_order_of_the_statistics() {
        let random = &mut Seed { seed: 4, case: 0 }.stream(0, Effect::PixelNoise, 0);
        let figures: Vec<BlockEffects> = (0..6)
            .map(|i| effects(&(0..20).map(|_| normal(random) + 0.2 * f64::from(i)).collect::<Vec<_>>()))
            .collect();
        let mut tested = test_of(&figures, 0.05).figures;
        assert!(tested.iter().all(|figure| figure.adjusted_p >= figure.p));
        tested.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
        assert!(tested.is_sorted_by(|a, b| a.adjusted_p <= b.adjusted_p));
    }

    /// Returns the number of false alarms in 1000 sets of figures without an effect.
    fn false_alarms(blocks: usize, draw: impl Fn(&mut draws::Stream) -> [f64; 8]) -> u32 {
        let exchanges = Exchanges::new(blocks);
        (0..1000)
            .filter(|&trial| {
                let random = &mut Seed { seed: 12, case: trial }.stream(0, Effect::PixelNoise, 0);
                let drawn: Vec<[f64; 8]> = (0..blocks).map(|_| draw(random)).collect();
                let figures: Vec<BlockEffects> = (0..8)
                    .map(|i| effects(&drawn.iter().map(|block| block[i]).collect::<Vec<_>>()))
                    .collect();
                joint_test(&figures, &exchanges, 0.05).figures.iter().any(|figure| figure.adjusted_p <= 0.05)
            })
            .count() as u32
    }

    /// Binomial distribution of 1000 at 0.05: standard deviation 6.9; the limit is three of them above the
    /// mean.
    #[test]
    fn the_family_has_its_stated_level_with_few_blocks_and_heavy_tails() {
        let correlated = |random: &mut draws::Stream| {
            let common = normal(random);
            std::array::from_fn(|_| common + 0.5 * normal(random))
        };
        let wild = |random: &mut draws::Stream| {
            let scale = if uniform(random) < 0.1 { 30.0 } else { 1.0 };
            std::array::from_fn(|_| scale * normal(random))
        };
        let discrete = |random: &mut draws::Stream| {
            std::array::from_fn(|_| {
                ((3.0 * uniform(random)).floor() - 1.0) * f64::from(uniform(random) < 0.2)
            })
        };
        for (name, alarms) in [
            ("correlated", false_alarms(8, correlated)),
            ("wild", false_alarms(8, wild)),
            ("discrete", false_alarms(8, discrete)),
        ] {
            assert!(alarms <= 71, "{name}: {alarms} of 1000");
        }
        assert!(false_alarms(8, correlated) >= 29, "the test is not asleep");
    }

    /// 95 % nominal for the mean of as few as eight blocks; the standard deviation of the coverage in 1000
    /// trials is 0.7 %.
    #[test]
    fn the_interval_of_few_blocks_covers_the_truth() {
        for (blocks, heavy) in [(8, false), (8, true), (30, false), (30, true)] {
            let exchanges = Exchanges::new(blocks);
            let covered = (0..1000)
                .filter(|&trial| {
                    let random = &mut Seed { seed: 13, case: trial }.stream(0, Effect::PixelNoise, 0);
                    let x: Vec<f64> = (0..blocks)
                        .map(|_| {
                            0.3 + if heavy && uniform(random) < 0.2 { 10.0 } else { 1.0 } * normal(random)
                        })
                        .collect();
                    let mean = |taken: &[bool]| {
                        let chosen = x.iter().zip(taken).filter(|(_, taken)| **taken);
                        let (n, sum) = chosen.fold((0.0, 0.0), |(n, sum), (x, _)| (n + 1.0, sum + x));
                        (n > 0.0).then(|| sum / n)
                    };
                    let interval = interval_one_by_one(&exchanges, mean).unwrap();
                    (interval.low..=interval.high).contains(&0.3)
                })
                .count();
            println!("{blocks} blocks, heavy {heavy}: {covered} of 1000");
            assert!((928..=972).contains(&covered), "{blocks} blocks, heavy {heavy}: {covered} of 1000");
        }
    }

    #[test]
    fn zero_blocks_have_no_result() {
        let test = joint_test(&[effects(&[])], &Exchanges::new(0), 0.05);
        assert_eq!((test.figures[0].p, test.figures[0].attainable_p, test.critical), (1.0, 1.0, 0.0));
        assert_eq!(interval_one_by_one(&Exchanges::new(0), |_| Some(1.0)), None);
    }
}
