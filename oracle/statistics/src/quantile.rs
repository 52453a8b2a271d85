//! Intervals of quantiles of values in clusters.

use statrs::function::beta::beta_reg;

use super::Interval;
use super::clusters::{ClusterSum, OUTSIDE, Ratio, non_empty, trials_by_scatter};

/// Number of a cluster, and a value that belongs to it.
pub type ClusterValue = (usize, f64);

/// Computes the interval of the quantile `p` of values in clusters, sorted by value: from fractional order
/// statistics (Hutson 1999, Journal of Statistical Computation and Simulation 63, 91–103) for the number of
/// independent values that would scatter about the quantile as much as the clusters. `None` where a limit
/// would lie beyond the smallest or the largest value, because there are too few values.
pub fn cluster_quantile_interval(sorted: &[ClusterValue], p: f64) -> Option<Interval> {
    let count = sorted.len();
    let n = independent_values(sorted, p)?;
    let rank = |probability: f64| {
        // P(at least r of n are below the quantile) decreases with r.
        let (mut low, mut high) = (0.0, n + 1.0);
        for _ in 0..60 {
            let r = 0.5 * (low + high);
            if beta_reg(r, n - r + 1.0, p) > probability { low = r } else { high = r }
        }
        0.5 * (low + high) * (count as f64 + 1.0) / (n + 1.0)
    };
    let at = |rank: f64| {
        let below = rank.floor();
        let first = sorted.get((below as usize).checked_sub(1)?)?.1;
        let part = rank - below;
        if part == 0.0 { Some(first) } else { Some(first + part * (sorted.get(below as usize)?.1 - first)) }
    };
    Some(Interval { low: at(rank(1.0 - 0.5 * OUTSIDE))?, high: at(rank(0.5 * OUTSIDE))? })
}

/// Returns the number of independent values that would scatter about the quantile `p` as much as these
/// values.
pub(super) fn independent_values(sorted: &[ClusterValue], p: f64) -> Option<f64> {
    let count = sorted.len();
    let clusters = sorted.iter().map(|(cluster, _)| cluster + 1).max()?;
    let below = ((p * count as f64).round() as usize).clamp(1, count.saturating_sub(1).max(1));
    let limit = sorted.get(below - 1)?.1;
    let mut sums = vec![ClusterSum::default(); clusters];
    for (cluster, value) in sorted {
        if let Some(sum) = sums.get_mut(*cluster) {
            sum.count += 1.0;
            sum.sum += f64::from(u8::from(*value <= limit));
        }
    }
    let counted = non_empty(&sums);
    Some(trials_by_scatter(&counted, &Ratio::new(&counted)?, 1.0))
}

#[cfg(test)]
mod tests {
    use super::super::clusters::tests::{check_coverage, coverage};
    use super::*;
    use draws::{Stream, normal};

    /// Draws clusters of `points` values each: the sum of a random number per cluster and one per value.
    fn values(random: &mut Stream, draws: usize, points: usize) -> Vec<ClusterValue> {
        let mut values = Vec::new();
        for draw in 0..draws {
            let of_draw = normal(random);
            values.extend((0..points).map(|_| (draw, of_draw + 0.5 * normal(random))));
        }
        values.sort_by(|a, b| a.1.total_cmp(&b.1));
        values
    }

    #[test]
    fn quantiles_hold_their_truth() {
        let sd = 1.25_f64.sqrt();
        let normal_95 = 1.644_853_626_951_472_2;
        for (p, truth) in [(0.05, -normal_95 * sd), (0.5, 0.0), (0.95, normal_95 * sd)] {
            for (draws, points) in [(100, 1), (100, 4), (200, 3)] {
                let held = coverage(2000, truth, |random| {
                    cluster_quantile_interval(&values(random, draws, points), p)
                });
                check_coverage(&format!("quantile {p} of {draws} draws at {points} points"), held);
            }
        }
    }
}
