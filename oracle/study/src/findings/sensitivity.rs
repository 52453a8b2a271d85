//! What the figures depend on.
use serde::{Deserialize, Serialize};

/// How a figure goes with a drawn value: Spearman's rank correlation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RankCorrelation {
    /// Path of the drawn value.
    pub parameter: String,
    /// Name of the figure.
    pub figure: String,
    /// From −1, the figure falls whenever the value grows, to 1.
    pub correlation: f64,
    /// Lower limit of the 95 % interval, by Fisher's transformation with the variance of Bonett & Wright (2000); absent where too few
    /// draws are known.
    pub low: Option<f64>,
    /// Upper limit.
    pub high: Option<f64>,
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

/// First-order and total index of a parameter by Saltelli et al. (2010), Computer Physics Communications 181, 259–270, Table 2 (b) and
/// (f, Jansen): f at the points A, B and A with the parameter of B. `None` where f does not vary.
pub(crate) fn sobol_index(a: &[f64], b: &[f64], ab: &[f64]) -> Option<(f64, f64)> {
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
    use crate::definition::design::{Design, DesignKind};

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
