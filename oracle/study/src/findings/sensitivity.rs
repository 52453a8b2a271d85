//! Sensitivity of figures to drawn parameters.
use serde::{Deserialize, Serialize};

/// Spearman's rank correlation of a figure with a drawn value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RankCorrelation {
    /// Path of the drawn value.
    pub parameter: String,
    /// Name of the figure.
    pub figure: String,
    /// Correlation coefficient, from −1 (the figure falls whenever the value grows) to 1.
    pub correlation: f64,
    /// Lower limit of the 95 % interval, by Fisher's transformation with the variance of Bonett & Wright
    /// (2000); absent if there are too few draws.
    pub low: Option<f64>,
    /// Upper limit of the 95 % interval; absent if there are too few draws.
    pub high: Option<f64>,
    /// Number of cases that have the figure.
    pub cases: u64,
}

/// Share of a parameter in the variance of a figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SobolIndex {
    /// Path of the drawn value.
    pub parameter: String,
    /// Name of the figure.
    pub figure: String,
    /// First-order index: the fraction of the variance that vanishes when only this parameter is fixed.
    pub first: f64,
    /// 95 % interval of the first-order index, from resampled points.
    pub first_interval: [f64; 2],
    /// Total index, including all interactions of the parameter: the fraction of the variance that remains
    /// when all other parameters are fixed. It includes the noise of a case.
    pub total: f64,
    /// 95 % interval of the total index, from resampled points.
    pub total_interval: [f64; 2],
}

/// Computes the first-order and total index of a parameter by Saltelli et al. (2010), Computer Physics
/// Communications 181, 259–270, Table 2 (b) and (f, Jansen), from f at the points A, B and A with the
/// parameter of B. `None` where f does not vary.
pub(crate) fn sobol_index(a: &[f64], b: &[f64], ab: &[f64]) -> Option<(f64, f64)> {
    let n = a.len() as f64;
    let mean = a.iter().chain(b).sum::<f64>() / (2.0 * n);
    let variance = a.iter().chain(b).map(|f| (f - mean) * (f - mean)).sum::<f64>() / (2.0 * n);
    if !(variance > 0.0 && variance.is_finite()) {
        return None;
    }
    let (mut first, mut total) = (0.0, 0.0);
    for ((a, b), ab) in a.iter().zip(b).zip(ab) {
        // Subtracting the mean does not change the limit, but greatly reduces the scatter.
        first += (b - mean) * (ab - a);
        total += 0.5 * (a - ab) * (a - ab);
    }
    Some((first / (n * variance), total / (n * variance)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::definition::design::{Design, DesignKind};

    /// The function of Ishigami & Homma (1990) with a = 7, b = 0.1, whose indices have a closed form.
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
            // 4096 points of a low-discrepancy sequence have errors of about a thousandth.
            assert!((first_got - alone[i] / variance).abs() < 0.01, "S{i}: {first_got}");
            assert!((total_got - total[i] / variance).abs() < 0.01, "ST{i}: {total_got}");
        }
    }
}
