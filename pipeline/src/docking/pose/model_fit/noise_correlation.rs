//! Correlation of the noise between neighbouring pixels.
//!
//! A blur, a codec or a rotation of the image spreads the noise of a pixel over its neighbours. The pixels
//! then determine the pose less well than independent pixels of the same variance. With the correlation ρ of
//! two pixels, measured from the residuals, the covariance of the estimate is σ² H⁻¹ Σ_ij ρ_ij g_i g_jᵀ H⁻¹
//! (the sandwich form of least squares; White 1980), where g_i is the gradient of pixel i and H the
//! information. The correlation is assumed separable: ρ(Δx, Δy) = ρ(Δx, 0) ρ(0, Δy).

use nalgebra::{Cholesky, Matrix6, SVector};

use super::samples::{Patch, Sample, Samples};
use super::solve::residual;
use super::unknowns::POSE;

/// Largest distance of two correlated pixels along a line and across lines, px.
const REACH: usize = 5;

/// Smallest correlation of adjacent lines that counts, and its significance in standard deviations of the
/// estimate. With 0.15 between adjacent lines alone, a variance is at most 1 + 2 · 0.15 = 1.3 times that of
/// independent noise.
const MIN_CORRELATION: f64 = 0.15;
const MIN_SIGNIFICANCE: f64 = 4.0;

/// Significance below which the correlation at a distance counts as zero.
const MIN_LAG_SIGNIFICANCE: f64 = 2.0;

/// Noise, and its correlation by distance, which is 1 at distance 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NoiseCorrelation {
    /// Variance of the noise of a pixel, DN².
    variance: f64,
    along: [f64; REACH + 1],
    across: [f64; REACH + 1],
}

impl NoiseCorrelation {
    /// Measures the correlation of the used pixels' residuals. Returns `None` if adjacent lines are not
    /// significantly correlated: the response of the video correlates the pixels of one line, and is an
    /// unknown of the fit.
    pub(super) fn measure(samples: &Samples, grid: &mut PatchGrid) -> Option<Self> {
        let used = || samples.patches.iter().filter(|patch| patch.is_used);
        let pixels = |patch: &Patch| samples.pixels.get(patch.first..patch.end).unwrap_or_default();
        let (mut squares, mut count, mut products, mut pairs) = (0.0, 0.0, 0.0, 0.0);
        let above = &mut grid.above;
        for patch in used() {
            above.clear();
            for pixel in pixels(patch).iter().filter(|pixel| pixel.is_used) {
                let r = residual(patch, pixel);
                squares += r * r;
                count += 1.0;
                if above.len() <= pixel.column {
                    above.resize(pixel.column + 1, (usize::MAX, 0.0));
                }
                if above[pixel.column].0 == pixel.row.wrapping_sub(1) {
                    products += above[pixel.column].1 * r;
                    pairs += 1.0;
                }
                above[pixel.column] = (pixel.row, r);
            }
        }
        let variance = f64::max(squares / f64::max(count, 1.0), 1e-9);
        let adjacent = products / f64::max(pairs, 1.0) / variance;
        if adjacent < MIN_CORRELATION || adjacent * pairs.sqrt() < MIN_SIGNIFICANCE {
            return None;
        }
        let mut sums = [[(0.0, 0.0); REACH + 1]; 2];
        for patch in used() {
            let pixels = pixels(patch);
            grid.begin(pixels);
            for pixel in pixels.iter().filter(|pixel| pixel.is_used) {
                grid.set(pixel, Channels::from_fn(|k, _| if k == 0 { residual(patch, pixel) } else { 1.0 }));
            }
            grid.add_products(&mut sums);
        }
        let [along, across] = sums.map(|sums| {
            let mut correlation = [0.0; REACH + 1];
            correlation[0] = 1.0;
            for (lag, (products, pairs)) in sums.iter().enumerate().skip(1) {
                let at_lag = products / f64::max(*pairs, 1.0) / variance;
                if at_lag * pairs.sqrt() < MIN_LAG_SIGNIFICANCE {
                    break;
                }
                correlation[lag] = at_lag.min(1.0);
            }
            correlation
        });
        Some(Self { variance, along, across })
    }

    /// Returns the number of lines that contain as much information as one line with independent noise.
    pub(super) fn correlated_lines(&self) -> f64 {
        1.0 + 2.0 * self.across.iter().skip(1).sum::<f64>()
    }
}

/// Change of the pose by a unit of a pixel; or the residual, and 1 where there is a pixel.
type Channels = SVector<f64, POSE>;

/// Pixels of a patch on their columns and rows, zero where the patch has no pixel.
#[derive(Debug, Default)]
pub(super) struct PatchGrid {
    first: (usize, usize),
    columns: usize,
    rows: usize,
    cells: Vec<Channels>,
    filtered: Vec<Channels>,
    /// Row and residual of the last pixel of each column.
    above: Vec<(usize, f64)>,
}

