//! Distributions of pixels with individual means: tables on a grid of means.
//!
//! Poisson(λ) is Poisson(λₖ) plus an independent n from Poisson(λ − λₖ), where λₖ is the next lower mean of a
//! fixed grid. The grid is so fine that n is nearly always 0: the digital number is then drawn from the table
//! of λₖ. For n of 1 and 2 there are separate tables; the few larger n are drawn in steps, at the pixel's own
//! address.
//!
//! Pixels are drawn in batches, with three short loops over each batch: the index of each pixel's cell, the
//! cell, the digital number. The first and the last loop apply the same arithmetic to all pixels, so wide
//! registers process many at once.

use std::ops::Range;

use draws::{GeneratorLanes, LANES};
use pulp::{Arch, Simd};
use render::draw::TILE;
use truth::Switch;

use super::alias::AliasTable;
use super::distribution::PixelDistribution;
use super::poisson_digits::by_inversion;

/// Tables for the means of the grid, made on first use: 3072 tables of at most
/// [`MeanTables::MAX_TABLE_WIDTH_DN`] digital numbers, 25 MB. The numbers do not depend on which tables are
/// made already.
#[derive(Debug, Clone)]
pub(crate) struct MeanTables {
    /// Binary logarithm of the number of cells of a table.
    log2_cells: u32,
    /// Packed cells of the tables, by mean in quarters of an electron, then by n; 0 in tables that are not
    /// made yet and in one additional table.
    cells: Vec<u64>,
}

/// Number of tables per mean: with 0, 1 and 2 extra electrons.
const TABLES_PER_MEAN: usize = 3;
/// Number of tables of the grid.
const TABLES: usize = 4 * MeanTables::END_E as usize * TABLES_PER_MEAN;
/// Upper end of the grid, in quarters of an electron.
const QUARTERS: f32 = 4.0 * MeanTables::END_E as f32;
const TWO_TO_23: f32 = 8_388_608.0;
const TWO_TO_24: f32 = 16_777_216.0;

/// Pixel that no table holds: a Poisson number of mean `node_e` plus `extra_e` electrons.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Untabulated {
    pub(crate) node_e: f64,
    pub(crate) extra_e: f64,
}

impl MeanTables {
    /// Upper end of the grid, electrons: pixels of larger means are drawn directly.
    pub(crate) const END_E: f64 = 256.0;
    /// Maximum number of digital numbers in a table.
    const MAX_TABLE_WIDTH_DN: f64 = 1024.0;

    /// Creates the grid without any tables. Returns `None` if tables do not fit the distribution: they would
    /// be too wide, or there is no shot noise.
    pub(crate) fn new(distribution: &PixelDistribution) -> Option<Self> {
        let width_dn = distribution.width_dn(Self::END_E);
        if distribution.shot == Switch::Off || width_dn > Self::MAX_TABLE_WIDTH_DN {
            return None;
        }
        // A distribution covers as many numbers as its width, and one more at each end; n shifts it by up to
        // two electrons without widening it.
        let cells = (width_dn.max(0.0) as usize + 3).next_power_of_two();
        Some(Self { log2_cells: cells.trailing_zeros(), cells: vec![0; (TABLES + 1) * cells] })
    }

    /// Draws the pixels of the first `tiles` tiles of a batch from their means and words. Tiles that are
    /// marked as flat have the mean `flat`.
    pub(crate) fn draw_batch(&self, registers: Arch, batch: &mut Batch, flat: &FlatMean, tiles: usize) {
        let mut tile = 0;
        while tile < tiles {
            let (is_flat, from) = (batch.is_flat[tile], tile);
            while tile < tiles && batch.is_flat[tile] == is_flat {
                tile += 1;
            }
            let pixels = from * TILE..tile * TILE;
            let flat = is_flat.then_some(flat);
            registers.dispatch(ChooseTables { tables: self, flat, batch, pixels });
        }
        registers.dispatch(LookUp { tables: self, batch, pixels: tiles * TILE });
    }

