//! Dark pixels above a floor: selection without a draw of every pixel.
//!
//! A camera that keeps regions around bright pixels examines a pixel if its digital number is above a floor,
//! the camera's threshold, or if it lies in a region. Most pixels are neither, and need no number. To make a
//! partly drawn frame *equal* to the whole frame wherever it is examined, a frame with a floor is defined by
//! two steps:
//!
//! 1. *Dark pixels that exceed the floor.* A pixel is dark if its mean is at most the limit λ₀ of its row,
//!    which is the largest mean of the row's background, clamped between the means that exceed the floor with
//!    probabilities of 1 in 2^20 and 1 in 64. No dark pixel exceeds the floor with a higher probability than
//!    p₀ = p(λ₀). Candidates occur with probability p₀ per pixel, with geometric gaps (Devroye, Non-Uniform
//!    Random Variate Generation, 1986, X.2): their number is binomial, their positions uniform. A dark
//!    candidate of mean λ is kept with the probability p(λ)/p₀ (PRNU, DSNU and gradients give every pixel an
//!    individual mean), and gets a number from its distribution above the floor ([`Exceedance`]).
//! 2. *All other pixels.* They are drawn as without a floor. A dark pixel whose number is above the floor,
//!    but which was not selected in the first step, is drawn again until its number is not above the floor:
//!    this gives its distribution conditional on not exceeding the floor.
//!
//! Pixels brighter than λ₀, near sources, are drawn by the second step only. Every pixel therefore has the
//! same distribution as without a floor and, if no pixel exceeds the floor, the same number.
//!
//! The first step costs one candidate per row or fewer. The second can be done separately for any tile: first
//! for the tiles in which a pixel may be brighter than λ₀, then, once the camera has found its regions from
//! the pixels above the floor, for the tiles in its regions.
//!
//! Frames with readout offsets, or of detectors without tables, have no dark pixels: all tiles are drawn.

use draws::{Streams, uniform};
use optics::simd_kernel::SimdKernel;
use pulp::Simd;
use render::draw::ExpectedImage;

use super::sparse_image::Pixel;
use super::tiles::TileSet;
use crate::pixel::distribution::PixelDistribution;
use crate::pixel::exceedance::{DarkLimit, Exceedance};
use crate::pixel::sampler::PixelSampler;
use crate::pixel::words::PixelStreams;

/// Dark pixels of a frame: their limit in each row, and those above the floor. Reused from frame to frame.
#[derive(Debug, Default)]
pub(super) struct DarkPixels {
    /// Distribution above the floor, kept from frame to frame.
    exceedance: Option<Exceedance>,
    floor_dn: u16,
    /// Limit of dark pixels in each row; empty if no pixel is dark.
    limits: Vec<DarkLimit>,
    /// Dark pixels above the floor.
    pub(super) exceeding: Vec<Pixel>,
}

impl DarkPixels {
    /// Forgets the pixels of the last frame.
    pub(super) fn clear(&mut self) {
        self.limits.clear();
        self.exceeding.clear();
    }

    /// Prepares the distribution of a detector above a floor.
    pub(super) fn set_floor(&mut self, distribution: &PixelDistribution, floor_dn: u16) {
        self.floor_dn = floor_dn;
        if !self.exceedance.as_ref().is_some_and(|kept| kept.is_valid_for(distribution, floor_dn)) {
            self.exceedance = Some(Exceedance::new(distribution, floor_dn));
        }
    }

    /// Redraws the dark pixels that are above the floor. `means_e` are the means of the pixels of row `y`
    /// from index `first` of the image on, `numbers` their digital numbers.
    #[inline(always)]
    pub(super) fn keep_below_floor(
        &self,
        y: usize,
        first: usize,
        means_e: &[f64],
        numbers: &mut [u16],
        redraw: &mut Redraw<'_>,
    ) {
        let Some(limit) = self.limits.get(y) else { return };
        if numbers.iter().fold(0, |peak, &dn| peak.max(dn)) <= self.floor_dn {
            return;
        }
        for (i, (dn, &mean_e)) in numbers.iter_mut().zip(means_e).enumerate() {
            if *dn > self.floor_dn && mean_e <= limit.mean_e {
                *dn = redraw.below(self.floor_dn, mean_e, first + i);
            }
        }
    }
}

