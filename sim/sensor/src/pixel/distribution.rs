//! Distribution of one pixel: from its expected electrons to its digital number.
//!
//! Collected electrons are Poisson distributed and limited to the full well; the read noise is normal; the
//! converter rounds and clips. The distribution is implemented twice: as the probability of every digital
//! number, and in steps ([`DirectSampler`](super::direct_sampler::DirectSampler)).

use truth::Switch;

use super::alias::AliasTable;
use crate::config::SensorConfig;

/// Parameters of a pixel's distribution other than its mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PixelDistribution {
    gain_e_per_dn: f64,
    bias_dn: f64,
    full_well_e: f64,
    read_noise_e: f64,
    non_linearity: f64,
    pub(crate) shot: Switch,
    full_scale_dn: u16,
}

/// Probability of each digital number from `first_dn` on.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DnDistribution {
    pub(crate) first_dn: u16,
    pub(crate) probabilities: Vec<f64>,
}

/// Standard deviations at which a normal distribution is truncated: 6e-14 of it lies beyond, less than 2^-43.
const NORMAL_REACH: f64 = 7.5;

impl PixelDistribution {
    pub(crate) fn new(config: &SensorConfig) -> Self {
        Self {
            gain_e_per_dn: config.gain_e_per_dn,
            bias_dn: config.bias_dn,
            full_well_e: config.full_well_e,
            read_noise_e: config.noise.read.apply(config.read_noise_e),
            non_linearity: config.non_linearity,
            shot: config.noise.shot,
            full_scale_dn: config.full_scale_dn(),
        }
    }

    /// Returns the digital number for the electrons that a pixel collected, limited to the full well, with
    /// `normal` standard deviations of read noise.
    #[inline(always)]
    pub(crate) fn read(&self, collected_e: f64, normal: f64, offset_e: f64) -> u16 {
        let held_e = self.amplified(collected_e.min(self.full_well_e));
        self.digitise(held_e + self.read_noise_e * normal + offset_e)
    }

    /// Equivalent electrons at the input of a linear amplifier: e (1 − β e/full well).
    #[inline(always)]
    fn amplified(&self, held_e: f64) -> f64 {
        if self.non_linearity == 0.0 {
            return held_e;
        }
        held_e * (1.0 - self.non_linearity * held_e / self.full_well_e)
    }

    /// Full well of a pixel, electrons.
    pub(crate) fn full_well_e(&self) -> f64 {
        self.full_well_e
    }

    /// Mean from which on a pixel may collect more than its full well; below it the probability is less than
    /// 2^-40 (the bound of [`PoissonReach`], solved for the mean).
    pub(crate) fn may_overflow_from_e(&self) -> f64 {
        match self.shot {
            Switch::On => {
                let shift = 2.0 * PoissonReach::EXPONENT / 3.0;
                let root = (3.0 * shift * self.full_well_e + shift * shift).sqrt();
                (self.full_well_e + shift - root).max(0.0)
            }
            Switch::Off => self.full_well_e,
        }
    }

    /// Converts electrons to a digital number: floor(e/gain + bias + ½), clipped.
    #[inline(always)]
    fn digitise(&self, electrons: f64) -> u16 {
        let dn = electrons / self.gain_e_per_dn + self.bias_dn + 0.5;
        // Above 0 the conversion equals the floor.
        dn.clamp(0.0, f64::from(self.full_scale_dn)) as u16
    }

    /// Number of digital numbers that the distribution of a mean covers, without clipping.
    pub(crate) fn width_dn(&self, mean_e: f64) -> f64 {
        let reach = PoissonReach::new(mean_e);
        (reach.high - reach.low + 2.0 * NORMAL_REACH * self.read_noise_e) / self.gain_e_per_dn
    }

