//! One-sided bounds of rates, means and quantiles of values in clusters, used to decide a requirement.
//!
//! Each bound is computed for a relative size: 1 for the given clusters; larger for the bound expected from
//! this many times as many clusters of the same kind.

use statrs::function::beta::beta_reg;

use super::clusters::{ClusterSum, MIN_CLUSTERS, Ratio, independent_trials, non_empty};
use super::quantile::{ClusterValue, independent_values};

/// Two one-sided bounds: the value is at least `low` with the requested confidence, and at most `high` with
/// the same confidence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Lower bound; absent if there are too few clusters.
    pub low: Option<f64>,
    /// Upper bound; absent if there are too few clusters.
    pub high: Option<f64>,
}

/// Computes the bounds of a rate over clusters: those of Clopper & Pearson (1934) for the number of
/// independent trials that would scatter as much as the clusters (Korn & Graubard 1998, Survey Methodology
/// 24, 193–201). The true confidence is at least `confidence`. `None` if there is nothing to count.
pub fn cluster_rate_bounds(clusters: &[ClusterSum], confidence: f64, size: f64) -> Option<Bounds> {
    let counted = non_empty(clusters);
    let ratio = Ratio::new(&counted)?;
    let n = independent_trials(&counted, &ratio, size);
    let count = ratio.value * n;
    let low = if count <= 0.0 { 0.0 } else { beta_quantile(count, n - count + 1.0, 1.0 - confidence) };
    let high = if count >= n { 1.0 } else { beta_quantile(count + 1.0, n - count, confidence) };
    Some(Bounds { low: Some(low), high: Some(high) })
}

/// Computes the bounds of a mean over clusters, Σ sum / Σ count, by Student's t with a correction for
/// skewness. `None` for fewer than [`MIN_CLUSTERS`].
pub fn cluster_mean_bounds(clusters: &[ClusterSum], confidence: f64, size: f64) -> Option<Bounds> {
    let counted = non_empty(clusters);
    if counted.len() < MIN_CLUSTERS {
        return None;
    }
    let ratio = Ratio::new(&counted)?;
    let reach = ratio.residuals.reach(confidence, size);
    Some(Bounds { low: Some(ratio.value - reach.below), high: Some(ratio.value + reach.above) })
}

/// Computes the bounds of the quantile `p` of values in clusters, sorted by value: order statistics of the
/// number of independent values that would scatter about the quantile as much as the clusters do. Infinities
/// at the ends may stand for missing values. A bound is absent if that number of values, multiplied by
/// `size`, has no order statistic with the confidence; one that lies beyond the given values is the outermost
/// value.
pub fn cluster_quantile_bounds(
    sorted: &[ClusterValue],
    p: f64,
    confidence: f64,
    size: f64,
) -> Option<Bounds> {
    let count = sorted.len();
    let n = (independent_values(sorted, p)? * size).floor();
    // Largest and smallest rank that P(at least this many values are below the quantile) allows.
    let at_least = |rank: f64| if rank <= 0.0 { 1.0 } else { beta_reg(rank, n - rank + 1.0, p) };
    let first_below = |limit: f64| {
        let (mut low, mut high) = (0.0, n + 1.0);
        while high - low > 1.0 {
            let middle = (0.5 * (low + high)).floor();
            let chance = if middle > n { 0.0 } else { at_least(middle) };
            if chance >= limit { low = middle } else { high = middle }
        }
        high
    };
    let (low, high) = (first_below(confidence) - 1.0, first_below(1.0 - confidence));
    let at = |rank: f64| {
        let exists = (1.0..=n).contains(&rank);
        let place = (rank * (count as f64 + 1.0) / (n + 1.0)).round().clamp(1.0, count as f64);
        exists.then(|| sorted.get(place as usize - 1).map(|(_, value)| *value)).flatten()
    };
    Some(Bounds { low: at(low), high: at(high) })
}

