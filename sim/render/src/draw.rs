//! Expected image: photoelectrons before any noise.

mod background;
mod objects;

use std::ops::Range;

use background::Background;
use objects::Objects;
use optics::Stamp;
use optics::pixel_factors::PixelFactors;
use optics::simd_kernel::{F64x8, LANES, SimdKernel, run_widest};
use optics::smooth_field::SmoothField;
use pulp::Simd;

/// Number of pixels in a tile, the part of a row that is drawn as one: about the width of a star.
pub const TILE: usize = 16;

/// Number of pixels in a piece of a row, for which an upper bound is kept, with one word of bits per piece.
const PIECE: usize = u64::BITS as usize;
/// Number of tiles in a piece.
const TILES: usize = PIECE / TILE;

/// Expected photoelectrons of a frame: a flat level, the non-uniform background, the images of objects, and
/// single pixels.
///
/// All of these are stored as added, the background in layers and the images of objects as stamps, and
/// evaluated for a row, or for a piece of a row, on request. Adding an object does not traverse the image,
/// and pixels that are never read cost nothing. The image is reused from frame to frame.
#[derive(Debug, Clone)]
pub struct ExpectedImage {
    columns: usize,
    rows: usize,
    background: Background,
    /// Fraction of the incident light that each pixel collects; `None`: all of it.
    response: Option<PixelFactors>,
    objects: Objects,
    /// Electrons of single pixels in addition to background and objects, row by row.
    single: Vec<f64>,
    /// One bit per pixel, `words_per_row` words per row: set if the pixel has an entry in `single`.
    is_single: Vec<u64>,
    words_per_row: usize,
    /// Upper bound of the electrons above the background in each piece.
    peaks: Vec<f64>,
}

/// Images are equal if every pixel has equal electrons, however these were added.
impl PartialEq for ExpectedImage {
    fn eq(&self, other: &Self) -> bool {
        self.size() == other.size() && self.iter().eq(other.iter())
    }
}

impl ExpectedImage {
    /// Creates a dark image on pixels that collect all incident light.
    pub fn new(columns: usize, rows: usize) -> Self {
        let words_per_row = columns.div_ceil(64);
        Self {
            columns,
            rows,
            background: Background::default(),
            response: None,
            objects: Objects::new(rows),
            single: vec![0.0; columns * rows],
            is_single: vec![0; words_per_row * rows],
            words_per_row,
            peaks: vec![0.0; words_per_row * rows],
        }
    }

    /// Returns this image on pixels with different responses: each collects the incident light times its
    /// factor.
    pub fn with_response(mut self, response: &PixelFactors) -> Self {
        self.response = (!response.is_empty()).then(|| response.clone());
        self.background.response = self.response.clone();
        self
    }

    /// Number of columns and rows.
    pub fn size(&self) -> (usize, usize) {
        (self.columns, self.rows)
    }

    /// Removes all objects, single pixels and non-uniform layers, and sets the flat level, electrons per
    /// pixel.
    pub fn clear(&mut self, flat_e: f64) {
        let rows = self.single.chunks_exact_mut(self.columns.max(1));
        for (row, words) in rows.zip(self.is_single.chunks_exact_mut(self.words_per_row.max(1))) {
            if !any(words) {
                continue;
            }
            for (pixels, word) in row.chunks_mut(PIECE).zip(words).filter(|(_, word)| **word != 0) {
                pixels.fill(0.0);
                *word = 0;
            }
        }
        self.objects.clear();
        self.peaks.fill(0.0);
        let mut field = std::mem::take(&mut self.background.field);
        field.clear();
        let response = self.response.clone();
        self.background = Background { light_e: flat_e, field, response, ..Background::default() };
    }

    /// Sets a background light that varies from pixel to pixel: `scale` · `field`, electrons above the flat
    /// level, row by row; `None` removes it. Values missing at the end of `field` count as zero.
    pub fn set_field(&mut self, field: Option<&[f64]>, scale: f64) {
        let held = &mut self.background.field;
        held.clear();
        if let Some(field) = field {
            let pixels = self.columns * self.rows;
            held.extend(field.iter().take(pixels).map(|electrons| scale * electrons));
            held.resize(pixels, 0.0);
        }
    }

    /// Sets a smooth background light: `scale` · `smooth`, electrons above the flat level.
    pub fn set_smooth(&mut self, smooth: &SmoothField, scale: f64) {
        self.background.smooth = Some((smooth.clone(), scale));
    }

