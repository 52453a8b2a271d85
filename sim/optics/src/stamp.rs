//! Stamp: the image of one object as a small patch of expected electrons.

use contract::{PixelPoint, Window};
use pulp::Simd;

use crate::simd_kernel::{F64x8, LANES, SimdKernel, run_widest};

/// Expected electrons of one object, in a rectangle of the detector. Reused from object to object.
///
/// A stamp is clipped to the detector: electrons outside the detector are in no pixel and in no sum.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stamp {
    pub(super) x: usize,
    pub(super) y: usize,
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Number of columns plus trailing zeros up to a multiple of [`LANES`]: rows are short, and loops over
    /// them need no remainder.
    pub(super) stride: usize,
    pub(super) centre: PixelPoint,
    /// Electrons row by row.
    pub(super) electrons: Vec<f64>,
}

/// Entries of the truth table about the image of one object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StampTruth {
    /// Sum over the stamp's pixels, electrons.
    pub electrons: f64,
    /// Electrons of the brightest pixel.
    pub peak_electrons: f64,
    /// Signal-to-noise ratio of a matched filter with known noise: sqrt(Σ s²/(s + b + σ²)), with s limited to
    /// the range of a pixel above its background.
    pub snr: f64,
    /// Distance from the centre to the farthest pixel centre whose signal exceeds the noise of the empty
    /// background, sqrt(b + σ²), px; at least 0.5.
    pub radius_px: f64,
}

impl Stamp {
    /// Creates an empty stamp.
    pub fn new() -> Self {
        Self::default()
    }

    /// Turns this stamp into that of a single pixel, for instance of a hot pixel.
    pub fn set_pixel(&mut self, x: usize, y: usize, electrons: f64) {
        self.reset(PixelPoint::new(x as f64, y as f64), (x, x + 1), (y, y + 1));
        self.electrons[0] = electrons;
    }

    /// Resets this stamp to zeros over columns `x.0..x.1` and rows `y.0..y.1`; an empty range makes it empty.
    pub fn reset(&mut self, centre: PixelPoint, x: (usize, usize), y: (usize, usize)) {
        (self.x, self.y) = (x.0, y.0);
        (self.columns, self.rows) = (x.1.saturating_sub(x.0), y.1.saturating_sub(y.0));
        self.stride = self.columns.next_multiple_of(LANES);
        self.centre = centre;
        self.electrons.clear();
        self.electrons.resize(self.stride * self.rows, 0.0);
    }

    /// Turns this stamp into the image of an object in an interlaced frame: rows for which `in_first` holds
    /// are taken from `first`, all other rows from `second`. Its centre is the midpoint of their centres.
    pub fn weave(&mut self, first: &Self, second: &Self, in_first: impl Fn(usize) -> bool) {
        let fields = [(first, true), (second, false)];
        let (x, y) = covered(&[first, second]);
        let middle = |a: f64, b: f64| 0.5 * (a + b);
        let centre =
            PixelPoint::new(middle(first.centre.x, second.centre.x), middle(first.centre.y, second.centre.y));
        self.reset(centre, x, y);
        for (stamp, is_first) in fields {
            for (start, row, electrons) in stamp.rows().filter(|(_, row, _)| in_first(*row) == is_first) {
                let at = (row - self.y) * self.stride + start - self.x;
                self.electrons[at..at + electrons.len()].copy_from_slice(electrons);
            }
        }
    }

    /// Turns this stamp into the image of an object that moves while its rows are exposed one after another.
    /// `images` are the images at the times of the rows `centre` − `span`, `centre` and `centre` + `span`;
    /// each row is interpolated between them by a parabola. Its centre is that of the second image.
    pub fn interpolate_rows(&mut self, images: [&Self; 3], centre: f64, span: f64) {
        let (x, y) = covered(&images);
        self.reset(images[1].centre, x, y);
        for (index, image) in images.into_iter().enumerate() {
            for (start, row, electrons) in image.rows() {
                let t = (row as f64 - centre) / span;
                let weight = [0.5 * t * (t - 1.0), 1.0 - t * t, 0.5 * t * (t + 1.0)][index];
                let at = (row - self.y) * self.stride + start - self.x;
                for (i, value) in electrons.iter().enumerate() {
                    self.electrons[at + i] += weight * value;
                }
            }
        }
        // The parabola may fall below zero at the edge of an image.
        for value in &mut self.electrons {
            *value = value.max(0.0);
        }
    }

