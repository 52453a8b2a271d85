//! Raw image of which only some tiles are drawn.

use render::draw::TILE;

use super::dark_pixels::DarkPixels;
use super::tiles::{TileRun, TileSet, tile_pixels};
use crate::raw_image::RawImage;

/// Raw image of which only some tiles, 16 pixels of a row each, are drawn. Reused from frame to frame.
#[derive(Debug)]
pub struct SparseImage {
    /// The image. Pixels that are not drawn are 0, except those above the floor.
    pub(super) raw: RawImage,
    /// Tiles in which all pixels are drawn.
    pub(super) drawn: TileSet,
    /// Tiles that the camera examines.
    pub(super) wanted: TileSet,
    /// Tiles to draw in one pass.
    pub(super) runs: Vec<TileRun>,
    /// Tiles in which single pixels were set.
    touched: TileSet,
    /// Dark pixels above the floor.
    pub(super) dark: DarkPixels,
    /// Pixels that overflow or receive overflowing charge, all of them set in the image.
    pub(super) bloomed: Vec<Pixel>,
}

/// Pixel, given by its index in the image, and its digital number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pixel {
    pub(super) index: usize,
    pub(super) dn: u16,
}

impl SparseImage {
    /// Creates an image in `raw` with no pixels drawn.
    pub(super) fn new(raw: RawImage) -> Self {
        let none = TileSet::empty(raw.columns, raw.dn.len() / raw.columns.max(1));
        Self {
            raw,
            drawn: none.clone(),
            wanted: none.clone(),
            runs: Vec::new(),
            touched: none,
            dark: DarkPixels::default(),
            bloomed: Vec::new(),
        }
    }

    /// Returns the image. Digital numbers equal those of the whole frame if they are above the floor or in a
    /// window that was read out.
    pub fn raw(&self) -> &RawImage {
        &self.raw
    }

    /// Returns the image for drawing as a whole.
    pub fn full_image(&mut self) -> &mut RawImage {
        for y in 0..self.raw.rows {
            self.drawn.add_columns(y, 0, self.raw.columns);
        }
        &mut self.raw
    }

    /// Returns the pixels set in the image, tile by tile: the index of the first pixel, and the digital
    /// numbers. All other pixels are 0.
    pub fn runs(&self) -> impl Iterator<Item = (usize, &[u16])> {
        let Self { raw, drawn, touched, .. } = self;
        drawn.union(touched).map(|(y, tile)| {
            let pixels = tile_pixels(raw.columns, y, tile);
            (pixels.start, &raw.dn[pixels])
        })
    }

    /// Sets all pixels to 0 that are not above a floor.
    pub fn suppress(&mut self, floor_dn: u16) {
        let Self { raw, drawn, touched, .. } = self;
        for (y, tile) in drawn.union(touched) {
            for dn in &mut raw.dn[tile_pixels(raw.columns, y, tile)] {
                *dn = if *dn > floor_dn { *dn } else { 0 };
            }
        }
    }

    /// Clears the image: no pixels are drawn.
    pub(super) fn clear(&mut self) {
        let Self { raw, drawn, wanted, touched, .. } = self;
        for (y, tile) in drawn.union(touched) {
            raw.dn[tile_pixels(raw.columns, y, tile)].fill(0);
        }
        for tiles in [drawn, wanted, touched] {
            tiles.clear();
        }
        self.dark.clear();
        self.bloomed.clear();
    }

    /// Sets the pixels that were drawn singly, replacing those drawn in tiles.
    pub(super) fn set_single_pixels(&mut self) {
        let columns = self.raw.columns;
        for pixel in self.dark.exceeding.iter().chain(&self.bloomed) {
            self.raw.dn[pixel.index] = pixel.dn;
            self.touched.add(pixel.index / columns, pixel.index % columns / TILE, 1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows with more tiles than a word has bits, and a short last tile.
    #[test]
    fn set_pixels_are_listed_part_by_part_and_cleared() {
        let (columns, rows) = (2 * TileSet::OF_A_WORD * TILE + 5, 3);
        let mut image = SparseImage::new(RawImage::from_dn(columns, rows, 12, vec![0; columns * rows]));
        assert_eq!(image.runs().count(), 0);
        image.drawn.add_columns(0, columns - 6, columns);
        image.drawn.add(1, TileSet::OF_A_WORD - 4, 0b1001);
        image.dark.exceeding.push(Pixel { index: 2 * columns, dn: 9 });
        image.bloomed.push(Pixel { index: columns + (TileSet::OF_A_WORD - 1) * TILE, dn: 70 });
        image.set_single_pixels();
        let found: Vec<_> =
            image.runs().map(|(first, run)| (first % columns / TILE, first / columns, run.len())).collect();
        let last = 2 * TileSet::OF_A_WORD;
        let middle = TileSet::OF_A_WORD;
        assert_eq!(
            found,
            [(last - 1, 0, TILE), (last, 0, 5), (middle - 4, 1, TILE), (middle - 1, 1, TILE), (0, 2, TILE)]
        );
        image.suppress(50);
        assert_eq!(image.raw().dn().iter().map(|&dn| usize::from(dn)).sum::<usize>(), 70);
        image.clear();
        assert!(image.runs().count() == 0 && image.raw().dn().iter().all(|&dn| dn == 0));
        image.full_image().dn.fill(1);
        assert_eq!(image.runs().map(|(_, run)| run.len()).sum::<usize>(), columns * rows);
    }
}
