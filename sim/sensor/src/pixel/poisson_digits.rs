//! Poisson random numbers of any mean from a small number of tables.

use super::alias::AliasTable;
use super::distribution::poisson_table;

/// Sampler of Poisson numbers of means from 0 to [`PoissonDigits::END_E`].
///
/// A mean is written in digits, λ = 4096 c + 64 b + a/4 + δ with integers a, b, c and 0 ≤ δ < ¼. Poisson(λ)
/// is the sum of independent Poisson numbers of these four means: three from tables, to the 2^-32 of their
/// words, the last by inversion. Tables are made on first use and do not depend on the detector: 333 at most,
/// 1.5 MB.
#[derive(Debug, Clone)]
pub(super) struct PoissonDigits {
    quarters: Vec<Option<AliasTable>>,
    sixty_fours: Vec<Option<AliasTable>>,
    four_thousands: Vec<Option<AliasTable>>,
}

impl Default for PoissonDigits {
    fn default() -> Self {
        Self { quarters: vec![None; 256], sixty_fours: vec![None; 64], four_thousands: vec![None; 16] }
    }
}

impl PoissonDigits {
    /// Mean from which on there are no tables, electrons: a number with its spread must fit 16 bits.
    pub(super) const END_E: f64 = 65_536.0;

    /// Draws a Poisson number of a mean from 0 to less than [`PoissonDigits::END_E`] from two uniform words.
    #[inline(always)]
    pub(super) fn draw(&mut self, mean_e: f64, words: [u64; 2]) -> u32 {
        let quarters = (mean_e * 4.0) as u32;
        let rest_e = mean_e - 0.25 * f64::from(quarters);
        let mut number = digit(&mut self.quarters, quarters % 256, 0.25, words[0] as u32);
        if quarters >= 256 {
            number += digit(&mut self.sixty_fours, quarters / 256 % 64, 64.0, words[1] as u32);
            number += digit(&mut self.four_thousands, quarters / 16_384, 4096.0, (words[1] >> 32) as u32);
        }
        number + small_poisson(rest_e, (words[0] >> 32) as u32) as u32
    }
}

/// Draws a Poisson number of mean `digit` · `unit_e`.
#[inline(always)]
fn digit(tables: &mut [Option<AliasTable>], digit: u32, unit_e: f64, word: u32) -> u32 {
    let Some(table) = tables.get_mut(digit as usize).filter(|_| digit > 0) else { return 0 };
    let table = table.get_or_insert_with(|| poisson_table(f64::from(digit) * unit_e));
    u32::from(table.draw(word))
}

/// Maximum number of electrons drawn from a mean of 4 or less: more than 24 have a probability of 1.4e-12,
/// far below the 2^-32 that a word resolves.
pub(super) const MAX_SMALL_E: usize = 24;

/// Draws a Poisson number of a mean of at most 4 from a uniform word: the smallest n with P(N ≤ n) ≥ u, at
/// most [`MAX_SMALL_E`].
#[inline(always)]
pub(super) fn small_poisson(mean: f64, word: u32) -> usize {
    let u = (f64::from(word) + 0.5) * (1.0 / 4_294_967_296.0);
    // Bounds from the Taylor series, whose terms alternate and decrease for means up to 1, are nearly always
    // sufficient for a small mean. They need no exponential and no branch between 0 and 1: exp(−s) lies
    // between 1 − s + s²/2 − s³/6 and 1 − s + s²/2, and (1 + s) exp(−s) ≥ 1 − s²/2.
    let half_square = 0.5 * mean * mean;
    let none_to = 1.0 - mean + half_square;
    let none_from = none_to - half_square * mean * (1.0 / 3.0);
    if (mean <= 1.0) & ((u <= none_from) | ((u > none_to) & (u <= 1.0 - half_square))) {
        usize::from(u > none_from)
    } else {
        by_inversion(mean, u)
    }
}

/// Draws the number of [`small_poisson`] where its bounds are not sufficient.
pub(super) fn by_inversion(mean: f64, u: f64) -> usize {
    let (mut n, mut left, mut probability) = (0, u, libm::exp(-mean));
    while left > probability && n < MAX_SMALL_E {
        left -= probability;
        n += 1;
        probability *= mean / n as f64;
    }
    n
}

#[cfg(test)]
mod tests {
    use super::super::distribution::tests::{chi_square_p, histogram};
    use super::*;
    use draws::{Effect, Seed};
    use rand::Rng;
    use statrs::distribution::{Discrete, Poisson};

    #[test]
    fn its_numbers_follow_the_probability_mass() {
        let mut digits = PoissonDigits::default();
        for (place, mean_e) in
            [0.0, 0.1, 0.25, 3.3, 20.0, 63.99, 64.1, 700.3, 4095.9, 4096.0, 12_345.6, 65_535.9]
                .into_iter()
                .enumerate()
        {
            let mut stream = Seed { seed: 32, case: 0 }.stream(0, Effect::PixelNoise, place as u64);
            let counts = histogram((0..300_000).map(|_| {
                let words = [stream.next_u64(), stream.next_u64()];
                digits.draw(mean_e, words) as usize
            }));
            if mean_e == 0.0 {
                assert_eq!(counts, [300_000]);
                continue;
            }
            let law = Poisson::new(mean_e).unwrap();
            let expected: Vec<f64> = (0..counts.len() + 100).map(|k| law.pmf(k as u64)).collect();
            let p = chi_square_p(&counts, &expected);
            assert!(p > 1e-4, "mean {mean_e}: p = {p}");
        }
    }

    #[test]
    fn the_bounds_save_exponentials_and_change_nothing() {
        for mean in [1e-9, 0.01, 0.24, 0.6, 1.0, 1.7, 4.0] {
            let poisson = Poisson::new(mean).unwrap();
            for i in 0..100_000_u32 {
                let word = i * 42_949;
                let u = (f64::from(word) + 0.5) / 4_294_967_296.0;
                let (mut n, mut up_to) = (0, poisson.pmf(0));
                while u > up_to {
                    n += 1;
                    up_to += poisson.pmf(n);
                }
                assert_eq!(small_poisson(mean, word) as u64, n, "{mean}, {u}");
            }
        }
        assert_eq!((small_poisson(0.0, 0), small_poisson(0.0, u32::MAX)), (0, 0));
        assert!(small_poisson(4.0, u32::MAX) <= MAX_SMALL_E);
    }
}