    /// Adds electrons to a pixel; does nothing outside the stamp.
    pub fn add(&mut self, x: usize, y: usize, electrons: f64) {
        if let Some(pixel) = self.pixel_mut(x, y) {
            *pixel += electrons;
        }
    }

    /// Sets the electrons of a pixel to zero; does nothing outside the stamp.
    pub fn empty(&mut self, x: usize, y: usize) {
        if let Some(pixel) = self.pixel_mut(x, y) {
            *pixel = 0.0;
        }
    }

    /// Electrons of a pixel; `None` outside the stamp.
    fn pixel_mut(&mut self, x: usize, y: usize) -> Option<&mut f64> {
        let is_inside =
            (self.x..self.x + self.columns).contains(&x) && (self.y..self.y + self.rows).contains(&y);
        is_inside.then(|| &mut self.electrons[(y - self.y) * self.stride + x - self.x])
    }

    /// Flux-weighted mean position of the geometric image, including its part off the detector.
    pub fn centre(&self) -> PixelPoint {
        self.centre
    }

    /// Rectangle that the stamp covers; `None` if it contains no pixel of the detector.
    pub fn window(&self) -> Option<Window> {
        (!self.electrons.is_empty()).then_some(Window {
            x: self.x,
            y: self.y,
            columns: self.columns,
            rows: self.rows,
        })
    }

    /// Rows of the stamp: first column, row, expected electrons.
    pub fn rows(&self) -> impl Iterator<Item = (usize, usize, &[f64])> {
        // An empty stamp has rows without columns; a chunk size of zero is not allowed.
        let rows = self.electrons.chunks_exact(self.stride.max(1)).enumerate();
        rows.map(|(j, row)| (self.x, self.y + j, &row[..self.columns]))
    }

    /// Expected electrons of row `y` of the detector, which must be a row of the stamp.
    #[inline(always)]
    pub fn row(&self, y: usize) -> &[f64] {
        let start = (y - self.y) * self.stride;
        &self.electrons[start..start + self.columns]
    }

    /// Rows of the stamp with their trailing zeros: first column, row, expected electrons.
    #[inline(always)]
    pub fn rows_mut(&mut self) -> impl Iterator<Item = (usize, usize, &mut [f64])> {
        let (x, y) = (self.x, self.y);
        self.electrons.chunks_exact_mut(self.stride.max(1)).enumerate().map(move |(j, row)| (x, y + j, row))
    }

    /// Number of columns, without the trailing zeros.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Computes the entries of the truth table, over a flat background of `background_e` electrons per pixel
    /// (sky and dark current), with a readout noise of `readout_noise_e` per pixel, and pixels that saturate
    /// at `saturation_e` electrons.
    pub fn truth(&self, background_e: f64, readout_noise_e: f64, saturation_e: f64) -> StampTruth {
        run_widest(Truth { stamp: self, background_e, readout_noise_e, saturation_e })
    }

    /// Distance from the centre to the farthest pixel centre with more than `electrons`, px; at least 0.5.
    #[inline(always)]
    fn radius_px(&self, electrons: f64) -> f64 {
        let mut radius2 = 0.25_f64;
        for (j, row) in self.electrons.chunks_exact(self.stride.max(1)).enumerate() {
            // The farthest pixel of a row is the first or the last.
            let Some((first, last)) = first_and_last_above(row, electrons) else { continue };
            let dy = (self.y + j) as f64 - self.centre.y;
            for i in [first, last] {
                let dx = (self.x + i) as f64 - self.centre.x;
                radius2 = radius2.max(dx * dx + dy * dy);
            }
        }
        radius2.sqrt()
    }

    /// Distance along the columns from the centre to the farthest pixel centre with more than `electrons`,
    /// px; 0 if there is none.
    pub fn height_px(&self, electrons: f64) -> f64 {
        self.rows()
            .filter(|(_, _, row)| row.iter().any(|&signal| signal > electrons))
            .map(|(_, y, _)| (y as f64 - self.centre.y).abs())
            .fold(0.0, f64::max)
    }

