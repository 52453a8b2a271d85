//! Background of an image, and its noise.

use files::GreyImage;

/// Side of a cell of the background, px: some times the image of a bright star, a small part of the gradients
/// of lens and sky.
const CELL_PX: usize = 64;

/// Limit, in standard deviations, beyond which a pixel does not belong to the background, and number of
/// rounds.
const CLIP_SIGMAS: f64 = 3.0;
const CLIP_ROUNDS: usize = 5;

/// Noise of a converter that rounds to whole numbers, DN: the noise of an image is not less.
const ROUNDING_DN: f64 = 0.288_675_134_594_812_9;

/// Background on a grid of cells, with the noise of a pixel.
#[derive(Debug, Clone)]
pub struct Background {
    cells: [usize; 2],
    levels_dn: Vec<f64>,
    /// Standard deviation of a pixel about the background, DN.
    pub noise_dn: f64,
}

impl Background {
    /// Estimates the background of an image.
    pub fn of(image: &GreyImage) -> Self {
        let cells = [image.columns.div_ceil(CELL_PX), image.rows.div_ceil(CELL_PX)];
        let mut levels_dn = Vec::with_capacity(cells[0] * cells[1]);
        for row in 0..cells[1] {
            for column in 0..cells[0] {
                levels_dn.push(clipped(&cell_values(image, column, row)).0);
            }
        }
        let mut background = Self { cells, levels_dn, noise_dn: 0.0 };
        let mut rest = Vec::with_capacity(image.values.len());
        for row in 0..image.rows {
            for column in 0..image.columns {
                rest.push(image.at(column, row) - background.at(column, row));
            }
        }
        background.noise_dn = clipped(&rest).1.max(ROUNDING_DN);
        background
    }

    /// Returns the background at a pixel, DN: bilinear between the centres of the cells.
    pub fn at(&self, column: usize, row: usize) -> f64 {
        let along = |pixel: usize, count: usize| {
            let position = (pixel as f64 + 0.5) / CELL_PX as f64 - 0.5;
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
    pub fn median_dn(&self) -> f64 {
        let mut levels = self.levels_dn.clone();
        levels.sort_by(f64::total_cmp);
        levels[levels.len() / 2]
    }
}

fn cell_values(image: &GreyImage, column: usize, row: usize) -> Vec<f64> {
    let mut values = Vec::with_capacity(CELL_PX * CELL_PX);
    for y in row * CELL_PX..((row + 1) * CELL_PX).min(image.rows) {
        for x in column * CELL_PX..((column + 1) * CELL_PX).min(image.columns) {
            values.push(image.at(x, y));
        }
    }
    values
}

/// Returns mean and standard deviation of values without those far from the mean. The first limit is about
/// the median, by the deviations of half of the values.
pub fn clipped(values: &[f64]) -> (f64, f64) {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let mut mean = sorted[sorted.len() / 2];
    let mut deviations: Vec<f64> = sorted.iter().map(|value| (value - mean).abs()).collect();
    deviations.sort_by(f64::total_cmp);
    // 1.4826: the standard deviation of normal values in units of their median deviation.
    let mut sigma = 1.4826 * deviations[deviations.len() / 2];
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
