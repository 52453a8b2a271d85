//! Spearman's rank correlation of values in clusters.

use super::clusters::{MIN_CLUSTERS, t_95};
use super::{Interval, Z_95};

/// Computes Spearman's rank correlation of values in clusters, (cluster, x, y), and its interval: Fisher's
/// transformation with the variance of Bonett & Wright (2000, Psychometrika 65, 23–28) for the number of
/// independent pairs whose correlation would scatter as much as over the clusters, according to its influence
/// function. `None` for fewer than four pairs, or if x or y never varies; no interval below
/// [`MIN_CLUSTERS`].
pub fn cluster_rank_correlation(values: &[(usize, f64, f64)]) -> Option<(f64, Option<Interval>)> {
    let count = values.len() as f64;
    if count < 4.0 {
        return None;
    }
    let x = RankedValues::new(values.iter().map(|(_, x, _)| *x).collect());
    let y = RankedValues::new(values.iter().map(|(_, _, y)| *y).collect());
    let mean = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / count;
    let (of_x, of_y) = (mean(&x.centred, &x.centred), mean(&y.centred, &y.centred));
    let spread = (of_x * of_y).sqrt();
    if spread <= 0.0 {
        return None;
    }
    let product = mean(&x.centred, &y.centred);
    let r = (product / spread).clamp(-1.0, 1.0);

    // Influence of each pair on the correlation: the pair changes the ranks, and with equal values also the
    // spread of the ranks.
    let (y_above_x, x_above_y) = (x.mean_above(&y.centred), y.mean_above(&x.centred));
    let (x_above_x, y_above_y) = (x.mean_above(&x.centred), y.mean_above(&y.centred));
    let clusters = values.iter().map(|(cluster, ..)| cluster + 1).max().unwrap_or_default();
    let mut sums = vec![0.0; clusters];
    let mut squares = 0.0;
    for (i, (cluster, ..)) in values.iter().enumerate() {
        let (a, b) = (x.centred[i], y.centred[i]);
        let moved = a * b + y_above_x[i] + x_above_y[i] - 3.0 * product;
        let x_moved = a * a + 2.0 * x_above_x[i] - 3.0 * of_x;
        let y_moved = b * b + 2.0 * y_above_y[i] - 3.0 * of_y;
        let influence = moved / spread - 0.5 * r * (x_moved / of_x + y_moved / of_y);
        sums[*cluster] += influence;
        squares += influence * influence;
    }
    let mut sizes = vec![0_u32; clusters];
    values.iter().for_each(|(cluster, ..)| sizes[*cluster] += 1);
    let n = sizes.iter().filter(|size| **size > 0).count();
    if n < MIN_CLUSTERS {
        return Some((r, None));
    }
    let is_single = sizes.iter().all(|size| *size <= 1);
    let (pairs, quantile) = if is_single {
        (count, Z_95)
    } else {
        let of_clusters = sums.iter().map(|sum| sum * sum).sum::<f64>() * n as f64 / (n as f64 - 1.0);
        (if of_clusters > 0.0 { count * squares / of_clusters } else { n as f64 }, t_95(n))
    };
    // A perfect order has no interval by this transformation: its width would be 0.
    let z = libm::atanh(r.clamp(-1.0 + 1e-12, 1.0 - 1e-12));
    let half = quantile * ((1.0 + 0.5 * r * r) / (pairs - 3.0)).sqrt();
    let interval = (pairs > 3.0)
        .then(|| Interval { low: libm::tanh(z - half).min(r), high: libm::tanh(z + half).max(r) });
    Some((r, interval))
}

/// Values replaced by their ranks; equal values share their mean rank.
struct RankedValues {
    /// Rank minus the middle rank, over the number of values.
    centred: Vec<f64>,
    /// Indices of the values in ascending order, in groups of equal values.
    order: Vec<Vec<usize>>,
}

impl RankedValues {
    fn new(values: Vec<f64>) -> Self {
        let mut places: Vec<usize> = (0..values.len()).collect();
        places.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
        let order: Vec<Vec<usize>> =
            places.chunk_by(|a, b| values[*a] == values[*b]).map(<[usize]>::to_vec).collect();
        let count = values.len() as f64;
        let mut centred = vec![0.0; values.len()];
        let mut below = 0.0;
        for equal in &order {
            let rank = below + 0.5 * (equal.len() as f64 + 1.0);
            equal.iter().for_each(|place| centred[*place] = (rank - 0.5 * (count + 1.0)) / count);
            below += equal.len() as f64;
        }
        Self { centred, order }
    }

