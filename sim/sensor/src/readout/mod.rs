//! Readout: from expected photoelectrons to digital numbers.

mod blooming;
mod dark_pixels;
mod sparse_image;
mod tiles;

use contract::{OutOfRange, Window};
use draws::{Effect, GeneratorLanes, Seed, normal};
use optics::simd_kernel::{arch, run_widest};
use pulp::{Arch, Simd, WithSimd};
use render::draw::{ExpectedImage, TILE, set_bits};
use truth::SimError;

use crate::charge::Charge;
use crate::detector::Sensor;
use crate::pixel::mean_tables::{Batch, FlatMean};
use crate::pixel::sampler::PixelSampler;
use crate::pixel::words::PixelStreams;
use crate::raw_image::RawImage;
use blooming::Overflow;
use dark_pixels::{DarkPixelScan, DarkPixels, Redraw};
use sparse_image::Pixel;
pub use sparse_image::SparseImage;
use tiles::{TileRun, tile_pixels};

/// Inputs from which a frame is read out.
pub struct FrameCharge<'a> {
    /// Charge of the pixels.
    pub charge: &'a Charge<'a>,
    /// Seed of the readout.
    pub seed: Seed,
    /// Number of the frame.
    pub frame: u64,
}

/// Everything that determines the digital numbers of a frame, apart from the detector.
pub(super) struct PixelInputs<'a> {
    pub(super) expected: &'a ExpectedImage,
    /// Electrons that the readout adds to rows and columns; `None` if it adds none.
    pub(super) offsets: Option<LineOffsets>,
    pub(super) streams: PixelStreams,
    /// Choice of the table for pixels of the flat level.
    flat: FlatMean,
}

/// Electrons that the readout adds to each row and to each column of a frame.
pub(super) struct LineOffsets {
    rows: Vec<f64>,
    columns: Vec<f64>,
}

impl LineOffsets {
    /// Offset of one pixel, electrons.
    #[inline(always)]
    pub(super) fn offset_at(&self, x: usize, y: usize) -> f64 {
        self.rows[y] + self.columns[x]
    }
}

impl Sensor {
    /// Returns a sampler for the pixels of this detector.
    pub fn new_sampler(&self) -> PixelSampler {
        PixelSampler::new(&self.distribution)
    }

    /// Returns a raw image with no pixels drawn.
    pub fn new_sparse(&self) -> SparseImage {
        SparseImage::new(self.new_raw())
    }

    /// Draws the digital number of every pixel.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] if the image does not have the sensor's size.
    pub fn read_out(
        &self,
        collected: &FrameCharge<'_>,
        sampler: &mut PixelSampler,
        raw: &mut RawImage,
    ) -> Result<(), SimError> {
        let inputs = self.pixel_inputs(collected)?;
        sampler.set_distribution(&self.distribution);
        (raw.columns, raw.rows, raw.bit_depth) = (self.columns, self.rows, self.config().bit_depth);
        raw.dn.resize(self.columns * self.rows, 0);
        let runs = TileRun::of_image(self.columns, self.rows);
        let dark = DarkPixels::default();
        TileLoop { registers: arch(), inputs: &inputs, dark: &dark, sampler, raw }.draw(&runs);
        self.spill_overflow(&inputs, sampler, |pixel| raw.dn[pixel.index] = pixel.dn);
        Ok(())
    }

