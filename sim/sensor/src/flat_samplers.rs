//! Distributions of pixels without signal and of pixels with a weak signal: tables instead of samplers.
//!
//! Most pixels of a frame have the same mean and therefore the same distribution of their digital number:
//! they need one table, and one word per pixel. For a pixel with a weak signal s above the flat mean λ,
//! superposition applies: Poisson(λ + s) is Poisson(λ) plus an independent n from Poisson(s). For given n its
//! distribution is that of the flat mean plus n fixed electrons: one table for each n.

use std::collections::BTreeMap;

use draws::{Stream, Streams};
use rand::Rng;
use truth::Switch;

use super::alias::AliasTable;
use super::exceedance::Exceedance;
use super::mean_tables::MeanTables;
use super::pixel_distribution::PixelDistribution;
use super::poisson_digits::{MAX_SMALL_E, PoissonDigits, small_poisson};
use super::ziggurat::Ziggurat;

/// Cache of tables for means, kept from frame to frame. Results do not depend on the cached tables: an empty
/// cache gives the same results, only more slowly.
#[derive(Debug, Clone, Default)]
pub struct FlatSamplers {
    distribution: Option<PixelDistribution>,
    /// Tables by the bits of the mean.
    means: BTreeMap<u64, FlatSampler>,
    mean_tables: Option<MeanTables>,
    exceedance: Option<Exceedance>,
    digits: PoissonDigits,
    normal: Ziggurat,
}

impl FlatSamplers {
    /// Maximum number of cached means; a shutter's ladder has fewer exposures.
    const MEANS: usize = 64;

    /// Creates an empty cache.
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns the tables of a flat mean, electrons.
    pub(super) fn sampler_for(&mut self, distribution: &PixelDistribution, mean_e: f64) -> &mut FlatSampler {
        if self.distribution != Some(*distribution)
            || (self.means.len() >= Self::MEANS && !self.means.contains_key(&mean_e.to_bits()))
        {
            self.forget(distribution);
        }
        self.means.entry(mean_e.to_bits()).or_insert_with(|| FlatSampler::new(*distribution, mean_e))
    }

    /// Returns the tables for pixels with individual means.
    pub(super) fn mean_tables(&mut self, distribution: &PixelDistribution) -> &mut MeanTables {
        if self.distribution != Some(*distribution) {
            self.forget(distribution);
        }
        self.mean_tables.get_or_insert_with(|| MeanTables::new(distribution))
    }

    /// Returns the distribution of the digital numbers above a floor.
    pub(super) fn exceedance(&mut self, distribution: &PixelDistribution, floor_dn: u16) -> &mut Exceedance {
        if self.exceedance.as_ref().is_some_and(|kept| !kept.is_valid_for(distribution, floor_dn)) {
            self.exceedance = None;
        }
        self.exceedance.get_or_insert_with(|| Exceedance::new(distribution, floor_dn))
    }

    /// Returns the tables of electron numbers and of the read noise, for pixels whose distribution is in no
    /// table.
    pub(super) fn in_parts(&mut self) -> (&mut PoissonDigits, &Ziggurat) {
        (&mut self.digits, &self.normal)
    }

    fn forget(&mut self, distribution: &PixelDistribution) {
        self.means.clear();
        self.mean_tables = None;
        self.distribution = Some(*distribution);
    }
}

/// Distribution of pixels with a common flat mean.
#[derive(Debug, Clone)]
pub(super) struct FlatSampler {
    distribution: PixelDistribution,
    mean_e: f64,
    flat: AliasTable,
    /// Tables for 0, 1, 2 … extra electrons, made on first use.
    more: Vec<Option<AliasTable>>,
}

impl FlatSampler {
    /// Maximum signal that is drawn from tables, electrons.
    const FAINT_E: f64 = 4.0;

    fn new(distribution: PixelDistribution, mean_e: f64) -> Self {
        let table = table(&distribution, mean_e, 0);
        Self { distribution, mean_e, flat: table, more: vec![None; MAX_SMALL_E + 1] }
    }

    /// Draws pixels without signal, two from each word.
    #[inline(always)]
    pub(super) fn draw_row(&self, row: &mut [u16], stream: &mut Stream) {
        let mut pairs = row.chunks_exact_mut(2);
        for pair in &mut pairs {
            let word = stream.next_u64();
            pair[0] = self.flat.draw(word as u32);
            pair[1] = self.flat.draw((word >> 32) as u32);
        }
        if let [last] = pairs.into_remainder() {
            *last = self.flat.draw(stream.next_u64() as u32);
        }
    }