/// Returns the value below which the beta distribution has the probability `p`.
fn beta_quantile(a: f64, b: f64, p: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if beta_reg(a, b, middle) < p { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use draws::{Effect, Seed, Stream, normal, uniform};

    /// scipy 1.17: beta.ppf(0.05, k, n − k + 1) and beta.ppf(0.95, k + 1, n − k), as for trials without
    /// clusters.
    #[test]
    fn rates_of_single_trials_have_the_exact_bounds() {
        for (count, n, low, high) in [
            (93, 100, 0.872_541_984_417_029_7, 0.966_688_084_382_368),
            (279, 300, 0.900_760_739_009_910_7, 0.952_617_729_530_771_1),
            (0, 50, 0.0, 0.058_155_079_116_972_25),
        ] {
            let trials: Vec<ClusterSum> =
                (0..n).map(|i| ClusterSum { sum: f64::from(u8::from(i < count)), count: 1.0 }).collect();
            let got = cluster_rate_bounds(&trials, 0.95, 1.0).unwrap();
            assert!((got.low.unwrap() - low).abs() < 1e-9, "{count} of {n}: {got:?}");
            assert!((got.high.unwrap() - high).abs() < 1e-9, "{count} of {n}: {got:?}");
        }
    }

    /// The textbook's 59 runs for a bound of the 95 % quantile with a confidence of 95 %: 0.95⁵⁹ = 0.0485,
    /// 0.95⁵⁸ = 0.0510.
    #[test]
    fn the_bound_of_a_quantile_exists_from_59_values_on() {
        let values = |n: usize| -> Vec<ClusterValue> { (0..n).map(|i| (i, i as f64)).collect() };
        let of = |n, p, size| cluster_quantile_bounds(&values(n), p, 0.95, size).unwrap();
        assert_eq!(of(58, 0.95, 1.0).high, None);
        assert_eq!(of(59, 0.95, 1.0).high, Some(58.0));
        assert_eq!(of(58, 0.05, 1.0).low, None);
        assert_eq!(of(59, 0.05, 1.0).low, Some(0.0));
        assert_eq!(of(30, 0.95, 2.0).high, Some(29.0));
        // scipy 1.17: binom.cdf(k − 1, n, 0.95) allows the second largest of 93 values (0.9508), but not of
        // 92 (0.9483).
        assert_eq!(of(93, 0.95, 1.0).high, Some(91.0));
        assert_eq!(of(92, 0.95, 1.0).high, Some(91.0));
    }

    /// Returns the fraction of 2,000 studies in which a bound at 95 % is on the wrong side of the truth: [low
    /// above it, high below it].
    fn wrong(truth: f64, bounds: impl Fn(&mut Stream) -> Option<Bounds>) -> [f64; 2] {
        let mut wrong = [0.0; 2];
        for study in 0..2000 {
            let random = &mut Seed { seed: 23, case: study }.stream(0, Effect::StudyParameter, 0);
            let got = bounds(random).unwrap();
            wrong[0] += f64::from(u8::from(got.low.is_some_and(|low| low > truth))) / 2000.0;
            wrong[1] += f64::from(u8::from(got.high.is_some_and(|high| high < truth))) / 2000.0;
        }
        wrong
    }

    /// 5 % are allowed; the standard deviation of the fraction in 2,000 studies is 0.5 %.
    #[test]
    fn bounds_fail_at_their_stated_rate() {
        let rate = wrong(0.95, |random| {
            let mut draw = || {
                let of_draw = 0.9 + 0.1 * uniform(random);
                ClusterSum { sum: (0..50).filter(|_| uniform(random) < of_draw).count() as f64, count: 50.0 }
            };
            cluster_rate_bounds(&(0..40).map(|_| draw()).collect::<Vec<_>>(), 0.95, 1.0)
        });
        let mean = wrong(0.0, |random| {
            let sums: Vec<_> = (0..12).map(|_| ClusterSum { sum: normal(random), count: 1.0 }).collect();
            cluster_mean_bounds(&sums, 0.95, 1.0)
        });
        let quantile = wrong(1.644_853_626_951_472_2, |random| {
            let mut values: Vec<ClusterValue> = (0..100).map(|i| (i, normal(random))).collect();
            values.sort_by(|a, b| a.1.total_cmp(&b.1));
            cluster_quantile_bounds(&values, 0.95, 0.95, 1.0)
        });
        for (name, wrong) in [("rate", rate), ("mean", mean), ("quantile", quantile)] {
            println!(
                "{name}: low bound wrong in {:.1} %, high in {:.1} %",
                100.0 * wrong[0],
                100.0 * wrong[1]
            );
            assert!(wrong.iter().all(|&wrong| wrong <= 0.065), "{name}: {wrong:?}");
            assert!(wrong.iter().any(|&wrong| wrong > 0.01), "{name}: {wrong:?}");
        }
    }
}