    /// Draws the digital number of a pixel with a mean of `mean_e` electrons from its word, from a table that
    /// is made if it is missing: the highest 24 bits of the word determine n, its lower half the number.
    ///
    /// # Errors
    /// The pixel, if no table holds its distribution.
    pub(crate) fn draw(
        &mut self,
        distribution: &PixelDistribution,
        mean_e: f64,
        word: u64,
    ) -> Result<u16, Untabulated> {
        let (lower, upper) = halves(word);
        let choice = TableChoice::from_mean(mean_e.max(0.0) as f32, upper);
        let index = self.table_cell(choice.table(), lower) as usize;
        let cell = self.cells.get(index).copied().unwrap_or(0);
        if !is_open(cell) {
            let (level, pair) = halves(cell);
            return Ok(self.number(level, pair, lower) as u16);
        }
        if choice.quarters >= QUARTERS as i32 {
            return Err(Untabulated { node_e: mean_e, extra_e: 0.0 });
        }
        let node_e = 0.25 * f64::from(choice.quarters);
        if choice.more >= TABLES_PER_MEAN as i32 {
            let u = (f64::from(upper) + 0.5) * (1.0 / 4_294_967_296.0);
            let n = by_inversion(f64::from(choice.rest), u).max(TABLES_PER_MEAN);
            return Err(Untabulated { node_e, extra_e: n as f64 });
        }
        Ok(self.make_table(distribution, node_e, choice).draw(lower))
    }

    /// Makes the table of a choice and stores it.
    #[cold]
    fn make_table(
        &mut self,
        distribution: &PixelDistribution,
        node_e: f64,
        choice: TableChoice,
    ) -> AliasTable {
        let distribution = distribution.probabilities(node_e, choice.more as u32);
        let cells = 1 << self.log2_cells;
        let table = AliasTable::with_cells(cells, distribution.first_dn, &distribution.probabilities);
        let start = choice.table() as usize * cells;
        // A distribution with more numbers than a table has cells is not stored: it is recomputed on every
        // draw.
        if table.packed().len() == cells
            && let Some(stored) = self.cells.get_mut(start..start + cells)
        {
            for (cell, packed) in stored.iter_mut().zip(table.packed()) {
                *cell = packed;
            }
        }
        table
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

/// Task of choosing the table and the cell of some pixels of a batch.
struct ChooseTables<'a> {
    tables: &'a MeanTables,
    /// Common mean of the pixels, if they have one.
    flat: Option<&'a FlatMean>,
    batch: &'a mut Batch,
    pixels: Range<usize>,
}

impl pulp::WithSimd for ChooseTables<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { tables, flat, batch, pixels } = self;
        let Batch { means_e, means, words, places, .. } = batch;
        let (words, places) = (&words[pixels.clone()], &mut places[pixels.clone()]);
        if let Some(flat) = flat {
            for i in 0..places.len() {
                let (lower, upper) = halves(words[i]);
                places[i] = tables.table_cell(flat.table(upper), lower);
            }
            return;
        }
        let (means_e, means) = (&means_e[pixels.clone()], &mut means[pixels]);
        for i in 0..means.len() {
            means[i] = means_e[i].max(0.0) as f32;
        }
        for i in 0..places.len() {
            let (lower, upper) = halves(words[i]);
            places[i] = tables.table_cell(TableChoice::from_mean(means[i], upper).table(), lower);
        }
    }
}

/// Task of reading the chosen cells and the digital numbers in them.
struct LookUp<'a> {
    tables: &'a MeanTables,
    batch: &'a mut Batch,
    pixels: usize,
}

