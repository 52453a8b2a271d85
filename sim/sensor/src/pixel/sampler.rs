//! Draws of the digital numbers of pixels.
//!
//! There are two ways. A pixel without a readout offset whose mean lies on the grid of the tables is drawn
//! from a table, with the word that it has in the words of its row. Any other pixel is drawn in the steps of
//! the detector, with the words at its own address. The way of a pixel depends only on its own distribution,
//! so no other pixel and no effect of zero strength changes its number.

use pulp::Arch;

use super::direct_sampler::DirectSampler;
use super::distribution::PixelDistribution;
use super::mean_tables::{Batch, FlatMean, MeanTables};
use super::words::PixelWords;

/// Sampler of the pixels of a detector, kept from frame to frame. Its tables are made on first use; numbers
/// do not depend on which are made already.
#[derive(Debug, Clone)]
pub struct PixelSampler {
    distribution: PixelDistribution,
    tables: Option<MeanTables>,
    direct: DirectSampler,
}

impl PixelSampler {
    /// Creates a sampler without any tables.
    pub(crate) fn new(distribution: &PixelDistribution) -> Self {
        Self {
            distribution: *distribution,
            tables: MeanTables::new(distribution),
            direct: DirectSampler::default(),
        }
    }

    /// Makes this the sampler of `distribution`, if it was made for another detector.
    pub(crate) fn set_distribution(&mut self, distribution: &PixelDistribution) {
        if self.distribution != *distribution {
            *self = Self::new(distribution);
        }
    }

    /// Returns true if there are tables for pixels without an offset.
    pub(crate) fn has_tables(&self) -> bool {
        self.tables.is_some()
    }

    /// Draws the first `tiles` tiles of a batch, without offsets; tiles that are marked as flat have the mean
    /// `flat`. Some numbers are still missing: see [`PixelSampler::draw_open`].
    pub(crate) fn draw_batch(&self, registers: Arch, batch: &mut Batch, flat: &FlatMean, tiles: usize) {
        if let Some(tables) = &self.tables {
            tables.draw_batch(registers, batch, flat, tiles);
        }
    }

    /// Draws a pixel whose number is not in a table yet ([`Batch::open_pixels`]): the table is made, or the
    /// pixel has none.
    pub(crate) fn draw_open(&mut self, mean_e: f64, word: u64, own_words: &PixelWords) -> u16 {
        let Some(tables) = self.tables.as_mut().filter(|_| mean_e < MeanTables::END_E) else {
            return self.draw_directly(mean_e, 0.0, own_words);
        };
        match tables.draw(&self.distribution, mean_e, word) {
            Ok(dn) => dn,
            Err(pixel) => {
                let collected_e = self.collect(pixel.node_e, own_words) + pixel.extra_e;
                self.convert(collected_e, 0.0, own_words)
            }
        }
    }

    /// Draws a pixel with a mean of `mean_e` electrons (a negative mean counts as 0) to which the readout
    /// adds `offset_e` electrons, in the steps of the detector.
    #[inline(always)]
    pub(crate) fn draw_directly(&mut self, mean_e: f64, offset_e: f64, own_words: &PixelWords) -> u16 {
        self.direct.draw(&self.distribution, mean_e.max(0.0), offset_e, own_words)
    }

    /// Draws the electrons that a pixel collects, before the limit of the full well.
    pub(crate) fn collect(&mut self, mean_e: f64, own_words: &PixelWords) -> f64 {
        self.direct.collect(&self.distribution, mean_e.max(0.0), own_words)
    }

    /// Draws the digital number of a pixel that collected `collected_e` electrons.
    pub(crate) fn convert(&self, collected_e: f64, offset_e: f64, own_words: &PixelWords) -> u16 {
        self.direct.convert(&self.distribution, collected_e, offset_e, own_words)
    }
}

#[cfg(test)]
mod tests {
    use super::super::distribution::tests::{chi_square_p, from_zero, histogram};
    use super::*;
    use crate::config::tests::{interval, twelve_bit};
    use crate::{
        BloomingConfig, FixedPatternConfig, FrameCharge, HotPixelConfig, LineNoiseConfig, NoiseConfig,
        Sensor, SensorConfig, TelegraphConfig,
    };
    use contract::PixelPoint;
    use draws::Seed;
    use optics::{Psf, PsfConfig, Stamp};
    use sha2::{Digest, Sha256};
    use truth::Switch;