    /// Returns true if the background varies from pixel to pixel.
    pub fn has_field(&self) -> bool {
        self.background.is_uneven()
    }

    /// Merges all layers of the background into one field and keeps the flat level, for a step that is not a
    /// layer.
    fn flatten(&mut self) {
        let flat_e = self.flat_e();
        let mut field = vec![0.0; self.columns * self.rows];
        for (y, row) in field.chunks_exact_mut(self.columns.max(1)).enumerate() {
            self.background.span(0, y, self.columns, row);
            row.iter_mut().for_each(|electrons| *electrons -= flat_e);
        }
        self.background = Background { light_e: flat_e, field, ..Background::default() };
    }

    /// Adds `electrons` to every pixel, multiplied by the factor of the pixel.
    pub fn add_pattern(&mut self, electrons: f64, factors: &PixelFactors) {
        if self.background.pattern.is_some() {
            self.flatten();
        }
        self.background.pattern = Some((electrons, factors.clone()));
    }

    /// Adds to every pixel `share` of the electrons of all other pixels of its column; returns the gain of a
    /// pixel, averaged over all pixels.
    pub fn smear(&mut self, share: f64) -> f64 {
        let (mut sums, mut row_e) = (vec![0.0; self.columns], vec![0.0; self.columns]);
        for y in 0..self.rows {
            self.row(y, &mut row_e);
            for (sum, row_e) in sums.iter_mut().zip(&row_e) {
                *sum += row_e;
            }
        }
        self.flatten();
        for y in 0..self.rows {
            self.row(y, &mut row_e);
            let field = self.background.field.iter_mut().skip(y * self.columns);
            for ((field, row_e), sum) in field.zip(&row_e).zip(&sums) {
                *field += share * (sum - row_e);
            }
        }
        // Each pixel contributes to all other pixels of its column, so its electrons are added once per other
        // pixel.
        let others = self.rows.saturating_sub(1) as f64;
        share * others * sums.iter().sum::<f64>() / (self.columns * self.rows).max(1) as f64
    }

    /// Removes all electrons of a pixel, including the background.
    pub fn empty_pixel(&mut self, x: usize, y: usize) {
        self.objects.empty(x, y);
        let background_e = self.background_at(x, y);
        *self.single_pixel(x, y) = -background_e;
    }

    /// Electrons of a single pixel, which is marked as such.
    fn single_pixel(&mut self, x: usize, y: usize) -> &mut f64 {
        self.is_single[y * self.words_per_row + x / PIECE] |= 1 << (x % PIECE);
        &mut self.single[y * self.columns + x]
    }

    /// Expected electrons of the background in a pixel.
    pub fn background_at(&self, x: usize, y: usize) -> f64 {
        self.background.electrons_at(x, y, self.columns)
    }

    /// Expected electrons of the background around a pixel: without the deviation of this pixel from its
    /// neighbours in response and dark current.
    pub fn background_near(&self, x: usize, y: usize) -> f64 {
        self.background.uniform_response_electrons_at(x, y, self.columns)
    }

    /// Raises the flat level of every pixel, electrons; the response is not applied.
    pub fn add_flat(&mut self, electrons: f64) {
        self.background.dark_e += electrons;
    }

    /// Adds the image of an object, made for a detector of the image's size, with the response of the pixels
    /// applied; returns the resulting image. Parts of the stamp outside the image are left out.
    pub fn add(&mut self, stamp: &Stamp) -> &Stamp {
        self.add_painted(|next| next.clone_from(stamp))
    }

    /// Adds the image of an object, made by `paint`, like [`ExpectedImage::add`].
    pub fn add_painted(&mut self, paint: impl FnOnce(&mut Stamp)) -> &Stamp {
        let mut stamp = self.objects.reuse_stamp();
        paint(&mut stamp);
        run_widest(Respond { image: self, stamp: &mut stamp });
        self.objects.push(stamp)
    }

    /// Images of the objects with the pixel response applied, in the order in which they were added.
    pub fn objects(&self) -> &[Stamp] {
        self.objects.stamps()
    }

    /// Adds electrons that pixels have already collected: the response is not applied.
    pub fn add_collected(&mut self, stamp: &Stamp) {
        for (x, y, row) in stamp.rows() {
            for (i, &electrons) in row.iter().enumerate().filter(|(_, electrons)| **electrons > 0.0) {
                self.add_pixel(x + i, y, electrons);
            }
        }
    }

