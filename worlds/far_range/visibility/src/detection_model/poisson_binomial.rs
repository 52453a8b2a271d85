//! Number of successes among independent events with different probabilities: the Poisson-binomial
//! distribution.

/// Returns P(N ≥ `n_min`), exact: the distribution of N, truncated at `n_min`, updated event by event (Chen &
/// Liu 1997, Statistica Sinica 7, 875, Sec. 2, the direct recursion). `distribution` is a reusable buffer.
pub fn at_least(
    n_min: usize,
    probabilities: impl IntoIterator<Item = f64>,
    distribution: &mut Vec<f64>,
) -> f64 {
    distribution.clear();
    distribution.resize(n_min, 0.0);
    let Some(none) = distribution.first_mut() else { return 1.0 };
    *none = 1.0;
    // Upper limit of the number of successes so far.
    let mut seen = 0;
    for p in probabilities {
        seen = (seen + 1).min(n_min - 1);
        for n in (1..=seen).rev() {
            distribution[n] = distribution[n] * (1.0 - p) + distribution[n - 1] * p;
        }
        distribution[0] *= 1.0 - p;
    }
    (1.0 - distribution.iter().sum::<f64>()).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chance(n_min: usize, probabilities: &[f64]) -> f64 {
        at_least(n_min, probabilities.iter().copied(), &mut Vec::new())
    }

    /// Equal probabilities: the binomial distribution. 1 − Σ_{k<n} C(20, k) 0.3^k 0.7^(20 − k), summed in
    /// rational numbers (Python's `fractions`).
    #[test]
    fn equal_probabilities_give_the_binomial_distribution() {
        for (n_min, expected) in
            [(1, 0.999_202_077_337_023_9), (5, 0.762_492_221_122_398_3), (10, 0.047_961_897_331_343_48)]
        {
            assert!((chance(n_min, &[0.3; 20]) - expected).abs() < 1e-14, "{n_min}");
        }
    }

    /// Closed forms for two and three events.
    #[test]
    fn few_events_are_as_written_out() {
        let (a, b, c) = (0.1, 0.6, 0.85);
        assert!((chance(1, &[a, b]) - (a + b - a * b)).abs() < 1e-15);
        assert!((chance(2, &[a, b, c]) - (a * b + a * c + b * c - 2.0 * a * b * c)).abs() < 1e-15);
        assert!((chance(3, &[a, b, c]) - a * b * c).abs() < 1e-15);
    }

    #[test]
    fn certain_and_impossible_events_count_as_such() {
        assert_eq!(chance(0, &[]), 1.0);
        assert_eq!(chance(1, &[]), 0.0);
        assert_eq!(chance(3, &[1.0, 0.0, 1.0, 0.0, 1.0]), 1.0);
        assert_eq!(chance(4, &[1.0, 0.0, 1.0, 0.0, 1.0]), 0.0);
    }

    #[test]
    fn the_order_of_events_does_not_matter() {
        let ps: Vec<f64> = (0..40).map(|i| f64::from(i) / 40.0).collect();
        let turned: Vec<f64> = ps.iter().rev().copied().collect();
        for n_min in [1, 15, 20, 25, 40] {
            assert!((chance(n_min, &ps) - chance(n_min, &turned)).abs() < 1e-14);
        }
    }
}
