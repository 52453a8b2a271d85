//! Poisson random numbers based on `libm`, so they are equal on every machine.

use draws::{Stream, uniform};

/// Mean at which the method changes: PTRS needs a mean of 10 or more.
const INVERSION_BELOW: f64 = 10.0;

/// Draws a Poisson number of a mean from 0 to 1e15, as a float with an integer value.
///
/// Below a mean of 10 by sequential inversion of one uniform random number of 53 bits; from 10 on by
/// transformed rejection with squeeze, PTRS (Hörmann, "The transformed rejection method for generating
/// Poisson random variables", Insurance: Mathematics and Economics 12, 1993).
pub fn poisson(mean: f64, stream: &mut Stream) -> f64 {
    if mean < INVERSION_BELOW { by_inversion(mean, uniform(stream)) } else { by_rejection(mean, stream) }
}

/// Returns the smallest k with P(N ≤ k) ≥ u.
fn by_inversion(mean: f64, u: f64) -> f64 {
    // At a mean of 10, numbers above 100 have a probability of 5e-64: only rounding could lead there.
    const LAST: f64 = 100.0;
    let (mut k, mut left, mut probability) = (0.0, u, libm::exp(-mean));
    while left > probability && k < LAST {
        left -= probability;
        k += 1.0;
        probability *= mean / k;
    }
    k
}

/// Algorithm PTRS; the constants and their names are those of the paper.
fn by_rejection(mean: f64, stream: &mut Stream) -> f64 {
    let b = 0.931 + 2.53 * mean.sqrt();
    let a = -0.059 + 0.02483 * b;
    let v_r = 0.9277 - 3.6224 / (b - 2.0);
    let (mut ln_mean, mut ln_inverse_alpha) = (None, None);
    loop {
        let v = uniform(stream);
        let u = uniform(stream) - 0.5;
        let us = 0.5 - u.abs();
        let k = ((2.0 * a / us + b) * u + mean + 0.43).floor();
        if us >= 0.07 && v <= v_r {
            return k;
        }
        if k < 0.0 || (us < 0.013 && v > us) {
            continue;
        }
        // Only one number in ten needs this.
        let ln_mean = *ln_mean.get_or_insert_with(|| libm::log(mean));
        let ln_inverse_alpha =
            *ln_inverse_alpha.get_or_insert_with(|| libm::log(1.1239 + 1.1328 / (b - 3.4)));
        let ln_accepted = libm::log(v) + ln_inverse_alpha - libm::log(a / (us * us) + b);
        if ln_accepted <= k * ln_mean - mean - libm::lgamma(k + 1.0) {
            return k;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pixel::distribution::tests::{chi_square_p, histogram};
    use draws::{Effect, Seed};
    use statrs::distribution::{Discrete, Poisson};

    fn stream(index: u64) -> Stream {
        Seed { seed: 11, case: 0 }.stream(0, Effect::PixelNoise, index)
    }

    #[test]
    fn its_numbers_follow_the_probability_mass() {
        let n = 200_000;
        for (index, mean) in [0.1, 1.0, 4.0, 9.99, 10.0, 30.0, 200.0, 5000.0].into_iter().enumerate() {
            let mut stream = stream(index as u64);
            let counts = histogram((0..n).map(|_| poisson(mean, &mut stream) as usize));
            let law = Poisson::new(mean).unwrap();
            let expected: Vec<f64> = (0..counts.len() + 100).map(|k| law.pmf(k as u64)).collect();
            let p = chi_square_p(&counts, &expected);
            // Eight tests: one in 10,000 random seeds would fail by chance, but the seed is fixed.
            assert!(p > 1e-5, "mean {mean}: p = {p}");
        }
    }

    /// Compares the histogram with that of an independent implementation, number by number.
    #[test]
    fn its_numbers_are_like_those_of_rand_distr() {
        use rand_distr::Distribution;
        let n = 200_000;
        for (index, mean) in [0.5, 7.0, 15.0, 400.0].into_iter().enumerate() {
            let (mut own, mut other) = (stream(100 + index as u64), stream(200 + index as u64));
            let witness = rand_distr::Poisson::new(mean).unwrap();
            let ours = histogram((0..n).map(|_| poisson(mean, &mut own) as usize));
            let theirs = histogram((0..n).map(|_| {
                let number: f64 = witness.sample(&mut other);
                number as usize
            }));
            // Two samples of equal size: Σ (a − b)²/(a + b) over bins of 20 or more.
            let (mut chi2, mut bins, mut a, mut b) = (0.0, 0.0, 0.0, 0.0);
            for k in 0..ours.len().max(theirs.len()) {
                a += ours.get(k).copied().unwrap_or(0) as f64;
                b += theirs.get(k).copied().unwrap_or(0) as f64;
                if a + b >= 20.0 {
                    chi2 += (a - b) * (a - b) / (a + b);
                    bins += 1.0;
                    (a, b) = (0.0, 0.0);
                }
            }
            let p = crate::pixel::distribution::tests::chi_square_tail(chi2, bins - 1.0);
            assert!(p > 1e-5, "mean {mean}: p = {p}");
        }
    }

    #[test]
    fn a_huge_mean_has_its_mean_and_its_variance() {
        let (mean, n) = (1e9, 20_000);
        let mut stream = stream(300);
        let z: Vec<f64> = (0..n).map(|_| (poisson(mean, &mut stream) - mean) / mean.sqrt()).collect();
        let average = z.iter().sum::<f64>() / n as f64;
        let variance = z.iter().map(|z| z * z).sum::<f64>() / n as f64;
        // Standard errors 1/sqrt(n) = 0.007 and sqrt(2/n) = 0.01; the tolerance is four of them.
        assert!(average.abs() < 0.028 && (variance - 1.0).abs() < 0.04, "{average}, {variance}");
    }

    #[test]
    fn zero_flux_gives_no_electrons() {
        assert_eq!(poisson(0.0, &mut stream(0)), 0.0);
    }
}
