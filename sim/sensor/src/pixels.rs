//! Digital numbers of a frame, pixel by pixel: from tables where a table holds a pixel's distribution,
//! otherwise in separate steps.

use draws::{GeneratorLanes, Streams};
use optics::simd_kernel::arch;
use rand::Rng;
use render::draw::{ExpectedImage, PART, PIECE};
use truth::Switch;

use super::detector::Sensor;
use super::flat_samplers::FlatSamplers;
use super::mean_tables::{MeanTables, UniformMean, Words};
use super::poisson_digits::PoissonDigits;
use super::raw_image::RawImage;

/// Electrons that the readout adds to each row and to each column of a frame.
pub(super) struct LineOffsets {
    pub(super) rows: Vec<f64>,
    pub(super) columns: Vec<f64>,
}

impl LineOffsets {
    /// Offset of one pixel, electrons.
    pub(super) fn offset_at(&self, x: usize, y: usize) -> f64 {
        self.rows[y] + self.columns[x]
    }
}

impl Sensor {
    /// Draws a frame with a flat background above the range of the tables; nearly all pixels share a table
    /// made for this level.
    pub(super) fn draw_flat(
        &self,
        expected: &ExpectedImage,
        streams: &Streams,
        samplers: &mut FlatSamplers,
        raw: &mut RawImage,
    ) {
        let flat = samplers.sampler_for(&self.distribution, expected.flat_e());
        for (y, row) in raw.dn.chunks_exact_mut(self.columns.max(1)).enumerate() {
            flat.draw_row(row, &mut streams.stream_at(y as u64));
        }
        for (index, signal_e) in expected.object_pixels() {
            raw.dn[index] = flat.draw_lit(signal_e, streams, (self.rows + index) as u64);
        }
    }

    /// Returns true if there are tables for the means of nearly all pixels.
    pub(super) fn has_tables_for(&self, expected: &ExpectedImage) -> bool {
        self.distribution.shot == Switch::On && expected.flat_e() < MeanTables::end_e(&self.distribution)
    }

    /// Draws a frame in which every pixel has an individual mean.
    pub(super) fn draw_with_mean_tables(
        &self,
        expected: &ExpectedImage,
        streams: &Streams,
        samplers: &mut FlatSamplers,
        raw: &mut RawImage,
    ) {
        let tables = samplers.mean_tables(&self.distribution);
        // Identical steps on every machine, on its widest registers.
        arch().dispatch(MeanTableFrame { expected, streams, tables, raw });
    }

    /// Draws a frame without tables of pixel distributions, because rows and columns have offsets or the flat
    /// level is high: electrons, then read noise, then the converter.
    pub(super) fn draw_in_parts(
        &self,
        expected: &ExpectedImage,
        offsets: Option<&LineOffsets>,
        streams: &Streams,
        samplers: &mut FlatSamplers,
        raw: &mut RawImage,
    ) {
        let (digits, normal) = samplers.in_parts();
        let [mut means, mut collected, mut noise, mut offsets_e] = [(); 4].map(|()| vec![0.0; self.columns]);
        for (y, row) in raw.dn.chunks_exact_mut(self.columns.max(1)).enumerate() {
            let pixel_stream = |x: usize| streams.stream_at((self.rows + y * self.columns + x) as u64);
            let mut stream = streams.stream_at(y as u64);
            expected.row(y, &mut means);
            // Each step is a short loop over the row.
            match self.distribution.shot {
                Switch::On => {
                    for (collected, &mean_e) in collected.iter_mut().zip(&means) {
                        let words = [stream.next_u64(), stream.next_u64()];
                        *collected = f64::from(digits.draw(mean_e.max(0.0), words));
                    }
                }
                Switch::Off => {
                    for (collected, mean_e) in collected.iter_mut().zip(&means) {
                        *collected = mean_e.max(0.0);
                    }
                }
            }
            match offsets {
                Some(offsets) => {
                    for (offset_e, column_e) in offsets_e.iter_mut().zip(&offsets.columns) {
                        *offset_e = offsets.rows[y] + column_e;
                    }
                }
                None => offsets_e.fill(0.0),
            }
            for (x, noise) in noise.iter_mut().enumerate() {
                *noise = normal.draw(stream.next_u64(), || pixel_stream(x));
            }
            for (((dn, &collected_e), &noise), &offset_e) in
                row.iter_mut().zip(&collected).zip(&noise).zip(&offsets_e)
            {
                *dn = self.distribution.read(collected_e, noise, offset_e);
            }
            if self.distribution.shot == Switch::On {
                for (x, (dn, &mean_e)) in row.iter_mut().zip(&means).enumerate() {
                    if mean_e >= PoissonDigits::END_E {
                        *dn = self.distribution.sample(mean_e, offsets_e[x], &mut pixel_stream(x));
                    }
                }
            }
        }
    }
}

