//! How much the poses of fields scatter about their motion, against what their covariances say.
//!
//! A covariance from the residuals of pixels holds for noise that is independent from pixel to pixel. Shifted lines, ringing or
//! places that change with the rows of a field move a pose as a whole, and are only seen from field to field.

use nalgebra::{Cholesky, Matrix6, Vector6};

/// W, the covariance of whitened residuals: with S = L Lᵀ of a field, its errors have the covariance L W Lᵀ. It is the mean of
/// the identity, with a weight of ν0 degrees of freedom, and of what was seen in this portion and, forgotten by a factor, in
/// those before.
#[derive(Debug, Clone)]
pub(super) struct Scatter {
    trust: f64,
    squares: Matrix6<f64>,
    freedom: f64,
}

impl Scatter {
    /// Nothing seen yet; ν0 = `trust`.
    pub(super) fn new(trust: f64) -> Self {
        Self { trust, squares: Matrix6::zeros(), freedom: 0.0 }
    }

    /// Adds a portion of residuals about their own straight line, each with the covariance of its field as told; of what
    /// was seen before, the part `kept` counts.
    pub(super) fn add(&mut self, residuals: &[(Vector6<f64>, Matrix6<f64>)], kept: f64) {
        self.squares *= kept;
        self.freedom *= kept;
        let whitened: Vec<Vector6<f64>> = residuals
            .iter()
            .filter_map(|(residual, covariance)| factor(covariance)?.solve_lower_triangular(residual))
            .collect();
        for residual in &whitened {
            self.squares += residual * residual.transpose();
        }
        // A line takes two of each parameter.
        self.freedom += (whitened.len() as f64 - 2.0).max(0.0);
    }

    /// The covariance of a field's errors; `None` for one that is not positive definite.
    pub(super) fn covariance(&self, told: &Matrix6<f64>) -> Option<Matrix6<f64>> {
        let root = factor(told)?;
        let scattered = root * self.factor() * root.transpose();
        Some((scattered + scattered.transpose()) * 0.5)
    }

    /// W, times 1 + 7 ν/(ν + ν0)². To second order that makes the mean of W⁻¹, and with it that of the NEES, right:
    /// E Δ² = (6 + 1) ν/(ν + ν0)² for the scatter Δ of a Wishart matrix of 6 dimensions.
    fn factor(&self) -> Matrix6<f64> {
        let weight = self.trust + self.freedom;
        let mean = (Matrix6::identity() * self.trust + self.squares) / weight;
        mean * (1.0 + 7.0 * self.freedom / (weight * weight))
    }
}

/// L of S = L Lᵀ, lower triangular; metres and radians are scaled first, so that they cost no digits.
fn factor(covariance: &Matrix6<f64>) -> Option<Matrix6<f64>> {
    let sigma = covariance.diagonal().map(f64::sqrt);
    if !sigma.iter().all(|s| *s > 0.0 && s.is_finite()) {
        return None;
    }
    let scaled = Matrix6::from_fn(|i, j| covariance[(i, j)] / (sigma[i] * sigma[j]));
    let root = Cholesky::new(scaled)?.l();
    Some(Matrix6::from_fn(|i, j| root[(i, j)] * sigma[i]))
}

#[cfg(test)]
mod tests {
    use super::super::tests::normal;
    use super::*;

    fn residuals(seed: u64, scale: &Vector6<f64>) -> Vec<(Vector6<f64>, Matrix6<f64>)> {
        (0..10)
            .map(|field| {
                let draw = Vector6::from_fn(|i, _| normal(seed * 1000 + field * 6 + i as u64));
                // 8 degrees of freedom in 10 residuals.
                (draw.component_mul(scale) * 0.8f64.sqrt(), Matrix6::identity())
            })
            .collect()
    }

    #[test]
    fn what_scatters_more_than_it_says_is_believed_after_a_few_portions() {
        let scale = Vector6::new(1.0, 1.0, 1.0, 4.0, 1.0, 1.0);
        let (mut sum, n) = (Matrix6::zeros(), 100);
        for seed in 0..n {
            let mut scatter = Scatter::new(12.0);
            for portion in 0..10 {
                scatter.add(&residuals(seed * 10 + portion, &scale), 0.8);
            }
            sum += scatter.covariance(&Matrix6::identity()).unwrap() / n as f64;
        }
        // ν = 36 of 48 degrees of freedom: (12 + 36 × 16)/48 = 12.2 and 1, times 1.11; 100 runs of 36 degrees of freedom
        // scatter by 2 %.
        assert!((sum[(3, 3)] / 13.5 - 1.0).abs() < 0.1, "{}", sum[(3, 3)]);
        assert!((sum[(0, 0)] / 1.11 - 1.0).abs() < 0.1, "{}", sum[(0, 0)]);
    }

    #[test]
    fn before_anything_is_seen_a_field_is_believed() {
        let told = Matrix6::from_fn(|i, j| if i == j { 1e-6 * (1.0 + i as f64) } else { 2e-7 });
        assert!((Scatter::new(12.0).covariance(&told).unwrap() - told).abs().max() < 1e-18);
        assert_eq!(Scatter::new(12.0).covariance(&Matrix6::zeros()), None);
    }
}
