//! The expected image: photo-electrons before any noise.

use crate::optics::Stamp;

/// Expected photo-electrons of a frame: a flat level, a field where the background is not flat, and signal where
/// something was drawn.
///
/// Most pixels of a star field hold the flat level and nothing else. The image knows which ones do not, so that
/// clearing it, and drawing the noise, cost as much as there is signal. It is reused from frame to frame.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpectedImage {
    columns: usize,
    rows: usize,
    flat_e: f64,
    /// Background above the flat level, row by row; empty when there is none.
    field: Vec<f64>,
    /// Electrons of what was drawn, above the background, row by row.
    signal: Vec<f64>,
    /// One bit a pixel, `words_per_row` words a row: whether something was drawn there.
    drawn: Vec<u64>,
    words_per_row: usize,
}

impl ExpectedImage {
    /// An image without light.
    pub fn new(columns: usize, rows: usize) -> Self {
        let words_per_row = columns.div_ceil(64);
        Self {
            columns,
            rows,
            flat_e: 0.0,
            field: Vec::new(),
            signal: vec![0.0; columns * rows],
            drawn: vec![0; words_per_row * rows],
            words_per_row,
        }
    }

    /// Columns and rows.
    pub fn size(&self) -> (usize, usize) {
        (self.columns, self.rows)
    }

    /// Takes away everything drawn and the field, and sets the flat level, electrons a pixel.
    pub fn clear(&mut self, flat_e: f64) {
        for (row, words) in self
            .signal
            .chunks_exact_mut(self.columns.max(1))
            .zip(self.drawn.chunks_exact_mut(self.words_per_row.max(1)))
        {
            for (pixels, word) in row.chunks_mut(64).zip(words) {
                if *word != 0 {
                    pixels.fill(0.0);
                    *word = 0;
                }
            }
        }
        self.flat_e = flat_e;
        self.field.clear();
    }

    /// Sets a background that varies from pixel to pixel: `scale` · `field`, electrons above the flat level, row by row;
    /// `None` takes it away. Where `field` is too short, there is none.
    pub fn set_field(&mut self, field: Option<&[f64]>, scale: f64) {
        self.field.clear();
        if let Some(field) = field {
            self.field.extend(field.iter().take(self.signal.len()).map(|electrons| scale * electrons));
            self.field.resize(self.signal.len(), 0.0);
        }
    }

    /// Whether the background varies from pixel to pixel.
    pub fn has_field(&self) -> bool {
        !self.field.is_empty()
    }

    /// The field, of zeros if there was none, for the effects of the detector.
    fn field_mut(&mut self) -> &mut [f64] {
        self.field.resize(self.signal.len(), 0.0);
        &mut self.field
    }

    /// Multiplies the light of every pixel, background and signal, by its response.
    pub(crate) fn respond(&mut self, response: &[f32]) {
        let flat_e = self.flat_e;
        if self.field.is_empty() {
            let pixels = response.iter().take(self.signal.len());
            self.field.extend(pixels.map(|&response| flat_e * f64::from(response) - flat_e));
            self.field.resize(self.signal.len(), 0.0);
        } else {
            for (field, &response) in self.field.iter_mut().zip(response) {
                *field = (flat_e + *field) * f64::from(response) - flat_e;
            }
        }
        // Where nothing was drawn there is nothing to multiply.
        for index in drawn_pixels(&self.drawn, self.columns, self.words_per_row) {
            if let (Some(signal), Some(&response)) = (self.signal.get_mut(index), response.get(index)) {
                *signal *= f64::from(response);
            }
        }
    }

