//! Rounding of the converter, taken out of measured variances.
//!
//! Above 0.7 DN of noise the rounding adds 1/12 DN² (Sheppard; EMVA 1288, quantisation noise). Below, the
//! added variance depends on the fraction of a digital number at which the level lies. The model here is a
//! level that varies between pixels by a normal distribution and noise that is normal, both rounded: mean and
//! variance of all pixels give the level and the sum of both variances, the temporal variance divides it.

use libm::{erfc, exp, sqrt};

/// Variance of the rounding where the noise is larger than a digital number, DN².
pub(crate) const ROUNDING_VARIANCE: f64 = 1.0 / 12.0;

/// Temporal variance above which the rounding adds 1/12 to 1e-4, DN².
const SMOOTH_VARIANCE: f64 = 0.6;

/// Number of levels in the distribution of pixels, and their largest distance in standard deviations.
const LEVELS: usize = 61;
const LEVEL_SIGMAS: f64 = 4.5;

/// Steps of a bisection.
const STEPS: usize = 60;

/// Share of the rounded normal distribution below the upper edge of a code.
fn below(edge: f64, mean: f64, sigma: f64) -> f64 {
    0.5 * erfc((mean - edge) / (sigma * std::f64::consts::SQRT_2))
}

/// Mean and variance of a normal distribution after rounding to integers.
pub(crate) fn rounded_moments(mean: f64, sigma: f64) -> (f64, f64) {
    let sigma = sigma.max(1e-9);
    let reach = (8.5 * sigma).ceil() + 1.0;
    let centre = mean.round();
    let (mut first, mut second) = (0.0, 0.0);
    let mut code = -reach;
    let mut lower = below(centre + code - 0.5, mean, sigma);
    while code <= reach {
        let upper = below(centre + code + 0.5, mean, sigma);
        let share = upper - lower;
        first += share * code;
        second += share * code * code;
        lower = upper;
        code += 1.0;
    }
    (centre + first, second - first * first)
}

/// Mean over the pixels of the variance after rounding, for noise `sigma` and levels of standard deviation
/// `spread`.
fn mean_rounded_variance(mean: f64, sigma: f64, spread: f64) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for level in 0..LEVELS {
        let z = LEVEL_SIGMAS * (2.0 * level as f64 / (LEVELS - 1) as f64 - 1.0);
        let weight = exp(-0.5 * z * z);
        sum += weight * rounded_moments(mean + spread * z, sigma).1;
        weights += weight;
    }
    sum / weights
}