    /// Draws every pixel whose digital number is above `floor_dn`.
    ///
    /// # Errors
    /// See [`Sensor::read_out`].
    pub fn read_out_above(
        &self,
        floor_dn: u16,
        collected: &FrameCharge<'_>,
        sampler: &mut PixelSampler,
        image: &mut SparseImage,
    ) -> Result<(), SimError> {
        let inputs = self.pixel_inputs(collected)?;
        sampler.set_distribution(&self.distribution);
        image.clear();
        if inputs.offsets.is_none() && sampler.has_tables() {
            image.dark.set_floor(&self.distribution, floor_dn);
            let candidates = collected.seed.streams(collected.frame, Effect::Exceedance);
            let SparseImage { dark, wanted, .. } = image;
            run_widest(DarkPixelScan { expected: inputs.expected, candidates, dark, wanted });
        } else {
            image.wanted.add_window(&Window { x: 0, y: 0, columns: self.columns, rows: self.rows });
        }
        draw_new_tiles(&inputs, sampler, image);
        self.spill_overflow(&inputs, sampler, |pixel| image.bloomed.push(pixel));
        image.set_single_pixels();
        Ok(())
    }

    /// Draws all pixels in some windows of a frame whose pixels above a floor were drawn by
    /// [`Sensor::read_out_above`].
    ///
    /// # Errors
    /// See [`Sensor::read_out`].
    pub fn read_out_windows(
        &self,
        windows: &[Window],
        collected: &FrameCharge<'_>,
        sampler: &mut PixelSampler,
        image: &mut SparseImage,
    ) -> Result<(), SimError> {
        for window in windows {
            image.wanted.add_window(window);
        }
        draw_new_tiles(&self.pixel_inputs(collected)?, sampler, image);
        image.set_single_pixels();
        Ok(())
    }

    /// Passes every pixel that overflows or receives overflowing charge to `put`.
    fn spill_overflow(&self, inputs: &PixelInputs<'_>, sampler: &mut PixelSampler, put: impl FnMut(Pixel)) {
        if let Some(blooming) = &self.config().blooming {
            self.bloom(&mut Overflow { blooming, inputs, sampler }, put);
        }
    }

    /// Collects what determines the digital numbers of a frame.
    fn pixel_inputs<'a>(&self, collected: &FrameCharge<'a>) -> Result<PixelInputs<'a>, OutOfRange> {
        let &FrameCharge { charge, seed, frame } = collected;
        let expected = charge.expected();
        if expected.size() != (self.columns, self.rows) {
            return Err(OutOfRange::new(
                "size of the expected image",
                format!("{:?}", expected.size()),
                "the columns and rows of the sensor",
            ));
        }
        Ok(PixelInputs {
            expected,
            offsets: self.line_offsets(&seed, frame),
            streams: PixelStreams::new(&seed, frame, self.columns, self.rows),
            flat: FlatMean::new(expected.flat_e()),
        })
    }

    /// Offsets that the readout adds to rows and columns: noise of this frame, and fixed offsets. `None` if
    /// there are neither.
    fn line_offsets(&self, seed: &Seed, frame: u64) -> Option<LineOffsets> {
        let (row_e, column_e) = self.line_noise_e();
        let fixed_e = &self.pattern().column_offsets_e;
        let noise = |sigma_e: f64, effect: Effect, place: usize| {
            if sigma_e > 0.0 { sigma_e * normal(&mut seed.stream(frame, effect, place as u64)) } else { 0.0 }
        };
        self.has_line_offsets().then(|| LineOffsets {
            rows: (0..self.rows).map(|y| noise(row_e, Effect::RowNoise, y)).collect(),
            columns: (0..self.columns)
                .map(|x| noise(column_e, Effect::ColumnNoise, x) + fixed_e.get(x).copied().unwrap_or(0.0))
                .collect(),
        })
    }

    /// Standard deviations of the simulated noise of rows and of columns, electrons.
    fn line_noise_e(&self) -> (f64, f64) {
        let read = self.config().noise.read;
        (read.apply(self.config().line_noise.row_e), read.apply(self.config().line_noise.column_e))
    }

    /// Returns true if the readout adds offsets to rows or columns.
    fn has_line_offsets(&self) -> bool {
        let (row_e, column_e) = self.line_noise_e();
        row_e > 0.0 || column_e > 0.0 || !self.pattern().column_offsets_e.is_empty()
    }
}