    /// Returns the probability of every digital number if a Poisson number of mean `mean_e` plus `extra_e`
    /// fixed electrons is collected. The absolute error of a probability is below 2^-40.
    pub(crate) fn probabilities(&self, mean_e: f64, extra_e: u32) -> DnDistribution {
        let extra_e = f64::from(extra_e);
        let reach = PoissonReach::new(mean_e);
        let linear = self.non_linearity == 0.0;
        let smooth = linear && self.read_noise_e >= 1.0 && reach.high + extra_e < self.full_well_e;
        match self.shot {
            Switch::On if smooth => self.by_characteristic_function(mean_e, extra_e, reach),
            Switch::On => self.by_sum(&poisson_atoms(mean_e, reach), extra_e),
            Switch::Off => self.by_sum(&[(mean_e, 1.0)], extra_e),
        }
    }

    /// Sums directly over numbers of electrons (value, probability): each gives a normal distribution divided
    /// into digital numbers.
    fn by_sum(&self, atoms: &[(f64, f64)], extra_e: f64) -> DnDistribution {
        let collected = |value: f64| self.amplified((value + extra_e).min(self.full_well_e));
        let reach_e = NORMAL_REACH * self.read_noise_e;
        let ends = |ends: (f64, f64)| (self.digitise(ends.0 - reach_e), self.digitise(ends.1 + reach_e));
        let values = || atoms.iter().map(|&(value, _)| collected(value));
        let (first_dn, last_dn) =
            ends((values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)));
        let mut probabilities = vec![0.0; usize::from(last_dn - first_dn) + 1];
        for &(value, probability) in atoms {
            let value = collected(value);
            let (low, high) = ends((value, value));
            let mut below = 0.0;
            for dn in low..high {
                let edge_e = (f64::from(dn) + 0.5 - self.bias_dn) * self.gain_e_per_dn;
                let up_to = normal_cdf((edge_e - value) / self.read_noise_e);
                probabilities[usize::from(dn - first_dn)] += probability * (up_to - below);
                below = up_to;
            }
            probabilities[usize::from(high - first_dn)] += probability * (1.0 - below);
        }
        DnDistribution { first_dn, probabilities }
    }

    /// Computes the probabilities from the characteristic function of Poisson plus normal, φ(u) =
    /// exp(λ(e^{iu} − 1) + iux − σ²u²/2), for a smooth distribution: tens of terms per digital number instead
    /// of hundreds.
    ///
    /// With n digital numbers of width g that hold the whole distribution, the probability of the one centred
    /// at c is the Fourier series (1/n) [1 + 2 Σ_j Re(φ(u_j) e^{−i u_j c}) sinc(u_j g/2)], u_j = 2πj/(n g).
    /// It is exact except for the probability outside these numbers, and is truncated where φ is below 1e-15.
    fn by_characteristic_function(&self, mean_e: f64, extra_e: f64, reach: PoissonReach) -> DnDistribution {
        const NEGLIGIBLE_EXPONENT: f64 = 35.0;
        let (gain, sigma) = (self.gain_e_per_dn, self.read_noise_e);
        let to_dn = |electrons: f64| (electrons / gain + self.bias_dn + 0.5).floor();
        let first = to_dn(reach.low + extra_e - NORMAL_REACH * sigma);
        let count = (to_dn(reach.high + extra_e + NORMAL_REACH * sigma) - first) as usize + 1;
        let first_centre_e = (first - self.bias_dn) * gain - extra_e;
        let base = 2.0 * std::f64::consts::PI / (count as f64 * gain);
        let last = ((2.0 * NEGLIGIBLE_EXPONENT).sqrt() / sigma / base) as usize;
        let mut series = vec![0.5; count];
        for j in 1..=last {
            let u = base * j as f64;
            let (sin, cos) = libm::sincos(u);
            let exponent = mean_e * (1.0 - cos) + 0.5 * sigma * sigma * u * u;
            if exponent > NEGLIGIBLE_EXPONENT {
                continue;
            }
            let half_width = 0.5 * u * gain;
            let amplitude = libm::exp(-exponent) * libm::sin(half_width) / half_width;
            // The angle falls by u g from each digital number to the next, so a rotation replaces a cosine.
            let (mut im, mut re) = libm::sincos(mean_e * sin - u * first_centre_e);
            let (turn_im, turn_re) = libm::sincos(u * gain);
            for term in &mut series {
                *term += amplitude * re;
                (re, im) = (re * turn_re + im * turn_im, im * turn_re - re * turn_im);
            }
        }
        let full_scale = f64::from(self.full_scale_dn);
        let clip = |dn: f64| dn.clamp(0.0, full_scale) as u16;
        let (first_dn, last_dn) = (clip(first), clip(first + (count - 1) as f64));
        let mut probabilities = vec![0.0; usize::from(last_dn - first_dn) + 1];
        for (i, term) in series.into_iter().enumerate() {
            // Rounding leaves about 1e-17 of either sign where the probability is zero.
            let probability = (2.0 * term / count as f64).max(0.0);
            probabilities[usize::from(clip(first + i as f64) - first_dn)] += probability;
        }
        DnDistribution { first_dn, probabilities }
    }
}

