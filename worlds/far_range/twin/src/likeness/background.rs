//! Background of a set of frames: level, unevenness, noise of pixels, rows and columns, correlation.
//!
//! Each frame is reduced to its values above a smooth background (cells of 64 px). Pixels above six standard
//! deviations and their neighbours are left out: stars, hot pixels, hits. What remains is split into an
//! offset of each row, an offset of each column, and the noise of the pixels.

use camera_fit::{Background, clipped};
use files::GreyImage;

use super::difference::{Likeness, Unit};
use super::estimate::Estimate;
use super::offsets::variance_of_offsets;
use super::spectrum::Spectrum;

/// Side of a cell, px.
const CELL_PX: usize = 64;

/// Heights above the background, standard deviations, from which a pixel and its neighbours within a distance
/// are left out, px: the wings of bright stars reach far.
const BRIGHT: [(f64, usize); 4] = [(6.0, 3), (60.0, 6), (400.0, 12), (3000.0, 24)];

/// Values beyond this many standard deviations are left out.
const CLIP_SIGMAS: f64 = 4.0;

/// Range of the histogram, in standard deviations of the camera's noise, and bins to one.
pub(crate) const HISTOGRAM_SIGMAS: [f64; 2] = [-6.0, 24.0];
pub(crate) const BINS_PER_SIGMA: f64 = 4.0;

/// Figures of the background of one frame.
#[derive(Debug, Clone)]
pub struct FrameBackground {
    /// Mean level, DN.
    pub level: Estimate,
    /// Standard deviation of a pixel without the offsets of rows and columns, DN.
    pub noise: Estimate,
    /// Correlation of a pixel with its neighbour in the row, and in the column.
    pub correlation: [Estimate; 2],
    /// Offset of each row and of each column from the smooth background, DN.
    pub row_offsets: Vec<f64>,
    /// Offset of each column, DN.
    pub column_offsets: Vec<f64>,
    /// Level of each cell above the mean, DN.
    pub cell_offsets: Vec<f64>,
    /// Number of pixels by their height above the background, in bins of a quarter of the stated noise.
    pub histogram: Vec<u64>,
    /// Power spectra along rows and columns, DN².
    pub spectra: [Spectrum; 2],
}

impl FrameBackground {
    /// Measures a frame; `bin_dn` is the standard deviation in which the bins of the histogram are stated,
    /// DN.
    /// `None` for an image smaller than four cells or without a pixel of background.
    pub fn of(image: &GreyImage, bin_dn: f64) -> Option<Self> {
        let background = Background::of(image);
        let above = Plane::above(image, &background);
        let mut plane = above.clone();
        plane.leave_out_bright(background.noise_dn);
        plane.clip(CLIP_SIGMAS * background.noise_dn);
        let spectra = [Spectrum::along_rows(&plane), Spectrum::along_columns(&plane)];
        let row_offsets = plane.take_row_offsets();
        let column_offsets = plane.take_column_offsets();
        let cells = plane.cells();
        if cells.len() < 4 {
            return None;
        }
        let noise = noise_of(&cells)?;
        let levels = cell_levels(image, &plane);
        let level = levels.iter().sum::<f64>() / levels.len() as f64;
        Some(Self {
            level: Estimate::known(level, level_sigma(&plane, noise.value, &row_offsets, &column_offsets)),
            noise,
            correlation: [correlation_of(&cells, 0)?, correlation_of(&cells, 1)?],
            cell_offsets: levels.into_iter().map(|of_cell| of_cell - level).collect(),
            row_offsets,
            column_offsets,
            histogram: above.histogram(bin_dn),
            spectra,
        })
    }
}

/// Returns the figures of two sets of frames.
pub fn likenesses(camera: &[FrameBackground], twin: &[FrameBackground]) -> Vec<Likeness> {
    let mut figures = Vec::new();
    let mut add = |code, name, unit, of: &dyn Fn(&[FrameBackground]) -> Option<Estimate>| {
        if let (Some(first), Some(second)) = (of(camera), of(twin)) {
            figures.push(Likeness::new(code, name, unit, [first, second]));
        }
    };
    add("background", "background level", Unit::Dn, &|set| mean_over(set, |frame| frame.level));
    add("unevenness", "unevenness, variance", Unit::SquareDn, &|set| {
        variance_over(set, |frame| &frame.cell_offsets)
    });
    add("noise", "noise of a pixel", Unit::Dn, &|set| mean_over(set, |frame| frame.noise));
    add("row_noise", "row offsets, variance", Unit::SquareDn, &|set| {
        variance_over(set, |frame| &frame.row_offsets)
    });
    add("column_noise", "column offsets, variance", Unit::SquareDn, &|set| {
        variance_over(set, |frame| &frame.column_offsets)
    });
    add("row_correlation", "correlation along rows", Unit::Number, &|set| {
        mean_over(set, |frame| frame.correlation[0])
    });
    add("column_correlation", "correlation along columns", Unit::Number, &|set| {
        mean_over(set, |frame| frame.correlation[1])
    });
    figures
}