impl pulp::WithSimd for LookUp<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { tables, batch, pixels } = self;
        let Batch { words, places, cells, numbers, has_open, .. } = batch;
        let (words, places) = (&words[..pixels], &places[..pixels]);
        let (cells, numbers) = (&mut cells[..pixels], &mut numbers[..pixels]);
        let all = tables.cells.as_slice();
        let Some(last) = all.len().checked_sub(1) else { return };
        for i in 0..pixels {
            cells[i] = all[(places[i] as usize).min(last)];
        }
        for i in 0..pixels {
            let (level, pair) = halves(cells[i]);
            numbers[i] = tables.number(level, pair, words[i] as u32) as u16;
        }
        for (cells, has_open) in cells.as_chunks::<TILE>().0.iter().zip(has_open) {
            *has_open = cells.iter().fold(false, |open, &cell| open | is_open(cell));
        }
    }
}

/// Pixels that are drawn together, tile after tile.
///
/// First all their means are computed, then their words, then their numbers. Each of these reads a different
/// area of memory, and several accesses of one kind overlap in time.
pub(crate) struct Batch {
    /// Expected electrons.
    pub(crate) means_e: [f64; Batch::PIXELS],
    /// Expected electrons with the precision of the tables.
    means: [f32; Batch::PIXELS],
    /// Tiles whose pixels all have the flat mean of the frame.
    pub(crate) is_flat: [bool; Batch::TILES],
    /// Words, one per pixel.
    words: [u64; Batch::PIXELS],
    /// Indices of the cells of the tables, and the cells.
    places: [u32; Batch::PIXELS],
    cells: [u64; Batch::PIXELS],
    /// Tiles with pixels whose number is not in a table yet.
    has_open: [bool; Batch::TILES],
    /// Digital numbers, where they are in a table.
    pub(crate) numbers: [u16; Batch::PIXELS],
}

impl Batch {
    /// Number of tiles.
    pub(crate) const TILES: usize = 32;
    /// Number of pixels.
    const PIXELS: usize = Self::TILES * TILE;

    /// Creates a batch of pixels that are not drawn yet.
    pub(crate) fn new() -> Self {
        Self {
            means_e: [0.0; Self::PIXELS],
            means: [0.0; Self::PIXELS],
            is_flat: [false; Self::TILES],
            words: [0; Self::PIXELS],
            places: [0; Self::PIXELS],
            cells: [0; Self::PIXELS],
            has_open: [false; Self::TILES],
            numbers: [0; Self::PIXELS],
        }
    }

    /// Draws the words of adjacent tiles of a row for some tiles of the batch, after those of `skipped`
    /// tiles.
    pub(crate) fn draw_words(
        &mut self,
        registers: Arch,
        tiles: Range<usize>,
        skipped: usize,
        lanes: &mut GeneratorLanes,
    ) {
        let words = &mut self.words[tiles.start * TILE..tiles.end * TILE];
        registers.dispatch(DrawWords { words, skipped: skipped * TILE / LANES, lanes });
    }

    /// Word of pixel `i`.
    pub(crate) fn word(&self, i: usize) -> u64 {
        self.words[i]
    }

    /// Returns one bit for each pixel of a tile of the batch whose number is not in a table yet; it is drawn
    /// by [`MeanTables::draw`].
    pub(crate) fn open_pixels(&self, tile: usize) -> u64 {
        if !self.has_open[tile] {
            return 0;
        }
        let cells = &self.cells[tile * TILE..(tile + 1) * TILE];
        cells.iter().enumerate().fold(0, |open, (i, &cell)| open | u64::from(is_open(cell)) << i)
    }
}

/// Arguments of [`Batch::draw_words`] for vectorised code.
struct DrawWords<'a> {
    words: &'a mut [u64],
    /// Steps of the generators before the first word.
    skipped: usize,
    lanes: &'a mut GeneratorLanes,
}

impl pulp::WithSimd for DrawWords<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { words, skipped, lanes } = self;
        lanes.steps(simd, skipped, |_, _| ());
        let eights = words.as_chunks_mut::<LANES>().0;
        lanes.steps(simd, eights.len(), |step, words| eights[step] = words);
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

