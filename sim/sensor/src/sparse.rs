//! Frames of which only the pixels that the camera examines are drawn.
//!
//! A camera that keeps regions around bright pixels examines a pixel if its digital number is above a floor,
//! the camera's threshold, or if it lies in a region. Most pixels are neither, and need no number. To make a
//! partly drawn frame *equal* to the whole frame wherever it is examined, the whole frame is defined by two
//! steps:
//!
//! 1. *Dark pixels that exceed the floor.* A pixel is dark if its mean is at most the limit λ₀ of its row,
//!    which is the largest mean of the row's background, clamped between the means that exceed the floor with
//!    probabilities of 1 in 2^20 and 1 in 64. No dark pixel exceeds the floor with a higher probability than
//!    p₀ = p(λ₀). Candidates occur with probability p₀ per pixel, with geometric gaps (Devroye, Non-Uniform
//!    Random Variate Generation, 1986, X.2): their number is binomial, their positions uniform. A dark
//!    candidate of mean λ is kept with the probability p(λ)/p₀ (PRNU, DSNU and gradients give every pixel an
//!    individual mean), and gets a number from its distribution above the floor ([`Exceedance`]).
//! 2. *All other pixels.* They are drawn from the words of their row, as without a floor. A dark pixel whose
//!    number is above the floor, but which was not selected in the first step, is redrawn until its number is
//!    not above the floor: this gives its distribution conditional on not exceeding the floor.
//!
//! Pixels brighter than λ₀, near sources, are drawn by the second step only. Every pixel therefore has the
//! same distribution as without a floor and, if no pixel exceeds the floor, the same number.
//!
//! The first step costs one candidate per row or fewer. The second can be done separately for any part of 16
//! pixels of a row: first for the parts in which a pixel may be brighter than λ₀, then, once the camera has
//! found its regions from the pixels above the floor, for the parts in its regions. In either case,
//! overflowing charge is drawn column by column from the pixels' own addresses.
//!
//! Frames with noise or offsets of rows or columns, of detectors without shot noise, or with high flat levels
//! are not drawn from tables: all their pixels are drawn directly.

use contract::Window;
use draws::{Effect, GeneratorLanes, LANES, Seed, Streams, uniform};
use optics::simd_kernel::{SimdKernel, arch, run_widest};
use pulp::Simd;
use render::draw::{ExpectedImage, PART, PARTS, set_bits};
use truth::SimError;

use super::blooming::Overflow;
use super::charge::Charge;
use super::detector::Sensor;
use super::exceedance::{DarkLimit, Exceedance};
use super::flat_samplers::FlatSamplers;
use super::mean_tables::{MeanTables, Words};
use super::pixel_distribution::PixelDistribution;
use super::sparse_image::{Parts, Pixel, SparseImage, pixels};

/// Inputs from which a frame is read out.
pub struct FrameCharge<'a> {
    /// Charge of the pixels.
    pub charge: &'a Charge<'a>,
    /// Seed of the readout.
    pub seed: Seed,
    /// Number of the frame.
    pub frame: u64,
}

impl Sensor {
    /// Returns a raw image with no pixels drawn.
    pub fn new_sparse(&self) -> SparseImage {
        SparseImage::new(self.new_raw())
    }

    /// Draws every pixel whose digital number is above `floor_dn`.
    ///
    /// # Errors
    /// See [`Sensor::read_out`].
    pub fn read_out_above(
        &self,
        floor_dn: u16,
        collected: &FrameCharge<'_>,
        samplers: &mut FlatSamplers,
        image: &mut SparseImage,
    ) -> Result<(), SimError> {
        let &FrameCharge { charge, seed, frame } = collected;
        let expected = charge.expected();
        image.clear();
        image.floor_dn = floor_dn;
        if !self.has_tables_for(expected) || self.has_line_offsets() {
            return self.read_out(charge, &seed, frame, samplers, image.full_image());
        }
        self.check_size(expected)?;
        let streams = &seed.streams(frame, Effect::Exceedance);
        let exceedance = samplers.exceedance(&self.distribution, floor_dn);
        run_widest(CandidateScan { expected, exceedance, streams, rows: self.rows, image });
        self.draw_requested(collected, samplers, image);
        if let Some(blooming) = &self.config().blooming {
            let streams = seed.streams(frame, Effect::PixelNoise);
            self.bloom(&Overflow { blooming, expected, offsets: None, streams: &streams }, |index, dn| {
                image.bloomed.push(Pixel { index, dn });
            });
        }
        image.set_single_pixels();
        Ok(())
    }