    const SEED: Seed = Seed { seed: 43, case: 0 };
    const SIZE: usize = 128;

    /// Returns a frame with stars of the given electrons along a diagonal.
    fn frame(sensor: &Sensor, number: u64, sampler: &mut PixelSampler, stars_e: &[f64]) -> Vec<u16> {
        let (mut image, mut raw) = (sensor.new_expected(), sensor.new_raw());
        image.clear(sensor.sky_electrons(1.0));
        let (mut psf, mut stamp) = (Psf::new(&PsfConfig::Gaussian { sigma_px: 0.8 }).unwrap(), Stamp::new());
        for (i, electrons) in stars_e.iter().enumerate() {
            let centre = PixelPoint::new(10.3 + 20.0 * i as f64, 12.8 + 20.0 * i as f64);
            psf.stamp(centre, *electrons, Psf::FLOOR_E, image.size(), &mut stamp);
            image.add(&stamp);
        }
        let charge = sensor.collect(&mut image, &interval(1.0));
        let collected = FrameCharge { charge: &charge, seed: SEED, frame: number };
        sensor.read_out(&collected, sampler, &mut raw).unwrap();
        raw.dn
    }

    /// Returns the same from a new detector.
    fn first_frame(config: &SensorConfig, number: u64, stars_e: &[f64]) -> Vec<u16> {
        let sensor = Sensor::new(config, SIZE, SIZE).unwrap();
        frame(&sensor, number, &mut sensor.new_sampler(), stars_e)
    }

    /// Returns a uniform detector with a sky background; its row offsets or its response vary.
    fn even(sky_e: f64, row_e: f64, prnu_fraction: f64) -> SensorConfig {
        SensorConfig {
            bit_depth: 16,
            gain_e_per_dn: 2.0,
            read_noise_e: 3.0,
            full_well_e: 120_000.0,
            background_e_per_s: sky_e,
            dark_current_e_per_s: 0.0,
            hot_pixels: Default::default(),
            line_noise: LineNoiseConfig { row_e, column_e: 0.0 },
            fixed_pattern: FixedPatternConfig { prnu_fraction, ..Default::default() },
            ..twelve_bit()
        }
    }

    #[test]
    fn either_way_a_pixel_has_its_distribution() {
        for sky_e in [0.0, 0.4, 20.3, 150.7, 300.0, 5000.0, 70_000.0] {
            // Imperceptible offsets of rows: every pixel is drawn directly.
            for row_e in [0.0, 1e-9] {
                let config = even(sky_e, row_e, 0.0);
                let sensor = Sensor::new(&config, SIZE, SIZE).unwrap();
                let mut sampler = sensor.new_sampler();
                let dn: Vec<u16> =
                    (0..8).flat_map(|number| frame(&sensor, number, &mut sampler, &[])).collect();
                let distribution = from_zero(&sensor.distribution.probabilities(sky_e, 0));
                let p = chi_square_p(&histogram(dn.iter().map(|&dn| usize::from(dn))), &distribution);
                // Fourteen tests of 131,072 pixels.
                assert!(p > 1e-4, "{sky_e} e⁻, rows {row_e} e⁻: p = {p}");
            }
        }
    }

    #[test]
    fn without_shot_noise_a_pixel_has_its_mean_and_the_read_noise() {
        let noise = NoiseConfig { shot: Switch::Off, ..NoiseConfig::default() };
        let config = SensorConfig { noise, ..even(1234.5, 0.0, 0.0) };
        let dn = first_frame(&config, 0, &[]);
        let distribution = PixelDistribution::new(&config).probabilities(1234.5, 0);
        let p = chi_square_p(&histogram(dn.iter().map(|&dn| usize::from(dn))), &from_zero(&distribution));
        assert!(p > 1e-4, "p = {p}");
    }