    /// Fraction of the stamp's electrons outside every window, in [0, 1]; 0 for an empty stamp.
    pub fn cut(&self, windows: &[Window]) -> f64 {
        let (right, bottom) = (self.x + self.columns, self.y + self.rows);
        // Most windows of a frame are elsewhere, and most stamps are in one window or in none. There is no
        // early exit, to test many windows at once.
        let touches = |w: &&Window| {
            (w.x < right) & (self.x < w.x + w.columns) & (w.y < bottom) & (self.y < w.y + w.rows)
        };
        let touched: Vec<&Window> = if windows.iter().fold(false, |any, w| any | touches(&w)) {
            windows.iter().filter(touches).collect()
        } else {
            Vec::new()
        };
        let covers = |w: &&Window| {
            w.x <= self.x && w.y <= self.y && right <= w.x + w.columns && bottom <= w.y + w.rows
        };
        if touched.iter().any(covers) {
            return 0.0;
        }
        if touched.is_empty() {
            return if self.electrons.iter().any(|&signal| signal > 0.0) { 1.0 } else { 0.0 };
        }
        let mut kept = 0.0;
        let (top, last) =
            touched.iter().fold((bottom, self.y), |(top, last), w| (top.min(w.y), last.max(w.y + w.rows)));
        for (x, y, row) in self.rows().skip(top.saturating_sub(self.y)).take_while(|(_, y, _)| *y < last) {
            // From the left: to the end of the windows that contain a pixel, then to the start of the next
            // window, and so on, so that overlapping windows count once.
            let mut from = 0;
            while from < row.len() {
                let in_row = || touched.iter().filter(|w| w.contains(w.x, y));
                let holding = in_row().filter(|w| w.contains(x + from, y)).map(|w| w.x + w.columns - x).max();
                let next = match holding {
                    Some(end) => end.min(row.len()),
                    None => in_row().filter(|w| w.x > x + from).map(|w| w.x - x).min().unwrap_or(row.len()),
                };
                if holding.is_some() {
                    kept += row[from..next].iter().sum::<f64>();
                }
                from = next;
            }
        }
        // Sums are formed in parallel: in sequence each would wait for the previous one.
        let mut sums = [0.0; LANES];
        for electrons in self.electrons.as_chunks::<LANES>().0 {
            for (sum, electrons) in sums.iter_mut().zip(electrons) {
                *sum += electrons;
            }
        }
        let total: f64 = sums.iter().sum();
        if total > 0.0 { ((total - kept) / total).clamp(0.0, 1.0) } else { 0.0 }
    }
}

/// Arguments of [`Stamp::truth`].
struct Truth<'a> {
    stamp: &'a Stamp,
    background_e: f64,
    readout_noise_e: f64,
    saturation_e: f64,
}

impl SimdKernel for Truth<'_> {
    type Output = StampTruth;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> StampTruth {
        let Self { stamp, background_e, readout_noise_e, saturation_e } = self;
        let variance = background_e + readout_noise_e * readout_noise_e;
        let noise_e = variance.sqrt();
        let none = F64x8::splat(simd, 0.0);
        // Without signal and noise the quotient is 0, not NaN.
        let noise2 = F64x8::splat(simd, variance.max(f64::MIN_POSITIVE));
        let room = F64x8::splat(simd, (saturation_e - background_e).max(0.0));
        let [mut electrons, mut snr2, mut peaks] = [none; 3];
        for signals in stamp.electrons.as_chunks::<LANES>().0 {
            let lit = F64x8::from_array(simd, signals).max(none);
            electrons = electrons.plus(lit);
            let signal_e = lit.min(room);
            snr2 = snr2.plus(signal_e.times(signal_e.over(signal_e.plus(noise2))));
            peaks = peaks.max(lit);
        }
        let peak_electrons = peaks.largest();
        StampTruth {
            electrons: electrons.sum(),
            peak_electrons,
            snr: snr2.sum().sqrt(),
            radius_px: if peak_electrons > noise_e { stamp.radius_px(noise_e) } else { 0.5 },
        }
    }
}

/// Indices of the first and the last value above a limit in a row of a stamp, including its padding.
#[inline(always)]
fn first_and_last_above(row: &[f64], limit: f64) -> Option<(usize, usize)> {
    let chunks = row.as_chunks::<LANES>().0;
    // No early exit within a chunk, to test all its values at once.
    let any = |chunk: &[f64; LANES]| chunk.iter().fold(false, |any, &number| any | (number > limit));
    let above = |&number: &f64| number > limit;
    let (i, j) = (chunks.iter().position(any)?, chunks.iter().rposition(any)?);
    let first = i * LANES + chunks[i].iter().position(above)?;
    let last = j * LANES + chunks[j].iter().rposition(above)?;
    Some((first, last))
}