/// Task of drawing a frame from the tables of individual means; on a uniform background, pixels without
/// signal use their common mean.
struct MeanTableFrame<'a> {
    expected: &'a ExpectedImage,
    streams: &'a Streams,
    tables: &'a mut MeanTables,
    raw: &'a mut RawImage,
}

impl pulp::WithSimd for MeanTableFrame<'_> {
    type Output = ();

    // Everything is inlined: only then is it compiled for the registers of the machine.
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let Self { expected, streams, tables, raw } = self;
        let (columns, rows) = (raw.columns, raw.rows);
        let even = (!expected.has_field()).then(|| UniformMean::new(expected.flat_e()));
        // With a uniform background, these are between rows always the means of a row without signal.
        let mut means = vec![expected.flat_e(); columns];
        let mut is_lit = vec![true; columns.div_ceil(PART)];
        let mut words = Words::new();
        for (y, row) in raw.dn.chunks_exact_mut(columns.max(1)).enumerate() {
            let pixel_stream = |x: usize| streams.stream_at((rows + y * columns + x) as u64);
            let mut lanes = GeneratorLanes::from_streams(streams, y as u64);
            let Some(even) = &even else {
                expected.row(y, &mut means);
                tables.draw_row(simd, &means, lanes, row, pixel_stream);
                continue;
            };
            expected.lit_parts::<PART>(y, &mut is_lit);
            for (part, means_e) in lit(&is_lit, &mut means) {
                expected.part::<PART>(y, part, means_e);
            }
            let pieces = row.chunks_mut(PIECE).zip(means.chunks(PIECE)).zip(is_lit.chunks(PIECE / PART));
            for (p, ((row, means_e), is_lit)) in pieces.enumerate() {
                words.draw(simd, &mut lanes);
                let pixel_stream = |i: usize| pixel_stream(p * PIECE + i);
                tables.draw_mostly_even_piece(even, is_lit, means_e, &words, row, pixel_stream);
            }
            lit(&is_lit, &mut means).for_each(|(_, means_e)| means_e.fill(expected.flat_e()));
        }
    }
}

/// Returns the lit parts of a row, by number, with the means of their pixels.
#[inline(always)]
fn lit<'a>(is_lit: &'a [bool], means_e: &'a mut [f64]) -> impl Iterator<Item = (usize, &'a mut [f64])> {
    let parts = means_e.chunks_mut(PART).enumerate().zip(is_lit);
    parts.filter(|(_, is_lit)| **is_lit).map(|(part, _)| part)
}

#[cfg(test)]
mod tests {
    use super::super::config::tests::{interval, twelve_bit};
    use super::super::pixel_distribution::tests::{chi_square_p, from_zero, histogram};
    use super::super::{FixedPatternConfig, LineNoiseConfig, NoiseConfig, SensorConfig};
    use super::*;
    use contract::PixelPoint;
    use draws::Seed;
    use optics::{Psf, PsfConfig, Stamp};
    use sha2::{Digest, Sha256};

    const SEED: Seed = Seed { seed: 43, case: 0 };

    fn frame(config: &SensorConfig, number: u64, samplers: &mut FlatSamplers, stars_e: &[f64]) -> Vec<u16> {
        let sensor = Sensor::new(config, 128, 128).unwrap();
        let (mut image, mut raw) = (sensor.new_expected(), sensor.new_raw());
        image.clear(sensor.sky_electrons(1.0));
        let (mut psf, mut stamp) = (Psf::new(&PsfConfig::Gaussian { sigma_px: 0.8 }).unwrap(), Stamp::new());
        for (i, electrons) in stars_e.iter().enumerate() {
            let centre = PixelPoint::new(10.3 + 20.0 * i as f64, 12.8 + 20.0 * i as f64);
            psf.stamp(centre, *electrons, Psf::FLOOR_E, image.size(), &mut stamp);
            image.add(&stamp);
        }
        let charge = sensor.collect(&mut image, &interval(1.0));
        sensor.read_out(&charge, &SEED, number, samplers, &mut raw).unwrap();
        raw.dn
    }

