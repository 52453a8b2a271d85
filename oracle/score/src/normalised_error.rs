//! Error in units of its covariance.

use contract::Covariance2;

/// Upper limit of NEES: a larger value counts as this one, so that extreme errors are counted and the mean
/// remains finite.
const MAX_NEES: f64 = 1e12;

/// Upper limit of an error over its standard deviation.
const MAX_OVER_SIGMA: f64 = 1e6;

/// Error of two components in units of its covariance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalisedError {
    /// Each component over its standard deviation; at most 1e6 in magnitude.
    pub over_sigma: [f64; 2],
    /// Normalised estimation error squared per dimension, eᵀ C⁻¹ e / 2: 1 in the mean for a correct
    /// covariance C; at most 1e12.
    pub nees: f64,
}

impl NormalisedError {
    /// Normalises an error by its covariance; both must have the same unit.
    pub fn from_error(error: [f64; 2], covariance: &Covariance2) -> Self {
        let sigmas = [covariance.sigma_x(), covariance.sigma_y()];
        let over = |i: usize| match (error.get(i), sigmas.get(i)) {
            (Some(error), Some(sigma)) => (error / sigma).clamp(-MAX_OVER_SIGMA, MAX_OVER_SIGMA),
            _ => 0.0,
        };
        // `min` replaces the NaN of errors so large that their squares are infinite.
        let nees = (covariance.mahalanobis_squared(error) / 2.0).min(MAX_NEES);
        Self { over_sigma: [over(0), over(1)], nees }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sigmas(x: f64, y: f64, correlation: f64) -> Covariance2 {
        Covariance2::from_sigmas(x, y, correlation).unwrap()
    }

    /// (x² − 2 ρ x y + y²)/(1 − ρ²)/2 in units of σ: (4 − 2 + 1)/0.75/2 and (4 + 2 + 1)/0.75/2.
    #[test]
    fn the_nees_of_a_correlated_error_is_its_closed_form() {
        for (correlation, nees) in [(0.5, 2.0), (-0.5, 14.0 / 3.0)] {
            let error = NormalisedError::from_error([1.0, 0.25], &sigmas(0.5, 0.25, correlation));
            assert_eq!(error.over_sigma, [2.0, 1.0]);
            assert!((error.nees - nees).abs() < 1e-14, "{error:?}");
        }
    }

    #[test]
    fn an_error_beyond_all_proportion_is_a_number() {
        for sigma in [1e-9, 1e-200, 1e-310] {
            let error = NormalisedError::from_error([1.0, -1.0], &sigmas(sigma, sigma, 0.5));
            assert_eq!((error.over_sigma, error.nees), ([1e6, -1e6], MAX_NEES), "{sigma}");
        }
        assert_eq!(NormalisedError::from_error([0.0; 2], &sigmas(1e-310, 1e-310, 0.0)).nees, 0.0);
    }
}
