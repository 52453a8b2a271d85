//! The expected image: photo-electrons before any noise.

mod background;
mod objects;

use std::ops::Range;

use background::Background;
use objects::Objects;
use pulp::Simd;

use crate::optics::Stamp;
use crate::pixel_factors::PixelFactors;
use crate::simd_kernel::{F64x8, LANES, SimdKernel, run_widest};
use crate::smooth_field::SmoothField;

/// Pixels of a piece of a row, the unit in which images are looked at: of each there is one word of bits.
pub(crate) const PIECE: usize = u64::BITS as usize;

/// Pixels of a part of a piece, the unit in which frames are lit and drawn in parts: about as many as a star is wide.
pub(crate) const PART: usize = 16;
/// Parts of a piece.
pub(crate) const PARTS: usize = PIECE / PART;

/// Expected photo-electrons of a frame: a flat level, what makes the background uneven, the images of objects, and single pixels.
///
/// All of it is kept as it was told, the background in layers and the images of objects as stamps, and made for a row, or for a
/// piece of it, when that is asked for: an image is not walked through for each of them, and what nobody looks at costs
/// nothing. It is reused from frame to frame.
#[derive(Debug, Clone)]
pub struct ExpectedImage {
    columns: usize,
    rows: usize,
    background: Background,
    /// What each pixel makes of the light that falls on it; `None`: all of it.
    response: Option<PixelFactors>,
    objects: Objects,
    /// Electrons of single pixels, above all that, row by row.
    single: Vec<f64>,
    /// One bit a pixel, `words_per_row` words a row: whether it is such a pixel.
    is_single: Vec<u64>,
    words_per_row: usize,
    /// Of each piece, no pixel has more electrons above the background.
    peaks: Vec<f64>,
}

/// Images are equal that have the same electrons in every pixel, however they were told.
impl PartialEq for ExpectedImage {
    fn eq(&self, other: &Self) -> bool {
        self.size() == other.size() && self.iter().eq(other.iter())
    }
}

impl ExpectedImage {
    /// An image without light, on pixels that collect all of it.
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

    /// The same on pixels that respond differently: each collects the light that falls on it times its factor.
    pub(crate) fn with_response(mut self, response: &PixelFactors) -> Self {
        self.response = (!response.is_empty()).then(|| response.clone());
        self.background.response = self.response.clone();
        self
    }

    /// Columns and rows.
    pub fn size(&self) -> (usize, usize) {
        (self.columns, self.rows)
    }

    /// Takes away everything drawn and all that is uneven, and sets the flat level, electrons a pixel.
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

    /// Sets light that varies from pixel to pixel: `scale` · `field`, electrons above the flat level, row by row;
    /// `None` takes it away. Where `field` is too short, there is none.
    pub fn set_field(&mut self, field: Option<&[f64]>, scale: f64) {
        let held = &mut self.background.field;
        held.clear();
        if let Some(field) = field {
            let pixels = self.columns * self.rows;
            held.extend(field.iter().take(pixels).map(|electrons| scale * electrons));
            held.resize(pixels, 0.0);
        }
    }

    /// Sets smooth light: `scale` · `smooth`, electrons above the flat level.
    pub(crate) fn set_smooth(&mut self, smooth: &SmoothField, scale: f64) {
        self.background.smooth = Some((smooth.clone(), scale));
    }

    /// Whether the background varies from pixel to pixel.
    pub fn has_field(&self) -> bool {
        self.background.is_uneven()
    }

    /// Makes one field of all layers of the background, the flat level being kept: for a step that is not a layer.
    fn flatten(&mut self) {
        let flat_e = self.flat_e();
        let mut field = vec![0.0; self.columns * self.rows];
        for (y, row) in field.chunks_exact_mut(self.columns.max(1)).enumerate() {
            self.background.span(0, y, self.columns, row);
            row.iter_mut().for_each(|electrons| *electrons -= flat_e);
        }
        self.background = Background { light_e: flat_e, field, ..Background::default() };
    }

