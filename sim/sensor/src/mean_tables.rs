//! Distributions of pixels with individual means: tables on a grid of means.
//!
//! Poisson(λ) is Poisson(λₖ) plus an independent n from Poisson(λ − λₖ), where λₖ is the next lower mean of a
//! fixed grid. The grid is so fine that n is nearly always 0: the digital number is then drawn from the table
//! of λₖ. For n of 1 and 2 there are separate tables; the few larger n are drawn with the direct sampler, at
//! the pixel's own address.
//!
//! Pixels are drawn in pieces, with three short loops over each piece: the index of each pixel's cell, the
//! cell, the digital number. The first and the last loop apply the same arithmetic to all pixels, so wide
//! registers process many at once.

use draws::{GeneratorLanes, LANES, Stream};
use pulp::Simd;
use render::draw::{PART, PIECE};

use super::alias::AliasTable;
use super::pixel_distribution::PixelDistribution;
use super::poisson_digits::by_inversion;

/// Tables for the means of the grid, made on first use: 3072 tables of at most
/// [`MeanTables::MAX_TABLE_WIDTH_DN`] digital numbers, 25 MB.
#[derive(Debug, Clone)]
pub(super) struct MeanTables {
    distribution: PixelDistribution,
    /// Binary logarithm of the number of cells of a table.
    log2_cells: u32,
    /// Packed cells of the tables, by mean in quarters of an electron, then by n; 0 in tables that are not
    /// made yet and in one additional table.
    cells: Vec<u64>,
}

/// Upper end of the grid, electrons.
const END_E: f64 = 256.0;
/// Number of tables per mean: with 0, 1 and 2 extra electrons.
const TABLES_PER_MEAN: usize = 3;
/// Number of tables of the grid.
const TABLES: usize = 4 * END_E as usize * TABLES_PER_MEAN;
/// Upper end of the grid, in quarters of an electron.
const QUARTERS: f32 = 4.0 * END_E as f32;
const TWO_TO_23: f32 = 8_388_608.0;
const TWO_TO_24: f32 = 16_777_216.0;

impl MeanTables {
    /// Maximum number of digital numbers in a table.
    const MAX_TABLE_WIDTH_DN: f64 = 1024.0;

    /// Creates the grid without any tables.
    pub(super) fn new(distribution: &PixelDistribution) -> Self {
        // A distribution covers as many numbers as its width, and one more at each end; n shifts it by up to
        // two electrons without widening it.
        let cells = (distribution.width_dn(END_E).clamp(0.0, Self::MAX_TABLE_WIDTH_DN) as usize + 3)
            .next_power_of_two();
        Self {
            distribution: *distribution,
            log2_cells: cells.trailing_zeros(),
            cells: vec![0; (TABLES + 1) * cells],
        }
    }

    /// Mean from which on pixels are not drawn from the grid, electrons; 0 if the tables of this distribution
    /// would be too wide.
    pub(super) fn end_e(distribution: &PixelDistribution) -> f64 {
        if distribution.width_dn(END_E) <= Self::MAX_TABLE_WIDTH_DN { END_E } else { 0.0 }
    }

    /// Draws the pixels of a row, each with its mean, electrons (a negative mean counts as 0), from the words
    /// of `lanes`, one per pixel. `pixel_stream` returns the stream at a pixel's own address.
    #[inline(always)]
    pub(super) fn draw_row<S: Simd>(
        &mut self,
        simd: S,
        means_e: &[f64],
        mut lanes: GeneratorLanes,
        row: &mut [u16],
        pixel_stream: impl Fn(usize) -> Stream,
    ) {
        let mut words = Words::<PIECE>::new();
        for (p, (row, means_e)) in row.chunks_mut(PIECE).zip(means_e.chunks(PIECE)).enumerate() {
            words.draw(simd, &mut lanes);
            self.draw_piece(means_e, &words, row, |i| pixel_stream(p * PIECE + i));
        }
    }

    /// Draws at most `N` adjacent pixels of a row from their words; see [`MeanTables::draw_row`].
    #[inline(always)]
    pub(super) fn draw_piece<const N: usize>(
        &mut self,
        means_e: &[f64],
        words: &Words<N>,
        piece: &mut [u16],
        pixel_stream: impl Fn(usize) -> Stream,
    ) {
        let mut means = [0.0; N];
        for (mean, &mean_e) in means.iter_mut().zip(means_e) {
            *mean = mean_e.max(0.0) as f32;
        }
        let mut places = [0; N];
        for i in 0..N {
            places[i] =
                self.table_cell(TableChoice::from_mean(means[i], words.upper[i]).table(), words.lower[i]);
        }
        self.pick(&places, words, means_e, piece, pixel_stream);
    }

