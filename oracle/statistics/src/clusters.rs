//! Estimates from clustered values: cases that share a draw form a cluster, and only the clusters are
//! independent.
//!
//! Ratios, rates and differences are linearised, with one residual per cluster (Cochran 1977, Sampling
//! Techniques, 6.3 and 9A). Their intervals use Student's t with one degree of freedom fewer than there are
//! clusters. All intervals are of 95 %.

use statrs::distribution::{ContinuousCDF, StudentsT};

use super::{Interval, Z_95, normal_quantile, wilson};

/// Smallest number of clusters for which an interval is computed.
pub const MIN_CLUSTERS: usize = 5;
/// Probability outside a two-sided interval.
pub(super) const OUTSIDE: f64 = 0.05;

/// Contribution of a cluster to a ratio Σ `sum` / Σ `count`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ClusterSum {
    /// Number of successes of a rate, or sum of the values of a mean.
    pub sum: f64,
    /// Number of trials or values.
    pub count: f64,
}

/// Ratio with the residual of each of its clusters.
pub(super) struct Ratio {
    pub(super) value: f64,
    residuals: Vec<f64>,
}

impl Ratio {
    /// Computes the ratio; `None` if the sum of `count` is 0.
    pub(super) fn new(clusters: &[ClusterSum]) -> Option<Self> {
        let (sum, of) = clusters.iter().fold((0.0, 0.0), |(s, n), c| (s + c.sum, n + c.count));
        let value = (of > 0.0).then(|| sum / of)?;
        let mean_of = of / clusters.len() as f64;
        let residual = |cluster: &ClusterSum| (cluster.sum - value * cluster.count) / mean_of;
        Some(Self { value, residuals: clusters.iter().map(residual).collect() })
    }

    pub(super) fn variance(&self) -> f64 {
        variance_of_mean(&self.residuals)
    }
}

/// Variance of the mean of independent residuals whose mean is 0.
fn variance_of_mean(residuals: &[f64]) -> f64 {
    let n = residuals.len() as f64;
    residuals.iter().map(|r| r * r).sum::<f64>() / (n * (n - 1.0))
}

/// Returns the 97.5 % quantile of Student's t for two or more clusters.
pub(super) fn t_95(clusters: usize) -> f64 {
    t_quantile(clusters as f64, 1.0 - 0.5 * OUTSIDE)
}

/// Returns the quantile `p` of Student's t for more than one cluster.
pub(super) fn t_quantile(clusters: f64, p: f64) -> f64 {
    StudentsT::new(0.0, 1.0, clusters - 1.0).map_or_else(|_| normal_quantile(p), |t| t.inverse_cdf(p))
}

/// Computes the interval of a mean over clusters, Σ sum / Σ of ± t s. Clusters without a value are left out.
/// `None` below [`MIN_CLUSTERS`].
pub fn cluster_mean_interval(clusters: &[ClusterSum]) -> Option<Interval> {
    let counted = non_empty(clusters);
    if counted.len() < MIN_CLUSTERS {
        return None;
    }
    let ratio = Ratio::new(&counted)?;
    let half = t_95(counted.len()) * ratio.variance().sqrt();
    Some(Interval { low: ratio.value - half, high: ratio.value + half })
}

/// Computes the interval of a rate over clusters: Wilson's interval for the number of independent trials that
/// would scatter as much as the clusters, divided by (t/z)² because this number is itself estimated (Korn &
/// Graubard 1998, Survey Methodology 24, 193–201). Clusters of one trial are independent trials. Clusters
/// with equal rates contain no information about their scatter: each counts as one trial when all or none of
/// the trials are successes, and with all its trials otherwise. `None` if there is no trial.
pub fn cluster_rate_interval(clusters: &[ClusterSum]) -> Option<Interval> {
    let counted = non_empty(clusters);
    let ratio = Ratio::new(&counted)?;
    wilson(ratio.value, independent_trials(&counted, &ratio))
}