    /// Adds `electrons` to every pixel, times a factor of its own.
    pub(crate) fn add_pattern(&mut self, electrons: f64, factors: &PixelFactors) {
        if self.background.pattern.is_some() {
            self.flatten();
        }
        self.background.pattern = Some((electrons, factors.clone()));
    }

    /// Adds to every pixel `share` of the light of all other pixels of its column; tells what a pixel gains, the mean over
    /// all pixels.
    pub(crate) fn smear(&mut self, share: f64) -> f64 {
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
        // Each pixel gives to all others of its column, and there are as many of them as pixels that it is one of.
        let others = self.rows.saturating_sub(1) as f64;
        share * others * sums.iter().sum::<f64>() / (self.columns * self.rows).max(1) as f64
    }

    /// Empties one pixel, background included.
    pub(crate) fn empty_pixel(&mut self, x: usize, y: usize) {
        self.objects.empty(x, y);
        let background_e = self.background_at(x, y);
        *self.single_pixel(x, y) = -background_e;
    }

    /// The electrons of a single pixel.
    fn single_pixel(&mut self, x: usize, y: usize) -> &mut f64 {
        self.is_single[y * self.words_per_row + x / PIECE] |= 1 << (x % PIECE);
        &mut self.single[y * self.columns + x]
    }

    /// Expected electrons of the background in a pixel.
    pub fn background_at(&self, x: usize, y: usize) -> f64 {
        self.background.electrons_at(x, y, self.columns)
    }

    /// Expected electrons of the background about a pixel: without what this pixel has more or less than those around it, its response
    /// and its dark current.
    pub(crate) fn background_near(&self, x: usize, y: usize) -> f64 {
        self.background.uniform_response_electrons_at(x, y, self.columns)
    }

    /// Raises the flat level of every pixel, electrons; no response changes them.
    pub fn add_flat(&mut self, electrons: f64) {
        self.background.dark_e += electrons;
    }

    /// Adds the image of an object, made for a detector of the size of the image, as its pixels respond to the light; tells that
    /// image. What of a stamp lies off the image is left out.
    pub fn add(&mut self, stamp: &Stamp) -> &Stamp {
        self.add_painted(|next| next.clone_from(stamp))
    }

    /// Adds the image of an object as [`ExpectedImage::add`] does: `paint` makes it.
    pub(crate) fn add_painted(&mut self, paint: impl FnOnce(&mut Stamp)) -> &Stamp {
        let mut stamp = self.objects.reuse_stamp();
        paint(&mut stamp);
        run_widest(Respond { image: self, stamp: &mut stamp });
        self.objects.push(stamp)
    }

    /// The images of the objects, in the order in which they were added: as the pixels have responded to their light.
    pub fn objects(&self) -> &[Stamp] {
        self.objects.stamps()
    }

    /// Adds what something has left in pixels, as they have collected it.
    pub(crate) fn add_collected(&mut self, stamp: &Stamp) {
        for (x, y, row) in stamp.rows() {
            for (i, &electrons) in row.iter().enumerate().filter(|(_, electrons)| **electrons > 0.0) {
                self.add_pixel(x + i, y, electrons);
            }
        }
    }

    /// Adds electrons to one pixel, as it has collected them; outside the image nothing happens.
    pub fn add_pixel(&mut self, x: usize, y: usize, electrons: f64) {
        if x < self.columns && y < self.rows {
            *self.single_pixel(x, y) += electrons;
            self.peaks[y * self.words_per_row + x / PIECE] += electrons.max(0.0);
        }
    }

    /// The flat level, electrons a pixel: all of the background where it does not vary.
    pub fn flat_e(&self) -> f64 {
        let pattern_e = self.background.pattern.as_ref().map_or(0.0, |(electrons, _)| *electrons);
        self.background.light_e + (self.background.dark_e + pattern_e)
    }

    /// Expected electrons of a pixel, background included.
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