    /// [`MeanTables::draw_piece`] for a piece whose pixels, except in the lit parts, have the mean `even`:
    /// the same numbers in less time.
    #[inline(always)]
    pub(super) fn draw_mostly_even_piece(
        &mut self,
        even: &UniformMean,
        is_lit: &[bool],
        means_e: &[f64],
        words: &Words<PIECE>,
        piece: &mut [u16],
        pixel_stream: impl Fn(usize) -> Stream,
    ) {
        let mut places = [0; PIECE];
        for (i, index) in places.iter_mut().enumerate() {
            *index = self.table_cell(even.table(words.upper[i]), words.lower[i]);
        }
        for (part, _) in is_lit.iter().enumerate().filter(|(_, is_lit)| **is_lit) {
            let pixels = part * PART..((part + 1) * PART).min(means_e.len());
            for i in pixels {
                let choice = TableChoice::from_mean(means_e[i].max(0.0) as f32, words.upper[i]);
                places[i] = self.table_cell(choice.table(), words.lower[i]);
            }
        }
        self.pick(&places, words, means_e, piece, pixel_stream);
    }

    /// Sets the numbers of a piece from the indices of their cells; pixels whose cell has no number are drawn
    /// from their mean.
    #[inline(always)]
    fn pick<const N: usize>(
        &mut self,
        places: &[u32; N],
        words: &Words<N>,
        means_e: &[f64],
        piece: &mut [u16],
        pixel_stream: impl Fn(usize) -> Stream,
    ) {
        // The address of the tables is loaded once per piece, not per pixel.
        let all = self.cells.as_slice();
        let Some(last) = all.len().checked_sub(1) else { return };
        let mut cells = [0; N];
        for i in 0..N {
            cells[i] = all[(places[i] as usize).min(last)];
        }
        let (mut levels, mut pairs) = ([0; N], [0; N]);
        for i in 0..N {
            (levels[i], pairs[i]) = halves(cells[i]);
        }
        let mut numbers = [0; N];
        for i in 0..N {
            numbers[i] = self.number(levels[i], pairs[i], words.lower[i]) as u16;
        }
        piece.copy_from_slice(&numbers[..piece.len()]);
        if cells.iter().fold(false, |open, &cell| open | is_open(cell)) {
            for (i, (number, mean_e)) in piece.iter_mut().zip(means_e).enumerate() {
                if is_open(cells[i]) {
                    *number = self.draw(*mean_e, words.word(i), || pixel_stream(i));
                }
            }
        }
    }

    /// Draws the digital number of a pixel with a mean of `mean_e` electrons from a uniform word: its highest
    /// 24 bits determine n, its lower half the digital number. `pixel_stream` returns the stream at
    /// the pixel's own address.
    fn draw(&mut self, mean_e: f64, word: u64, pixel_stream: impl FnOnce() -> Stream) -> u16 {
        let mean = mean_e.max(0.0) as f32;
        let choice = TableChoice::from_mean(mean, (word >> 32) as u32);
        let index = self.table_cell(choice.table(), word as u32) as usize;
        let cell = self.cells.get(index).copied().unwrap_or(0);
        if is_open(cell) {
            return self.draw_open(mean_e, choice, word, pixel_stream());
        }
        let (level, pair) = halves(cell);
        self.number(level, pair, word as u32) as u16
    }

    /// Does the work of [`MeanTables::draw`] for a pixel without a table, or whose table is not made yet.
    #[cold]
    fn draw_open(&mut self, mean_e: f64, choice: TableChoice, word: u64, mut pixel_stream: Stream) -> u16 {
        if choice.quarters >= QUARTERS as i32 {
            return self.distribution.sample(mean_e, 0.0, &mut pixel_stream);
        }
        let node_e = 0.25 * f64::from(choice.quarters);
        if choice.more >= TABLES_PER_MEAN as i32 {
            let u = ((word >> 32) as f64 + 0.5) * (1.0 / 4_294_967_296.0);
            let n = by_inversion(f64::from(choice.rest), u).max(TABLES_PER_MEAN);
            return self.distribution.sample_more(node_e, n as f64, &mut pixel_stream);
        }
        let distribution = self.distribution.probabilities(node_e, choice.more as u32);
        let table =
            AliasTable::with_cells(1 << self.log2_cells, distribution.first_dn, &distribution.probabilities);
        let start = (choice.table() as usize) << self.log2_cells;
        // A distribution with more numbers than a table has cells is not stored: it is recomputed on every
        // draw.
        if table.packed().len() == 1 << self.log2_cells
            && let Some(cells) = self.cells.get_mut(start..start + (1 << self.log2_cells))
        {
            cells.iter_mut().zip(table.packed()).for_each(|(cell, packed)| *cell = packed);
        }
        table.draw(word as u32)
    }

