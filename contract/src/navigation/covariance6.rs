//! Covariance of six jointly estimated values.

use nalgebra::{Matrix6, Vector6};

use crate::OutOfRange;

/// Relative asymmetry of a matrix that is attributed to rounding.
const MAX_ASYMMETRY: f64 = 1e-6;

/// Symmetric, positive definite 6 × 6 covariance matrix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Covariance6(Matrix6<f64>);

impl Covariance6 {
    /// Creates a covariance from its matrix, symmetrised.
    ///
    /// # Errors
    /// [`OutOfRange`] unless the matrix is finite, symmetric within 1e-6 of the product of the two σ, and
    /// positive definite (its matrix of correlations has a Cholesky factor).
    pub fn from_matrix(matrix: Matrix6<f64>) -> Result<Self, OutOfRange> {
        let refused = |value: String, expected: &str| Err(OutOfRange::new("covariance", value, expected));
        let variances = matrix.diagonal();
        if let Some(variance) = variances.iter().find(|variance| !(**variance > 0.0 && variance.is_finite()))
        {
            return refused(variance.to_string(), "a positive, finite variance");
        }
        let sigmas = variances.map(f64::sqrt);
        let correlations = matrix.component_div(&(sigmas * sigmas.transpose()));
        let asymmetry = (correlations - correlations.transpose()).abs().max();
        // A maximum ignores NaN.
        let is_finite = correlations.iter().all(|correlation| correlation.is_finite());
        if !is_finite || asymmetry > MAX_ASYMMETRY {
            return refused(format!("asymmetric by {asymmetry} of its σ"), "a symmetric, finite matrix");
        }
        let symmetric = (correlations + correlations.transpose()) * 0.5;
        if symmetric.cholesky().is_none() {
            return refused("not positive definite".to_owned(), "a positive definite matrix");
        }
        Ok(Self((matrix + matrix.transpose()) * 0.5))
    }

    /// Creates the covariance of six independent values from their standard deviations.
    ///
    /// # Errors
    /// [`OutOfRange`] unless every standard deviation is positive and finite.
    pub fn from_sigmas(sigmas: [f64; 6]) -> Result<Self, OutOfRange> {
        Self::from_matrix(Matrix6::from_diagonal(&Vector6::from(sigmas).map(|sigma| sigma * sigma)))
    }

    /// Returns the matrix.
    pub fn matrix(&self) -> &Matrix6<f64> {
        &self.0
    }

    /// Returns the standard deviations.
    pub fn sigmas(&self) -> Vector6<f64> {
        self.0.diagonal().map(f64::sqrt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sigmas_are_the_roots_of_the_diagonal() {
        let covariance = Covariance6::from_sigmas([1.0, 2.0, 3.0, 1e-3, 5.0, 1e4]).unwrap();
        assert_eq!(covariance.sigmas().as_slice(), [1.0, 2.0, 3.0, 1e-3, 5.0, 1e4]);
    }

    #[test]
    fn matrices_that_are_no_covariance_are_refused() {
        let refused = |change: fn(&mut Matrix6<f64>)| {
            let mut matrix = Matrix6::identity();
            change(&mut matrix);
            Covariance6::from_matrix(matrix).unwrap_err().to_string()
        };
        assert!(refused(|m| m[(2, 2)] = 0.0).contains("positive, finite variance"));
        assert!(refused(|m| m[(2, 2)] = f64::INFINITY).contains("positive, finite variance"));
        assert!(refused(|m| m[(0, 1)] = f64::NAN).contains("symmetric"));
        assert!(refused(|m| m[(0, 1)] = 0.5).contains("symmetric"));
        assert!(refused(|m| (m[(0, 1)], m[(1, 0)]) = (1.5, 1.5)).contains("positive definite"));
    }

    /// The units of six values differ by many orders of magnitude: definiteness is that of the correlations.
    #[test]
    fn the_scale_of_a_value_is_irrelevant() {
        let sigmas = Vector6::new(1e5, 1e-9, 1.0, 1e-6, 1e3, 1.0);
        let mut matrix = Matrix6::from_diagonal(&sigmas.component_mul(&sigmas));
        (matrix[(0, 1)], matrix[(1, 0)]) = (0.99e-4, 0.99e-4);
        assert!(Covariance6::from_matrix(matrix).is_ok());
        (matrix[(0, 1)], matrix[(1, 0)]) = (1.01e-4, 1.01e-4);
        assert!(Covariance6::from_matrix(matrix).is_err());
    }
}
