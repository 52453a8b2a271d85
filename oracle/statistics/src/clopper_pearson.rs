//! Exact one-sided bounds of a rate.

/// Returns the one-sided bounds of Clopper & Pearson (1934, Biometrika 26, 404) of a rate observed as `count`
/// of `n` independent trials: the rates at which `count` or more, and `count` or fewer, have the probability
/// 1 − `confidence`. (0, 1) without any trial.
pub fn clopper_pearson(count: u64, n: u64, confidence: f64) -> (f64, f64) {
    if n == 0 {
        return (0.0, 1.0);
    }
    let miss = 1.0 - confidence;
    let low = if count == 0 { 0.0 } else { root(|p| binomial_at_least(count, n, p) - miss) };
    let high = if count >= n { 1.0 } else { root(|p| miss - (1.0 - binomial_at_least(count + 1, n, p))) };
    (low, high)
}

/// Returns P(K ≥ `count`) for `n` independent trials of probability `p`.
pub fn binomial_at_least(count: u64, n: u64, p: f64) -> f64 {
    if count == 0 {
        return 1.0;
    }
    if p <= 0.0 || count > n {
        return 0.0;
    }
    if p >= 1.0 {
        return 1.0;
    }
    let trials = n as f64;
    let (ln_p, ln_q) = (libm::log(p), libm::log1p(-p));
    let term = |k: u64| {
        let k = k as f64;
        let ln_ways = libm::lgamma(trials + 1.0) - libm::lgamma(k + 1.0) - libm::lgamma(trials - k + 1.0);
        libm::exp(ln_ways + k * ln_p + (trials - k) * ln_q)
    };
    // The shorter tail has fewer terms and loses fewer digits.
    if count as f64 > trials * p {
        (count..=n).map(term).sum::<f64>().min(1.0)
    } else {
        (1.0 - (0..count).map(term).sum::<f64>()).max(0.0)
    }
}

/// Finds the root of an increasing function on [0, 1].
fn root(f: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// scipy 1.17: beta.ppf(0.05, k, n − k + 1) and beta.ppf(0.95, k + 1, n − k).
    #[test]
    fn the_bounds_agree_with_the_quantiles_of_beta() {
        for (count, n, low, high) in SCIPY {
            let got = clopper_pearson(count, n, 0.95);
            assert!((got.0 - low).abs() < 1e-10 && (got.1 - high).abs() < 1e-10, "{count}/{n}: {got:?}");
        }
    }

    const SCIPY: [(u64, u64, f64, f64); 4] = [
        (1, 20, 0.002_561_378_776_530_280_6, 0.216_106_164_206_847_3),
        (93, 100, 0.872_541_984_417_029_7, 0.966_688_084_382_368),
        (279, 300, 0.900_760_739_009_910_7, 0.952_617_729_530_771_1),
        (0, 50, 0.0, 0.058_155_079_116_972_25),
    ];

    #[test]
    fn zero_trials_have_the_widest_interval() {
        assert_eq!(clopper_pearson(0, 0, 0.95), (0.0, 1.0));
    }

    /// The lower bound of 100 successes in 100 trials is 0.05^(1/100).
    #[test]
    fn all_of_a_hundred_have_their_closed_form() {
        let (low, high) = clopper_pearson(100, 100, 0.95);
        assert!((low - libm::pow(0.05, 0.01)).abs() < 1e-12 && high == 1.0);
    }

    /// scipy: binom.sf(count − 1, n, p), on either side of the mean.
    #[test]
    fn tails_agree_with_the_binomial_distribution() {
        for (count, n, p, expected) in [
            (3, 10, 0.2, 0.322_200_473_6),
            (8, 10, 0.7, 0.382_782_786_4),
            (1, 5, 0.01, 0.049_009_950_1),
            (60, 100, 0.5, 0.028_443_966_820_490_4),
        ] {
            let tail = binomial_at_least(count, n, p);
            assert!((tail - expected).abs() < 1e-12, "{count} of {n} at {p}: {tail}");
        }
    }

    /// Computed as 1 minus the other tail, this probability would be rounding error only. scipy: binom.sf(59,
    /// 100, 0.2).
    #[test]
    fn a_small_tail_keeps_its_digits() {
        assert!((binomial_at_least(60, 100, 0.2) / 2.515819199533466e-18 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn impossible_and_certain_outcomes_have_no_tail() {
        assert_eq!(binomial_at_least(0, 10, 0.0), 1.0);
        assert_eq!(binomial_at_least(1, 10, 0.0), 0.0);
        assert_eq!(binomial_at_least(11, 10, 0.5), 0.0);
        assert_eq!(binomial_at_least(11, 10, 1.0), 0.0);
        assert_eq!(binomial_at_least(10, 10, 1.0), 1.0);
    }
}