    /// Adds collected electrons to one pixel; does nothing outside the image.
    pub fn add_pixel(&mut self, x: usize, y: usize, electrons: f64) {
        if x < self.columns && y < self.rows {
            *self.single_pixel(x, y) += electrons;
            self.peaks[y * self.words_per_row + x / PIECE] += electrons.max(0.0);
        }
    }

    /// Returns the flat level, electrons per pixel: the background in pixels where it does not vary.
    pub fn flat_e(&self) -> f64 {
        let pattern_e = self.background.pattern.as_ref().map_or(0.0, |(electrons, _)| *electrons);
        self.background.light_e + (self.background.dark_e + pattern_e)
    }

    /// Expected electrons of a pixel, including background.
    pub fn electrons_at(&self, x: usize, y: usize) -> f64 {
        let mut signal_e = [0.0];
        self.add_signal(x, y, &mut signal_e);
        self.background_at(x, y) + signal_e[0]
    }

    /// Adds the electrons above the background to the pixels of row `y` from column `x` on.
    #[inline(always)]
    fn add_signal(&self, x: usize, y: usize, out: &mut [f64]) {
        self.objects.add_to(x, y, out);
        let words = &self.is_single[y * self.words_per_row..(y + 1) * self.words_per_row];
        let pieces = x / PIECE..(x + out.len()).div_ceil(PIECE);
        for p in pieces.filter(|&p| words[p] != 0) {
            let (from, to) = ((p * PIECE).max(x), ((p + 1) * PIECE).min(x + out.len()));
            let single = &self.single[y * self.columns + from..y * self.columns + to];
            for (out, single) in out[from - x..to - x].iter_mut().zip(single) {
                *out += single;
            }
        }
    }

    /// Electrons of all pixels above the background, row by row.
    pub fn signal(&self) -> Vec<f64> {
        let mut signal_e = vec![0.0; self.columns * self.rows];
        for (y, row) in signal_e.chunks_exact_mut(self.columns.max(1)).enumerate() {
            self.add_signal(0, y, row);
        }
        signal_e
    }

    /// Expected electrons of all pixels, row by row, including background.
    pub fn iter(&self) -> impl Iterator<Item = f64> {
        (0..self.rows).flat_map(|y| {
            let mut row = vec![0.0; self.columns];
            self.row(y, &mut row);
            row
        })
    }

    /// Computes the expected electrons of the pixels of a row, including background; `out` is as long as a
    /// row.
    pub fn row(&self, y: usize, out: &mut [f64]) {
        self.span(0, y, out);
    }

    /// Computes the expected electrons of the pixels of row `y` from column `x` on, including background.
    #[inline(always)]
    pub fn span(&self, x: usize, y: usize, out: &mut [f64]) {
        self.background.span(x, y, self.columns, out);
        let end = x + out.len();
        for p in x / PIECE..end.div_ceil(PIECE) {
            if !self.is_lit(y, p) {
                continue;
            }
            // In the order of the computation of one pixel: the sum of all signal, added to the background.
            let (from, to) = ((p * PIECE).max(x), ((p + 1) * PIECE).min(end));
            let mut signal_e = [0.0; PIECE];
            let signal_e = &mut signal_e[..to - from];
            self.add_signal(from, y, signal_e);
            for (out, signal_e) in out[from - x..to - x].iter_mut().zip(signal_e) {
                *out += *signal_e;
            }
        }
    }

    /// Sets for each tile of row `y` from tile `first` on whether all its pixels have the flat level.
    pub fn mark_flat_tiles(&self, y: usize, first: usize, is_flat: &mut [bool]) {
        let is_even = !self.has_field();
        for (tile, is_flat) in (first..).zip(is_flat) {
            *is_flat = is_even && !self.is_lit(y, tile / TILES);
        }
    }

    /// Returns true if objects or single pixels may change the electrons in piece `p` of row `y`.
    #[inline(always)]
    fn is_lit(&self, y: usize, p: usize) -> bool {
        let piece = y * self.words_per_row + p;
        (self.peaks[piece] != 0.0) | (self.is_single[piece] != 0)
    }

    /// Upper bound of the background electrons in row `y`.
    #[inline(always)]
    pub fn row_bound_e(&self, y: usize) -> f64 {
        self.background.row_bound_e(y, self.columns)
    }

