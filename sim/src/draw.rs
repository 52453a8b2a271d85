//! The expected image: photo-electrons before any noise.

mod background;

use std::ops::Range;

use background::Background;

use crate::optics::Stamp;
use crate::pixel_factors::PixelFactors;
use crate::smooth_field::SmoothField;
use crate::widest::{Work, by_eights, widest};

/// Pixels of a piece of a row, the unit in which images are looked at: of each there is one word of bits.
pub(crate) const PIECE: usize = u64::BITS as usize;

/// Expected photo-electrons of a frame: a flat level, what makes the background uneven, and signal where something was drawn.
///
/// The background is kept as it was told, in layers, and made row by row when it is asked for: an image is not walked through
/// for each of them. The image knows the pixels where something was drawn, so that clearing it, and drawing the noise of a flat
/// background, cost as much as there is signal. It is reused from frame to frame.
#[derive(Debug, Clone)]
pub struct ExpectedImage {
    columns: usize,
    rows: usize,
    background: Background,
    /// Electrons of what was drawn, above the background, row by row.
    signal: Vec<f64>,
    /// One bit a pixel, `words_per_row` words a row: whether something was drawn there.
    drawn: Vec<u64>,
    words_per_row: usize,
    /// Of each piece, no pixel has more electrons of what was drawn.
    peaks: Vec<f64>,
}

/// Images are equal that have the same electrons in every pixel, however they were told.
impl PartialEq for ExpectedImage {
    fn eq(&self, other: &Self) -> bool {
        self.size() == other.size() && self.drawn == other.drawn && self.iter().eq(other.iter())
    }
}

impl ExpectedImage {
    /// An image without light.
    pub fn new(columns: usize, rows: usize) -> Self {
        let words_per_row = columns.div_ceil(64);
        Self {
            columns,
            rows,
            background: Background::default(),
            signal: vec![0.0; columns * rows],
            drawn: vec![0; words_per_row * rows],
            words_per_row,
            peaks: vec![0.0; words_per_row * rows],
        }
    }

    /// Columns and rows.
    pub fn size(&self) -> (usize, usize) {
        (self.columns, self.rows)
    }

    /// Takes away everything drawn and all that is uneven, and sets the flat level, electrons a pixel.
    pub fn clear(&mut self, flat_e: f64) {
        for (row, words) in self
            .signal
            .chunks_exact_mut(self.columns.max(1))
            .zip(self.drawn.chunks_exact_mut(self.words_per_row.max(1)))
        {
            for (pixels, word) in row.chunks_mut(PIECE).zip(words) {
                if *word != 0 {
                    pixels.fill(0.0);
                    *word = 0;
                }
            }
        }
        self.peaks.fill(0.0);
        let mut field = std::mem::take(&mut self.background.field);
        field.clear();
        self.background = Background { light_e: flat_e, field, ..Background::default() };
    }