    /// Draws all pixels in some windows of a frame whose pixels above a floor were drawn by
    /// [`Sensor::read_out_above`].
    pub fn read_out_windows(
        &self,
        windows: &[Window],
        collected: &FrameCharge<'_>,
        samplers: &mut FlatSamplers,
        image: &mut SparseImage,
    ) {
        for window in windows {
            let right = window.x + window.columns;
            for y in window.y..window.y + window.rows {
                image.requested.add_columns(y, window.x, right);
            }
        }
        self.draw_requested(collected, samplers, image);
        image.set_single_pixels();
    }

    /// Draws the requested parts that are not drawn yet.
    fn draw_requested(
        &self,
        collected: &FrameCharge<'_>,
        samplers: &mut FlatSamplers,
        image: &mut SparseImage,
    ) {
        let &FrameCharge { charge, seed, frame } = collected;
        let expected = charge.expected();
        let (words, again) =
            (seed.streams(frame, Effect::PixelNoise), seed.streams(frame, Effect::Exceedance));
        let (distribution, columns, rows) = (&self.distribution, self.columns, self.rows);
        let task = Task { distribution, expected, words: &words, again: &again, columns, rows };
        let tables = samplers.mean_tables(distribution);
        // Identical steps on every machine, on its widest registers.
        arch().dispatch(MeanTableParts { task, tables, image });
    }
}

/// Task of the first step, and of selecting the parts for the second step.
struct CandidateScan<'a> {
    expected: &'a ExpectedImage,
    exceedance: &'a mut Exceedance,
    streams: &'a Streams,
    rows: usize,
    image: &'a mut SparseImage,
}

impl SimdKernel for CandidateScan<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { expected, exceedance, streams, rows, image } = self;
        for y in 0..rows {
            let bound_e = expected.row_bound_e(y);
            let limit = exceedance.dark_limit(bound_e);
            image.limits.push(limit);
            thin_row(expected, y, limit, exceedance, streams, &mut image.exceeding);
            if bound_e > limit.mean_e {
                image.requested.add_columns(y, 0, expected.size().0);
                continue;
            }
            if !expected.is_row_lit(y) {
                continue;
            }
            for p in 0..expected.size().0.div_ceil(PARTS * PART) {
                let parts = expected.parts_that_may_rise_above(simd, y, p, bound_e, limit.mean_e);
                image.requested.add(y, p * PARTS, parts);
            }
        }
    }
}

/// Appends the dark pixels of a row that are above the floor.
#[inline(always)]
fn thin_row(
    expected: &ExpectedImage,
    y: usize,
    limit: DarkLimit,
    exceedance: &mut Exceedance,
    streams: &Streams,
    exceeding: &mut Vec<Pixel>,
) {
    let columns = expected.size().0;
    if limit.probability <= 0.0 {
        return;
    }
    // P(no candidate) = (1 − p)ⁿ ≥ 1 − n p: nearly all rows need only the first number of their stream.
    if streams.first_uniform(y as u64) <= 1.0 - columns as f64 * limit.probability {
        return;
    }
    let mut stream = streams.stream_at(y as u64);
    let mut level = uniform(&mut stream);
    let per_pixel = libm::log1p(-limit.probability);
    let mut x = 0.0;
    loop {
        x += (libm::log(level) / per_pixel).floor();
        if x >= columns as f64 {
            return;
        }
        let mean_e = expected.electrons_at(x as usize, y);
        let levels = std::array::from_fn(|_| uniform(&mut stream));
        if mean_e <= limit.mean_e
            && let Some(dn) = exceedance.thin(mean_e, limit, levels)
        {
            exceeding.push(Pixel { index: y * columns + x as usize, dn });
        }
        x += 1.0;
        level = uniform(&mut stream);
    }
}

/// Inputs from which the parts of a frame are drawn.
#[derive(Clone, Copy)]
struct Task<'a> {
    distribution: &'a PixelDistribution,
    expected: &'a ExpectedImage,
    /// Random streams of rows and pixels.
    words: &'a Streams,
    /// Random streams for redrawing dark pixels.
    again: &'a Streams,
    columns: usize,
    rows: usize,
}

