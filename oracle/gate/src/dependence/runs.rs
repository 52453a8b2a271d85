//! Runs of losses: units lost through one event.
//!
//! Exchanging whole blocks cannot detect an event in a single section. With the same frames, the flips of a
//! rate contain more information: of the units whose outcome changed, some were lost and some won, and if the
//! pipelines are alike, both are equally likely. Flips come in episodes, which are no longer than the
//! episodes in which the baseline itself fails: n flips are worth n/τ tosses of a fair coin, with the
//! autocorrelation time τ of the rate. Two counts are tested: the number of losses among all changed units
//! (the sign test), and the length of the longest run of losses among them.
use std::ops::Range;

use run::figure_by_name;
use score::{Better, FigureTerms, Kind, UnitVerdict};
use serde::Serialize;
use statistics::binomial_at_least;

use super::memory::memory_of;

/// Shortest assumed length of an episode, units: if a baseline hardly ever fails, its autocorrelation is not
/// visible.
const SHORTEST_EPISODE: f64 = 3.0;

/// Changes of the units that a rate counts, in order.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LossRun {
    /// Number of units that counted for the better in the baseline and do not in the result.
    pub lost: u64,
    /// Number of units that count for the better in the result and did not in the baseline.
    pub won: u64,
    /// Length of the longest run of losses without a win.
    pub longest: u64,
    /// Number of the first unit of the longest run; null if there is no loss.
    pub first: Option<u64>,
    /// Number of the last unit of the longest run; null if there is no loss.
    pub last: Option<u64>,
    /// Assumed length of an episode, units: the autocorrelation time of the rate in the baseline, at least 3.
    pub episode: f64,
    /// Probability of at least this many losses, or of a run at least this long, if losing and winning are
    /// equally likely; adjusted for all rates together.
    pub adjusted_p: f64,
    /// Shortest run of losses, without any other flip, that the test would detect, units; null if the rate
    /// counts fewer units.
    pub smallest_visible: Option<u64>,
}

/// Flips of one rate.
struct Series {
    /// Index of each changed unit, and true if the unit was lost.
    flips: Vec<(usize, bool)>,
    /// Number of units that the rate counts in both runs.
    units: u64,
    episode: f64,
}

impl Series {
    /// Returns `None` for a figure that is not a rate, or whose best value is a given value.
    fn from_terms(before: &FigureTerms, after: &FigureTerms, sequences: &[Range<usize>]) -> Option<Self> {
        let sense = figure_by_name(&before.name).sense;
        let sign = match (sense.kind, sense.better) {
            (Kind::Rate, Better::More) => 1.0,
            (Kind::Rate, Better::Less) => -1.0,
            _ => return None,
        };
        let (mut flips, mut counted) = (Vec::new(), 0);
        for (unit, (before, after)) in before.terms.iter().zip(&after.terms).enumerate() {
            if before.count == 0 || after.count == 0 {
                continue;
            }
            counted += 1;
            let change = sign * (after.sum / f64::from(after.count) - before.sum / f64::from(before.count));
            if change != 0.0 {
                flips.push((unit, change < 0.0));
            }
        }
        let episode = memory_of(before, sequences).max(SHORTEST_EPISODE);
        Some(Self { flips, units: counted, episode })
    }

    fn lost(&self) -> usize {
        self.flips.iter().filter(|(_, is_lost)| *is_lost).count()
    }

    /// Returns the longest run of losses.
    fn longest(&self) -> &[(usize, bool)] {
        let runs =
            self.flips.chunk_by(|a, b| a.1 == b.1).filter(|run| run.first().is_some_and(|flip| flip.1));
        runs.max_by_key(|run| run.len()).unwrap_or_default()
    }

    /// Probability of at least `lost` losses among `flips` flips, or of a run of at least `longest` losses.
    fn p(&self, lost: usize, longest: usize, flips: usize) -> f64 {
        let episodes = |units: usize| units as f64 / self.episode;
        let (lost_of, won_of) = (episodes(lost).floor() as u64, episodes(flips - lost).ceil() as u64);
        let by_count = binomial_at_least(lost_of, lost_of + won_of, 0.5);
        let (run, of) = (episodes(longest).floor(), episodes(flips).ceil());
        // A run begins at the first episode, or after a won episode.
        let by_run = libm::exp2(-run) * (1.0 + 0.5 * (of - run).max(0.0));
        (2.0 * by_count.min(by_run)).min(1.0)
    }
}