    /// Returns for each value the sum of `weights` of the larger values plus half of those of equal ones,
    /// over the number of values.
    fn mean_above(&self, weights: &[f64]) -> Vec<f64> {
        let count = weights.len() as f64;
        let mut means = vec![0.0; weights.len()];
        let mut above = 0.0;
        for equal in self.order.iter().rev() {
            let here: f64 = equal.iter().map(|place| weights[*place]).sum();
            equal.iter().for_each(|place| means[*place] = (above + 0.5 * here) / count);
            above += here;
        }
        means
    }
}

#[cfg(test)]
mod tests {
    use super::super::clusters::tests::{check_coverage, coverage};
    use super::*;
    use draws::{Effect, Seed, Stream, normal};

    /// scipy 1.17.1: `scipy.stats.spearmanr([1, 2, 3, 4, 5], [5, 6, 7, 8, 7])` gives 0.8207826816681233.
    #[test]
    fn the_rank_correlation_is_that_of_scipy() {
        let triples = [(0, 1.0, 5.0), (1, 2.0, 6.0), (2, 3.0, 7.0), (3, 4.0, 8.0), (4, 5.0, 7.0)];
        let (r, interval) = cluster_rank_correlation(&triples).unwrap();
        assert!((r - 0.820_782_681_668_123_3).abs() < 1e-14, "{r}");
        assert!(interval.is_some_and(|i| i.low < r && r < i.high && i.high < 1.0));
    }

    #[test]
    fn a_value_that_never_varies_has_no_correlation() {
        let never: Vec<_> = (0..10).map(|draw| (draw, 1.0, draw as f64)).collect();
        assert_eq!(cluster_rank_correlation(&never), None);
        assert_eq!(cluster_rank_correlation(&[(0, 1.0, 2.0), (1, 2.0, 3.0)]), None);
        let few = [(0, 1.0, 2.0), (0, 2.0, 3.0), (1, 4.0, 2.0), (1, 5.0, 9.0)];
        assert!(cluster_rank_correlation(&few).is_some_and(|(_, interval)| interval.is_none()));
    }

    /// Every draw has the same set of swept values.
    #[test]
    fn correlations_with_the_swept_value_hold_their_truth() {
        let triples = |random: &mut Stream, draws: usize| {
            let mut triples = Vec::new();
            for draw in 0..draws {
                let of_draw = normal(random);
                triples.extend((0..4).map(|point| {
                    let x = f64::from(point);
                    (draw, x, 0.5 * x + of_draw + 0.5 * normal(random))
                }));
            }
            triples
        };
        let all = &mut Seed { seed: 23, case: 0 }.stream(0, Effect::StudyParameter, 0);
        let (truth, _) = cluster_rank_correlation(&triples(all, 200_000)).unwrap();
        let held = coverage(2000, truth, |random| cluster_rank_correlation(&triples(random, 40))?.1);
        check_coverage("correlation with the swept value, 40 draws", held);
    }

    /// For a normal distribution with Pearson's correlation ρ, Spearman's is 6/π asin(ρ/2).
    #[test]
    fn correlations_over_draws_hold_their_truth() {
        for (points, draws, noise) in [(1, 40, 1.0), (4, 40, 1.0), (4, 40, 0.2), (3, 200, 2.0)] {
            let rho = 1.0 / (1.0 + noise * noise + 0.25_f64).sqrt();
            let truth = 6.0 / std::f64::consts::PI * libm::asin(0.5 * rho);
            let held = coverage(2000, truth, |random| {
                let mut triples = Vec::new();
                for draw in 0..draws {
                    let (x, of_draw) = (normal(random), noise * normal(random));
                    triples.extend((0..points).map(|_| (draw, x, x + of_draw + 0.5 * normal(random))));
                }
                cluster_rank_correlation(&triples)?.1
            });
            check_coverage(&format!("correlation, {draws} draws at {points} points, noise {noise}"), held);
        }
    }
}
