//! What the figures depend on.
use serde::{Deserialize, Serialize};
use statistics::Z_95;

/// How a figure goes with a drawn value: Spearman's rank correlation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RankCorrelation {
    /// Path of the drawn value.
    pub parameter: String,
    /// Name of the figure.
    pub figure: String,
    /// From −1, the figure falls whenever the value grows, to 1.
    pub correlation: f64,
    /// Lower limit of the 95 % interval, by Fisher's transformation with the variance of Bonett & Wright (2000).
    pub low: f64,
    /// Upper limit.
    pub high: f64,
    /// Cases that have the figure.
    pub cases: u64,
}

/// How much of a figure's variance is a parameter's doing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SobolIndex {
    /// Path of the drawn value.
    pub parameter: String,
    /// Name of the figure.
    pub figure: String,
    /// The parameter alone: the part of the variance that goes when it is known.
    pub first: f64,
    /// 95 % interval of it, from points drawn again.
    pub first_interval: [f64; 2],
    /// With all in which it takes part: the part that stays when all others are known. The noise of a case counts here.
    pub total: f64,
    /// 95 % interval of it.
    pub total_interval: [f64; 2],
}

/// Spearman's rank correlation of pairs; `None` for fewer than four, or where either never varies.
pub(super) fn rank_correlation(pairs: &[(f64, f64)]) -> Option<(f64, f64, f64)> {
    let n = pairs.len();
    if n < 4 {
        return None;
    }
    let x = ranks(&pairs.iter().map(|pair| pair.0).collect::<Vec<_>>());
    let y = ranks(&pairs.iter().map(|pair| pair.1).collect::<Vec<_>>());
    let middle = 0.5 * (n as f64 + 1.0);
    let sum =
        |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| (a - middle) * (b - middle)).sum() };
    let spread = sum(&x, &x) * sum(&y, &y);
    if spread <= 0.0 {
        return None;
    }
    let r = (sum(&x, &y) / spread.sqrt()).clamp(-1.0, 1.0);
    // Of a perfect order no interval can be told by this transformation: it has no width.
    let z = libm::atanh(r.clamp(-1.0 + 1e-12, 1.0 - 1e-12));
    let half = Z_95 * ((1.0 + 0.5 * r * r) / (n as f64 - 3.0)).sqrt();
    Some((r, libm::tanh(z - half).min(r), libm::tanh(z + half).max(r)))
}

/// Ranks from 1; equal values share the mean of theirs.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    while first < order.len() {
        let alike = order[first..].iter().take_while(|i| values[**i] == values[order[first]]).count();
        let rank = first as f64 + 0.5 * (alike as f64 + 1.0);
        order[first..first + alike].iter().for_each(|i| ranks[*i] = rank);
        first += alike;
    }
    ranks
}

/// First-order and total index of a parameter by Saltelli et al. (2010), Computer Physics Communications 181, 259–270, Table 2 (b) and
/// (f, Jansen): f at the points A, B and A with the parameter of B. `None` where f does not vary.
pub(super) fn sobol_index(a: &[f64], b: &[f64], ab: &[f64]) -> Option<(f64, f64)> {
    let n = a.len() as f64;
    let mean = a.iter().chain(b).sum::<f64>() / (2.0 * n);
    let variance = a.iter().chain(b).map(|f| (f - mean) * (f - mean)).sum::<f64>() / (2.0 * n);
    if !(variance > 0.0 && variance.is_finite()) {
        return None;
    }
    let (mut first, mut total) = (0.0, 0.0);
    for ((a, b), ab) in a.iter().zip(b).zip(ab) {
        // Centred on the mean, which changes nothing in the limit and much of the scatter.
        first += (b - mean) * (ab - a);
        total += 0.5 * (a - ab) * (a - ab);
    }
    Some((first / (n * variance), total / (n * variance)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{Design, DesignKind};

    /// scipy 1.17.1: `scipy.stats.spearmanr([1, 2, 3, 4, 5], [5, 6, 7, 8, 7])` gives 0.8207826816681233.
    #[test]
    fn the_rank_correlation_is_that_of_scipy() {
        let pairs = [(1.0, 5.0), (2.0, 6.0), (3.0, 7.0), (4.0, 8.0), (5.0, 7.0)];
        let (r, low, high) = rank_correlation(&pairs).unwrap();
        assert!((r - 0.820_782_681_668_123_3).abs() < 1e-14, "{r}");
        assert!(low < r && r < high && high < 1.0);
    }

    #[test]
    fn what_never_varies_has_no_correlation() {
        assert_eq!(rank_correlation(&[(1.0, 2.0); 10]), None);
        assert_eq!(rank_correlation(&[(1.0, 2.0), (2.0, 3.0)]), None);
    }

    /// The function of Ishigami & Homma (1990) with a = 7, b = 0.1, whose indices are known in closed form.
    #[test]
    fn the_indices_are_those_of_ishigamis_function() {
        let (a, b) = (7.0, 0.1);
        let pi = std::f64::consts::PI;
        let f = |x: &[f64]| {
            let x: Vec<f64> = x.iter().map(|u| pi * (2.0 * u - 1.0)).collect();
            let (s0, s1) = (libm::sin(x[0]), libm::sin(x[1]));
            s0 + a * s1 * s1 + b * x[2] * x[2] * x[2] * x[2] * s0
        };
        let n = 4096;
        let design = Design::new(DesignKind::Saltelli, 3, 5 * n, 1).unwrap();
        let member = |m: u64| -> Vec<f64> { (0..n).map(|i| f(&design.point(5 * i + m))).collect() };
        let (pi4, pi8) = (pi * pi * pi * pi, pi * pi * pi * pi * pi * pi * pi * pi);
        let alone = [0.5 * (1.0 + b * pi4 / 5.0) * (1.0 + b * pi4 / 5.0), a * a / 8.0, 0.0];
        let shared = b * b * pi8 * (1.0 / 18.0 - 1.0 / 50.0);
        let variance = alone.iter().sum::<f64>() + shared;
        let total = [alone[0] + shared, alone[1], shared];
        for i in 0..3 {
            let (first_got, total_got) = sobol_index(&member(0), &member(1), &member(2 + i as u64)).unwrap();
            // 4096 points of a low-discrepancy sequence: errors of about a thousandth.
            assert!((first_got - alone[i] / variance).abs() < 0.01, "S{i}: {first_got}");
            assert!((total_got - total[i] / variance).abs() < 0.01, "ST{i}: {total_got}");
        }
    }
}