/// Numbers at which a Poisson distribution is truncated, with less than 2^-40 on either side, by Chernoff's
/// bounds in Bernstein's form: P(N ≥ λ + x) ≤ exp(−x²/(2λ + 2x/3)) and P(N ≤ λ − x) ≤ exp(−x²/(2λ)).
#[derive(Debug, Clone, Copy, PartialEq)]
struct PoissonReach {
    low: f64,
    high: f64,
}

impl PoissonReach {
    /// exp(−28) < 2^-40.
    const EXPONENT: f64 = 28.0;

    fn new(mean: f64) -> Self {
        let third = Self::EXPONENT / 3.0;
        Self {
            low: (mean - (2.0 * Self::EXPONENT * mean).sqrt()).floor().max(0.0),
            high: (mean + third + (third * third + 2.0 * Self::EXPONENT * mean).sqrt()).ceil(),
        }
    }
}

/// Returns the numbers of a Poisson distribution within its reach, with their probabilities.
fn poisson_atoms(mean: f64, reach: PoissonReach) -> Vec<(f64, f64)> {
    if mean <= 0.0 {
        return vec![(0.0, 1.0)];
    }
    let ln_mean = libm::log(mean);
    let probability = |k: f64| libm::exp(k * ln_mean - mean - libm::lgamma(k + 1.0));
    let count = (reach.high - reach.low) as usize + 1;
    (0..count).map(|i| reach.low + i as f64).map(|k| (k, probability(k))).collect()
}

/// Returns the table of a Poisson distribution with a mean of at most 61,440 (its numbers have 16 bits).
pub(super) fn poisson_table(mean: f64) -> AliasTable {
    let reach = PoissonReach::new(mean);
    let probabilities: Vec<f64> = poisson_atoms(mean, reach).into_iter().map(|(_, p)| p).collect();
    AliasTable::new(reach.low as u16, &probabilities)
}

