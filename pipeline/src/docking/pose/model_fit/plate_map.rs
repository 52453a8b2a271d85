//! Map of the plate's pixels: sums over any rectangle of cells.

use std::ops::{Add, Sub};

/// Number of cells of the map per side.
pub(super) const CELLS: usize = 64;

/// Number of corners of cells per side.
const CORNERS: usize = CELLS + 1;

/// Pixel of the plate, clear of marks, cross and rim, with the cross's blurred signal subtracted.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlatePixel {
    pub(super) u: f64,
    pub(super) v: f64,
    pub(super) y1: f64,
    pub(super) y2: f64,
    pub(super) dn: f64,
}

/// Number of pixels, and the sum of their values.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PixelSum {
    pub(super) count: f64,
    pub(super) dn: f64,
}

impl Add for PixelSum {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { count: self.count + other.count, dn: self.dn + other.dn }
    }
}

impl Sub for PixelSum {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { count: self.count - other.count, dn: self.dn - other.dn }
    }
}

/// Range of cells along an axis: from the first corner to the last.
#[derive(Debug, Clone, Copy)]
pub(super) struct CellSpan {
    from: usize,
    to: usize,
}

/// Map of the square around the plate, of [`CELLS`] by [`CELLS`] cells: a summed-area table.
#[derive(Debug, Default)]
pub(super) struct PlateMap {
    /// Sums over the cells with smaller y1 and y2 than each corner, row by row of y2.
    sums: Vec<PixelSum>,
    radius_m: f64,
    /// Side of a cell, m.
    cell_m: f64,
    total: PixelSum,
    /// Sum of the squared values, DN².
    squares_dn2: f64,
}

impl PlateMap {
    /// Fills the map with pixels of a plate.
    pub(super) fn fill(&mut self, radius_m: f64, pixels: &[PlatePixel]) {
        self.radius_m = radius_m;
        self.cell_m = 2.0 * radius_m / CELLS as f64;
        self.sums.clear();
        self.sums.resize(CORNERS * CORNERS, PixelSum::default());
        self.total = PixelSum { count: pixels.len() as f64, dn: 0.0 };
        self.squares_dn2 = 0.0;
        for pixel in pixels {
            let corner = self.corner_above(pixel.y2) * CORNERS + self.corner_above(pixel.y1);
            let sum = &mut self.sums[corner];
            *sum = *sum + PixelSum { count: 1.0, dn: pixel.dn };
            self.total.dn += pixel.dn;
            self.squares_dn2 += pixel.dn * pixel.dn;
        }
        for row in 1..CORNERS {
            let mut along = PixelSum::default();
            for column in 1..CORNERS {
                let corner = row * CORNERS + column;
                along = along + self.sums[corner];
                self.sums[corner] = along + self.sums[corner - CORNERS];
            }
        }
    }

    /// Returns the sum over all pixels.
    pub(super) fn total(&self) -> PixelSum {
        self.total
    }

    /// Returns the variance of a pixel about the mean, DN².
    pub(super) fn variance(&self) -> f64 {
        let PixelSum { count, dn } = self.total;
        (self.squares_dn2 - dn * dn / count) / count
    }

    /// Returns the side of a cell, m.
    pub(super) fn cell_m(&self) -> f64 {
        self.cell_m
    }

    /// Returns the corner above the cell of a coordinate, m.
    fn corner_above(&self, y_m: f64) -> usize {
        (((y_m + self.radius_m) / self.cell_m) as usize).min(CELLS - 1) + 1
    }

    /// Returns the sum over the cell of a point, m.
    pub(super) fn cell_at(&self, y1_m: f64, y2_m: f64) -> PixelSum {
        let (column, row) = (self.corner_above(y1_m), self.corner_above(y2_m));
        self.within(CellSpan { from: column - 1, to: column }, CellSpan { from: row - 1, to: row })
    }

    /// Returns the cells within `half_m` of a coordinate, in whole cells.
    pub(super) fn span(&self, centre_m: f64, half_m: f64) -> CellSpan {
        CellSpan { from: self.nearest_corner(centre_m - half_m), to: self.nearest_corner(centre_m + half_m) }
    }

    fn nearest_corner(&self, y_m: f64) -> usize {
        ((y_m + self.radius_m) / self.cell_m + 0.5).clamp(0.0, CELLS as f64) as usize
    }

    /// Returns the sum over a rectangle of cells.
    pub(super) fn within(&self, y1: CellSpan, y2: CellSpan) -> PixelSum {
        let at = |row: usize, column: usize| self.sums[row * CORNERS + column];
        at(y2.to, y1.to) - at(y2.from, y1.to) - at(y2.to, y1.from) + at(y2.from, y1.from)
    }
}