/// Choice of the table for the many pixels with a common mean, prepared once.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FlatMean {
    /// Index of the table with 0 extra electrons.
    first: u32,
    /// Values of a word's 24 bits from which on there are at least 1, 2 and 3 extra electrons.
    steps: [i32; TABLES_PER_MEAN],
}

impl FlatMean {
    /// Prepares the choice for a mean, electrons.
    pub(crate) fn new(mean_e: f64) -> Self {
        let (quarters, rest) = grid_node(mean_e.max(0.0) as f32);
        // A float represents 24 bits exactly, so a comparison of integers equals a comparison of shares.
        let steps = n_at_most(rest).map(|share| (f64::from(share) * f64::from(TWO_TO_24)).ceil() as i32);
        // From the upper end of the grid on, this is one past the last table.
        Self { first: (quarters * TABLES_PER_MEAN as i32) as u32, steps }
    }

    /// Index of the table for the upper half of a word.
    #[inline(always)]
    fn table(&self, upper: u32) -> u32 {
        let u = (upper >> 8) as i32;
        let [one, two, three] = self.steps;
        // Three or more lead beyond the last table.
        self.first + u32::from(u >= one) + u32::from(u >= two) + u32::from(u >= three) * TABLES as u32
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
    use super::super::distribution::tests::{chi_square_p, from_zero, histogram};
    use super::super::sampler::PixelSampler;
    use super::super::words::PixelStreams;
    use super::*;
    use crate::SensorConfig;
    use crate::config::tests::twelve_bit;
    use draws::{Effect, Seed};

    /// A gain of 1 e⁻/DN and a low read noise, so single electrons are distinguishable.
    fn distribution() -> PixelDistribution {
        PixelDistribution::new(&SensorConfig { gain_e_per_dn: 1.0, read_noise_e: 1.2, ..twelve_bit() })
    }

    /// Sampler of the pixels of one row of many.
    struct Row {
        sampler: PixelSampler,
        streams: PixelStreams,
        batch: Batch,
    }

    impl Row {
        fn new(seed: u64, frame: u64) -> Self {
            let seed = Seed { seed, case: 0 };
            let streams = PixelStreams::new(&seed, frame, Batch::PIXELS, 1 << 20);
            Self { sampler: PixelSampler::new(&distribution()), streams, batch: Batch::new() }
        }

        /// Draws row `y` of pixels whose means are set, or are all `flat_e`.
        fn draw(&mut self, y: usize, flat_e: Option<f64>) -> [u16; Batch::PIXELS] {
            let mut lanes = self.streams.row_words(Arch::Scalar, y);
            self.batch.draw_words(Arch::Scalar, 0..Batch::TILES, 0, &mut lanes);
            self.batch.is_flat.fill(flat_e.is_some());
            if let Some(flat_e) = flat_e {
                self.batch.means_e.fill(flat_e);
            }
            let flat = FlatMean::new(flat_e.unwrap_or(0.0));
            self.sampler.draw_batch(Arch::Scalar, &mut self.batch, &flat, Batch::TILES);
            let mut numbers = self.batch.numbers;
            for (i, dn) in numbers.iter_mut().enumerate() {
                if self.batch.open_pixels(i / TILE) >> (i % TILE) & 1 == 1 {
                    let own_words = self.streams.pixel_words(y * Batch::PIXELS + i);
                    *dn = self.sampler.draw_open(self.batch.means_e[i], self.batch.word(i), &own_words);
                }
            }
            numbers
        }
    }

    #[test]
    fn pixels_of_different_means_follow_their_distributions() {
        for (frame, mean_e) in [0.0, 0.1, 0.3, 1.0, 17.99, 63.99, 64.0, 65.49, 201.7, 255.99, 256.0, 300.3]
            .into_iter()
            .enumerate()
        {
            let mut row = Row::new(23, frame as u64);
            let drawn = histogram((0..600).flat_map(|y| row.draw(y, Some(mean_e))).map(usize::from));
            let p = chi_square_p(&drawn, &from_zero(&distribution().probabilities(mean_e, 0)));
            assert!(p > 1e-4, "mean {mean_e}: p = {p}");
        }
    }

    /// Checks means half-way between the nodes of the grid, where n is least certain. Pearson's test against
    /// the exact distribution, its tails merged to an expected count of ten; one row of draws at a time.
    fn assert_the_distribution_midway(draws: usize) {
        let mut after = 0.0;
        for i in 0..20_u64 {
            // At most one mean per quarter.
            let quarters = (4.0 * 0.1 * libm::pow(2550.0, i as f64 / 19.0)).floor().max(after);
            after = quarters + 1.0;
            let mean_e = 0.25 * quarters + 0.125;
            let mut row = Row::new(26, i);
            row.batch.means_e.fill(mean_e);
            let mut counts = vec![0; 4096];
            for y in 0..draws / Batch::PIXELS {
                row.draw(y, None).iter().for_each(|&dn| counts[usize::from(dn)] += 1);
            }
            let p = chi_square_p(&counts, &from_zero(&distribution().probabilities(mean_e, 0)));
            // Twenty tests.
            assert!(p > 1e-4, "mean {mean_e}: p = {p}");
        }
    }

    #[test]
    fn midway_between_nodes_the_distribution_is_exact() {
        assert_the_distribution_midway(1_000_000);
    }

    /// Full version: `cargo test --release -p boresight-sensor --lib midway -- --ignored`, 15 s of CPU time.
    #[test]
    #[ignore = "2e9 draws: for a scheduled job"]
    fn midway_between_nodes_the_distribution_is_exact_in_a_hundred_million_draws() {
        assert_the_distribution_midway(100_000_000);
    }

    #[test]
    fn tables_that_are_made_already_change_nothing() {
        let mut kept = Row::new(24, 0);
        for (i, mean_e) in kept.batch.means_e.iter_mut().enumerate() {
            *mean_e = i as f64 * 0.527 - 2.0;
        }
        let means_e = kept.batch.means_e;
        let first = kept.draw(7, None);
        assert_eq!(kept.draw(7, None), first);
        for i in (0..Batch::PIXELS).step_by(61) {
            let mut fresh = Row::new(24, 0);
            fresh.batch.means_e[i] = means_e[i];
            assert_eq!(fresh.draw(7, None)[i], first[i], "{i}");
        }
    }

    #[test]
    fn a_flat_tile_is_drawn_as_its_pixels_are() {
        for mean_e in [0.0, 3.1, 20.0, 20.13, 255.99, 256.0, 400.0] {
            let (mut flat, mut each) = (Row::new(25, 0), Row::new(25, 0));
            each.batch.means_e.fill(mean_e);
            for y in 0..50 {
                assert_eq!(flat.draw(y, Some(mean_e)), each.draw(y, None), "mean {mean_e}");
            }
        }
    }

    #[test]
    fn words_after_skipped_tiles_are_those_of_the_row() {
        let streams = Seed { seed: 27, case: 0 }.streams(0, Effect::PixelNoise);
        let (mut whole, mut part) = (Batch::new(), Batch::new());
        let lanes = GeneratorLanes::from_streams(&streams, 3);
        whole.draw_words(Arch::Scalar, 0..8, 0, &mut lanes.clone());
        part.draw_words(Arch::new(), 1..3, 5, &mut lanes.clone());
        assert_eq!(part.words[TILE..3 * TILE], whole.words[5 * TILE..7 * TILE]);
    }

    #[test]
    fn wide_tables_are_not_made() {
        assert!(MeanTables::new(&distribution()).is_some());
        let wide = SensorConfig { gain_e_per_dn: 0.05, ..twelve_bit() };
        assert!(MeanTables::new(&PixelDistribution::new(&wide)).is_none());
        let mut silent = twelve_bit();
        silent.noise.shot = Switch::Off;
        assert!(MeanTables::new(&PixelDistribution::new(&silent)).is_none());
    }
}