/// Repeated draws of dark pixels.
pub(super) struct Redraw<'a> {
    pub(super) sampler: &'a mut PixelSampler,
    pub(super) streams: &'a PixelStreams,
}

impl Redraw<'_> {
    /// Draws the pixel `index` until its number is not above the floor.
    fn below(&mut self, floor_dn: u16, mean_e: f64, index: usize) -> u16 {
        // A dark pixel exceeds the floor with a probability of at most 1 in 64.
        let mut repeat = 1;
        loop {
            let words = self.streams.repeated_words(index, repeat);
            let dn = self.sampler.draw_directly(mean_e, 0.0, &words);
            if dn <= floor_dn {
                return dn;
            }
            repeat += 1;
        }
    }
}

/// Task of the first step, and of selecting the tiles for the second step.
pub(super) struct DarkPixelScan<'a> {
    pub(super) expected: &'a ExpectedImage,
    /// Random numbers of the candidates, by row.
    pub(super) candidates: Streams,
    pub(super) dark: &'a mut DarkPixels,
    pub(super) wanted: &'a mut TileSet,
}

impl SimdKernel for DarkPixelScan<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { expected, candidates, dark, wanted } = self;
        let DarkPixels { exceedance: Some(exceedance), limits, exceeding, .. } = dark else { return };
        let (columns, rows) = expected.size();
        for y in 0..rows {
            let bound_e = expected.row_bound_e(y);
            let limit = exceedance.dark_limit(bound_e);
            limits.push(limit);
            thin_row(expected, y, limit, exceedance, &candidates, exceeding);
            if bound_e > limit.mean_e {
                wanted.add_columns(y, 0, columns);
            } else {
                expected.for_tiles_that_may_rise_above(simd, y, bound_e, limit.mean_e, |first, tiles| {
                    wanted.add(y, first, tiles);
                });
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

#[cfg(test)]
mod tests {
    use crate::config::tests::{interval, twelve_bit};
    use crate::pixel::distribution::tests::{chi_square_p, from_zero};
    use crate::{BloomingConfig, FixedPatternConfig, FrameCharge, LineNoiseConfig, Sensor, SensorConfig};
    use contract::Window;
    use draws::Seed;

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
        let mut sampler = sensor.new_sampler();
        let mut draw = |windows: &[Window]| {
            let mut sparse = sensor.new_sparse();
            // Remainder of an earlier frame.
            sparse.full_image().dn.fill(4095);
            sensor.read_out_above(floor_dn, &collected, &mut sampler, &mut sparse).unwrap();
            sensor.read_out_windows(windows, &collected, &mut sampler, &mut sparse).unwrap();
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
            let (mut sampler, mut image, mut sparse) =
                (sensor.new_sampler(), sensor.new_expected(), sensor.new_sparse());
            for floor_dn in [62, 64, 66, 70] {
                let mut drawn = [[0_usize; 4096]; 2];
                for number in 0..frames {
                    image.clear(sensor.sky_electrons(1.0));
                    // Every third pixel is brighter than the background.
                    (0..64).for_each(|y| (0..128).step_by(3).for_each(|x| image.add_pixel(x, y, 8.0)));
                    let charge = sensor.collect(&mut image, &interval(1.0));
                    let collected = FrameCharge { charge: &charge, seed: SEED, frame: number };
                    sensor.read_out_above(floor_dn, &collected, &mut sampler, &mut sparse).unwrap();
                    let whole = Window { x: 0, y: 0, columns: 128, rows: 64 };
                    sensor.read_out_windows(&[whole], &collected, &mut sampler, &mut sparse).unwrap();
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

    /// Full version: `cargo test --release -p boresight-sensor --lib floor -- --ignored`, half a minute of
    /// CPU time.
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
            let collected = FrameCharge { charge: &charge, seed: SEED, frame: 3 };
            sensor.read_out(&collected, &mut sensor.new_sampler(), &mut raw).unwrap();
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
}