    /// Passes to `visit` the tiles of row `y` in which the signal may bring a pixel above `limit_e`, over a
    /// background of at most `bound_e`, which is at most `limit_e`: the number of a tile, and one bit for
    /// this and each of the next tiles, the lowest first.
    #[inline(always)]
    pub fn for_tiles_that_may_rise_above<S: Simd>(
        &self,
        simd: S,
        y: usize,
        bound_e: f64,
        limit_e: f64,
        mut visit: impl FnMut(usize, u64),
    ) {
        for p in 0..self.words_per_row {
            if self.is_lit(y, p) {
                visit(p * TILES, self.tiles_that_may_rise_above(simd, y, p, bound_e, limit_e));
            }
        }
    }

    /// Tiles of piece `p` of row `y`, as for [`ExpectedImage::for_tiles_that_may_rise_above`].
    #[inline(always)]
    fn tiles_that_may_rise_above<S: Simd>(
        &self,
        simd: S,
        y: usize,
        p: usize,
        bound_e: f64,
        limit_e: f64,
    ) -> u64 {
        if bound_e + self.peaks[y * self.words_per_row + p] <= limit_e {
            return 0;
        }
        // The stored bound adds the peaks of objects that lie side by side, so the signal is computed.
        let mut signal_e = [0.0; PIECE];
        let pixels = PIECE.min(self.columns - p * PIECE);
        self.add_signal(p * PIECE, y, &mut signal_e[..pixels]);
        signal_e.as_chunks::<TILE>().0.iter().enumerate().fold(0, |tiles, (i, tile)| {
            let eights = tile.as_chunks::<LANES>().0.iter().map(|eight| F64x8::from_array(simd, eight));
            let peak_e = eights.fold(F64x8::splat(simd, 0.0), F64x8::max).largest();
            tiles | u64::from(bound_e + peak_e > limit_e) << i
        })
    }

    /// Returns for each column the rows from the first to the last pixel with more than `limit_e` expected
    /// electrons.
    pub fn rows_above(&self, limit_e: f64) -> Vec<Range<usize>> {
        let mut columns = vec![0..0; self.columns];
        let extend = |rows: &mut Range<usize>, y: usize| {
            let first = if rows.start == rows.end { y } else { rows.start };
            *rows = first..y + 1;
        };
        let bound_e = self.background.bound_e();
        if bound_e > limit_e {
            let mut row = vec![0.0; self.columns];
            for y in 0..self.rows {
                self.row(y, &mut row);
                let above = columns.iter_mut().zip(&row).filter(|(_, electrons)| **electrons > limit_e);
                above.for_each(|(rows, _)| extend(rows, y));
            }
            return columns;
        }
        // Only drawn pixels can be above the limit here.
        let simd = pulp::Scalar::new();
        for y in 0..self.rows {
            let may_rise = |&p: &usize| self.tiles_that_may_rise_above(simd, y, p, bound_e, limit_e) != 0;
            for p in (0..self.words_per_row).filter(may_rise) {
                let piece = columns.iter_mut().enumerate().skip(p * PIECE).take(PIECE);
                piece
                    .filter(|(x, _)| self.electrons_at(*x, y) > limit_e)
                    .for_each(|(_, rows)| extend(rows, y));
            }
        }
        columns
    }
}

/// Returns true if any bit is set. It has no early exit, to process many words at once.
#[inline(always)]
fn any(words: &[u64]) -> bool {
    words.iter().fold(0, |all, word| all | word) != 0
}

/// Applies the response of an image's pixels to the image of an object.
struct Respond<'a> {
    image: &'a mut ExpectedImage,
    stamp: &'a mut Stamp,
}

impl SimdKernel for Respond<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { image, stamp } = self;
        let width = stamp.columns();
        for (x, y, row) in stamp.rows_mut() {
            let to = (x + width).min(image.columns);
            if y >= image.rows || x >= to {
                continue;
            }
            let row = row.as_chunks_mut::<LANES>().0;
            if let Some(response) = &image.response {
                for (i, electrons) in row.iter_mut().enumerate() {
                    let factors = F64x8::from_f32(simd, response.eight(x + i * LANES, y));
                    F64x8::from_array(simd, electrons).times(factors).store(electrons);
                }
            }
            let peaks = row.iter().fold(F64x8::splat(simd, 0.0), |peaks, electrons| {
                peaks.max(F64x8::from_array(simd, electrons))
            });
            let peak_e = peaks.largest();
            if peak_e > 0.0 {
                image.objects.add_span(y, x, to);
                for p in x / PIECE..to.div_ceil(PIECE) {
                    image.peaks[y * image.words_per_row + p] += peak_e;
                }
            }
        }
    }
}