    /// Frames whose background is drawn from tables, and frames whose background is drawn directly.
    #[test]
    fn an_effect_of_zero_strength_changes_no_pixel() {
        let pattern = |config: &SensorConfig, change: fn(&mut FixedPatternConfig)| {
            let mut config = config.clone();
            change(&mut config.fixed_pattern);
            config
        };
        for sky_e in [20.0, 255.9, 400.0] {
            let plain = SensorConfig { dark_current_e_per_s: 3.0, ..even(sky_e, 0.0, 0.0) };
            let hot_pixels = HotPixelConfig {
                count: 50,
                median_e_per_s: 1e-12,
                telegraph: Some(TelegraphConfig { fraction: 1.0, low_level: 0.5, high_s: 1.0, low_s: 1.0 }),
                ..HotPixelConfig::default()
            };
            let blooming = Some(BloomingConfig { spill_fraction: 1.0 });
            let effects = [
                ("response", pattern(&plain, |pattern| pattern.prnu_fraction = 1e-13)),
                ("dark current", pattern(&plain, |pattern| pattern.dsnu_fraction = 1e-13)),
                ("seed of the detector", pattern(&plain, |pattern| pattern.seed = 9)),
                ("hot pixels", SensorConfig { hot_pixels, ..plain.clone() }),
                ("frame transfer", SensorConfig { frame_transfer_s: 1e-15, ..plain.clone() }),
                ("blooming", SensorConfig { blooming, ..plain.clone() }),
                ("amplifier", SensorConfig { non_linearity: 1e-15, ..plain.clone() }),
            ];
            let stars_e = [100.0, 3e3, 5e4];
            let expected = first_frame(&plain, 5, &stars_e);
            for (effect, config) in effects {
                assert!(first_frame(&config, 5, &stars_e) == expected, "{effect} at {sky_e} e⁻");
            }
        }
    }

    /// The background crosses the end of the tables in half of the image.
    #[test]
    fn the_level_of_one_pixel_changes_no_other() {
        let sensor = Sensor::new(&even(250.0, 0.0, 0.0), SIZE, SIZE).unwrap();
        let draw = |step_e: f64| {
            let (mut image, mut raw) = (sensor.new_expected(), sensor.new_raw());
            image.clear(sensor.sky_electrons(1.0));
            (0..SIZE * SIZE / 2).for_each(|i| image.add_pixel(i % SIZE, i / SIZE, step_e));
            let charge = sensor.collect(&mut image, &interval(1.0));
            let collected = FrameCharge { charge: &charge, seed: SEED, frame: 6 };
            sensor.read_out(&collected, &mut sensor.new_sampler(), &mut raw).unwrap();
            raw.dn
        };
        let (without, with) = (draw(0.0), draw(20.0));
        assert_ne!(without[..SIZE * SIZE / 2], with[..SIZE * SIZE / 2]);
        assert_eq!(without[SIZE * SIZE / 2..], with[SIZE * SIZE / 2..]);
    }

    #[test]
    fn a_star_changes_only_its_own_pixels_on_any_detector() {
        for config in [even(20.0, 5.0, 0.0), even(20.0, 0.0, 0.02), even(2000.0, 0.0, 0.02)] {
            let (without, with) = (first_frame(&config, 1, &[]), first_frame(&config, 1, &[1e6]));
            assert_ne!(with, without);
            for (index, _) in with.iter().zip(&without).enumerate().filter(|(_, (a, b))| a != b) {
                let pixel = PixelPoint::new((index % SIZE) as f64, (index / SIZE) as f64);
                // exp(−d²/2σ²) of a million electrons is below the floor of 0.01 e⁻ from 4.9 px on; the
                // corner of a pixel adds to that.
                assert!(pixel.distance(PixelPoint::new(10.3, 12.8)) < 5.7, "{index}");
            }
        }
    }

    #[test]
    fn the_registers_of_the_machine_change_no_bit() {
        for config in [even(20.0, 0.0, 0.0), even(20.0, 0.0, 0.02), even(20.0, 5.0, 0.02)] {
            optics::simd_kernel::registers::same_on_all_registers(|| first_frame(&config, 3, &[500.0, 5e4]));
        }
    }

    /// The pixel values are frozen: they must be equal on every machine, and a change here changes every
    /// result of such detectors and must be recorded in CHANGELOG.md.
    #[test]
    fn the_pixels_of_uneven_detectors_are_frozen() {
        let hashes = [even(20.0, 5.0, 0.0), even(20.0, 0.0, 0.02), even(2000.0, 3.0, 0.02)].map(|config| {
            let dn = first_frame(&config, 7, &[500.0, 5e3, 5e4, 5e5]);
            let bytes: Vec<u8> = dn.iter().flat_map(|dn| dn.to_le_bytes()).collect();
            let hash = Sha256::digest(&bytes);
            hash.iter().take(8).map(|byte| format!("{byte:02x}")).collect::<String>()
        });
        // Row offsets, pixel response, and the two together.
        assert_eq!(hashes, ["d96bc26e2182d6e1", "fffe2053bc4eb917", "737e983b54414b16"]);
    }
}