impl Task<'_> {
    /// Address of a pixel's own stream; the addresses before it belong to the rows.
    #[inline(always)]
    fn stream_index(&self, index: usize) -> u64 {
        (self.rows + index) as u64
    }

    /// Redraws the dark pixels that are above the floor; `means_e` are the means of the pixels from index
    /// `first` on.
    #[inline(always)]
    fn keep_dark_pixels_below(
        &self,
        floor_dn: u16,
        limit: DarkLimit,
        first: usize,
        means_e: &[f64],
        dn: &mut [u16],
    ) {
        if dn.iter().fold(0, |peak, &dn| peak.max(dn)) <= floor_dn {
            return;
        }
        for (i, (dn, &mean_e)) in dn.iter_mut().zip(means_e).enumerate() {
            if *dn > floor_dn && mean_e <= limit.mean_e {
                let mut stream = self.again.stream_at(self.stream_index(first + i));
                // A dark pixel exceeds the floor with a probability of at most 1 in 64.
                while *dn > floor_dn {
                    *dn = self.distribution.sample(mean_e.max(0.0), 0.0, &mut stream);
                }
            }
        }
    }
}

/// Number of parts processed together: first their means, then their words, then their numbers. Each of these
/// reads a different area of memory, and several accesses of one kind overlap in time.
const BATCH: usize = 32;

/// Task of drawing the requested parts of a detector in which every pixel has an individual mean.
struct MeanTableParts<'a> {
    task: Task<'a>,
    tables: &'a mut MeanTables,
    image: &'a mut SparseImage,
}

