//! Background of an image, and its noise.

use files::GreyImage;

/// Side of a cell of the background, px: some times the image of a bright star, a small part of the gradients
/// of lens and sky.
pub(crate) const CELL_PX: usize = 64;

/// Side of a cell under clouds, the halo of the Moon and other structure, px: still larger than a star.
pub(crate) const FINE_CELL_PX: usize = 16;

/// Limit, in standard deviations, beyond which a pixel does not belong to the background, and number of
/// rounds.
const CLIP_SIGMAS: f64 = 3.0;
const CLIP_ROUNDS: usize = 5;

/// Noise of a converter that rounds to whole numbers, DN: the noise of an image is not less.
const ROUNDING_DN: f64 = 0.288_675_134_594_812_9;

/// Background on a grid of cells, with the noise of a pixel.
#[derive(Debug, Clone)]
pub struct Background {
    cell_px: usize,
    cells: [usize; 2],
    levels_dn: Vec<f64>,
    /// Standard deviation of a pixel about the background, DN.
    pub noise_dn: f64,
}

impl Background {
    /// Estimates the background of an image in cells of 64 px.
    pub fn of(image: &GreyImage) -> Self {
        Self::in_cells(image, CELL_PX)
    }

    /// Estimates the background of an image in cells of `cell_px`.
    pub(crate) fn in_cells(image: &GreyImage, cell_px: usize) -> Self {
        let at = |column: usize, row: usize| image.at(column, row);
        let levels_dn = in_cells(image.columns, image.rows, cell_px, at, |values| clipped(values).0);
        let cells = [image.columns.div_ceil(cell_px), image.rows.div_ceil(cell_px)];
        let mut background = Self { cell_px, cells, levels_dn, noise_dn: 0.0 };
        let mut rest = Vec::with_capacity(image.values.len());
        for row in 0..image.rows {
            for column in 0..image.columns {
                rest.push(image.at(column, row) - background.at(column, row));
            }
        }
        background.noise_dn = clipped(&rest).1.max(ROUNDING_DN);
        background
    }

    /// Returns the deviations of the values of a plane from 0, in cells of [`CELL_PX`]. The values are those
    /// of an image without its background.
    pub(crate) fn of_deviations(columns: usize, rows: usize, values: &[f64]) -> Self {
        let at = |column: usize, row: usize| values[row * columns + column];
        let levels_dn = in_cells(columns, rows, CELL_PX, at, |values| clipped(values).1);
        let cells = [columns.div_ceil(CELL_PX), rows.div_ceil(CELL_PX)];
        Self { cell_px: CELL_PX, cells, levels_dn, noise_dn: 0.0 }
    }

    /// Returns the background at a pixel, DN: bilinear between the centres of the cells.
    pub fn at(&self, column: usize, row: usize) -> f64 {
        let along = |pixel: usize, count: usize| {
            let position = (pixel as f64 + 0.5) / self.cell_px as f64 - 0.5;
            let position = position.clamp(0.0, count as f64 - 1.0);
            let first = (position as usize).min(count.saturating_sub(2));
            (first, (first + 1).min(count - 1), position - first as f64)
        };
        let (left, right, x) = along(column, self.cells[0]);
        let (top, bottom, y) = along(row, self.cells[1]);
        let level = |column: usize, row: usize| self.levels_dn[row * self.cells[0] + column];
        let upper = level(left, top) * (1.0 - x) + level(right, top) * x;
        let lower = level(left, bottom) * (1.0 - x) + level(right, bottom) * x;
        upper * (1.0 - y) + lower * y
    }

    /// Returns the median of the cells, DN.
    pub(crate) fn median_dn(&self) -> f64 {
        let mut levels = self.levels_dn.clone();
        levels.sort_by(f64::total_cmp);
        levels[levels.len() / 2]
    }
}

/// Returns a figure of the values in each cell of a plane, row by row.
fn in_cells(
    columns: usize,
    rows: usize,
    cell_px: usize,
    at: impl Fn(usize, usize) -> f64,
    figure: impl Fn(&[f64]) -> f64,
) -> Vec<f64> {
    let mut figures = Vec::with_capacity(columns.div_ceil(cell_px) * rows.div_ceil(cell_px));
    let mut values = Vec::with_capacity(cell_px * cell_px);
    for top in (0..rows).step_by(cell_px) {
        for left in (0..columns).step_by(cell_px) {
            values.clear();
            for row in top..(top + cell_px).min(rows) {
                for column in left..(left + cell_px).min(columns) {
                    values.push(at(column, row));
                }
            }
            figures.push(figure(&values));
        }
    }
    figures
}

/// Returns the median of at least one value: of an even number, the greater of the two in the middle.
fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Returns mean and standard deviation of values without those far from the mean. The first limit is about
/// the median, by the deviations of half of the values.
pub fn clipped(values: &[f64]) -> (f64, f64) {
    let mut mean = median(values.to_vec());
    let deviations: Vec<f64> = values.iter().map(|value| (value - mean).abs()).collect();
    // 1.4826: the standard deviation of normal values in units of their median deviation.
    let mut sigma = 1.4826 * median(deviations);
    if sigma == 0.0 {
        // More than half of the values are equal: whole numbers.
        sigma = 1.0;
    }
    for _ in 0..CLIP_ROUNDS {
        let limit = CLIP_SIGMAS * sigma;
        let (mut count, mut sum, mut squares) = (0.0, 0.0, 0.0);
        for value in values.iter().filter(|value| (**value - mean).abs() <= limit) {
            count += 1.0;
            sum += value - mean;
            squares += (value - mean) * (value - mean);
        }
        if count < 2.0 {
            break;
        }
        let shift = sum / count;
        sigma = (squares / count - shift * shift).max(0.0).sqrt();
        mean += shift;
    }
    (mean, sigma)
}
