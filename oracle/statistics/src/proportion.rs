//! Interval of a rate.

use super::{Interval, Z_95};

/// Computes the score interval of Wilson (1927) for a rate observed over `n` independent trials:
///
/// (p + z²/2n ± z √(p(1−p)/n + z²/4n²)) / (1 + z²/n).
///
/// `n` may be an effective size and need not be an integer. The limits lie in [0, 1] for every input with
/// `rate` in [0, 1] and `n` > 0; a rate of 0 has the lower limit 0 and a rate of 1 the upper limit 1. `None`
/// when `n` is not positive, since there is no observation.
pub fn wilson(rate: f64, n: f64) -> Option<Interval> {
    // Tests for valid input and negates the result, which also excludes NaN.
    if !(n > 0.0 && (0.0..=1.0).contains(&rate)) {
        return None;
    }
    let z2 = Z_95 * Z_95;
    let scale = 1.0 / (1.0 + z2 / n);
    let centre = scale * (rate + z2 / (2.0 * n));
    let half = scale * Z_95 * (rate * (1.0 - rate) / n + z2 / (4.0 * n * n)).sqrt();
    Some(Interval {
        // Exact at the ends, where the difference of two equal numbers would leave a rounding error.
        low: if rate == 0.0 { 0.0 } else { (centre - half).max(0.0) },
        high: if rate == 1.0 { 1.0 } else { (centre + half).min(1.0) },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(count: u32, n: u32, low: f64, high: f64, tolerance: f64) {
        let got = wilson(f64::from(count) / f64::from(n), f64::from(n)).unwrap();
        assert!(
            (got.low - low).abs() <= tolerance && (got.high - high).abs() <= tolerance,
            "{count}/{n}: {got:?}, expected {low} to {high}"
        );
    }

    /// Newcombe (1998), Statistics in Medicine 17, 857–872, Table I, method 3; printed with four decimals.
    #[test]
    fn wilson_gives_the_published_intervals() {
        check(81, 263, 0.2553, 0.3662, 5e-5);
        check(15, 148, 0.0624, 0.1605, 5e-5);
        check(0, 20, 0.0, 0.1611, 5e-5);
        check(1, 29, 0.0061, 0.1718, 5e-5);
    }

    /// scipy 1.17.1: `scipy.stats.binomtest(k, n).proportion_ci(0.95, 'wilson')`. The tolerance covers the
    /// rounding of about a dozen operations on numbers up to 1, here and in scipy.
    #[test]
    fn wilson_agrees_with_scipy() {
        check(0, 1, 0.0, 0.793_450_685_622_762_6, 1e-14);
        check(1, 1, 0.206_549_314_377_237_45, 1.0, 1e-14);
        check(0, 10, 0.0, 0.277_532_799_862_889_26, 1e-14);
        check(10, 10, 0.722_467_200_137_110_7, 1.0, 1e-14);
        check(5, 10, 0.236_593_090_512_564, 0.763_406_909_487_436_1, 1e-14);
        check(15_089, 16_077, 0.934_727_599_240_987_5, 0.942_154_374_635_155_2, 1e-14);
        check(7, 1_000_000, 3.390_867_834_900_854_3e-6, 1.445_052_244_882_719e-5, 1e-14);
    }

    #[test]
    fn nothing_observed_has_no_interval() {
        assert_eq!(wilson(0.0, 0.0), None);
        assert_eq!(wilson(f64::NAN, 10.0), None);
        assert_eq!(wilson(0.5, f64::NAN), None);
    }
}
