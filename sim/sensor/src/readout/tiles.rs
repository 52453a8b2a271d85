//! Tiles: the unit in which an image is drawn, and sets of them.

use std::ops::Range;

use contract::Window;
use render::draw::{TILE, set_bits};

use crate::pixel::mean_tables::Batch;

/// Set of tiles of an image: one bit per tile, in separate words for each row.
#[derive(Debug, Clone)]
pub(super) struct TileSet {
    words: Vec<u64>,
    words_per_row: usize,
}

impl TileSet {
    /// Tiles per word: one bit each.
    pub(super) const OF_A_WORD: usize = u64::BITS as usize;

    /// Returns the empty set for an image of `columns` × `rows`.
    pub(super) fn empty(columns: usize, rows: usize) -> Self {
        let words_per_row = columns.div_ceil(TILE).div_ceil(Self::OF_A_WORD);
        Self { words: vec![0; words_per_row * rows], words_per_row }
    }

    /// Removes all tiles.
    pub(super) fn clear(&mut self) {
        self.words.fill(0);
    }

    /// Adds tiles of row `y`, given by `bits`, whose lowest bit is tile `tile`; all of them must be in one
    /// word.
    #[inline(always)]
    pub(super) fn add(&mut self, y: usize, tile: usize, bits: u64) {
        self.words[y * self.words_per_row + tile / Self::OF_A_WORD] |= bits << (tile % Self::OF_A_WORD);
    }

    /// Adds the tiles of row `y` that contain pixels of the columns `from` to `to`.
    pub(super) fn add_columns(&mut self, y: usize, from: usize, to: usize) {
        for tile in from / TILE..to.div_ceil(TILE) {
            self.add(y, tile, 1);
        }
    }

    /// Adds the tiles that contain pixels of a window.
    pub(super) fn add_window(&mut self, window: &Window) {
        for y in window.y..window.y + window.rows {
            self.add_columns(y, window.x, window.x + window.columns);
        }
    }

    /// Row and number of each tile in the union of this set and another of an image of the same size.
    pub(super) fn union<'a>(&'a self, other: &'a Self) -> impl Iterator<Item = (usize, usize)> + 'a {
        let words_per_row = self.words_per_row.max(1);
        self.words.iter().zip(&other.words).enumerate().flat_map(move |(i, (these, those))| {
            let first = i % words_per_row * Self::OF_A_WORD;
            set_bits(these | those).map(move |bit| (i / words_per_row, first + bit))
        })
    }

    /// Moves the tiles of `wanted` that are not in this set to it, and appends them to `runs`.
    pub(super) fn take_new(&mut self, wanted: &Self, runs: &mut Vec<TileRun>) {
        for (i, (have, want)) in self.words.iter_mut().zip(&wanted.words).enumerate() {
            let mut new = want & !*have;
            *have |= want;
            let (y, first) = (i / self.words_per_row, i % self.words_per_row * Self::OF_A_WORD);
            while new != 0 {
                let start = new.trailing_zeros();
                let length = (new >> start).trailing_ones().min(TileRun::MAX_TILES as u32);
                runs.push(TileRun { y, first: first + start as usize, tiles: length as usize });
                new &= !(u64::MAX >> (u64::BITS - length) << start);
            }
        }
    }
}

/// Adjacent tiles of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct TileRun {
    pub(super) y: usize,
    /// Number of the first tile in its row.
    pub(super) first: usize,
    pub(super) tiles: usize,
}

impl TileRun {
    /// Maximum number of tiles of a run: it fits a batch.
    pub(super) const MAX_TILES: usize = Batch::TILES;

    /// Returns the runs of all tiles of an image of `columns` × `rows`.
    pub(super) fn of_image(columns: usize, rows: usize) -> Vec<Self> {
        let tiles = columns.div_ceil(TILE);
        let mut runs = Vec::with_capacity(rows * tiles.div_ceil(Self::MAX_TILES));
        for y in 0..rows {
            for first in (0..tiles).step_by(Self::MAX_TILES) {
                runs.push(Self { y, first, tiles: (tiles - first).min(Self::MAX_TILES) });
            }
        }
        runs
    }

    /// Columns of the pixels of the run in an image of `columns`.
    #[inline(always)]
    pub(super) fn columns(&self, columns: usize) -> Range<usize> {
        self.first * TILE..((self.first + self.tiles) * TILE).min(columns)
    }
}

/// Pixels of a tile of row `y` in an image of `columns` columns, as indices into the image.
#[inline(always)]
pub(super) fn tile_pixels(columns: usize, y: usize, tile: usize) -> Range<usize> {
    y * columns + tile * TILE..y * columns + ((tile + 1) * TILE).min(columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_hold_the_new_tiles_of_a_row_once() {
        let columns = 2 * TileSet::OF_A_WORD * TILE + 5;
        let (mut drawn, mut wanted) = (TileSet::empty(columns, 3), TileSet::empty(columns, 3));
        wanted.add_columns(0, 0, columns);
        wanted.add(1, TileSet::OF_A_WORD + 3, 0b1101);
        drawn.add(1, TileSet::OF_A_WORD + 5, 1);
        let mut runs = Vec::new();
        drawn.take_new(&wanted, &mut runs);
        let expected =
            [(0, 0, 32), (0, 32, 32), (0, 64, 32), (0, 96, 32), (0, 128, 1), (1, 67, 1), (1, 70, 1)];
        assert_eq!(runs, expected.map(|(y, first, tiles)| TileRun { y, first, tiles }));
        assert_eq!(TileRun::of_image(columns, 1), runs[..5]);
        assert_eq!(runs[4].columns(columns), columns - 5..columns);
        runs.clear();
        drawn.take_new(&wanted, &mut runs);
        assert_eq!(runs, []);
        assert_eq!(drawn.union(&wanted).count(), 129 + 3);
    }
}