    /// Index of the cell that the lower half of a word selects in a table.
    #[inline(always)]
    fn table_cell(&self, table: u32, lower: u32) -> u32 {
        (table << self.log2_cells) + (lower >> (32 - self.log2_cells))
    }

    /// Digital number that the lower half of a word selects in its cell.
    #[inline(always)]
    fn number(&self, level: u32, pair: u32, lower: u32) -> u32 {
        let side = lower & (u32::MAX >> self.log2_cells);
        if side < level { pair & 0xffff } else { pair >> 16 }
    }
}

/// Words of `N` adjacent pixels, one per pixel, split into halves: a register holds twice as many 32-bit
/// numbers.
pub(super) struct Words<const N: usize> {
    upper: [u32; N],
    lower: [u32; N],
}

impl<const N: usize> Words<N> {
    /// Creates words that are not drawn yet.
    pub(super) fn new() -> Self {
        Self { upper: [0; N], lower: [0; N] }
    }

    /// Draws the next words of a row.
    #[inline(always)]
    pub(super) fn draw<S: Simd>(&mut self, simd: S, lanes: &mut GeneratorLanes) {
        simd.vectorize(DrawWords { words: self, lanes });
    }

    fn word(&self, i: usize) -> u64 {
        u64::from(self.upper[i]) << 32 | u64::from(self.lower[i])
    }
}

/// Arguments of [`Words::draw`] for vectorised code.
struct DrawWords<'a, const N: usize> {
    words: &'a mut Words<N>,
    lanes: &'a mut GeneratorLanes,
}

impl<const N: usize> pulp::WithSimd for DrawWords<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { words: Words { upper, lower }, lanes } = self;
        let (upper, lower) = (upper.as_chunks_mut::<LANES>().0, lower.as_chunks_mut::<LANES>().0);
        lanes.steps(simd, N / LANES, |step, words| {
            for lane in 0..LANES {
                (lower[step][lane], upper[step][lane]) = halves(words[lane]);
            }
        });
    }
}

/// Returns the lower and the upper half of a word or a cell. In a cell they are the threshold below which its
/// first number is selected, and its two numbers.
#[inline(always)]
fn halves(word: u64) -> (u32, u32) {
    (word as u32, (word >> 32) as u32)
}

/// Returns true if a cell has no number, because its table is missing or because the pixel is not drawn from
/// a table.
#[inline(always)]
fn is_open(cell: u64) -> bool {
    cell as u32 == 0
}

/// Table from which a pixel is drawn.
#[derive(Debug, Clone, Copy)]
struct TableChoice {
    /// Mean in quarters of an electron, rounded down, and the remainder, electrons.
    quarters: i32,
    rest: f32,
    /// Number n of electrons drawn from the remainder; [`TABLES_PER_MEAN`] if there are that many or more.
    more: i32,
}

impl TableChoice {
    /// Selects the table for a mean of 0 or more.
    ///
    /// n is resolved to 2^-24, by the highest bits of the upper half of a word, and the mean is rounded to
    /// the 24 bits of its float.
    #[inline(always)]
    fn from_mean(mean: f32, upper: u32) -> Self {
        let (quarters, rest) = grid_node(mean);
        let u = (upper >> 8) as i32 as f32 * (1.0 / TWO_TO_24);
        let at_most = n_at_most(rest);
        let more = i32::from(u >= at_most[0]) + i32::from(u >= at_most[1]) + i32::from(u >= at_most[2]);
        Self { quarters, rest, more }
    }

