//! Consistency of errors with their covariances.

use nalgebra::{SMatrix, SVector};

/// Smallest pivot of a correlation matrix that is distinguished from rounding. Lateral position and attitude
/// of a pose are correlated to 1 − 1e-6 at most (a direction known to 0.1 px, a tilt to a degree); rounding
/// is at 1e-16.
const MIN_PIVOT: f64 = 1e-10;

/// Upper limit of NEES: a larger value counts as this one.
const MAX_NEES: f64 = 1e12;

/// Returns the normalised estimation error squared, eᵀ P⁻¹ e / N: 1 in the mean for a correct covariance P (N
/// times this value follows a χ² distribution with N degrees of freedom). At most 1e12. Returns `None` if P
/// is not positive definite and thus contains no information.
pub fn nees<const N: usize>(error: &SVector<f64, N>, covariance: &SMatrix<f64, N, N>) -> Option<f64> {
    // The matrix is scaled to unit diagonal, so that metres and radians are comparable, then factored as L Lᵀ
    // and solved forwards row by row.
    let mut sigma = [0.0; N];
    for (i, sigma) in sigma.iter_mut().enumerate() {
        *sigma = covariance[(i, i)].sqrt();
        // The condition is negated, so that a NaN also returns `None`.
        if !(*sigma > 0.0 && sigma.is_finite()) {
            return None;
        }
    }
    let mut lower = SMatrix::<f64, N, N>::zeros();
    let mut solved = [0.0; N];
    let mut sum = 0.0;
    for i in 0..N {
        for j in 0..i {
            let mut value = covariance[(i, j)] / (sigma[i] * sigma[j]);
            for k in 0..j {
                value -= lower[(i, k)] * lower[(j, k)];
            }
            lower[(i, j)] = value / lower[(j, j)];
        }
        let mut pivot = 1.0;
        let mut rest = error[i] / sigma[i];
        for k in 0..i {
            pivot -= lower[(i, k)] * lower[(i, k)];
            rest -= lower[(i, k)] * solved[k];
        }
        if pivot.is_nan() || pivot <= MIN_PIVOT {
            return None;
        }
        lower[(i, i)] = pivot.sqrt();
        solved[i] = rest / lower[(i, i)];
        sum += solved[i] * solved[i];
    }
    // Extreme errors are counted, and the mean remains finite.
    if sum.is_nan() { None } else { Some((sum / N as f64).min(MAX_NEES)) }
}

/// Fraction of normally distributed errors within three standard deviations.
pub const WITHIN_3_SIGMA: f64 = 0.9973;

/// Returns true if an error is at most three standard deviations; `None` for a standard deviation that is not
/// positive and finite and thus contains no information.
pub fn within_3_sigma(error: f64, sigma: f64) -> Option<bool> {
    (sigma > 0.0 && sigma.is_finite()).then(|| error.abs() <= 3.0 * sigma)
}

#[cfg(test)]
mod tests {
    use draws::{Effect, Seed, normal};
    use nalgebra::{Matrix1, Matrix2, Matrix3, Matrix6, Vector1, Vector2, Vector3, Vector6};

    use super::*;

    #[test]
    fn a_diagonal_covariance_gives_the_mean_square_of_errors_over_sigma() {
        let error = Vector2::new(3.0, -0.1);
        let value = nees(&error, &Matrix2::new(4.0, 0.0, 0.0, 0.01)).unwrap();
        assert!((value - (2.25 + 1.0) / 2.0).abs() < 1e-15);
    }

    /// Computed in fractions: eᵀ P⁻¹ e = 1473/479.
    #[test]
    fn three_correlated_errors_count_as_worked_out_in_fractions() {
        let covariance = Matrix3::new(4.0, 2.0, 1.0, 2.0, 9.0, 3.0, 1.0, 3.0, 16.0);
        let value = nees(&Vector3::new(1.0, -2.0, 5.0), &covariance).unwrap();
        assert!((value - 1473.0 / 479.0 / 3.0).abs() < 1e-14, "{value}");
    }

    #[test]
    fn errors_that_are_exactly_correlated_have_no_consistency() {
        assert_eq!(nees(&Vector2::new(1.0, -1.0), &Matrix2::new(1.0, 1.0, 1.0, 1.0)), None);
        assert_eq!(nees(&Vector2::new(1.0, 1.0), &Matrix2::new(0.0, 0.0, 0.0, 1.0)), None);
        assert_eq!(nees(&Vector1::new(1.0), &Matrix1::new(0.0)), None);
        assert_eq!(nees(&Vector2::new(1.0, 1.0), &Matrix2::new(1.0, f64::NAN, f64::NAN, 1.0)), None);
    }

    /// Closed form for the correlation c: (x² − 2 c x y + y²)/(1 − c²)/2.
    #[test]
    fn the_effective_number_under_correlation_follows_its_closed_form() {
        let (c, x, y) = (0.9, 1.5, -0.5);
        let value = nees(&Vector2::new(2.0 * x, y), &Matrix2::new(4.0, 2.0 * c, 2.0 * c, 1.0)).unwrap();
        assert!((value - (x * x - 2.0 * c * x * y + y * y) / (1.0 - c * c) / 2.0).abs() < 1e-13);
    }

    #[test]
    fn an_invalid_covariance_has_no_consistency() {
        let error = Vector2::new(1.0, 1.0);
        for covariance in [
            Matrix2::zeros(),
            Matrix2::new(1.0, 1.0, 1.0, 1.0),
            Matrix2::new(1.0, 2.0, 2.0, 1.0),
            Matrix2::new(1.0, 0.0, 0.0, -1.0),
            Matrix2::new(1.0, f64::NAN, f64::NAN, 1.0),
            Matrix2::new(f64::INFINITY, 0.0, 0.0, 1.0),
        ] {
            assert_eq!(nees(&error, &covariance), None, "{covariance}");
        }
        let absurd = Matrix2::from_diagonal_element(1e-300);
        assert_eq!(nees(&error, &absurd), Some(MAX_NEES), "sure beyond all reason");
        assert_eq!(within_3_sigma(0.0, 0.0), None);
        assert_eq!(within_3_sigma(1.0, f64::NAN), None);
    }

    /// Errors are drawn from the distribution that the covariance states.
    #[test]
    fn errors_that_follow_their_covariance_have_a_mean_nees_of_one() {
        let root = Matrix6::from_fn(|i, j| match i.cmp(&j) {
            std::cmp::Ordering::Less => 0.0,
            std::cmp::Ordering::Equal => 0.1 + i as f64,
            std::cmp::Ordering::Greater => 0.7,
        });
        let covariance = root * root.transpose();
        let random = &mut Seed { seed: 2004, case: 0 }.stream(0, Effect::PixelNoise, 0);
        let trials = 20_000;
        let (mut sum, mut within) = (0.0, 0);
        for _ in 0..trials {
            let error = root * Vector6::from_fn(|_, _| normal(random));
            sum += nees(&error, &covariance).unwrap();
            within += usize::from(within_3_sigma(error[5], covariance[(5, 5)].sqrt()).unwrap());
        }
        // χ² with 6 degrees of freedom over 6 has a standard deviation of √(2/6), the mean of 20,000 values
        // one of 0.4 %.
        assert!((sum / trials as f64 - 1.0).abs() < 0.02, "{}", sum / trials as f64);
        // 99.73 %, with a standard deviation of 0.04 %.
        assert!((within as f64 / trials as f64 - 0.9973).abs() < 0.002, "{within}");
    }
}
