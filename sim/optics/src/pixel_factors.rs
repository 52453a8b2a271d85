//! Factor of every pixel of a detector, constant over all frames.

use std::ops::Range;
use std::sync::Arc;

use crate::simd_kernel::LANES;

/// Number of adjacent columns in a strip.
const STRIP: usize = 64;
/// Number of factors in a cache line of 64 bytes.
const LINE: usize = 16;
/// Number of factors in a row of a strip: whole cache lines.
const STRIDE: usize = (STRIP + LANES).next_multiple_of(LINE);

/// Factors of the pixels of a detector, none below 0; shared by all frames.
///
/// They are stored in strips of 64 columns, row after row of a strip. The rows of an object's image are thus
/// close together and not each in a separate page of memory, and each row of a strip begins at a cache line.
#[derive(Debug, Clone, Default)]
pub struct PixelFactors {
    /// Factors by strip. Each row of a strip continues with the first columns of the next strip: eight
    /// adjacent pixels are contiguous for any first pixel.
    values: Arc<[f32]>,
    /// Index at which the first strip begins.
    first: usize,
    columns: usize,
    rows: usize,
    largest: f32,
}

impl PixelFactors {
    /// Creates the factors of a detector with this number of columns, row by row; empty if there are none.
    pub fn new(columns: usize, factors: impl IntoIterator<Item = f32>) -> Self {
        let by_rows: Vec<f32> = factors.into_iter().collect();
        if by_rows.is_empty() || columns == 0 {
            return Self::default();
        }
        let rows = by_rows.len() / columns;
        // There is no light outside the pixels, so the padding is irrelevant.
        let mut values: Arc<[f32]> = vec![1.0; columns.div_ceil(STRIP) * rows * STRIDE + LINE].into();
        // Starts at a cache line if possible; this changes no factor.
        let first = values.as_ptr().align_offset(size_of::<[f32; LINE]>()).min(LINE);
        let slots = Arc::get_mut(&mut values).unwrap_or_default()[first..].chunks_exact_mut(STRIDE);
        let strips = (0..columns).step_by(STRIP);
        let all = strips.flat_map(|from| by_rows.chunks_exact(columns).map(move |row| &row[from..]));
        for (place, factors) in slots.zip(all) {
            let together = factors.len().min(STRIDE);
            place[..together].copy_from_slice(&factors[..together]);
        }
        let largest = by_rows.iter().copied().fold(0.0, f32::max);
        Self { values, first, columns, rows, largest }
    }

    /// Returns true if there are no factors.
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// Largest factor; 0 without factors.
    pub fn largest(&self) -> f64 {
        f64::from(self.largest)
    }

    /// Returns true if the factors belong to a detector with this number of columns and with a row `y`.
    #[inline(always)]
    pub fn has_row(&self, y: usize, columns: usize) -> bool {
        y < self.rows && columns == self.columns
    }

    /// Factor of a pixel; `None` off the detector.
    pub fn factor_at(&self, x: usize, y: usize) -> Option<f32> {
        let is_inside = x < self.columns && y < self.rows;
        is_inside.then(|| self.values.get(self.index(x, y)).copied()).flatten()
    }

    /// Factors of `length` pixels of a row from column `x` on, part by part: the range of the pixels, and
    /// their factors.
    #[inline(always)]
    pub fn span(&self, x: usize, y: usize, length: usize) -> impl Iterator<Item = (Range<usize>, &[f32])> {
        let end = x + length;
        (x / STRIP..end.div_ceil(STRIP)).map(move |strip| {
            let (from, to) = (x.max(strip * STRIP), end.min((strip + 1) * STRIP));
            let first = self.index(from, y);
            (from - x..to - x, self.values.get(first..first + (to - from)).unwrap_or_default())
        })
    }

    /// Factors of eight pixels of a row from column `x` on; 1 off the detector.
    #[inline(always)]
    pub fn eight(&self, x: usize, y: usize) -> &[f32; LANES] {
        let from = if y < self.rows { self.values.get(self.index(x, y)..) } else { None };
        from.and_then(<[f32]>::first_chunk).unwrap_or(&[1.0; LANES])
    }

    /// Factors row by row.
    /// Returns the factors, row by row.
    pub fn iter(&self) -> impl Iterator<Item = f32> {
        (0..self.rows).flat_map(move |y| (0..self.columns).filter_map(move |x| self.factor_at(x, y)))
    }

    #[inline(always)]
    fn index(&self, x: usize, y: usize) -> usize {
        self.first + (x / STRIP * self.rows + y) * STRIDE + x % STRIP
    }
}

/// Equality is independent of the alignment in memory.
impl PartialEq for PixelFactors {
    fn eq(&self, other: &Self) -> bool {
        let strips = self.values.len().saturating_sub(LINE);
        let (these, those) = (self.values.iter().skip(self.first), other.values.iter().skip(other.first));
        (self.columns, self.rows) == (other.columns, other.rows) && these.take(strips).eq(those.take(strips))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_access_path_gives_a_pixel_the_same_factor() {
        for (columns, rows) in [(1, 1), (63, 2), (64, 3), (65, 2), (130, 5), (752, 4)] {
            let of = |x: usize, y: usize| (y * 1000 + x) as f32;
            let factors =
                PixelFactors::new(columns, (0..rows * columns).map(|i| of(i % columns, i / columns)));
            assert_eq!(factors.largest(), f64::from(of(columns - 1, rows - 1)));
            assert!(factors.iter().eq((0..rows * columns).map(|i| of(i % columns, i / columns))));
            for (x, y) in (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))) {
                for (lane, factor) in factors.eight(x, y).iter().enumerate() {
                    assert_eq!(
                        *factor,
                        if x + lane < columns { of(x + lane, y) } else { 1.0 },
                        "{x} {y} {lane}"
                    );
                }
                let spans: Vec<_> = factors.span(x, y, columns - x).collect();
                assert!(spans.iter().flat_map(|(_, part)| *part).copied().eq((x..columns).map(|x| of(x, y))));
                assert!(spans.iter().flat_map(|(pixels, _)| pixels.clone()).eq(0..columns - x));
            }
            assert_eq!((factors.factor_at(columns, 0), factors.factor_at(0, rows)), (None, None));
            assert_eq!(factors.eight(0, rows), &[1.0; LANES]);
            assert!(factors.has_row(rows - 1, columns));
            assert!(!factors.has_row(rows, columns) && !factors.has_row(0, columns + 1));
        }
        assert!(PixelFactors::new(5, []) == PixelFactors::default() && PixelFactors::default().is_empty());
    }
}
