//! Raw image that is drawn in parts.

use render::draw::{PART, set_bits};

use super::exceedance::DarkLimit;
use super::raw_image::RawImage;

/// Raw image of which only some parts of rows, 16 pixels each, are drawn. Reused from frame to frame.
#[derive(Debug)]
pub struct SparseImage {
    /// The image. Pixels that are not drawn are 0, except those above the floor.
    pub(super) raw: RawImage,
    /// Parts in which all pixels are drawn.
    pub(super) drawn: Parts,
    /// Parts to be drawn.
    pub(super) requested: Parts,
    /// Row and number of each part to draw in one pass.
    pub(super) to_draw: Vec<(usize, usize)>,
    /// Parts in which single pixels were set.
    touched: Parts,
    /// Limit of dark pixels in each row; empty if all pixels are drawn directly.
    pub(super) limits: Vec<DarkLimit>,
    /// Dark pixels above the floor.
    pub(super) exceeding: Vec<Pixel>,
    /// Pixels that overflow or receive overflowing charge, all of them set in the image.
    pub(super) bloomed: Vec<Pixel>,
    pub(super) floor_dn: u16,
}

/// Pixel, given by its index in the image, and its digital number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pixel {
    pub(super) index: usize,
    pub(super) dn: u16,
}

/// Set of parts of the rows of an image: one bit per part, in separate words for each row.
#[derive(Debug, Clone)]
pub(super) struct Parts {
    words: Vec<u64>,
    words_per_row: usize,
}

impl Parts {
    /// Parts per word: one bit each.
    pub(super) const OF_A_WORD: usize = u64::BITS as usize;

    /// Returns the empty set for an image of `columns` × `rows`.
    fn empty(columns: usize, rows: usize) -> Self {
        let words_per_row = columns.div_ceil(PART).div_ceil(Self::OF_A_WORD);
        Self { words: vec![0; words_per_row * rows], words_per_row }
    }

    /// Words of a row.
    #[inline(always)]
    pub(super) fn row(&self, y: usize) -> &[u64] {
        &self.words[y * self.words_per_row..(y + 1) * self.words_per_row]
    }

    #[inline(always)]
    pub(super) fn row_mut(&mut self, y: usize) -> &mut [u64] {
        &mut self.words[y * self.words_per_row..(y + 1) * self.words_per_row]
    }

    /// Adds the parts of row `y` given by `bits`, whose lowest bit is part `part`; all of them must be in one
    /// word.
    #[inline(always)]
    pub(super) fn add(&mut self, y: usize, part: usize, bits: u64) {
        self.words[y * self.words_per_row + part / Self::OF_A_WORD] |= bits << (part % Self::OF_A_WORD);
    }

    /// Adds the parts of row `y` that contain pixels of the columns `from` to `to`.
    pub(super) fn add_columns(&mut self, y: usize, from: usize, to: usize) {
        for part in from / PART..to.div_ceil(PART) {
            self.add(y, part, 1);
        }
    }
}

impl SparseImage {
    /// Creates an image in `raw` with no pixels drawn.
    pub(super) fn new(raw: RawImage) -> Self {
        let none = Parts::empty(raw.columns, raw.dn.len() / raw.columns.max(1));
        Self {
            raw,
            drawn: none.clone(),
            requested: none.clone(),
            to_draw: Vec::new(),
            touched: none,
            limits: Vec::new(),
            exceeding: Vec::new(),
            bloomed: Vec::new(),
            floor_dn: 0,
        }
    }

    /// Returns the image. Digital numbers equal those of the whole frame if they are above the floor or were
    /// requested.
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

    /// Returns the pixels set in the image, part by part: the index of the first pixel, and the digital
    /// numbers. All other pixels are 0.
    pub fn runs(&self) -> impl Iterator<Item = (usize, &[u16])> {
        let Self { raw, drawn, touched, .. } = self;
        parts_in(drawn, touched).map(|(y, part)| {
            let pixels = pixels(raw.columns, y, part);
            (pixels.start, &raw.dn[pixels])
        })
    }