impl pulp::WithSimd for MeanTableParts<'_> {
    type Output = ();

    // Everything is inlined: only then is it compiled for the registers of the machine.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { task, tables, image } = self;
        let SparseImage { raw, drawn, requested, to_draw, limits, floor_dn, .. } = image;
        to_draw.clear();
        // Without limits, all pixels are drawn already.
        for y in 0..limits.len() {
            let rows = requested.row(y).iter().zip(drawn.row_mut(y));
            for (i, (requested, drawn)) in
                rows.enumerate().filter(|(_, (requested, drawn))| **requested & !**drawn != 0)
            {
                to_draw.extend(set_bits(requested & !*drawn).map(|bit| (y, i * Parts::OF_A_WORD + bit)));
                *drawn |= *requested;
            }
        }
        let mut means_e = [[0.0; PART]; BATCH];
        let mut words: [Words<PART>; BATCH] = std::array::from_fn(|_| Words::new());
        let (mut lanes, mut of_row, mut next) = (GeneratorLanes::from_streams(task.words, 0), 0, 0);
        for parts in to_draw.chunks(BATCH) {
            for (&(y, part), means_e) in parts.iter().zip(&mut means_e) {
                let length = pixels(task.columns, y, part).len();
                task.expected.part::<PART>(y, part, &mut means_e[..length]);
            }
            for (&(y, part), words) in parts.iter().zip(&mut words) {
                if y != of_row {
                    (lanes, of_row, next) = (GeneratorLanes::from_streams(task.words, y as u64), y, 0);
                }
                lanes.skip(simd, (part - next) * PART / LANES);
                next = part + 1;
                words.draw(simd, &mut lanes);
            }
            for ((&(y, part), words), means_e) in parts.iter().zip(&words).zip(&means_e) {
                let pixels = pixels(task.columns, y, part);
                let (first, means_e) = (pixels.start, &means_e[..pixels.len()]);
                let row = &mut raw.dn[pixels];
                let pixel_stream = |i: usize| task.words.stream_at(task.stream_index(first + i));
                tables.draw_piece(means_e, words, row, pixel_stream);
                task.keep_dark_pixels_below(*floor_dn, limits[y], first, means_e, row);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::config::tests::{interval, twelve_bit};
    use super::super::pixel_distribution::tests::{chi_square_p, from_zero};
    use super::super::{BloomingConfig, FixedPatternConfig, LineNoiseConfig, SensorConfig};
    use super::*;

    const SEED: Seed = Seed { seed: 44, case: 0 };

    /// Returns a detector with a gain of 2 e⁻/DN and a sky of 20 e⁻: background pixels have 60.3 DN and a
    /// noise of 2.7 DN.
    fn detector(prnu_fraction: f64) -> SensorConfig {
        SensorConfig {
            gain_e_per_dn: 2.0,
            read_noise_e: 3.0,
            full_well_e: 7000.0,
            background_e_per_s: 20.0,
            dark_current_e_per_s: 0.0,
            hot_pixels: Default::default(),
            blooming: Some(BloomingConfig { spill_fraction: 1.0 }),
            fixed_pattern: FixedPatternConfig { prnu_fraction, ..Default::default() },
            ..twelve_bit()
        }
    }

    /// Returns frame `number` of a detector of 301 × 60 pixels with bright pixels, one of which overflows:
    /// drawn above `floor_dn` only, in `windows`, and as a whole.
    fn frames(config: &SensorConfig, number: u64, floor_dn: u16, windows: &[Window]) -> [Vec<u16>; 3] {
        let sensor = Sensor::new(config, 301, 60).unwrap();
        let mut image = sensor.new_expected();
        image.clear(sensor.sky_electrons(1.0));
        (0..60).for_each(|y| image.add_pixel(5 * y, y, libm::exp(0.16 * y as f64)));
        let charge = sensor.collect(&mut image, &interval(1.0));
        let collected = FrameCharge { charge: &charge, seed: SEED, frame: number };
        let mut samplers = FlatSamplers::new();
        let mut draw = |windows: &[Window]| {
            let mut sparse = sensor.new_sparse();
            // Remainder of an earlier frame.
            sparse.full_image().dn.fill(4095);
            sensor.read_out_above(floor_dn, &collected, &mut samplers, &mut sparse).unwrap();
            sensor.read_out_windows(windows, &collected, &mut samplers, &mut sparse);
            let mut from_runs = vec![0; sparse.raw.dn.len()];
            sparse.runs().for_each(|(first, run)| from_runs[first..first + run.len()].copy_from_slice(run));
            assert_eq!(from_runs, sparse.raw.dn);
            sparse.raw.dn
        };
        let whole = Window { x: 0, y: 0, columns: 301, rows: 60 };
        [draw(&[]), draw(windows), draw(&[whole])]
    }

    #[test]
    fn a_sparse_frame_is_the_whole_frame_wherever_anybody_looks() {
        let windows = [(0, 0, 20, 8), (55, 3, 20, 8), (60, 7, 9, 9), (281, 52, 20, 8)]
            .map(|(x, y, columns, rows)| Window { x, y, columns, rows });
        // Floors below the background, within its noise and above the background.
        for floor_dn in [55, 62, 65, 68, 72, 90, 300, 4095] {
            for (config, number) in [(detector(0.02), 0), (detector(0.3), 1), (detector(0.0), 2)] {
                let [above, seen, all] = frames(&config, number, floor_dn, &windows);
                for (index, &dn) in all.iter().enumerate() {
                    let (x, y) = (index % 301, index / 301);
                    assert!(
                        dn == above[index] || dn <= floor_dn && above[index] <= floor_dn,
                        "{x}, {y} over {floor_dn}"
                    );
                    let is_seen = windows.iter().any(|window| window.contains(x, y));
                    assert!(dn == seen[index] || dn <= floor_dn && !is_seen, "{x}, {y} over {floor_dn}");
                }
                // High floors save draws, except for a detector whose brightest background pixels exceed
                // them.
                if floor_dn >= 72 && number != 1 {
                    assert!(seen.iter().filter(|dn| **dn == 0).count() > all.len() / 2);
                }
            }
        }
    }

    /// Checks that a floor does not change the distribution of any pixel, for this number of frames and for
    /// floors that are exceeded with probabilities from 1 in 3 to 1 in 10^4.
    fn assert_the_distribution_over_floors(frames: u64) {
        for (config, means) in [(detector(0.0), [20.0, 28.0]), (detector(1e-9), [20.0, 28.0])] {
            let sensor = Sensor::new(&config, 128, 64).unwrap();
            let (mut samplers, mut image, mut sparse) =
                (FlatSamplers::new(), sensor.new_expected(), sensor.new_sparse());
            for floor_dn in [62, 64, 66, 70] {
                let mut drawn = [[0_usize; 4096]; 2];
                for number in 0..frames {
                    image.clear(sensor.sky_electrons(1.0));
                    // Every third pixel is brighter than the background.
                    (0..64).for_each(|y| (0..128).step_by(3).for_each(|x| image.add_pixel(x, y, 8.0)));
                    let charge = sensor.collect(&mut image, &interval(1.0));
                    let collected = FrameCharge { charge: &charge, seed: SEED, frame: number };
                    sensor.read_out_above(floor_dn, &collected, &mut samplers, &mut sparse).unwrap();
                    let whole = Window { x: 0, y: 0, columns: 128, rows: 64 };
                    sensor.read_out_windows(&[whole], &collected, &mut samplers, &mut sparse);
                    for (index, &dn) in sparse.raw.dn.iter().enumerate() {
                        drawn[usize::from(index % 128 % 3 == 0)][usize::from(dn)] += 1;
                    }
                }
                for (drawn, mean_e) in drawn.into_iter().zip(means) {
                    let p = chi_square_p(&drawn, &from_zero(&sensor.distribution.probabilities(mean_e, 0)));
                    // Sixteen tests.
                    assert!(p > 1e-4, "{mean_e} e⁻ over {floor_dn}: p = {p}");
                }
            }
        }
    }

    #[test]
    fn pixels_have_the_same_distribution_with_a_floor_and_without() {
        assert_the_distribution_over_floors(60);
    }

    /// Full version: `cargo test --release -p boresight-sim --lib floor -- --ignored`, half a minute of CPU
    /// time.
    #[test]
    #[ignore = "8e8 draws: for a scheduled job"]
    fn pixels_have_the_same_distribution_with_a_floor_and_without_in_a_hundred_million_draws() {
        assert_the_distribution_over_floors(12_208);
    }

    #[test]
    fn a_floor_that_nothing_exceeds_changes_no_pixel() {
        for config in [detector(0.02), detector(0.0)] {
            let sensor = Sensor::new(&config, 301, 60).unwrap();
            let mut image = sensor.new_expected();
            image.clear(sensor.sky_electrons(1.0));
            (0..60).for_each(|y| image.add_pixel(5 * y, y, libm::exp(0.16 * y as f64)));
            let charge = sensor.collect(&mut image, &interval(1.0));
            let mut raw = sensor.new_raw();
            sensor.read_out(&charge, &SEED, 3, &mut FlatSamplers::new(), &mut raw).unwrap();
            assert_eq!(frames(&config, 3, 100, &[])[2], raw.dn);
        }
    }

    #[test]
    fn without_a_table_every_pixel_is_drawn_directly() {
        let config =
            SensorConfig { line_noise: LineNoiseConfig { row_e: 2.0, column_e: 0.0 }, ..detector(0.02) };
        let [above, _, all] = frames(&config, 4, 100, &[]);
        assert_eq!(above, all);
    }

    #[test]
    fn the_registers_of_the_machine_change_no_bit() {
        let sensor = Sensor::new(&detector(0.02), 301, 40).unwrap();
        let mut image = sensor.new_expected();
        image.clear(sensor.sky_electrons(1.0));
        (0..40).for_each(|y| image.add_pixel(7 * y, y, libm::exp(0.2 * y as f64)));
        let charge = sensor.collect(&mut image, &interval(1.0));
        let expected = charge.expected();
        let (words, again) = (SEED.streams(3, Effect::PixelNoise), SEED.streams(3, Effect::Exceedance));
        let draw = |registers: pulp::Arch| {
            let (mut image, mut samplers) = (sensor.new_sparse(), FlatSamplers::new());
            image.floor_dn = 65;
            let limit = samplers.exceedance(&sensor.distribution, 65).dark_limit(22.0);
            image.limits.resize(40, limit);
            (0..40).for_each(|y| image.requested.add(y, y % 2, 0x2_5555));
            let task = Task {
                distribution: &sensor.distribution,
                expected,
                words: &words,
                again: &again,
                columns: 301,
                rows: 40,
            };
            let tables = samplers.mean_tables(&sensor.distribution);
            registers.dispatch(MeanTableParts { task, tables, image: &mut image });
            image.raw.dn
        };
        for registers in optics::simd_kernel::registers::registers() {
            assert!(draw(registers) == draw(pulp::Arch::Scalar), "{registers:?}");
        }
    }
}