/// Returns the number of independent trials that would scatter as much as the clusters; see
/// [`cluster_rate_interval`].
pub(super) fn independent_trials(counted: &[ClusterSum], ratio: &Ratio) -> f64 {
    let n = counted.len();
    let trials: f64 = counted.iter().map(|cluster| cluster.count).sum();
    let of_one_trial = ratio.value * (1.0 - ratio.value);
    if n == 1 {
        return 1.0;
    }
    let variance = ratio.variance();
    if counted.iter().all(|cluster| cluster.count == 1.0) {
        trials
    } else if variance > 0.0 && of_one_trial > 0.0 {
        let shrink = Z_95 / t_95(n);
        (of_one_trial / variance * shrink * shrink).max(1.0)
    } else if of_one_trial > 0.0 {
        trials
    } else {
        n as f64
    }
}

pub(super) fn non_empty(clusters: &[ClusterSum]) -> Vec<ClusterSum> {
    clusters.iter().copied().filter(|cluster| cluster.count > 0.0).collect()
}

/// Computes the interval of the difference of two means, second minus first, over clusters with values of
/// both. `None` below [`MIN_CLUSTERS`].
pub fn mean_difference_interval(pairs: &[(ClusterSum, ClusterSum)]) -> Option<Interval> {
    if pairs.len() < MIN_CLUSTERS {
        return None;
    }
    let (first, second) = ratios(pairs)?;
    let residuals: Vec<f64> = second.residuals.iter().zip(&first.residuals).map(|(b, a)| b - a).collect();
    let half = t_95(pairs.len()) * variance_of_mean(&residuals).sqrt();
    let difference = second.value - first.value;
    Some(Interval { low: difference - half, high: difference + half })
}

/// Computes the interval of the difference of two rates of the same clusters, second minus first, from the
/// interval of each rate and the correlation of their residuals (Newcombe 1998, Statistics in Medicine 17,
/// 2635–2650, method 8; for clusters Zou & Donner 2008, 27, 1693–1702). `None` below [`MIN_CLUSTERS`].
pub fn rate_difference_interval(pairs: &[(ClusterSum, ClusterSum)]) -> Option<Interval> {
    if pairs.len() < MIN_CLUSTERS {
        return None;
    }
    let (first, second) = ratios(pairs)?;
    let of_first: Vec<ClusterSum> = pairs.iter().map(|pair| pair.0).collect();
    let of_second: Vec<ClusterSum> = pairs.iter().map(|pair| pair.1).collect();
    let (a, b) = (cluster_rate_interval(&of_first)?, cluster_rate_interval(&of_second)?);
    let product: f64 = first.residuals.iter().zip(&second.residuals).map(|(a, b)| a * b).sum();
    let squares = |ratio: &Ratio| ratio.residuals.iter().map(|r| r * r).sum::<f64>();
    let spread = (squares(&first) * squares(&second)).sqrt();
    let correlation = if spread > 0.0 { (product / spread).clamp(-1.0, 1.0) } else { 0.0 };
    let reach = |of_second: f64, of_first: f64| {
        let square = of_second * of_second - 2.0 * correlation * of_second * of_first + of_first * of_first;
        square.max(0.0).sqrt()
    };
    let difference = second.value - first.value;
    Some(Interval {
        low: difference - reach(second.value - b.low, a.high - first.value),
        high: difference + reach(b.high - second.value, first.value - a.low),
    })
}