/// Returns the columns and the rows, from the first to the one after the last, that stamps cover together.
fn covered(stamps: &[&Stamp]) -> ((usize, usize), (usize, usize)) {
    let mut windows = stamps.iter().filter_map(|stamp| stamp.window());
    let Some(first) = windows.next() else { return ((0, 0), (0, 0)) };
    let mut x = (first.x, first.x + first.columns);
    let mut y = (first.y, first.y + first.rows);
    for window in windows {
        x = (x.0.min(window.x), x.1.max(window.x + window.columns));
        y = (y.0.min(window.y), y.1.max(window.y + window.rows));
    }
    (x, y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fill(stamp: &mut Stamp, electrons: &[f64]) {
        let columns = stamp.columns;
        for ((_, _, row), electrons) in stamp.rows_mut().zip(electrons.chunks_exact(columns)) {
            row[..columns].copy_from_slice(electrons);
        }
    }

    fn two_by_two() -> Stamp {
        let mut stamp = Stamp::new();
        stamp.reset(PixelPoint::new(10.0, 20.0), (10, 12), (20, 22));
        fill(&mut stamp, &[100.0, 30.0, 20.0, 0.0]);
        stamp
    }

    #[test]
    fn the_truth_of_a_stamp_follows_its_formulas() {
        let truth = two_by_two().truth(9.0, 4.0, f64::INFINITY);
        assert_eq!(truth.electrons, 150.0);
        assert_eq!(truth.peak_electrons, 100.0);
        let snr = (1e4 / 125.0 + 900.0 / 55.0 + 400.0 / 45.0_f64).sqrt();
        assert!((truth.snr - snr).abs() < 1e-12);
        // The noise is 5 e⁻: pixels at a distance of one exceed it, the diagonal pixel does not.
        assert_eq!(truth.radius_px, 1.0);
    }

    #[test]
    fn only_signal_below_the_full_well_counts() {
        let stamp = two_by_two();
        // The pixels have room for 40 e⁻ above the background of 9.
        let snr = (1600.0 / 65.0 + 900.0 / 55.0 + 400.0 / 45.0_f64).sqrt();
        assert!((stamp.truth(9.0, 4.0, 49.0).snr - snr).abs() < 1e-12);
        // The background saturates the pixels: the object exists, but it cannot be detected.
        let full = stamp.truth(60.0, 4.0, 49.0);
        assert_eq!((full.snr, full.electrons, full.peak_electrons), (0.0, 150.0, 100.0));
    }

    #[test]
    fn a_woven_stamp_has_alternate_rows_of_both_images() {
        let (first, mut second, mut woven) = (two_by_two(), Stamp::new(), Stamp::new());
        second.reset(PixelPoint::new(13.0, 21.0), (12, 14), (20, 23));
        fill(&mut second, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        woven.weave(&first, &second, |row| row % 2 == 0);
        let rows: Vec<_> = woven.rows().map(|(x, y, row)| (x, y, row.to_vec())).collect();
        assert_eq!(rows[0], (10, 20, vec![100.0, 30.0, 0.0, 0.0]));
        assert_eq!(rows[1], (10, 21, vec![0.0, 0.0, 3.0, 4.0]));
        assert_eq!(rows[2], (10, 22, vec![0.0; 4]));
        assert_eq!(woven.centre(), PixelPoint::new(11.5, 20.5));
        // An image off the detector contributes no rows.
        woven.weave(&first, &Stamp::new(), |row| row % 2 == 1);
        assert_eq!(woven.rows().map(|(_, _, row)| row.iter().sum()).collect::<Vec<f64>>(), [0.0, 20.0]);
        woven.weave(&Stamp::new(), &Stamp::new(), |_| true);
        assert_eq!(woven.window(), None);
        woven.weave(&first, &first, |row| row % 2 == 1);
        assert_eq!(woven, first);
    }

    #[test]
    fn a_faint_object_has_the_radius_of_a_pixel() {
        let mut stamp = Stamp::new();
        stamp.set_pixel(3, 4, 1.0);
        assert_eq!(stamp.truth(100.0, 10.0, f64::INFINITY).radius_px, 0.5);
    }

    #[test]
    fn the_cut_is_the_share_outside_every_window() {
        let window = |x, y, columns, rows| Window { x, y, columns, rows };
        let stamp = two_by_two();
        assert_eq!(stamp.cut(&[window(0, 0, 50, 50)]), 0.0);
        assert_eq!(stamp.cut(&[window(0, 0, 5, 5)]), 1.0);
        assert_eq!(stamp.cut(&[]), 1.0);
        assert_eq!(stamp.cut(&[window(0, 0, 50, 21)]), 20.0 / 150.0);
        // Overlapping windows count once.
        assert_eq!(stamp.cut(&[window(10, 20, 1, 2), window(10, 20, 1, 1)]), 30.0 / 150.0);
        assert_eq!(Stamp::new().cut(&[]), 0.0);
    }
}