/// Indices of the set bits in a word, lowest first.
pub fn set_bits(word: u64) -> impl Iterator<Item = usize> {
    // Each word is the previous word without its lowest set bit.
    std::iter::successors(Some(word), |word| Some(word & word.wrapping_sub(1)))
        .take_while(|word| *word != 0)
        .map(|word| word.trailing_zeros() as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use contract::PixelPoint;
    use optics::{Psf, PsfConfig};

    fn star(image: &mut ExpectedImage, x: f64, y: f64) {
        let mut psf = Psf::new(&PsfConfig::Gaussian { sigma_px: 2.0 }).unwrap();
        let mut stamp = Stamp::new();
        psf.stamp(PixelPoint::new(x, y), 1e4, 0.01, image.size(), &mut stamp);
        image.add(&stamp);
    }

    /// Spans that begin and end within a piece, over objects that begin and end within others.
    #[test]
    fn a_span_has_the_electrons_of_its_pixels() {
        let mut image = ExpectedImage::new(150, 70);
        image.clear(5.0);
        for (x, y) in [(64.0, 30.0), (66.0, 31.0), (0.0, 0.0), (149.0, 69.0), (127.5, 5.0)] {
            star(&mut image, x, y);
        }
        image.add_pixel(63, 60, 7.0);
        assert_eq!(image.electrons_at(63, 60), 12.0);
        for (y, from, to) in
            [(30, 0, 150), (31, 60, 70), (0, 3, 4), (69, 100, 150), (5, 128, 129), (60, 16, 64)]
        {
            let mut span = vec![0.0; to - from];
            image.span(from, y, &mut span);
            let pixels: Vec<f64> = (from..to).map(|x| image.electrons_at(x, y)).collect();
            assert_eq!(span, pixels);
            assert!(span.iter().any(|electrons| *electrons > 5.0), "{y}");
        }
    }

    #[test]
    fn a_cleared_image_is_as_good_as_new() {
        let mut image = ExpectedImage::new(150, 70);
        star(&mut image, 64.0, 30.0);
        image.add_pixel(149, 69, 3.0);
        image.clear(0.0);
        assert_eq!(image, ExpectedImage::new(150, 70));
    }

    #[test]
    fn a_field_is_part_of_every_pixel_until_it_is_cleared() {
        let mut image = ExpectedImage::new(3, 2);
        image.clear(5.0);
        image.set_field(Some(&[0.0, 1.0, 2.0, 3.0]), 10.0);
        image.add_pixel(1, 1, 7.0);
        assert_eq!(image.iter().collect::<Vec<_>>(), [5.0, 15.0, 25.0, 35.0, 12.0, 5.0]);
        assert_eq!((image.electrons_at(0, 1), image.background_at(1, 1)), (35.0, 5.0));
        image.set_field(None, 1.0);
        assert_eq!(image.electrons_at(2, 0), 5.0);
        image.set_field(Some(&[1.0; 6]), 1.0);
        image.clear(0.0);
        assert_eq!(image, ExpectedImage::new(3, 2));
    }

    #[test]
    fn a_smear_gives_each_pixel_a_share_of_the_rest_of_its_column() {
        let mut image = ExpectedImage::new(2, 3);
        image.clear(1.0);
        image.add_pixel(0, 2, 100.0);
        image.smear(0.5);
        // Column 0 holds 1, 1, 101 and column 1 three times 1.
        assert_eq!(image.iter().collect::<Vec<_>>(), [52.0, 2.0, 52.0, 2.0, 102.0, 2.0]);
    }

    #[test]
    fn a_stamp_made_for_a_larger_detector_is_clipped() {
        let mut image = ExpectedImage::new(10, 10);
        let mut stamp = Stamp::new();
        let mut psf = Psf::new(&PsfConfig::Gaussian { sigma_px: 2.0 }).unwrap();
        psf.stamp(PixelPoint::new(9.0, 9.0), 1e4, 0.01, (100, 100), &mut stamp);
        image.add(&stamp);
        image.add_pixel(10, 0, 1.0);
        assert!(image.iter().sum::<f64>() < 5e3);
    }
}