    /// Adds `electrons` to every pixel, times a factor of its own.
    pub(crate) fn add_pattern(&mut self, electrons: f64, factors: &[f32]) {
        self.flat_e += electrons;
        for (field, &factor) in self.field_mut().iter_mut().zip(factors) {
            *field += electrons * (f64::from(factor) - 1.0);
        }
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
        self.field_mut();
        for y in 0..self.rows {
            self.row(y, &mut own);
            let field = self.field.iter_mut().skip(y * self.columns);
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
        self.mark(y, x, x + 1);
    }

    /// Expected electrons of the background in a pixel: flat level and field.
    pub fn background_at(&self, x: usize, y: usize) -> f64 {
        self.flat_e + self.field.get(y * self.columns + x).copied().unwrap_or(0.0)
    }

    /// Raises the flat level of every pixel, electrons.
    pub fn add_flat(&mut self, electrons: f64) {
        self.flat_e += electrons;
    }

    /// Adds the image of an object. Pixels of the stamp that lie off the image are left out.
    pub fn add(&mut self, stamp: &Stamp) {
        for (x, y, row) in stamp.rows() {
            if y >= self.rows || x >= self.columns {
                continue;
            }
            let row = &row[..row.len().min(self.columns - x)];
            // Only from the first to the last pixel that has light.
            let Some(first) = row.iter().position(|&electrons| electrons > 0.0) else { continue };
            let end = row.iter().rposition(|&electrons| electrons > 0.0).map_or(first, |last| last + 1);
            let start = y * self.columns + x;
            for (pixel, electrons) in self.signal[start + first..start + end].iter_mut().zip(&row[first..end])
            {
                *pixel += electrons;
            }
            self.mark(y, x + first, x + end);
        }
    }

    /// Adds electrons to one pixel; outside the image nothing happens.
    pub fn add_pixel(&mut self, x: usize, y: usize, electrons: f64) {
        if x < self.columns && y < self.rows {
            self.signal[y * self.columns + x] += electrons;
            self.mark(y, x, x + 1);
        }
    }

    /// The flat level, electrons a pixel.
    pub fn flat_e(&self) -> f64 {
        self.flat_e
    }

    /// Expected electrons of a pixel, background included.
    pub fn at(&self, x: usize, y: usize) -> f64 {
        self.background_at(x, y) + self.signal[y * self.columns + x]
    }

    /// Expected electrons of all pixels, row by row, background included.
    pub fn iter(&self) -> impl Iterator<Item = f64> {
        let field = self.field.iter().copied().chain(std::iter::repeat(0.0));
        self.signal.iter().zip(field).map(|(signal, field)| self.flat_e + field + signal)
    }

    /// Expected electrons of the pixels of a row, background included; `out` is as long as a row.
    pub(crate) fn row(&self, y: usize, out: &mut [f64]) {
        let pixels = y * self.columns..(y + 1) * self.columns;
        let signal = self.signal.get(pixels.clone()).unwrap_or_default();
        match self.field.get(pixels) {
            Some(field) => {
                for ((out, signal), field) in out.iter_mut().zip(signal).zip(field) {
                    *out = self.flat_e + field + signal;
                }
            }
            None => {
                for (out, signal) in out.iter_mut().zip(signal) {
                    *out = self.flat_e + signal;
                }
            }
        }
    }

    /// Index (row by row) and electrons above the background of every pixel where something was drawn, in the order
    /// of the image.
    pub fn drawn(&self) -> impl Iterator<Item = (usize, f64)> {
        drawn_pixels(&self.drawn, self.columns, self.words_per_row).map(|index| (index, self.signal[index]))
    }

    /// Marks columns `from..to` of a row as drawn.
    fn mark(&mut self, y: usize, from: usize, to: usize) {
        for word in from / 64..to.div_ceil(64) {
            let start = from.max(word * 64) - word * 64;
            let length = to.min((word + 1) * 64) - word * 64 - start;
            self.drawn[y * self.words_per_row + word] |= (u64::MAX >> (64 - length)) << start;
        }
    }
}

/// Indices, row by row, of the pixels that are marked in `words`.
fn drawn_pixels(words: &[u64], columns: usize, words_per_row: usize) -> impl Iterator<Item = usize> {
    words.iter().enumerate().filter(|(_, word)| **word != 0).flat_map(move |(i, &word)| {
        let first = i / words_per_row * columns + i % words_per_row * 64;
        SetBits(word).map(move |bit| first + bit)
    })
}

/// The places of the ones in a word, lowest first.
struct SetBits(u64);

impl Iterator for SetBits {
    type Item = usize;
    fn next(&mut self) -> Option<usize> {
        if self.0 == 0 {
            return None;
        }
        let bit = self.0.trailing_zeros() as usize;
        self.0 &= self.0 - 1;
        Some(bit)
    }
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