/// Root of a rising function between two limits, by bisection.
fn bisect(mut low: f64, mut high: f64, rises_above: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if rises_above(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

/// Level and noise of a normal distribution whose rounded numbers have the given mean and variance.
fn level_and_noise(mean: f64, variance: f64) -> (f64, f64) {
    let level_at =
        |sigma: f64| bisect(mean - 0.75, mean + 0.75, |level| rounded_moments(level, sigma).0 > mean);
    let sigma =
        bisect(1e-4, 1.0 + sqrt(variance), |sigma| rounded_moments(level_at(sigma), sigma).1 > variance);
    (level_at(sigma), sigma)
}

/// Measured moments of a stack in which the rounding matters, DN and DN².
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RoundedNoise {
    /// Mean of all pixels, and its standard deviation.
    pub(crate) mean: [f64; 2],
    /// Temporal variance, mean of the pixels, and its standard deviation.
    pub(crate) temporal: [f64; 2],
    /// Variance of the pixels of one frame, temporal and spatial, and its standard deviation.
    pub(crate) total: [f64; 2],
}

/// Returns the temporal variance before the rounding with its standard deviation, DN²; `None` if the numbers
/// do not determine it, because the noise is far below a digital number.
pub(crate) fn unrounded_variance(noise: &RoundedNoise) -> Option<[f64; 2]> {
    let [temporal, sigma] = noise.temporal;
    if temporal > SMOOTH_VARIANCE {
        return Some([temporal - ROUNDING_VARIANCE, sigma]);
    }
    let solve = |mean: f64, temporal: f64, total: f64| {
        let (level, both) = level_and_noise(mean, total.max(temporal));
        let spread_of = |sigma: f64| sqrt((both * both - sigma * sigma).max(0.0));
        let sigma =
            bisect(1e-4, both, |sigma| mean_rounded_variance(level, sigma, spread_of(sigma)) > temporal);
        sigma * sigma
    };
    let value = solve(noise.mean[0], temporal, noise.total[0]);
    // Partial derivatives times the errors of the three measured moments.
    let parts = [
        solve(noise.mean[0] + noise.mean[1], temporal, noise.total[0]) - value,
        solve(noise.mean[0], temporal + sigma, noise.total[0]) - value,
        solve(noise.mean[0], temporal, noise.total[0] + noise.total[1]) - value,
        // In a frame without fixed pattern the two variances are one number and move together.
        solve(noise.mean[0], temporal + sigma, noise.total[0] + noise.total[1]) - value,
    ];
    let error = sqrt(parts.iter().map(|part| part * part).sum());
    (temporal > 0.0 && error.is_finite() && error < value).then_some([value, error.max(sigma)])
}

/// Standard deviation of the error of a mean by the rounding, DN: the first harmonic, for a level at an
/// unknown fraction of a digital number and numbers with the given variance.
pub(crate) fn rounding_of_mean(mean: f64, variance: f64) -> f64 {
    let pi = std::f64::consts::PI;
    let before = if variance > SMOOTH_VARIANCE {
        variance - ROUNDING_VARIANCE
    } else {
        let (_, sigma) = level_and_noise(mean, variance);
        sigma * sigma
    };
    exp(-2.0 * pi * pi * before) / (pi * std::f64::consts::SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_noise_gains_a_twelfth_and_narrow_noise_stays_on_one_code() {
        for level in [10.0, 10.3, 10.5] {
            let (mean, variance) = rounded_moments(level, 1.5);
            assert!((mean - level).abs() < 1e-9 && (variance - 2.25 - 1.0 / 12.0).abs() < 1e-9);
        }
        let (mean, variance) = rounded_moments(10.2, 0.01);
        assert!((mean - 10.0).abs() < 1e-12 && variance.abs() < 1e-12, "{mean} {variance}");
        let (mean, variance) = rounded_moments(10.5, 0.01);
        assert!((mean - 10.5).abs() < 1e-9 && (variance - 0.25).abs() < 1e-9);
    }

    #[test]
    fn narrow_noise_is_recovered_at_every_fraction_of_a_number() {
        for level in [100.0, 100.2, 100.37, 100.5] {
            for (sigma, spread) in [(0.35, 0.2), (0.45, 0.0), (0.3, 0.4), (0.6, 0.1)] {
                let both = sqrt(sigma * sigma + spread * spread);
                let (mean, total) = rounded_moments(level, both);
                let temporal = mean_rounded_variance(level, sigma, spread);
                let noise =
                    RoundedNoise { mean: [mean, 1e-5], temporal: [temporal, 1e-5], total: [total, 1e-5] };
                let [found, error] = unrounded_variance(&noise).unwrap();
                let off = (found - sigma * sigma).abs();
                assert!(off < 1e-3, "{level} {sigma} {spread}: {found}, {error}");
            }
        }
    }

    #[test]
    fn noise_on_two_codes_alone_is_not_determined() {
        let (mean, total) = rounded_moments(100.45, 0.03);
        let error = 1e-3;
        let noise = RoundedNoise { mean: [mean, error], temporal: [total, error], total: [total, error] };
        assert_eq!(unrounded_variance(&noise), None);
        let still = RoundedNoise { mean: [100.0, 1e-6], temporal: [0.0, 1e-6], total: [0.0, 1e-6] };
        assert_eq!(unrounded_variance(&still), None);
    }
}