/// Draws the wanted tiles that are not drawn yet.
fn draw_new_tiles(inputs: &PixelInputs<'_>, sampler: &mut PixelSampler, image: &mut SparseImage) {
    let SparseImage { raw, drawn, wanted, runs, dark, .. } = image;
    runs.clear();
    drawn.take_new(wanted, runs);
    TileLoop { registers: arch(), inputs, dark, sampler, raw }.draw(runs);
}

/// Loop over the tiles of a frame: the only place that knows in which order pixels are drawn.
struct TileLoop<'a> {
    /// Registers that process many pixels at once; they change no bit.
    registers: Arch,
    inputs: &'a PixelInputs<'a>,
    dark: &'a DarkPixels,
    sampler: &'a mut PixelSampler,
    raw: &'a mut RawImage,
}

/// Generators of the words of a row, and the tile that their next words belong to.
struct RowWords {
    y: usize,
    next: usize,
    lanes: GeneratorLanes,
}

impl TileLoop<'_> {
    /// Draws the tiles of some runs, batch by batch.
    fn draw(&mut self, runs: &[TileRun]) {
        let mut batch = Batch::new();
        let lanes = self.inputs.streams.row_words(self.registers, 0);
        let mut row = RowWords { y: 0, next: 0, lanes };
        let has_tables = self.inputs.offsets.is_none() && self.sampler.has_tables();
        let mut rest = runs;
        while !rest.is_empty() {
            let (runs, others) = rest.split_at(runs_in_a_batch(rest));
            rest = others;
            self.set_means(runs, &mut batch);
            if has_tables {
                self.draw_words(runs, &mut row, &mut batch);
                let tiles = runs.iter().map(|run| run.tiles).sum();
                self.sampler.draw_batch(self.registers, &mut batch, &self.inputs.flat, tiles);
                self.set_numbers(runs, &batch);
            } else {
                self.draw_directly(runs, &batch);
            }
        }
    }

    /// Computes the expected electrons of the pixels of some runs, and marks the tiles where they are flat.
    fn set_means(&self, runs: &[TileRun], batch: &mut Batch) {
        let expected = self.inputs.expected;
        let mut tile = 0;
        for run in runs {
            let columns = run.columns(self.raw.columns);
            let means_e = &mut batch.means_e[tile * TILE..][..columns.len()];
            self.registers.dispatch(Span { expected, x: columns.start, y: run.y, means_e });
            expected.mark_flat_tiles(run.y, run.first, &mut batch.is_flat[tile..tile + run.tiles]);
            tile += run.tiles;
        }
    }

    /// Draws the words of the pixels of some runs.
    fn draw_words(&self, runs: &[TileRun], row: &mut RowWords, batch: &mut Batch) {
        let mut tile = 0;
        for run in runs {
            if row.y != run.y {
                let lanes = self.inputs.streams.row_words(self.registers, run.y);
                *row = RowWords { y: run.y, next: 0, lanes };
            }
            batch.draw_words(self.registers, tile..tile + run.tiles, run.first - row.next, &mut row.lanes);
            row.next = run.first + run.tiles;
            tile += run.tiles;
        }
    }

    /// Sets the numbers of some runs to those of a batch, and draws the pixels that are not in a table.
    fn set_numbers(&mut self, runs: &[TileRun], batch: &Batch) {
        let mut tile = 0;
        for run in runs {
            let columns = run.columns(self.raw.columns);
            let start = run.y * self.raw.columns;
            let numbers = &mut self.raw.dn[start + columns.start..start + columns.end];
            numbers.copy_from_slice(&batch.numbers[tile * TILE..][..columns.len()]);
            for tile_of_row in run.first..run.first + run.tiles {
                let pixels = tile_pixels(self.raw.columns, run.y, tile_of_row);
                self.draw_open_pixels(pixels.start, batch, tile);
                let means_e = &batch.means_e[tile * TILE..][..pixels.len()];
                let (first, numbers) = (pixels.start, &mut self.raw.dn[pixels]);
                let mut redraw = Redraw { sampler: self.sampler, streams: &self.inputs.streams };
                self.dark.keep_below_floor(run.y, first, means_e, numbers, &mut redraw);
                tile += 1;
            }
        }
    }

    /// Draws the pixels of a tile that are not in a table; `first` is the index of its first pixel.
    fn draw_open_pixels(&mut self, first: usize, batch: &Batch, tile: usize) {
        let row_end = (first / self.raw.columns + 1) * self.raw.columns;
        for i in set_bits(batch.open_pixels(tile)) {
            // The last tile may extend beyond its row.
            if first + i < row_end {
                let in_batch = tile * TILE + i;
                let own_words = self.inputs.streams.pixel_words(first + i);
                self.raw.dn[first + i] =
                    self.sampler.draw_open(batch.means_e[in_batch], batch.word(in_batch), &own_words);
            }
        }
    }

    /// Draws the numbers of some runs in the steps of the detector.
    fn draw_directly(&mut self, runs: &[TileRun], batch: &Batch) {
        let mut tile = 0;
        for run in runs {
            let columns = run.columns(self.raw.columns);
            let means_e = &batch.means_e[tile * TILE..][..columns.len()];
            let first = run.y * self.raw.columns + columns.start;
            let numbers = &mut self.raw.dn[first..first + columns.len()];
            let (inputs, sampler) = (self.inputs, &mut *self.sampler);
            self.registers.dispatch(DirectRun { inputs, run, first, means_e, sampler, numbers });
            tile += run.tiles;
        }
    }
}