    /// Sets light that varies from pixel to pixel: `scale` · `field`, electrons above the flat level, row by row;
    /// `None` takes it away. Where `field` is too short, there is none.
    pub fn set_field(&mut self, field: Option<&[f64]>, scale: f64) {
        let held = &mut self.background.field;
        held.clear();
        if let Some(field) = field {
            held.extend(field.iter().take(self.signal.len()).map(|electrons| scale * electrons));
            held.resize(self.signal.len(), 0.0);
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
        let mut field = vec![0.0; self.signal.len()];
        for (y, row) in field.chunks_exact_mut(self.columns.max(1)).enumerate() {
            self.background.span(0, y, self.columns, row);
            row.iter_mut().for_each(|electrons| *electrons -= flat_e);
        }
        self.background = Background { light_e: flat_e, field, ..Background::default() };
    }

    /// Multiplies the light of every pixel, background and signal, by its response.
    pub(crate) fn respond(&mut self, response: &PixelFactors) {
        let Background { response: other, pattern, dark_e, .. } = &self.background;
        if other.is_some() || pattern.is_some() || *dark_e != 0.0 {
            self.flatten();
        }
        self.background.response = Some(response.clone());
        // A part in 10^12 for what rounding adds.
        let largest = response.largest() * (1.0 + 1e-12);
        self.peaks.iter_mut().for_each(|peak| *peak *= largest);
        widest(Respond { image: self, response });
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
        let (mut sums, mut own) = (vec![0.0; self.columns], vec![0.0; self.columns]);
        for y in 0..self.rows {
            self.row(y, &mut own);
            for (sum, own) in sums.iter_mut().zip(&own) {
                *sum += own;
            }
        }
        self.flatten();
        for y in 0..self.rows {
            self.row(y, &mut own);
            let field = self.background.field.iter_mut().skip(y * self.columns);
            for ((field, own), sum) in field.zip(&own).zip(&sums) {
                *field += share * (sum - own);
            }
        }
        // Each pixel gives to all others of its column, and there are as many of them as pixels that it is one of.
        let others = self.rows.saturating_sub(1) as f64;
        share * others * sums.iter().sum::<f64>() / (self.columns * self.rows).max(1) as f64
    }

    /// Empties one pixel, background included.
    pub(crate) fn empty_pixel(&mut self, x: usize, y: usize) {
        let background_e = self.background_at(x, y);
        self.signal[y * self.columns + x] = -background_e;
        self.mark(y, x, x + 1, 0.0);
    }

    /// Expected electrons of the background in a pixel.
    pub fn background_at(&self, x: usize, y: usize) -> f64 {
        self.background.at(x, y, self.columns)
    }

    /// Raises the flat level of every pixel, electrons; no response changes them.
    pub fn add_flat(&mut self, electrons: f64) {
        self.background.dark_e += electrons;
    }

    /// Adds the image of an object. Pixels of the stamp that lie off the image are left out.
    pub fn add(&mut self, stamp: &Stamp) {
        widest(Add { image: self, stamp });
    }

    /// Adds electrons to one pixel; outside the image nothing happens.
    pub fn add_pixel(&mut self, x: usize, y: usize, electrons: f64) {
        if x < self.columns && y < self.rows {
            let pixel = &mut self.signal[y * self.columns + x];
            *pixel += electrons;
            let peak_e = *pixel;
            self.mark(y, x, x + 1, peak_e);
        }
    }

    /// The flat level, electrons a pixel: all of the background where it does not vary.
    pub fn flat_e(&self) -> f64 {
        let pattern_e = self.background.pattern.as_ref().map_or(0.0, |(electrons, _)| *electrons);
        self.background.light_e + (self.background.dark_e + pattern_e)
    }

    /// Expected electrons of a pixel, background included.
    pub fn at(&self, x: usize, y: usize) -> f64 {
        self.background_at(x, y) + self.signal[y * self.columns + x]
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
        self.background.span(0, y, self.columns, out);
        let signal = self.signal.chunks_exact(self.columns.max(1)).nth(y).unwrap_or_default();
        let words = self.drawn.chunks_exact(self.words_per_row.max(1)).nth(y).unwrap_or_default();
        for ((out, signal), word) in out.chunks_mut(PIECE).zip(signal.chunks(PIECE)).zip(words) {
            if *word != 0 {
                for (out, signal) in out.iter_mut().zip(signal) {
                    *out += signal;
                }
            }
        }
    }

    /// The pixels of piece `p` of row `y`, as indices into the image.
    pub(crate) fn piece_pixels(&self, y: usize, p: usize) -> Range<usize> {
        y * self.columns + p * PIECE..y * self.columns + ((p + 1) * PIECE).min(self.columns)
    }

    /// [`ExpectedImage::row`] of piece `p` alone; `out` is as long as the piece.
    #[inline(always)]
    pub(crate) fn piece(&self, y: usize, p: usize, out: &mut [f64]) {
        self.background.span(p * PIECE, y, self.columns, out);
        if self.drawn_in(y, p) != 0 {
            for (out, signal) in out.iter_mut().zip(&self.signal[self.piece_pixels(y, p)]) {
                *out += signal;
            }
        }
    }

    /// The pixels of piece `p` of row `y` where something was drawn, one bit each.
    #[inline(always)]
    pub(crate) fn drawn_in(&self, y: usize, p: usize) -> u64 {
        self.drawn[y * self.words_per_row + p]
    }

    /// Electrons of what was drawn in a pixel, above the background.
    pub(crate) fn signal_at(&self, index: usize) -> f64 {
        self.signal[index]
    }

    /// No pixel of the background of row `y` has more electrons.
    pub(crate) fn row_bound_e(&self, y: usize) -> f64 {
        self.background.row_bound_e(y, self.columns)
    }

    /// Whether in piece `p` of row `y` something was drawn that may bring a pixel above `limit_e`, over a background of at
    /// most `bound_e`.
    #[inline(always)]
    pub(crate) fn may_rise_above(&self, y: usize, p: usize, bound_e: f64, limit_e: f64) -> bool {
        self.drawn_in(y, p) != 0 && bound_e + self.peaks[y * self.words_per_row + p] > limit_e
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
        for y in 0..self.rows {
            for p in (0..self.words_per_row).filter(|&p| self.may_rise_above(y, p, bound_e, limit_e)) {
                let piece = columns.iter_mut().enumerate().skip(p * PIECE).take(PIECE);
                piece.filter(|(x, _)| self.at(*x, y) > limit_e).for_each(|(_, rows)| extend(rows, y));
            }
        }
        columns
    }

    /// Index (row by row) and electrons above the background of every pixel where something was drawn, in the order
    /// of the image.
    pub fn drawn(&self) -> impl Iterator<Item = (usize, f64)> {
        drawn_pixels(&self.drawn, self.columns, self.words_per_row).map(|index| (index, self.signal[index]))
    }

    /// Marks columns `from..to` of a row as drawn, with at most `peak_e` electrons in a pixel.
    #[inline(always)]
    fn mark(&mut self, y: usize, from: usize, to: usize, peak_e: f64) {
        for word in from / 64..to.div_ceil(64) {
            let start = from.max(word * 64) - word * 64;
            let length = to.min((word + 1) * 64) - word * 64 - start;
            let piece = y * self.words_per_row + word;
            self.drawn[piece] |= (u64::MAX >> (64 - length)) << start;
            self.peaks[piece] = self.peaks[piece].max(peak_e);
        }
    }
}

/// What was drawn in an image, multiplied by the response of each pixel.
struct Respond<'a> {
    image: &'a mut ExpectedImage,
    response: &'a [f32],
}