    /// Returns a uniform detector with a sky background; its row offsets or its response vary imperceptibly.
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
    fn frames_in_parts_and_frames_by_tables_follow_the_distribution_of_a_pixel() {
        let mut samplers = FlatSamplers::new();
        for sky_e in [0.0, 0.4, 20.3, 150.7, 300.0, 5000.0, 70_000.0] {
            for (row_e, prnu_fraction) in [(1e-9, 0.0), (0.0, 1e-9)] {
                // The mean of a pixel is a 32-bit float times the sky level: accurate to 3e-8.
                let config = even(sky_e, row_e, prnu_fraction);
                let dn: Vec<u16> =
                    (0..8).flat_map(|number| frame(&config, number, &mut samplers, &[])).collect();
                let distribution = super::super::pixel_distribution::PixelDistribution::new(&config);
                let distribution = from_zero(&distribution.probabilities(config.background_e_per_s, 0));
                let p = chi_square_p(&histogram(dn.iter().map(|&dn| usize::from(dn))), &distribution);
                // Fourteen tests of 131,072 pixels.
                assert!(p > 1e-4, "{sky_e} e⁻, rows {row_e} e⁻: p = {p}");
            }
        }
    }

    #[test]
    fn without_shot_noise_the_parts_are_the_mean_and_the_read_noise() {
        let config = SensorConfig {
            noise: NoiseConfig { shot: Switch::Off, ..NoiseConfig::default() },
            ..even(1234.5, 1e-9, 0.0)
        };
        let dn = frame(&config, 0, &mut FlatSamplers::new(), &[]);
        let distribution =
            super::super::pixel_distribution::PixelDistribution::new(&config).probabilities(1234.5, 0);
        let p = chi_square_p(&histogram(dn.iter().map(|&dn| usize::from(dn))), &from_zero(&distribution));
        assert!(p > 1e-4, "p = {p}");
    }

    #[test]
    fn a_star_changes_only_its_own_pixels_on_any_detector() {
        for config in [even(20.0, 5.0, 0.0), even(20.0, 0.0, 0.02), even(2000.0, 0.0, 0.02)] {
            let mut samplers = FlatSamplers::new();
            let without = frame(&config, 1, &mut samplers, &[]);
            // Uses a separate cache of tables from that of the frame without the star.
            let with = frame(&config, 1, &mut FlatSamplers::new(), &[1e6]);
            assert_ne!(with, without);
            for (index, _) in with.iter().zip(&without).enumerate().filter(|(_, (a, b))| a != b) {
                let pixel = PixelPoint::new((index % 128) as f64, (index / 128) as f64);
                // exp(−d²/2σ²) of a million electrons is below the floor of 0.01 e⁻ from 4.9 px on; the
                // corner of a pixel adds to that.
                assert!(pixel.distance(PixelPoint::new(10.3, 12.8)) < 5.7, "{index}");
            }
        }
    }

    #[test]
    fn the_registers_of_the_machine_change_no_bit() {
        let config = even(20.0, 0.0, 0.02);
        let sensor = Sensor::new(&config, 301, 40).unwrap();
        let mut image = sensor.new_expected();
        image.clear(sensor.sky_electrons(1.0));
        (0..40).for_each(|y| image.add_pixel(7 * y, y, libm::exp(0.3 * y as f64)));
        let charge = sensor.collect(&mut image, &interval(1.0));
        let streams = SEED.streams(3, draws::Effect::PixelNoise);
        let draw = |registers: pulp::Arch| {
            let (mut raw, mut samplers) = (sensor.new_raw(), FlatSamplers::new());
            let tables = samplers.mean_tables(&sensor.distribution);
            let expected = charge.expected();
            registers.dispatch(MeanTableFrame { expected, streams: &streams, tables, raw: &mut raw });
            raw.dn
        };
        for registers in optics::simd_kernel::registers::registers() {
            assert!(draw(registers) == draw(pulp::Arch::Scalar), "{registers:?}");
        }
    }

    /// The pixel values are frozen: they must be equal on every machine, and a change here changes every
    /// result of such detectors and must be recorded in CHANGELOG.md.
    #[test]
    fn the_pixels_of_uneven_detectors_are_frozen() {
        let hashes = [even(20.0, 5.0, 0.0), even(20.0, 0.0, 0.02), even(2000.0, 3.0, 0.02)].map(|config| {
            let dn = frame(&config, 7, &mut FlatSamplers::new(), &[500.0, 5e3, 5e4, 5e5]);
            let bytes: Vec<u8> = dn.iter().flat_map(|dn| dn.to_le_bytes()).collect();
            let hash = Sha256::digest(&bytes);
            hash.iter().take(8).map(|byte| format!("{byte:02x}")).collect::<String>()
        });
        // Row offsets, pixel response, and the two together.
        assert_eq!(hashes, ["8f06fd1c95738a8f", "584784391a3412b5", "b8384caf98119a61"]);
    }
}