/// Returns the run of losses of each figure, for a result on the same frames; `None` for a figure that is not
/// a rate with a direction.
pub(crate) fn loss_runs(
    pairs: &[(&FigureTerms, &FigureTerms)],
    units: &[UnitVerdict],
    sequences: &[Range<usize>],
    alpha: f64,
) -> Vec<Option<LossRun>> {
    let series: Vec<Option<Series>> =
        pairs.iter().map(|(before, after)| Series::from_terms(before, after, sequences)).collect();
    // Rates that changed in the same way in the same units (hits and misses, for instance) count once. The
    // set of changed units is fixed under the null hypothesis, so counting the changed units does not depend
    // on the outcome.
    let mut distinct: Vec<&[(usize, bool)]> = Vec::new();
    for Series { flips, .. } in series.iter().flatten().filter(|series| !series.flips.is_empty()) {
        if !distinct.contains(&flips.as_slice()) {
            distinct.push(flips);
        }
    }
    let count = distinct.len().max(1) as f64;
    let of_series = |series: &Series| {
        let (flips, lost, longest) = (series.flips.len(), series.lost(), series.longest());
        let number =
            |flip: Option<&(usize, bool)>| flip.and_then(|flip| units.get(flip.0)).map(|unit| unit.number);
        let is_seen = |run: &u64| count * series.p(*run as usize, *run as usize, *run as usize) <= alpha;
        LossRun {
            lost: lost as u64,
            won: (flips - lost) as u64,
            longest: longest.len() as u64,
            first: number(longest.first()),
            last: number(longest.last()),
            episode: series.episode,
            adjusted_p: (count * series.p(lost, longest.len(), flips)).min(1.0),
            smallest_visible: (1..=series.units).find(is_seen),
        }
    };
    series.iter().map(|series| series.as_ref().map(of_series)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand_made::{days, rate};

    fn run_of(before: &[u8], after: &[u8]) -> LossRun {
        let [before, after] = [before, after].map(|bits| rate("hit_rate", bits));
        let units = days(&[("day 1", before.terms.len() as u64)]).units;
        let whole = 0..before.terms.len();
        loss_runs(&[(&before, &after)], &units, std::slice::from_ref(&whole), 0.0025)[0].clone().unwrap()
    }

    /// 30 frames without correlation: an episode has three units. Nine consecutive losses are three throws, 2
    /// · 2⁻³.
    #[test]
    fn losses_count_as_throws_of_a_coin_by_episodes() {
        let before: Vec<u8> = (0..30).map(|frame| u8::from(frame % 15 != 0)).collect();
        let lost = |lost: Range<usize>| -> Vec<u8> {
            (0..30).map(|frame| if lost.contains(&frame) { 0 } else { before[frame] }).collect()
        };
        let run = run_of(&before, &lost(1..10));
        assert_eq!((run.lost, run.won, run.longest, run.first, run.last), (9, 0, 9, Some(1), Some(9)));
        let is = |p: f64, expected: f64| assert!((p - expected).abs() < 1e-12, "{p}, not {expected}");
        assert_eq!(run.episode, 3.0);
        is(run.adjusted_p, 0.25);
        // Eleven losses contain three complete episodes; twelve contain four.
        is(run_of(&before, &lost(1..12)).adjusted_p, 0.25);
        is(run_of(&before, &lost(1..13)).adjusted_p, 0.125);
        // 2 · 2⁻ᵏ ≤ 0.0025 holds from ten throws on.
        assert_eq!(run.smallest_visible, Some(30));
        let none = run_of(&before, &before);
        assert_eq!((none.lost, none.longest, none.first, none.adjusted_p), (0, 0, None, 1.0));
    }

    /// Six lost, three won, six lost. By count: 4 of 5 throws, 6/32. By run: 2⁻² (1 + (5 − 2)/2).
    #[test]
    fn a_gain_interrupts_a_run_of_losses() {
        let before = [1, 1, 1, 1, 1, 1, 0, 0, 0, 1, 1, 1, 1, 1, 1, 0, 1, 0, 1, 0, 1];
        let after = [0, 0, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 1];
        let run = run_of(&before, &after);
        assert_eq!((run.lost, run.won, run.longest), (12, 3, 6));
        let series = Series { flips: Vec::new(), units: 100, episode: 3.0 };
        assert!((series.p(12, 6, 15) - 2.0 * 6.0 / 32.0).abs() < 1e-12);
        assert!((series.p(12, 12, 12) - 2.0 / 16.0).abs() < 1e-12);
        // Thousands of losses and wins do not overflow.
        assert!((0.9..=1.0).contains(&series.p(6000, 9, 12_000)));
        assert!(series.p(9000, 9, 12_000) < 1e-100);
    }

    /// If the baseline fails in episodes of twenty units, twenty consecutive losses are a single throw.
    #[test]
    fn a_memory_of_the_baseline_makes_losses_fewer_throws() {
        let before: Vec<u8> = (0..400).map(|frame| u8::from(frame % 100 >= 20)).collect();
        let after: Vec<u8> = (0..400).map(|frame| u8::from(frame >= 100 && before[frame] == 1)).collect();
        let run = run_of(&before, &after);
        assert!(run.episode > 10.0 && run.adjusted_p > 0.0025, "{run:?}");
        assert_eq!((run.lost, run.first, run.last), (80, Some(20), Some(99)));
    }

    /// Miss rate and hit rate are complementary: they form one series, and the second adds no correction for
    /// multiple tests.
    #[test]
    fn rates_with_the_same_terms_are_counted_once() {
        let [before, after] = [[1u8; 60], [0u8; 60]];
        let p = |names: &[&str]| {
            let bits = |name: &str, bits: &[u8; 60]| match name {
                "miss_rate" => rate(name, &bits.map(|bit| 1 - bit)),
                "correct_rate" => rate(
                    name,
                    &bits.iter().enumerate().map(|(i, bit)| bit & u8::from(i > 0)).collect::<Vec<_>>(),
                ),
                _ => rate(name, bits),
            };
            let figures: Vec<_> =
                names.iter().map(|name| (bits(name, &before), bits(name, &after))).collect();
            let pairs: Vec<_> = figures.iter().map(|(before, after)| (before, after)).collect();
            loss_runs(&pairs, &days(&[("day 1", 60)]).units, std::slice::from_ref(&(0..60)), 0.0025)[0]
                .clone()
                .unwrap()
                .adjusted_p
        };
        let alone = p(&["hit_rate"]);
        assert_eq!(p(&["hit_rate", "miss_rate"]), alone);
        assert_eq!(p(&["hit_rate", "miss_rate", "correct_rate"]), 2.0 * alone);
    }
}