    /// Index of the table; one past the last table if there is none.
    #[inline(always)]
    fn table(self) -> u32 {
        let known = (self.quarters < QUARTERS as i32) & (self.more < TABLES_PER_MEAN as i32);
        if known { (self.quarters * TABLES_PER_MEAN as i32 + self.more) as u32 } else { TABLES as u32 }
    }
}

/// Precomputed [`Choice`] for many pixels with a common mean.
#[derive(Debug, Clone, Copy)]
pub(super) struct UniformMean {
    /// Index of the table with 0 extra electrons.
    first: u32,
    /// Values of a word's 24 bits from which on there are at least 1, 2 and 3 extra electrons.
    steps: [i32; TABLES_PER_MEAN],
}

impl UniformMean {
    /// Creates the choice for a mean from 0 to [`MeanTables::end_e`], electrons.
    pub(super) fn new(mean_e: f64) -> Self {
        let (quarters, rest) = grid_node(mean_e.max(0.0) as f32);
        // A float represents 24 bits exactly, so a comparison of integers equals a comparison of shares.
        let steps = n_at_most(rest).map(|share| (f64::from(share) * f64::from(TWO_TO_24)).ceil() as i32);
        Self { first: (quarters * TABLES_PER_MEAN as i32) as u32, steps }
    }

    #[inline(always)]
    fn table(&self, upper: u32) -> u32 {
        let u = (upper >> 8) as i32;
        let [one, two, three] = self.steps.map(|step| u >= step);
        if three { TABLES as u32 } else { self.first + u32::from(one) + u32::from(two) }
    }
}

/// Returns the grid node below a mean, in quarters of an electron, and the remainder, electrons.
#[inline(always)]
fn grid_node(mean: f32) -> (i32, f32) {
    // Floor without a float-to-integer conversion, which most machines do for one number at a time: in a sum
    // with 2^23 the last bit counts ones.
    let all = mean * 4.0;
    let all = if all < QUARTERS { all } else { QUARTERS };
    let nearest = (all + TWO_TO_23) - TWO_TO_23;
    let floor = if nearest > all { nearest - 1.0 } else { nearest };
    let quarters = ((floor + TWO_TO_23).to_bits() & 0x7f_ffff) as i32;
    (quarters, mean - 0.25 * floor)
}

/// Probabilities that a mean of `rest` electrons gives none, at most one and at most two.
#[inline(always)]
fn n_at_most(rest: f32) -> [f32; TABLES_PER_MEAN] {
    // Taylor series of exp(−rest): for a remainder of at most ¼ the next term is 1.2e-8.
    let r = -rest;
    let none = 1.0
        + r * (1.0
            + r * (1.0 / 2.0 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * (1.0 / 120.0 + r * (1.0 / 720.0))))));
    let one = none * rest;
    let two = one * (0.5 * rest);
    [none, none + one, none + one + two]
}

#[cfg(test)]
mod tests {
    use super::super::SensorConfig;
    use super::super::config::tests::twelve_bit;
    use super::super::pixel_distribution::tests::{chi_square_p, from_zero, histogram, two_sample_p};
    use super::*;
    use draws::{Effect, Seed};

    /// A gain of 1 e⁻/DN and a low read noise, so single electrons are distinguishable.
    fn distribution() -> PixelDistribution {
        PixelDistribution::new(&SensorConfig { gain_e_per_dn: 1.0, read_noise_e: 1.2, ..twelve_bit() })
    }

    #[test]
    fn pixels_of_different_means_follow_the_distribution_of_the_direct_sampler() {
        let distribution = distribution();
        let mut tables = MeanTables::new(&distribution);
        for (frame, mean_e) in
            [0.0, 0.1, 0.3, 1.0, 17.99, 63.99, 64.0, 65.49, 201.7, 255.99].into_iter().enumerate()
        {
            let streams = Seed { seed: 23, case: 0 }.streams(frame as u64, Effect::PixelNoise);
            let n = 300_000;
            let drawn = histogram((0..n).map(|index| {
                usize::from(tables.draw(mean_e, streams.word(index), || streams.stream_at(n + index)))
            }));
            let p = chi_square_p(&drawn, &from_zero(&distribution.probabilities(mean_e, 0)));
            assert!(p > 1e-4, "mean {mean_e}: p = {p}");
            let mut stream = streams.stream_at(2 * n);
            let sampled =
                histogram((0..n).map(|_| usize::from(distribution.sample(mean_e, 0.0, &mut stream))));
            let p = two_sample_p(&drawn, &sampled);
            assert!(p > 1e-4, "mean {mean_e}: p = {p} against the sampler");
        }
    }