    /// Expected electrons of all pixels, row by row, background included.
    pub fn iter(&self) -> impl Iterator<Item = f64> {
        (0..self.rows).flat_map(|y| {
            let mut row = vec![0.0; self.columns];
            self.row(y, &mut row);
            row
        })
    }

    /// Expected electrons of the pixels of a row, background included; `out` is as long as a row.
    #[inline(always)]
    pub(crate) fn row(&self, y: usize, out: &mut [f64]) {
        self.span::<{ 16 * PIECE }>(0, y, out);
    }

    /// [`ExpectedImage::row`] of part `p` of `N` pixels alone; `out` is as long as the part.
    #[inline(always)]
    pub(crate) fn part<const N: usize>(&self, y: usize, p: usize, out: &mut [f64]) {
        self.span::<N>(p * N, y, out);
    }

    /// Whether something was drawn in row `y`.
    #[inline(always)]
    pub(crate) fn is_row_lit(&self, y: usize) -> bool {
        let words = &self.is_single[y * self.words_per_row..(y + 1) * self.words_per_row];
        self.objects.are_in_row(y) || any(words)
    }

    /// Of each `N` pixels of row `y`, whether something was drawn in any of them.
    pub(crate) fn lit_parts<const N: usize>(&self, y: usize, is_lit: &mut [bool]) {
        is_lit.fill(false);
        self.objects.for_each_span(y, |from, to| is_lit[from / N..to.div_ceil(N)].fill(true));
        let words = &self.is_single[y * self.words_per_row..(y + 1) * self.words_per_row];
        for (word, is_lit) in words.iter().zip(is_lit.chunks_mut(PIECE / N)).filter(|(word, _)| **word != 0) {
            for (i, is_lit) in is_lit.iter_mut().enumerate() {
                *is_lit |= word >> (i * N) & (u64::MAX >> (PIECE - N)) != 0;
            }
        }
    }

    /// Expected electrons of the pixels of row `y` from column `x` on, made by `N` pixels at a time.
    #[inline(always)]
    fn span<const N: usize>(&self, x: usize, y: usize, out: &mut [f64]) {
        self.background.span(x, y, self.columns, out);
        for (i, out) in out.chunks_mut(N).enumerate() {
            // As a pixel alone is made: the sum of all signal, added to the background.
            let mut signal_e = [0.0; N];
            let signal_e = &mut signal_e[..out.len()];
            self.add_signal(x + i * N, y, signal_e);
            for (out, signal_e) in out.iter_mut().zip(signal_e) {
                *out += *signal_e;
            }
        }
    }

    /// The pixels of piece `p` of row `y`, as indices into the image.
    pub(crate) fn piece_pixels(&self, y: usize, p: usize) -> Range<usize> {
        y * self.columns + p * PIECE..y * self.columns + ((p + 1) * PIECE).min(self.columns)
    }

    /// The pixels of piece `p` of row `y` where something was drawn, one bit each, and their electrons above the background.
    #[inline(always)]
    pub(crate) fn signal_in(&self, y: usize, p: usize) -> (u64, [f64; PIECE]) {
        let mut signal_e = [0.0; PIECE];
        self.add_signal(p * PIECE, y, &mut signal_e[..self.piece_pixels(y, p).len()]);
        let lit = signal_e.iter().enumerate().fold(0, |lit, (i, &e)| lit | u64::from(e > 0.0) << i);
        (lit | self.is_single[y * self.words_per_row + p], signal_e)
    }

    /// No pixel of the background of row `y` has more electrons.
    #[inline(always)]
    pub(crate) fn row_bound_e(&self, y: usize) -> f64 {
        self.background.row_bound_e(y, self.columns)
    }

