//! Covariance of a measured position or direction.

use crate::{OutOfRange, bounds::require};

/// Covariance matrix of two errors, stored as their standard deviations and their correlation.
///
/// Both standard deviations are positive and finite and the correlation lies between −1 and 1, which makes
/// the matrix positive definite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Covariance2 {
    sigma_x: f64,
    sigma_y: f64,
    correlation: f64,
}

impl Covariance2 {
    /// Creates a covariance from the standard deviations along x and y, in the same unit, and their
    /// correlation.
    ///
    /// # Errors
    /// [`OutOfRange`] unless the standard deviations are positive and finite and the correlation is above −1
    /// and below 1.
    pub fn from_sigmas(sigma_x: f64, sigma_y: f64, correlation: f64) -> Result<Self, OutOfRange> {
        let is_sigma = |sigma: f64| sigma > 0.0 && sigma.is_finite();
        require("sigma_x", sigma_x, "a positive number", is_sigma)?;
        require("sigma_y", sigma_y, "a positive number", is_sigma)?;
        require("correlation", correlation, "above -1 to below 1", |rho| rho > -1.0 && rho < 1.0)?;
        Ok(Self { sigma_x, sigma_y, correlation })
    }

    /// Creates a covariance from the elements of its matrix [[xx, xy], [xy, yy]].
    ///
    /// # Errors
    /// [`OutOfRange`] unless the matrix is positive definite and finite.
    pub fn from_matrix(xx: f64, xy: f64, yy: f64) -> Result<Self, OutOfRange> {
        let (sigma_x, sigma_y) = (xx.sqrt(), yy.sqrt());
        Self::from_sigmas(sigma_x, sigma_y, xy / (sigma_x * sigma_y))
    }

    /// Creates the covariance of two angles from their standard deviations, degrees, and their correlation.
    ///
    /// # Errors
    /// Those of [`Covariance2::from_sigmas`].
    pub fn from_degrees([sigma_x_deg, sigma_y_deg, correlation]: [f64; 3]) -> Result<Self, OutOfRange> {
        Self::from_sigmas(sigma_x_deg.to_radians(), sigma_y_deg.to_radians(), correlation)
    }

    /// Returns the standard deviations of two angles, degrees, and their correlation.
    pub fn degrees(&self) -> [f64; 3] {
        [self.sigma_x.to_degrees(), self.sigma_y.to_degrees(), self.correlation]
    }

    /// Returns the standard deviation of the first error.
    pub fn sigma_x(&self) -> f64 {
        self.sigma_x
    }

    /// Returns the standard deviation of the second error.
    pub fn sigma_y(&self) -> f64 {
        self.sigma_y
    }

    /// Returns the correlation of the two errors, above −1 and below 1.
    pub fn correlation(&self) -> f64 {
        self.correlation
    }

    /// Returns the elements xx, xy, yy of the matrix.
    pub fn matrix(&self) -> [f64; 3] {
        let Self { sigma_x, sigma_y, correlation } = self;
        [sigma_x * sigma_x, correlation * sigma_x * sigma_y, sigma_y * sigma_y]
    }

    /// Returns the squared Mahalanobis distance eᵀ C⁻¹ e of an error e: χ² with two degrees of freedom if C
    /// is the covariance of normal errors.
    pub fn mahalanobis_squared(&self, [x, y]: [f64; 2]) -> f64 {
        let (x, y, rho) = (x / self.sigma_x, y / self.sigma_y, self.correlation);
        // A sum of squares stays non-negative under rounding, however close the correlation is to ±1.
        let of_x_beside_y = x - rho * y;
        of_x_beside_y * of_x_beside_y / ((1.0 - rho) * (1.0 + rho)) + y * y
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sigmas_and_matrix_are_one_covariance() {
        let covariance = Covariance2::from_matrix(4.0, 1.5, 9.0).unwrap();
        assert_eq!((covariance.sigma_x(), covariance.sigma_y(), covariance.correlation()), (2.0, 3.0, 0.25));
        assert_eq!(covariance.matrix(), [4.0, 1.5, 9.0]);
    }

    #[test]
    fn the_mahalanobis_distance_is_that_of_the_inverse_matrix() {
        // [[4, 1.5], [1.5, 9]]⁻¹ = [[9, −1.5], [−1.5, 4]] / 33.75; e = (1, 2): (9 − 6 + 16) / 33.75.
        let covariance = Covariance2::from_matrix(4.0, 1.5, 9.0).unwrap();
        assert!((covariance.mahalanobis_squared([1.0, 2.0]) - 19.0 / 33.75).abs() < 1e-15);
    }

    #[test]
    fn a_distance_is_never_negative_and_angles_change_their_unit() {
        let narrow = Covariance2::from_sigmas(1.0, 1.0, 1.0 - f64::EPSILON).unwrap();
        assert!(narrow.mahalanobis_squared([0.1 + 0.2, 0.3]) >= 0.0);
        let angles = Covariance2::from_degrees([180.0, 90.0, -0.5]).unwrap();
        assert_eq!(angles.matrix()[0], std::f64::consts::PI * std::f64::consts::PI);
        assert_eq!(angles.degrees(), [180.0, 90.0, -0.5]);
        assert_eq!(Covariance2::from_degrees([1.0, -1.0, 0.0]).unwrap_err().path, "sigma_y");
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_is_refused() {
        for (xx, xy, yy) in [
            (0.0, 0.0, 1.0),
            (1.0, 1.0, 1.0),
            (-1.0, 0.0, 1.0),
            (1.0, f64::NAN, 1.0),
            (f64::INFINITY, 0.0, 1.0),
        ] {
            assert!(Covariance2::from_matrix(xx, xy, yy).is_err(), "{xx} {xy} {yy}");
        }
        let refused =
            |sigma_x, sigma_y, rho| Covariance2::from_sigmas(sigma_x, sigma_y, rho).unwrap_err().path;
        assert_eq!(refused(0.0, 1.0, 0.0), "sigma_x");
        assert_eq!(refused(1.0, f64::NAN, 0.0), "sigma_y");
        assert_eq!(refused(1.0, 1.0, 1.0), "correlation");
    }
}