    /// Sets all pixels to 0 that are not above a floor.
    pub fn suppress(&mut self, floor_dn: u16) {
        let Self { raw, drawn, touched, .. } = self;
        for (y, part) in parts_in(drawn, touched) {
            for dn in &mut raw.dn[pixels(raw.columns, y, part)] {
                *dn = if *dn > floor_dn { *dn } else { 0 };
            }
        }
    }

    /// Clears the image: no pixels are drawn.
    pub(super) fn clear(&mut self) {
        let Self { raw, drawn, requested, touched, .. } = self;
        for (y, part) in parts_in(drawn, touched) {
            raw.dn[pixels(raw.columns, y, part)].fill(0);
        }
        for parts in [drawn, requested, touched] {
            parts.words.fill(0);
        }
        self.limits.clear();
        self.exceeding.clear();
        self.bloomed.clear();
    }

    /// Sets the pixels that were drawn singly, replacing those drawn in parts.
    pub(super) fn set_single_pixels(&mut self) {
        let columns = self.raw.columns;
        for pixel in self.exceeding.iter().chain(&self.bloomed) {
            self.raw.dn[pixel.index] = pixel.dn;
            self.touched.add(pixel.index / columns, pixel.index % columns / PART, 1);
        }
    }
}

/// Returns row and number of each part in the union of two sets.
fn parts_in<'a>(these: &'a Parts, those: &'a Parts) -> impl Iterator<Item = (usize, usize)> + 'a {
    let words_per_row = these.words_per_row.max(1);
    these
        .words
        .iter()
        .zip(&those.words)
        .map(|(a, b)| a | b)
        .enumerate()
        .filter(|(_, word)| *word != 0)
        .flat_map(move |(i, word)| {
            let first = i % words_per_row * Parts::OF_A_WORD;
            set_bits(word).map(move |bit| (i / words_per_row, first + bit))
        })
}

/// Pixels of a part of row `y` in an image of `columns` columns, as indices into the image.
#[inline(always)]
pub(super) fn pixels(columns: usize, y: usize, part: usize) -> std::ops::Range<usize> {
    y * columns + part * PART..y * columns + ((part + 1) * PART).min(columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows with more parts than a word has bits, and a short last part.
    #[test]
    fn set_pixels_are_listed_part_by_part_and_cleared() {
        let (columns, rows) = (2 * Parts::OF_A_WORD * PART + 5, 3);
        let mut image = SparseImage::new(RawImage::from_dn(columns, rows, 12, vec![0; columns * rows]));
        assert_eq!(image.runs().count(), 0);
        image.drawn.add_columns(0, columns - 6, columns);
        image.drawn.add(1, Parts::OF_A_WORD - 4, 0b1001);
        image.exceeding.push(Pixel { index: 2 * columns, dn: 9 });
        image.bloomed.push(Pixel { index: columns + (Parts::OF_A_WORD - 1) * PART, dn: 70 });
        image.set_single_pixels();
        let found: Vec<_> =
            image.runs().map(|(first, run)| (first % columns / PART, first / columns, run.len())).collect();
        let last = 2 * Parts::OF_A_WORD;
        let middle = Parts::OF_A_WORD;
        assert_eq!(
            found,
            [(last - 1, 0, PART), (last, 0, 5), (middle - 4, 1, PART), (middle - 1, 1, PART), (0, 2, PART)]
        );
        image.suppress(50);
        assert_eq!(image.raw().dn().iter().map(|&dn| usize::from(dn)).sum::<usize>(), 70);
        image.clear();
        assert!(image.runs().count() == 0 && image.raw().dn().iter().all(|&dn| dn == 0));
        image.full_image().dn.fill(1);
        assert_eq!(image.runs().map(|(_, run)| run.len()).sum::<usize>(), columns * rows);
    }
}