    /// In which parts of piece `p` of row `y` something was drawn that may bring a pixel above `limit_e`, over a background of at
    /// most `bound_e`, which is no more than that: a bit each, the lowest first.
    #[inline(always)]
    pub(crate) fn parts_that_may_rise_above<S: Simd>(
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
        // The peaks of objects side by side were added up.
        let mut signal_e = [0.0; PIECE];
        self.add_signal(p * PIECE, y, &mut signal_e[..self.piece_pixels(y, p).len()]);
        signal_e.as_chunks::<PART>().0.iter().enumerate().fold(0, |parts, (i, part)| {
            let eights = part.as_chunks::<LANES>().0.iter().map(|eight| F64x8::from_array(simd, eight));
            let peak_e = eights.fold(F64x8::splat(simd, 0.0), F64x8::max).largest();
            parts | u64::from(bound_e + peak_e > limit_e) << i
        })
    }

    /// Of each column, the rows from the first to the last pixel with more than `limit_e` expected electrons.
    pub(crate) fn rows_above(&self, limit_e: f64) -> Vec<Range<usize>> {
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
        // Then only something drawn can be above it.
        let simd = pulp::Scalar::new();
        for y in 0..self.rows {
            let may_rise = |&p: &usize| self.parts_that_may_rise_above(simd, y, p, bound_e, limit_e) != 0;
            for p in (0..self.words_per_row).filter(may_rise) {
                let piece = columns.iter_mut().enumerate().skip(p * PIECE).take(PIECE);
                piece
                    .filter(|(x, _)| self.electrons_at(*x, y) > limit_e)
                    .for_each(|(_, rows)| extend(rows, y));
            }
        }
        columns
    }

    /// Index (row by row) and electrons above the background of every pixel where something was drawn, in the order
    /// of the image.
    pub fn object_pixels(&self) -> impl Iterator<Item = (usize, f64)> {
        let pieces = (0..self.rows).flat_map(|y| (0..self.words_per_row).map(move |p| (y, p)));
        pieces
            .filter(|(y, p)| {
                self.peaks[y * self.words_per_row + p] != 0.0
                    || self.is_single[y * self.words_per_row + p] != 0
            })
            .flat_map(|(y, p)| {
                let (lit, signal_e) = self.signal_in(y, p);
                let first = self.piece_pixels(y, p).start;
                set_bits(lit).map(move |bit| (first + bit, signal_e[bit]))
            })
    }
}

/// Whether any bit is set: without an early exit, for many words at once.
#[inline(always)]
fn any(words: &[u64]) -> bool {
    words.iter().fold(0, |all, word| all | word) != 0
}

/// The image of an object, as the pixels of an image respond to it.
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

/// The places of the ones in a word, lowest first.
pub(crate) fn set_bits(word: u64) -> impl Iterator<Item = usize> {
    // Each word is the one before without its lowest one.
    std::iter::successors(Some(word), |word| Some(word & word.wrapping_sub(1)))
        .take_while(|word| *word != 0)
        .map(|word| word.trailing_zeros() as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::{Psf, PsfConfig};
    use contract::PixelPoint;

    fn star(image: &mut ExpectedImage, x: f64, y: f64) {
        let mut psf = Psf::new(&PsfConfig::Gaussian { sigma_px: 2.0 }).unwrap();
        let mut stamp = Stamp::new();
        psf.stamp(PixelPoint::new(x, y), 1e4, 0.01, image.size(), &mut stamp);
        image.add(&stamp);
    }

    #[test]
    fn every_pixel_that_differs_from_the_flat_level_is_told_once_and_in_order() {
        let mut image = ExpectedImage::new(150, 70);
        image.clear(5.0);
        for (x, y) in [(64.0, 30.0), (66.0, 31.0), (0.0, 0.0), (149.0, 69.0), (127.5, 5.0)] {
            star(&mut image, x, y);
        }
        image.add_pixel(63, 60, 7.0);
        let indices: Vec<usize> = image.object_pixels().map(|(index, _)| index).collect();
        assert!(indices.windows(2).all(|pair| pair[0] < pair[1]));
        let differ: Vec<usize> =
            image.iter().enumerate().filter(|(_, e)| *e != 5.0).map(|(i, _)| i).collect();
        assert_eq!(indices, differ);
        assert_eq!(image.electrons_at(63, 60), 12.0);
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