    /// Checks means half-way between the nodes of the grid, where n is least certain. Pearson's test against
    /// the exact distribution, its tails merged to an expected count of ten; one row of draws at a time.
    fn assert_the_distribution_midway(draws: usize) {
        let distribution = distribution();
        let mut tables = MeanTables::new(&distribution);
        let mut row = vec![0; 1000];
        let mut after = 0.0;
        for i in 0..20_u64 {
            // At most one mean per quarter.
            let quarters = (4.0 * 0.1 * libm::pow(2550.0, i as f64 / 19.0)).floor().max(after);
            after = quarters + 1.0;
            let mean_e = 0.25 * quarters + 0.125;
            let streams = Seed { seed: 26, case: i }.streams(0, Effect::PixelNoise);
            let means = vec![mean_e; row.len()];
            let mut counts = vec![0; 4096];
            for y in 0..(draws / row.len()) as u64 {
                let pixel_stream = |x: usize| streams.stream_at((1 << 40) + (y << 10) + x as u64);
                tables.draw_row(
                    pulp::Scalar::new(),
                    &means,
                    GeneratorLanes::from_streams(&streams, y),
                    &mut row,
                    pixel_stream,
                );
                row.iter().for_each(|&dn| counts[usize::from(dn)] += 1);
            }
            let p = chi_square_p(&counts, &from_zero(&distribution.probabilities(mean_e, 0)));
            // Twenty tests.
            assert!(p > 1e-4, "mean {mean_e}: p = {p}");
        }
    }

    #[test]
    fn midway_between_nodes_the_distribution_is_exact() {
        assert_the_distribution_midway(1_000_000);
    }

    /// Full version: `cargo test --release -p boresight-sim --lib midway -- --ignored`, 15 s of CPU time.
    #[test]
    #[ignore = "2e9 draws: for a scheduled job"]
    fn midway_between_nodes_the_distribution_is_exact_in_a_hundred_million_draws() {
        assert_the_distribution_midway(100_000_000);
    }

    #[test]
    fn caching_changes_nothing() {
        let distribution = distribution();
        let mut kept = MeanTables::new(&distribution);
        let streams = Seed { seed: 24, case: 0 }.streams(0, Effect::PixelNoise);
        let mean_e = |index: u64| index as f64 * 0.0937;
        let draw = |tables: &mut MeanTables, index: u64| {
            tables.draw(mean_e(index), streams.word(index), || streams.stream_at(index))
        };
        let all: Vec<u16> = (0..2700).map(|index| draw(&mut kept, index)).collect();
        for index in (0..2700).step_by(61) {
            assert_eq!(draw(&mut MeanTables::new(&distribution), index), all[index as usize]);
        }
    }

    /// Pieces, the last of them short, give the same numbers as single pixels, without tables and with
    /// tables.
    #[test]
    fn a_row_is_drawn_as_its_pixels_are() {
        let distribution = distribution();
        let (mut by_row, mut one_by_one) = (MeanTables::new(&distribution), MeanTables::new(&distribution));
        let streams = Seed { seed: 25, case: 0 }.streams(0, Effect::PixelNoise);
        let means: Vec<f64> = (0..1003).map(|x| f64::from(x) * 0.31 - 2.0).collect();
        let mut row = vec![0; means.len()];
        for y in [0, 0, 1] {
            by_row.draw_row(
                pulp::Scalar::new(),
                &means,
                GeneratorLanes::from_streams(&streams, y),
                &mut row,
                |x| streams.stream_at(10 + x as u64),
            );
            let mut lanes = GeneratorLanes::from_streams(&streams, y);
            let words: Vec<u64> = (0..126).flat_map(|_| lanes.next_words()).collect();
            for (x, (dn, mean_e)) in row.iter().zip(&means).enumerate() {
                assert_eq!(
                    *dn,
                    one_by_one.draw(*mean_e, words[x], || streams.stream_at(10 + x as u64)),
                    "{x}"
                );
            }
        }
    }

    #[test]
    fn wide_tables_are_not_made() {
        assert_eq!(MeanTables::end_e(&distribution()), END_E);
        let wide = SensorConfig { gain_e_per_dn: 0.05, ..twelve_bit() };
        assert_eq!(MeanTables::end_e(&PixelDistribution::new(&wide)), 0.0);
    }
}