fn normal_cdf(z: f64) -> f64 {
    0.5 * libm::erfc(-z * std::f64::consts::FRAC_1_SQRT_2)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::super::direct_sampler::DirectSampler;
    use super::super::words::PixelStreams;
    use super::*;
    use crate::config::tests::twelve_bit;
    use draws::Seed;

    /// Counts the numbers of `count` pixels of one mean that are drawn directly.
    fn sampled(distribution: &PixelDistribution, mean_e: f64, frame: u64, count: usize) -> Vec<usize> {
        let streams = PixelStreams::new(&Seed { seed: 5, case: 0 }, frame, count, 1);
        let mut sampler = DirectSampler::default();
        let mut draw = |index| sampler.draw(distribution, mean_e, 0.0, &streams.pixel_words(index));
        histogram((0..count).map(|index| usize::from(draw(index))))
    }

    /// Number of occurrences of each number.
    pub(crate) fn histogram(numbers: impl Iterator<Item = usize>) -> Vec<usize> {
        let mut counts = Vec::new();
        for number in numbers {
            if number >= counts.len() {
                counts.resize(number + 1, 0);
            }
            counts[number] += 1;
        }
        counts
    }

    /// Probability that chi-square exceeds a value.
    pub(crate) fn chi_square_tail(chi2: f64, degrees_of_freedom: f64) -> f64 {
        use statrs::distribution::{ChiSquared, ContinuousCDF};
        ChiSquared::new(degrees_of_freedom).unwrap().sf(chi2)
    }

    /// Pearson's test of counts against probabilities; bins are merged until each has an expected count of
    /// ten.
    pub(crate) fn chi_square_p(counts: &[usize], probabilities: &[f64]) -> f64 {
        let n = counts.iter().sum::<usize>() as f64;
        let (mut chi2, mut bins, mut seen, mut expected) = (0.0, 0.0, 0.0, 0.0);
        let mut joined = 0.0;
        for i in 0..counts.len().max(probabilities.len()) {
            seen += counts.get(i).copied().unwrap_or(0) as f64;
            expected += n * probabilities.get(i).copied().unwrap_or(0.0);
            // The last bin includes the entire remainder, so unexpected numbers also count.
            if expected >= 10.0 && n - joined - expected >= 10.0 {
                chi2 += (seen - expected) * (seen - expected) / expected;
                bins += 1.0;
                joined += expected;
                (seen, expected) = (0.0, 0.0);
            }
        }
        let rest = n - joined;
        chi2 += (seen - rest) * (seen - rest) / rest;
        if bins < 1.0 { 1.0 } else { chi_square_tail(chi2, bins) }
    }

    /// Probabilities of a distribution, starting at the digital number 0.
    pub(crate) fn from_zero(distribution: &DnDistribution) -> Vec<f64> {
        let mut all = vec![0.0; usize::from(distribution.first_dn)];
        all.extend(&distribution.probabilities);
        all
    }

    fn distributions() -> Vec<(PixelDistribution, f64)> {
        let mut distributions = Vec::new();
        for mean_e in [0.0, 0.1, 3.0, 20.0, 300.0, 1000.0] {
            for (gain_e_per_dn, read_noise_e, bias_dn) in
                [(10.0, 15.0, 50.3), (1.0, 1.5, 0.0), (30.0, 4.0, 2.7), (0.5, 20.0, 0.0), (7.0, 0.0, 1.0)]
            {
                let config = SensorConfig { gain_e_per_dn, read_noise_e, bias_dn, ..twelve_bit() };
                distributions.push((PixelDistribution::new(&config), mean_e));
            }
        }
        distributions
    }

    #[test]
    fn both_ways_to_the_probabilities_agree() {
        for (distribution, mean_e) in
            distributions().into_iter().filter(|(distribution, _)| distribution.read_noise_e >= 1.0)
        {
            for extra_e in [0.0, 3.0] {
                let reach = PoissonReach::new(mean_e);
                let sum = from_zero(&distribution.by_sum(&poisson_atoms(mean_e, reach), extra_e));
                let series = from_zero(&distribution.by_characteristic_function(mean_e, extra_e, reach));
                for dn in 0..sum.len().max(series.len()) {
                    let at = |distribution: &[f64]| distribution.get(dn).copied().unwrap_or(0.0);
                    let error = at(&sum) - at(&series);
                    // 2^-40 for each.
                    assert!(error.abs() < 2.0 * 9.1e-13, "{distribution:?}, mean {mean_e}, {dn} DN: {error}");
                }
            }
        }
    }

    #[test]
    fn the_probabilities_have_the_moments_of_poisson_plus_normal_plus_rounding() {
        let mut checked = 0;
        for (distribution, mean_e) in distributions() {
            // Far from both ends and smooth, so Sheppard's correction of 1/12 DN² applies.
            if distribution.read_noise_e < 0.75 * distribution.gain_e_per_dn || distribution.bias_dn < 40.0 {
                continue;
            }
            let probabilities = from_zero(&distribution.probabilities(mean_e, 0));
            let moment = |f: &dyn Fn(f64) -> f64| -> f64 {
                probabilities.iter().enumerate().map(|(dn, p)| p * f(dn as f64)).sum()
            };
            assert!((moment(&|_| 1.0) - 1.0).abs() < 1e-11);
            let expected_dn = distribution.bias_dn + mean_e / distribution.gain_e_per_dn;
            let gain2 = distribution.gain_e_per_dn * distribution.gain_e_per_dn;
            let variance =
                (mean_e + distribution.read_noise_e * distribution.read_noise_e) / gain2 + 1.0 / 12.0;
            // The ripple due to rounding is exp(−2π²σ²/g²), below 1e-15 at 1.5 DN of read noise.
            assert!((moment(&|dn| dn) - expected_dn).abs() < 1e-8);
            assert!((moment(&|dn| (dn - expected_dn) * (dn - expected_dn)) - variance).abs() < 1e-8);
            checked += 1;
        }
        assert_eq!(checked, 6, "all means of one detector");
    }

    #[test]
    fn the_sampler_follows_the_probabilities() {
        for (frame, (distribution, mean_e)) in (0..).zip(distributions()) {
            let counts = sampled(&distribution, mean_e, frame, 50_000);
            let p = chi_square_p(&counts, &from_zero(&distribution.probabilities(mean_e, 0)));
            // Thirty tests: one in 3,000 random seeds would fail by chance, but the seed is fixed.
            assert!(p > 1e-5, "{distribution:?}, mean {mean_e}: p = {p}");
        }
    }

    #[test]
    fn a_full_well_and_a_full_converter_saturate() {
        for bit_depth in 8..=16 {
            let config = SensorConfig { bit_depth, full_well_e: 1e9, ..twelve_bit() };
            for mean_e in [1e8, 1e12, 1e300] {
                let counts = sampled(&PixelDistribution::new(&config), mean_e, 1, 1);
                assert_eq!(counts.len() - 1, usize::from(config.full_scale_dn()));
            }
        }
        let config = SensorConfig { full_well_e: 5000.0, ..twelve_bit() };
        let distribution = PixelDistribution::new(&config);
        let counts = sampled(&distribution, 1e6, 1, 20_000);
        // Exactly five thousand electrons, plus the read noise.
        let full = PixelDistribution { shot: Switch::Off, ..distribution }.probabilities(5000.0, 0);
        assert!(chi_square_p(&counts, &from_zero(&full)) > 1e-4);
        let half_full = sampled(&distribution, 5000.0, 1, 20_000);
        assert!(chi_square_p(&half_full, &from_zero(&distribution.probabilities(5000.0, 0))) > 1e-4);
    }

    #[test]
    fn a_nonlinear_amplifier_has_its_distribution() {
        let config =
            SensorConfig { non_linearity: 0.2, full_well_e: 2000.0, gain_e_per_dn: 3.0, ..twelve_bit() };
        let distribution = PixelDistribution::new(&config);
        for mean_e in [50.0, 1000.0, 2000.0] {
            let counts = sampled(&distribution, mean_e, 3, 50_000);
            let probabilities = from_zero(&distribution.probabilities(mean_e, 0));
            assert!(chi_square_p(&counts, &probabilities) > 1e-4, "mean {mean_e}");
            // e − 1e-4 e² of a Poisson number: ⟨e²⟩ = λ² + λ. The full well truncates the last mean.
            let mean_dn: f64 = probabilities.iter().enumerate().map(|(dn, p)| dn as f64 * p).sum();
            let expected_dn = 50.3 + (mean_e - 1e-4 * (mean_e * mean_e + mean_e)) / 3.0;
            assert!(mean_e == 2000.0 || (mean_dn - expected_dn).abs() < 1e-6, "{mean_dn}");
        }
    }

    #[test]
    fn without_any_noise_the_number_is_certain() {
        let mut config = twelve_bit();
        (config.noise.shot, config.noise.read) = (Switch::Off, Switch::Off);
        let distribution = PixelDistribution::new(&config);
        // 1234.5/10 + 50.3 + 0.5 = 174.25.
        assert_eq!(sampled(&distribution, 1234.5, 2, 1).len() - 1, 174);
        assert_eq!(
            distribution.probabilities(1234.5, 0),
            DnDistribution { first_dn: 174, probabilities: vec![1.0] }
        );
    }
}