    /// Draws a pixel with signal, at the address `index`.
    pub(super) fn draw_lit(&mut self, signal_e: f64, streams: &Streams, index: u64) -> u16 {
        // Without shot noise, electrons are not drawn as integers and superposition does not apply. A dead
        // pixel has less than the flat level.
        if (0.0..=Self::FAINT_E).contains(&signal_e) && self.distribution.shot == Switch::On {
            self.draw_faint(signal_e, streams.word(index))
        } else {
            self.distribution.sample(self.mean_e + signal_e, 0.0, &mut streams.stream_at(index))
        }
    }

    /// Draws the digital number of a pixel with a signal of at most [`FlatSampler::FAINT_E`] from a uniform
    /// word: its upper half determines the number of signal electrons (to 2^-32), its lower half the digital
    /// number.
    fn draw_faint(&mut self, signal_e: f64, word: u64) -> u16 {
        let n = small_poisson(signal_e, (word >> 32) as u32);
        if n == 0 {
            return self.flat.draw(word as u32);
        }
        self.more[n].get_or_insert_with(|| table(&self.distribution, self.mean_e, n as u32)).draw(word as u32)
    }
}

/// Returns the table of a mean plus `extra_e` fixed electrons.
pub(super) fn table(distribution: &PixelDistribution, mean_e: f64, extra_e: u32) -> AliasTable {
    let probabilities = distribution.probabilities(mean_e, extra_e);
    AliasTable::new(probabilities.first_dn, &probabilities.probabilities)
}

#[cfg(test)]
mod tests {
    use super::super::config::tests::twelve_bit;
    use super::super::pixel_distribution::tests::{chi_square_p, from_zero, histogram, two_sample_p};
    use super::*;
    use crate::SensorConfig;
    use draws::{Effect, Seed};

    fn distribution(gain_e_per_dn: f64) -> PixelDistribution {
        PixelDistribution::new(&SensorConfig { gain_e_per_dn, ..twelve_bit() })
    }

    #[test]
    fn flat_draws_follow_the_distribution_of_the_direct_sampler() {
        for (index, mean_e) in [0.1, 1.0, 20.0, 150.0, 1000.0].into_iter().enumerate() {
            let distribution = distribution(2.0);
            let mut stream = Seed { seed: 21, case: 0 }.stream(0, Effect::PixelNoise, index as u64);
            let mut samplers = FlatSamplers::new();
            let table = samplers.sampler_for(&distribution, mean_e).flat.clone();
            let n = 500_000;
            let drawn = histogram((0..n).map(|_| usize::from(table.draw(stream.next_u32()))));
            let p = chi_square_p(&drawn, &from_zero(&distribution.probabilities(mean_e, 0)));
            assert!(p > 1e-4, "mean {mean_e}: p = {p} against the probabilities");
            // Sampler and table share only the parameters.
            let sampled =
                histogram((0..n).map(|_| usize::from(distribution.sample(mean_e, 0.0, &mut stream))));
            let p = two_sample_p(&drawn, &sampled);
            assert!(p > 1e-4, "mean {mean_e}: p = {p} against the sampler");
        }
    }

    #[test]
    fn a_small_signal_superposes_to_the_distribution_of_the_sum() {
        // A gain of 1 e⁻/DN and a low read noise, so single electrons are distinguishable.
        let distribution =
            PixelDistribution::new(&SensorConfig { gain_e_per_dn: 1.0, read_noise_e: 1.2, ..twelve_bit() });
        for (frame, signal_e) in [0.02, 0.5, 1.0, 2.7, FlatSampler::FAINT_E].into_iter().enumerate() {
            let streams = Seed { seed: 22, case: 0 }.streams(frame as u64, Effect::PixelNoise);
            let mut samplers = FlatSamplers::new();
            let flat = samplers.sampler_for(&distribution, 3.0);
            let counts = histogram(
                (0..300_000).map(|index| usize::from(flat.draw_faint(signal_e, streams.word(index)))),
            );
            let p = chi_square_p(&counts, &from_zero(&distribution.probabilities(3.0 + signal_e, 0)));
            assert!(p > 1e-4, "signal {signal_e}: p = {p}");
        }
    }

    #[test]
    fn caching_changes_nothing() {
        let word = |i: u32| i.wrapping_mul(0x9e37_79b9);
        let mut kept = FlatSamplers::new();
        for i in 0..200 {
            kept.sampler_for(&distribution(1.0), f64::from(i));
        }
        kept.sampler_for(&distribution(3.0), 17.0);
        let fresh = FlatSamplers::new().sampler_for(&distribution(1.0), 17.0).flat.clone();
        let kept = &kept.sampler_for(&distribution(1.0), 17.0).flat;
        assert!((0..10_000).all(|i| fresh.draw(word(i)) == kept.draw(word(i))));
    }
}