/// Task of drawing the pixels of a run in the steps of the detector.
struct DirectRun<'a> {
    inputs: &'a PixelInputs<'a>,
    run: &'a TileRun,
    /// Index of the first pixel in the image.
    first: usize,
    means_e: &'a [f64],
    sampler: &'a mut PixelSampler,
    numbers: &'a mut [u16],
}

impl WithSimd for DirectRun<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let PixelInputs { offsets, streams, .. } = self.inputs;
        let first_column = self.run.first * TILE;
        for (i, (dn, &mean_e)) in self.numbers.iter_mut().zip(self.means_e).enumerate() {
            let offset_e =
                offsets.as_ref().map_or(0.0, |offsets| offsets.offset_at(first_column + i, self.run.y));
            *dn = self.sampler.draw_directly(mean_e, offset_e, &streams.pixel_words(self.first + i));
        }
    }
}

/// Task of computing the expected electrons of adjacent pixels of a row.
struct Span<'a> {
    expected: &'a ExpectedImage,
    x: usize,
    y: usize,
    means_e: &'a mut [f64],
}

impl WithSimd for Span<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.expected.span(self.x, self.y, self.means_e);
    }
}

/// Number of runs, from the first on, whose tiles fit a batch: at least one.
fn runs_in_a_batch(runs: &[TileRun]) -> usize {
    let mut tiles = 0;
    for (i, run) in runs.iter().enumerate() {
        tiles += run.tiles;
        if tiles > Batch::TILES {
            return i;
        }
    }
    runs.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::tests::{interval, twelve_bit};
    use crate::{BloomingConfig, LineNoiseConfig, SensorConfig};
    use contract::PixelPoint;
    use optics::{Psf, PsfConfig, Stamp};
    use sha2::{Digest, Sha256};
    use truth::Switch;

    const SEED: Seed = Seed { seed: 42, case: 0 };

    /// Returns a frame of 65 × 48 pixels with stars of the given electrons along a diagonal.
    fn frame(config: &SensorConfig, number: u64, stars_e: &[f64]) -> RawImage {
        let sensor = Sensor::new(config, 65, 48).unwrap();
        let mut psf = Psf::new(&PsfConfig::Gaussian { sigma_px: 0.8 }).unwrap();
        let mut image = sensor.new_expected();
        image.clear(sensor.sky_electrons(0.5));
        let mut stamp = Stamp::new();
        for (i, electrons) in stars_e.iter().enumerate() {
            let centre = PixelPoint::new(8.3 + 12.0 * i as f64, 6.8 + 10.0 * i as f64);
            psf.stamp(centre, *electrons, Psf::FLOOR_E, image.size(), &mut stamp);
            image.add(&stamp);
        }
        let mut raw = sensor.new_raw();
        let charge = sensor.collect(&mut image, &interval(0.5));
        let collected = FrameCharge { charge: &charge, seed: SEED, frame: number };
        sensor.read_out(&collected, &mut sensor.new_sampler(), &mut raw).unwrap();
        raw
    }

    fn hash(raw: &RawImage) -> String {
        let bytes: Vec<u8> = raw.dn.iter().flat_map(|dn| dn.to_le_bytes()).collect();
        Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// The pixel values are frozen: they must be equal on every machine, and a change here changes every
    /// result and must be recorded in CHANGELOG.md.
    #[test]
    fn the_pixels_of_a_small_frame_are_frozen() {
        let raw = frame(&twelve_bit(), 7, &[500.0, 5e3, 5e4, 5e5]);
        assert_eq!(hash(&raw), GOLDEN);
    }

    const GOLDEN: &str = "4f66bd5db1ea5f0985117ec90f3c23d76845d16d3e866e7da5d0805507812c93";

    #[test]
    fn a_star_changes_no_pixel_but_its_own() {
        let (without, with) = (frame(&twelve_bit(), 1, &[]), frame(&twelve_bit(), 1, &[5e3]));
        for (index, (a, b)) in without.dn.iter().zip(&with.dn).enumerate() {
            let distance =
                PixelPoint::new((index % 65) as f64, (index / 65) as f64).distance(PixelPoint::new(8.3, 6.8));
            // exp(−d²/2σ²) of 5,000 e⁻ is below the floor of 0.01 e⁻ from 4.2 px on; the corner of a pixel
            // adds to that.
            assert!(a == b || distance < 5.0, "{index}");
        }
        assert_ne!(without, with);
    }

    #[test]
    fn hot_pixels_stay_and_their_noise_does_not() {
        let mut config = twelve_bit();
        config.hot_pixels.median_e_per_s = 20_000.0;
        let sensor = Sensor::new(&config, 65, 48).unwrap();
        let hot: Vec<usize> = sensor.hot_pixels().iter().map(|pixel| pixel.y * 65 + pixel.x).collect();
        let frames: Vec<RawImage> = (0..20).map(|number| frame(&config, number, &[])).collect();
        for (pixel, index) in sensor.hot_pixels().iter().zip(&hot) {
            let expected_e = 20.0 + 0.5 * pixel.rate_e_per_s;
            let mean_dn = frames.iter().map(|raw| f64::from(raw.dn[*index])).sum::<f64>() / 20.0;
            let error_e = ((expected_e + 225.0) / 20.0).sqrt();
            // Five standard errors of twenty frames, plus 3 e⁻ for the rounding of the converter.
            assert!(
                ((mean_dn - 50.3) * 10.0 - expected_e.min(40_000.0)).abs() < 5.0 * error_e + 3.0,
                "{pixel:?}"
            );
        }
        assert_ne!(frames[0], frames[1]);
        config.hot_pixels.seed += 1;
        assert_ne!(Sensor::new(&config, 65, 48).unwrap().hot_pixels(), sensor.hot_pixels());
    }

    /// Flat frames with increasing exposure: the variance grows with the mean by 1/gain (Janesick's photon
    /// transfer).
    #[test]
    fn the_slope_of_variance_over_mean_is_one_over_the_gain() {
        let config = SensorConfig {
            gain_e_per_dn: 4.0,
            background_e_per_s: 2000.0,
            dark_current_e_per_s: 0.0,
            hot_pixels: Default::default(),
            ..twelve_bit()
        };
        let sensor = Sensor::new(&config, 512, 512).unwrap();
        let (mut image, mut raw, mut sampler) =
            (sensor.new_expected(), sensor.new_raw(), sensor.new_sampler());
        let mut moments = |exposure_s: f64| {
            let (mut sum, mut squares, mut n) = (0.0, 0.0, 0.0);
            for number in 0..4 {
                image.clear(sensor.sky_electrons(exposure_s));
                let charge = sensor.collect(&mut image, &interval(exposure_s));
                let collected = FrameCharge { charge: &charge, seed: SEED, frame: number + 1000 };
                sensor.read_out(&collected, &mut sampler, &mut raw).unwrap();
                for dn in &raw.dn {
                    let dn = f64::from(*dn) - 50.0;
                    (sum, squares, n) = (sum + dn, squares + dn * dn, n + 1.0);
                }
            }
            let mean = sum / n;
            (mean, squares / n - mean * mean)
        };
        let ((low_mean, low_variance), (high_mean, high_variance)) = (moments(0.05), moments(4.0));
        let slope = (high_variance - low_variance) / (high_mean - low_mean);
        // A million pixels determine a variance to sqrt(2/n) = 0.14 %; half a percent is three and a half
        // times that.
        assert!((slope * 4.0 - 1.0).abs() < 0.005, "slope {slope}");
        // At the lower end: 100 e⁻ and 15² e⁻² over 4², plus 1/12 for rounding.
        assert!((low_variance / (325.0 / 16.0 + 1.0 / 12.0) - 1.0).abs() < 0.007, "{low_variance}");
    }

    #[test]
    fn pixels_without_charge_spread_by_the_noise_of_the_readout() {
        let silent = SensorConfig {
            read_noise_e: 6.0,
            background_e_per_s: 0.0,
            dark_current_e_per_s: 0.0,
            hot_pixels: Default::default(),
            ..twelve_bit()
        };
        let dn = frame(&silent, 5, &[]).dn;
        let mean = dn.iter().map(|&dn| f64::from(dn)).sum::<f64>() / dn.len() as f64;
        let variance = dn.iter().map(|&dn| (f64::from(dn) - mean) * (f64::from(dn) - mean)).sum::<f64>();
        let spread_e = 10.0 * (variance / dn.len() as f64).sqrt();
        // 3120 pixels determine a standard deviation to 1.3 %; without the rounding it would be 10 % smaller.
        let expected_e = Sensor::new(&silent, 65, 48).unwrap().readout_noise_e();
        assert!((spread_e / expected_e - 1.0).abs() < 0.045, "{spread_e}, expected {expected_e}");
        let lines = LineNoiseConfig { row_e: 3.0, column_e: 2.0 };
        let noise_e =
            Sensor::new(&SensorConfig { line_noise: lines, ..silent }, 65, 48).unwrap().readout_noise_e();
        assert!((noise_e - (36.0 + 9.0 + 4.0 + 100.0 / 12.0_f64).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn every_bit_depth_reaches_its_full_scale_and_no_more() {
        for bit_depth in 8..=16 {
            let config = SensorConfig { bit_depth, full_well_e: 1e8, ..twelve_bit() };
            let raw = frame(&config, 3, &[1e9]);
            assert_eq!(raw.dn.iter().max(), Some(&config.full_scale_dn()));
        }
    }

    #[test]
    fn without_shot_and_read_noise_the_frame_is_the_expectation() {
        let mut config = twelve_bit();
        (config.noise.shot, config.noise.read) = (Switch::Off, Switch::Off);
        config.hot_pixels.count = 0;
        let raw = frame(&config, 3, &[]);
        // 20 e⁻ (sky 15, dark 5) at 10 e⁻/DN over a bias of 50.3, rounded.
        assert!(raw.dn.iter().all(|dn| *dn == 52));
    }

    fn blooming(config: SensorConfig, spill_fraction: f64) -> SensorConfig {
        SensorConfig { blooming: Some(BloomingConfig { spill_fraction }), ..config }
    }

    #[test]
    fn blooming_changes_nothing_but_columns_that_overflow_and_keeps_their_charge() {
        // Without read noise and with one electron per digital number, the digital numbers are the electrons.
        let config = SensorConfig {
            bit_depth: 16,
            gain_e_per_dn: 1.0,
            bias_dn: 0.0,
            full_well_e: 5000.0,
            read_noise_e: 0.0,
            ..twelve_bit()
        };
        let stars_e = [1e3, 1e4, 6e4];
        let deep = SensorConfig { full_well_e: 60_000.0, ..config.clone() };
        let (without, bloomed) = (frame(&deep, 1, &stars_e), frame(&blooming(config, 1.0), 1, &stars_e));
        let mut changed = vec![];
        for x in 0..65 {
            let column =
                |raw: &RawImage| -> Vec<u16> { raw.dn.iter().skip(x).step_by(65).copied().collect() };
            let (before, after) = (column(&without), column(&bloomed));
            assert!(after.iter().all(|&e| e <= 5000));
            if before != after {
                changed.push(x);
                let full = after.iter().filter(|&&e| e == 5000).count();
                let over = before.iter().filter(|&&e| e > 5000).count();
                assert!(over > 0 && full > over);
                // A flat pixel that receives charge is redrawn at its own address: at most as many pixels as
                // are full, each with twice the variance of its 20 electrons.
                let sum = |column: &[u16]| column.iter().map(|&e| f64::from(e)).sum::<f64>();
                let tolerance = 5.0 * (2.0 * 20.0 * (full + 2) as f64).sqrt();
                assert!((sum(&before) - sum(&after)).abs() < tolerance, "column {x}");
            }
        }
        // The brightest star, at x = 32.3.
        assert_eq!(changed, [32, 33]);
    }

    #[test]
    fn an_overflowing_flat_frame_is_full_with_drains_and_without() {
        let config =
            SensorConfig { full_well_e: 10.0, gain_e_per_dn: 1.0, read_noise_e: 0.0, ..twelve_bit() };
        // 20 e⁻ per pixel in a full well of 10: one pixel in 200 collects fewer than 10, and a neighbour
        // fills it.
        let raw = frame(&blooming(config.clone(), 1.0), 1, &[]);
        assert!(raw.dn.iter().all(|&dn| dn == 60));
        let drained = frame(&blooming(config.clone(), 0.0), 1, &[]);
        let lacking = drained.dn.iter().filter(|&&dn| dn < 60).count() as f64 / drained.dn.len() as f64;
        // P(N < 10) at a mean of 20 is 0.0050; 3120 pixels determine it to 0.0013.
        assert!((lacking - 0.005).abs() < 0.005, "{lacking}");
        assert!(drained.dn.iter().all(|&dn| dn <= 60));
    }

    #[test]
    fn a_frame_that_does_not_overflow_is_the_same_with_blooming() {
        let stars_e = [500.0, 5e3, 5e4];
        assert_eq!(frame(&twelve_bit(), 4, &stars_e), frame(&blooming(twelve_bit(), 1.0), 4, &stars_e));
    }

    #[test]
    fn an_image_of_another_size_is_refused() {
        let sensor = Sensor::new(&twelve_bit(), 65, 48).unwrap();
        let mut image = ExpectedImage::new(64, 48);
        let charge = sensor.collect(&mut image, &interval(1.0));
        let mut raw = sensor.new_raw();
        let collected = FrameCharge { charge: &charge, seed: SEED, frame: 0 };
        assert!(sensor.read_out(&collected, &mut sensor.new_sampler(), &mut raw).is_err());
    }
}