fn mean_over(set: &[FrameBackground], pick: fn(&FrameBackground) -> Estimate) -> Option<Estimate> {
    let frames: Vec<Estimate> = set.iter().map(pick).collect();
    Estimate::of_frames(&frames)
}

fn variance_over(set: &[FrameBackground], pick: fn(&FrameBackground) -> &Vec<f64>) -> Option<Estimate> {
    let frames: Vec<Vec<f64>> = set.iter().map(pick).cloned().collect();
    variance_of_offsets(&frames)
}

/// Heights of the pixels above the background, DN; NaN for those left out.
#[derive(Debug, Clone)]
pub struct Plane {
    /// Number of columns.
    pub(crate) columns: usize,
    /// Number of rows.
    pub(crate) rows: usize,
    pub(crate) values: Vec<f64>,
}

impl Plane {
    /// Returns the values of an image above a background.
    pub(crate) fn above(image: &GreyImage, background: &Background) -> Self {
        let mut values = Vec::with_capacity(image.values.len());
        for row in 0..image.rows {
            for column in 0..image.columns {
                values.push(image.at(column, row) - background.at(column, row));
            }
        }
        Self { columns: image.columns, rows: image.rows, values }
    }

    pub(crate) fn at(&self, column: usize, row: usize) -> f64 {
        self.values[row * self.columns + column]
    }

    /// Leaves out bright pixels and their neighbours.
    fn leave_out_bright(&mut self, noise_dn: f64) {
        let mut bright: Vec<(usize, usize, usize)> = Vec::new();
        for row in 0..self.rows {
            for column in 0..self.columns {
                let height = self.at(column, row) / noise_dn;
                let reach = BRIGHT.iter().rev().find(|(sigmas, _)| height > *sigmas);
                bright.extend(reach.map(|(_, reach)| (column, row, *reach)));
            }
        }
        for (column, row, reach) in bright {
            let last_row = (row + reach).min(self.rows - 1);
            let last_column = (column + reach).min(self.columns - 1);
            for y in row.saturating_sub(reach)..=last_row {
                for x in column.saturating_sub(reach)..=last_column {
                    self.values[y * self.columns + x] = f64::NAN;
                }
            }
        }
    }

    /// Leaves out pixels beyond a limit on either side.
    fn clip(&mut self, limit_dn: f64) {
        for value in &mut self.values {
            if value.abs() > limit_dn {
                *value = f64::NAN;
            }
        }
    }

    /// Subtracts the mean of each row, and returns these means.
    fn take_row_offsets(&mut self) -> Vec<f64> {
        let mut offsets = Vec::with_capacity(self.rows);
        for row in self.values.chunks_mut(self.columns.max(1)) {
            let offset = mean_of(row.iter().copied()).unwrap_or(0.0);
            for value in row {
                *value -= offset;
            }
            offsets.push(offset);
        }
        offsets
    }

    /// Subtracts the mean of each column, and returns these means.
    fn take_column_offsets(&mut self) -> Vec<f64> {
        let mut offsets = Vec::with_capacity(self.columns);
        for column in 0..self.columns {
            let of_column = self.values.iter().skip(column).step_by(self.columns).copied();
            let offset = mean_of(of_column).unwrap_or(0.0);
            for row in 0..self.rows {
                self.values[row * self.columns + column] -= offset;
            }
            offsets.push(offset);
        }
        offsets
    }

    /// Returns the sums of each whole cell.
    fn cells(&self) -> Vec<CellSums> {
        let mut cells = Vec::new();
        for first_row in (0..(self.rows + 1).saturating_sub(CELL_PX)).step_by(CELL_PX) {
            for first_column in (0..(self.columns + 1).saturating_sub(CELL_PX)).step_by(CELL_PX) {
                cells.push(self.cell(first_column, first_row));
            }
        }
        cells
    }

    fn cell(&self, first_column: usize, first_row: usize) -> CellSums {
        let mut sums = CellSums::default();
        for row in first_row..first_row + CELL_PX {
            for column in first_column..first_column + CELL_PX {
                let value = self.at(column, row);
                if value.is_nan() {
                    continue;
                }
                sums.squares += value * value;
                sums.count += 1.0;
                if column + 1 < first_column + CELL_PX {
                    sums.add_pair(0, value, self.at(column + 1, row));
                }
                if row + 1 < first_row + CELL_PX {
                    sums.add_pair(1, value, self.at(column, row + 1));
                }
            }
        }
        sums
    }