impl Work for Respond<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { image, response } = self;
        // Where nothing was drawn there is nothing to multiply.
        let rows = image.signal.chunks_exact_mut(image.columns.max(1));
        let words = image.drawn.chunks_exact(image.words_per_row.max(1));
        for ((signal, response), words) in rows.zip(response.chunks(image.columns.max(1))).zip(words) {
            let pieces = signal.chunks_mut(PIECE).zip(response.chunks(PIECE));
            for ((signal, response), _) in pieces.zip(words).filter(|(_, word)| **word != 0) {
                for (signal, &response) in signal.iter_mut().zip(response) {
                    *signal *= f64::from(response);
                }
            }
        }
    }
}

/// The image of an object, added to an image.
struct Add<'a> {
    image: &'a mut ExpectedImage,
    stamp: &'a Stamp,
}

impl Work for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { image, stamp } = self;
        for (x, y, row) in stamp.rows() {
            if y >= image.rows || x >= image.columns {
                continue;
            }
            let row = &row[..row.len().min(image.columns - x)];
            // Only from the first to the last pixel that has light.
            let Some(first) = row.iter().position(|&electrons| electrons > 0.0) else { continue };
            let end = row.iter().rposition(|&electrons| electrons > 0.0).map_or(first, |last| last + 1);
            let start = y * image.columns + x;
            let pixels = &mut image.signal[start + first..start + end];
            by_eights(pixels, &row[first..end], |pixel, electrons| *pixel += electrons);
            let peak_e = largest(pixels);
            image.mark(y, x + first, x + end, peak_e);
        }
    }
}

/// The largest of some numbers, and 0: eight at a time, for one after the other each would wait for the one before.
#[inline(always)]
fn largest(numbers: &[f64]) -> f64 {
    let (eights, rest) = numbers.as_chunks::<8>();
    let mut peaks = [0.0_f64; 8];
    for eight in eights {
        for (peak, &number) in peaks.iter_mut().zip(eight) {
            *peak = if number > *peak { number } else { *peak };
        }
    }
    peaks.iter().chain(rest).copied().fold(0.0, f64::max)
}

/// Indices, row by row, of the pixels that are marked in `words`.
fn drawn_pixels(words: &[u64], columns: usize, words_per_row: usize) -> impl Iterator<Item = usize> {
    words.iter().enumerate().filter(|(_, word)| **word != 0).flat_map(move |(i, &word)| {
        let first = i / words_per_row * columns + i % words_per_row * 64;
        set_bits(word).map(move |bit| first + bit)
    })
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
        let told: Vec<usize> = image.drawn().map(|(index, _)| index).collect();
        assert!(told.windows(2).all(|pair| pair[0] < pair[1]));
        let differ: Vec<usize> =
            image.iter().enumerate().filter(|(_, e)| *e != 5.0).map(|(i, _)| i).collect();
        assert_eq!(told, differ);
        assert_eq!(image.at(63, 60), 12.0);
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
        assert_eq!((image.at(0, 1), image.background_at(1, 1)), (35.0, 5.0));
        image.set_field(None, 1.0);
        assert_eq!(image.at(2, 0), 5.0);
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