fn ratios(pairs: &[(ClusterSum, ClusterSum)]) -> Option<(Ratio, Ratio)> {
    let of = |pick: fn(&(ClusterSum, ClusterSum)) -> ClusterSum| {
        Ratio::new(&pairs.iter().map(pick).collect::<Vec<_>>())
    };
    Some((of(|pair| pair.0)?, of(|pair| pair.1)?))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use sim::randomness::{Effect, Seed, Stream, normal, uniform};

    /// Returns the fraction of intervals that contain the truth, over `studies` studies; studies without an
    /// interval are left out.
    pub(in super::super) fn coverage(
        studies: u64,
        truth: f64,
        interval: impl Fn(&mut Stream) -> Option<Interval>,
    ) -> f64 {
        let random = |study| Seed { seed: 17, case: study }.stream(0, Effect::StudyParameter, 0);
        let intervals: Vec<Interval> =
            (0..studies).filter_map(|study| interval(&mut random(study))).collect();
        let held = intervals.iter().filter(|i| i.low <= truth && truth <= i.high).count();
        held as f64 / intervals.len() as f64
    }

    /// The coverage in 2,000 studies at 95 % has a standard deviation of 0.5 %: the required 93 to 97 % allow
    /// four times this deviation.
    pub(in super::super) fn check_coverage(name: &str, coverage: f64) {
        println!("{name}: {:.1} % held", 100.0 * coverage);
        assert!((0.93..=0.97).contains(&coverage), "{name}: {coverage}");
    }

    /// Draws 40 clusters of four sweep points with 25 frames each: the success probability is a draw between
    /// 0.6 and 1, minus 0.1 per point.
    fn swept_rates(random: &mut Stream) -> Vec<[ClusterSum; 4]> {
        let mut points = || {
            let of_draw = 0.6 + 0.4 * uniform(random);
            [0.0, 0.1, 0.2, 0.3].map(|less| {
                let hits = (0..25).filter(|_| uniform(random) < of_draw - less).count();
                ClusterSum { sum: hits as f64, count: 25.0 }
            })
        };
        (0..40).map(|_| points()).collect()
    }

    fn together(points: &[ClusterSum; 4]) -> ClusterSum {
        let add = |a: ClusterSum, b: &ClusterSum| ClusterSum { sum: a.sum + b.sum, count: a.count + b.count };
        points.iter().fold(ClusterSum::default(), add)
    }

    #[test]
    fn rates_over_draws_hold_their_truth() {
        let rate = coverage(2000, 0.65, |random| {
            cluster_rate_interval(&swept_rates(random).iter().map(together).collect::<Vec<_>>())
        });
        check_coverage("rate, four sweep points together", rate);
        let rate = coverage(2000, 0.8, |random| {
            cluster_rate_interval(&swept_rates(random).iter().map(|points| points[0]).collect::<Vec<_>>())
        });
        check_coverage("rate, one sweep point", rate);
        for seldom in [0.03, 0.1] {
            // Either all frames of a case fail, or none.
            let rate = coverage(2000, seldom, |random| {
                let mut fails = || f64::from(u8::from(uniform(random) < seldom)) * 50.0;
                cluster_rate_interval(
                    &(0..100).map(|_| ClusterSum { sum: fails(), count: 50.0 }).collect::<Vec<_>>(),
                )
            });
            check_coverage(&format!("rate of cases that fail as a whole, {seldom}"), rate);
        }
    }

    #[test]
    fn differences_between_points_hold_their_truth() {
        let difference = coverage(2000, -0.3, |random| {
            let pairs: Vec<_> = swept_rates(random).iter().map(|points| (points[0], points[3])).collect();
            rate_difference_interval(&pairs)
        });
        check_coverage("difference of rates", difference);
        let difference = coverage(2000, 0.5, |random| {
            let mut of_draw = || {
                let of_draw = normal(random);
                [0.0, 0.5].map(|more| ClusterSum { sum: of_draw + more + 0.3 * normal(random), count: 1.0 })
            };
            let pairs: Vec<_> = (0..12).map(|_| of_draw()).map(|[a, b]| (a, b)).collect();
            mean_difference_interval(&pairs)
        });
        check_coverage("difference of means, 12 draws", difference);
    }

    #[test]
    fn means_over_draws_hold_their_truth() {
        for (draws, points) in [(5, 1), (12, 1), (40, 1), (5, 4), (12, 4), (40, 4)] {
            let truth = 0.5 * f64::from(points - 1);
            let mean = coverage(2000, truth, |random| {
                let mut of_draw = || {
                    let of_draw = normal(random);
                    let sum =
                        (0..points).map(|point| of_draw + f64::from(point) + 0.3 * normal(random)).sum();
                    ClusterSum { sum, count: f64::from(points) }
                };
                cluster_mean_interval(&(0..draws).map(|_| of_draw()).collect::<Vec<_>>())
            });
            check_coverage(&format!("mean, {draws} draws at {points} points"), mean);
        }
    }
}