    /// Counts the pixels by their height in bins of a part of `bin_dn`.
    fn histogram(&self, bin_dn: f64) -> Vec<u64> {
        let [low, high] = HISTOGRAM_SIGMAS;
        let bins = ((high - low) * BINS_PER_SIGMA) as usize;
        let mut counts = vec![0; bins];
        for value in &self.values {
            let bin = (value / bin_dn - low) * BINS_PER_SIGMA;
            let bin = bin.floor().clamp(0.0, bins as f64 - 1.0) as usize;
            counts[bin] += 1;
        }
        counts
    }
}

/// Returns the mean of the values that are no NaN.
fn mean_of(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values.filter(|value| !value.is_nan()) {
        sum += value;
        count += 1.0;
    }
    (count > 0.0).then(|| sum / count)
}

/// Sums over the pixels of a cell.
#[derive(Debug, Clone, Copy, Default)]
struct CellSums {
    count: f64,
    squares: f64,
    /// Products of neighbours in a row and in a column, and their number.
    products: [f64; 2],
    pairs: [f64; 2],
}

impl CellSums {
    fn add_pair(&mut self, axis: usize, first: f64, second: f64) {
        if !second.is_nan() {
            self.products[axis] += first * second;
            self.pairs[axis] += 1.0;
        }
    }
}

/// Returns the noise of a pixel: the root of the mean variance of the cells.
fn noise_of(cells: &[CellSums]) -> Option<Estimate> {
    let mut variances = Vec::with_capacity(cells.len());
    for cell in cells.iter().filter(|cell| cell.count >= 0.25 * (CELL_PX * CELL_PX) as f64) {
        variances.push(cell.squares / cell.count);
    }
    let mean = mean_of_neighbours(&variances)?;
    let noise = mean.value.sqrt();
    (noise > 0.0).then(|| Estimate { value: noise, sigma: mean.sigma / (2.0 * noise), ..mean })
}

/// Returns the correlation of neighbours along an axis.
fn correlation_of(cells: &[CellSums], axis: usize) -> Option<Estimate> {
    let mut correlations = Vec::with_capacity(cells.len());
    for cell in cells.iter().filter(|cell| cell.squares > 0.0 && cell.pairs[axis] > 0.0) {
        correlations.push(cell.products[axis] / cell.pairs[axis] * cell.count / cell.squares);
    }
    mean_of_neighbours(&correlations)
}

/// Returns the mean of the values of cells in their order. Its error is that by the differences of successive
/// cells (von Neumann 1941), which a slow change over the image does not enlarge.
fn mean_of_neighbours(values: &[f64]) -> Option<Estimate> {
    let count = values.len() as f64;
    if values.len() < 4 {
        return None;
    }
    let mut squares = 0.0;
    for pair in values.windows(2) {
        squares += (pair[1] - pair[0]) * (pair[1] - pair[0]);
    }
    let variance = squares / (2.0 * (count - 1.0));
    // Neighbouring differences share a value: 2/3 of the degrees of freedom remain.
    let freedom = 2.0 / 3.0 * (count - 1.0);
    Some(Estimate { value: values.iter().sum::<f64>() / count, sigma: (variance / count).sqrt(), freedom })
}

/// Returns the mean of each whole cell, DN: of the pixels of the plane that are not left out.
fn cell_levels(image: &GreyImage, plane: &Plane) -> Vec<f64> {
    let mut levels = Vec::new();
    for first_row in (0..(plane.rows + 1).saturating_sub(CELL_PX)).step_by(CELL_PX) {
        for first_column in (0..(plane.columns + 1).saturating_sub(CELL_PX)).step_by(CELL_PX) {
            let mut kept = Vec::with_capacity(CELL_PX * CELL_PX);
            for row in first_row..first_row + CELL_PX {
                for column in first_column..first_column + CELL_PX {
                    if !plane.at(column, row).is_nan() {
                        kept.push(image.at(column, row));
                    }
                }
            }
            if !kept.is_empty() {
                levels.push(clipped(&kept).0);
            }
        }
    }
    levels
}

/// Returns the standard deviation of the mean level of a frame: √(s²/n + R/rows + C/columns), with the noise
/// s of a pixel and the variances R and C of the offsets of rows and columns.
fn level_sigma(plane: &Plane, noise_dn: f64, row_offsets: &[f64], column_offsets: &[f64]) -> f64 {
    let count = plane.values.iter().filter(|value| !value.is_nan()).count().max(1) as f64;
    let squares = |offsets: &[f64]| offsets.iter().map(|offset| offset * offset).sum::<f64>();
    let rows = row_offsets.len().max(1) as f64;
    let columns = column_offsets.len().max(1) as f64;
    let of_lines = squares(row_offsets) / (rows * rows) + squares(column_offsets) / (columns * columns);
    (noise_dn * noise_dn / count + of_lines).sqrt()
}