impl PatchGrid {
    /// Clears the grid and adapts its size to some pixels.
    fn begin(&mut self, pixels: &[Sample]) {
        let ends = |of: fn(&Sample) -> usize| {
            pixels.iter().map(of).fold((usize::MAX, 0), |(low, high), v| (low.min(v), high.max(v)))
        };
        let ((left, right), (top, bottom)) = (ends(|pixel| pixel.column), ends(|pixel| pixel.row));
        self.first = (left, top);
        (self.columns, self.rows) = ((right + 1).saturating_sub(left), (bottom + 1).saturating_sub(top));
        self.cells.clear();
        self.cells.resize(self.columns * self.rows, Channels::zeros());
    }

    fn set(&mut self, pixel: &Sample, value: Channels) {
        let index = (pixel.row - self.first.1) * self.columns + pixel.column - self.first.0;
        if let Some(cell) = self.cells.get_mut(index) {
            *cell = value;
        }
    }

    /// Adds Σ r_i r_j and the number of pairs by distance along and across lines. Channel 0 is the residual,
    /// channel 1 is 1 where there is a pixel.
    fn add_products(&self, sums: &mut [[(f64, f64); REACH + 1]; 2]) {
        for (index, cell) in self.cells.iter().enumerate().filter(|(_, cell)| cell[1] > 0.0) {
            let column = index % self.columns;
            for lag in 1..=REACH {
                let along = (column + lag < self.columns).then_some(index + lag);
                for (sums, other) in sums.iter_mut().zip([along, Some(index + lag * self.columns)]) {
                    if let Some(other) = other.and_then(|other| self.cells.get(other)) {
                        sums[lag].0 += cell[0] * other[0];
                        sums[lag].1 += other[1];
                    }
                }
            }
        }
    }

    /// Replaces `filtered` by the cells, correlated along lines.
    fn filter_along(&mut self, correlation: &[f64; REACH + 1]) {
        self.filtered.clear();
        for line in self.cells.chunks(self.columns.max(1)) {
            for column in 0..line.len() {
                let mut sum = line[column];
                for (lag, weight) in correlation.iter().enumerate().skip(1).filter(|(_, w)| **w > 0.0) {
                    if let Some(left) = column.checked_sub(lag) {
                        sum += line[left] * *weight;
                    }
                    if let Some(right) = line.get(column + lag) {
                        sum += right * *weight;
                    }
                }
                self.filtered.push(sum);
            }
        }
    }
}

/// Sums over the pixels of a field whose noise is correlated.
#[derive(Debug)]
pub(super) struct CorrelatedSums<'a> {
    correlation: NoiseCorrelation,
    grid: &'a mut PatchGrid,
    /// Σ_{i≠j} ρ_ij u_i u_jᵀ, where u is the change of the pose by a unit of a pixel.
    excess: Matrix6<f64>,
}

impl<'a> CorrelatedSums<'a> {
    /// Creates empty sums for noise of a correlation.
    pub(super) fn new(correlation: NoiseCorrelation, grid: &'a mut PatchGrid) -> Self {
        Self { correlation, grid, excess: Matrix6::zeros() }
    }

    /// Begins a patch of the given pixels.
    pub(super) fn begin(&mut self, pixels: &[Sample]) {
        self.grid.begin(pixels);
    }

    /// Adds a pixel of the current patch by the change of the pose by a unit of the pixel.
    pub(super) fn add(&mut self, pixel: &Sample, pose: Channels) {
        self.grid.set(pixel, pose);
    }

    /// Closes a patch: adds the correlated part of its sum.
    pub(super) fn close(&mut self) {
        let grid = &mut *self.grid;
        grid.filter_along(&self.correlation.along);
        let columns = grid.columns;
        for (index, cell) in grid.cells.iter().enumerate() {
            let mut beside = grid.filtered[index] - cell;
            for (lag, weight) in self.correlation.across.iter().enumerate().skip(1).filter(|(_, w)| **w > 0.0)
            {
                for other in [index.checked_sub(lag * columns), Some(index + lag * columns)] {
                    if let Some(other) = other.and_then(|other| grid.filtered.get(other)) {
                        beside += other * *weight;
                    }
                }
            }
            self.excess += cell * beside.transpose();
        }
    }

    /// Returns the increase of a covariance of the pose that makes it at least that of correlated noise. The
    /// covariance may already include the correlation as scatter of patches and lines, so the larger of both
    /// counts for each direction. `inverse` is the inverse of the information. Returns `None` when the
    /// covariance is not positive definite.
    pub(super) fn increase(&self, covariance: &Matrix6<f64>, inverse: &Matrix6<f64>) -> Option<Matrix6<f64>> {
        let lower = Cholesky::new(*covariance)?.unpack();
        let inverse_lower = lower.solve_lower_triangular(&Matrix6::identity())?;
        let above = (inverse + 0.5 * (self.excess + self.excess.transpose())) * self.correlation.variance
            - covariance;
        let mut eigen = (inverse_lower * above * inverse_lower.transpose()).symmetric_eigen();
        eigen.eigenvalues.iter_mut().for_each(|value| *value = value.max(0.0));
        Some(lower * eigen.recompose() * lower.transpose())
    }
}
