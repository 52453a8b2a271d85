//! Bloom: pixels brighter than white have a wide, weak halo.

use optics::{correlate, gaussian_kernel, pad};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Side of the cells on which the halo is computed, px of the camera.
const CELL_PX: usize = 8;
/// Maximum excess above white that a pixel contributes to the halo, in units of the white level: the target
/// of a camera tube, or a well, holds no more.
const MAX_EXCESS: f32 = 30.0;

/// Halo around pixels above white: a Gaussian that contains a share of the excess above white.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BloomConfig {
    /// Share of the excess above white that goes into the halo, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub share: f64,
    /// Standard deviation of the halo, px of the camera, 4 to 200.
    #[schemars(range(min = 4, max = 200))]
    pub sigma_px: f64,
}

impl Default for BloomConfig {
    fn default() -> Self {
        Self { share: 0.1, sigma_px: 14.0 }
    }
}

/// Computes halos on coarse cells; reuses its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Bloom {
    cells: Vec<f32>,
    along: Vec<f32>,
    padded: Vec<f32>,
}

impl Bloom {
    /// Adds the halo to the rows of a field, which are `step` rows of the camera apart.
    pub(super) fn add(&mut self, config: &BloomConfig, signal: &mut [f32], columns: usize, step: usize) {
        let rows_a_cell = CELL_PX / step;
        let rows = signal.len() / columns;
        let (across, down) = (columns.div_ceil(CELL_PX), rows.div_ceil(rows_a_cell));
        if !signal.chunks(columns).any(is_bright) {
            return;
        }
        self.cells.clear();
        let share = config.share as f32 / (CELL_PX * rows_a_cell) as f32;
        for rows in signal.chunks(rows_a_cell * columns) {
            // Sums down the columns first, because they are independent of each other.
            self.along.clear();
            self.along.resize(columns, 0.0);
            for row in rows.chunks_exact(columns) {
                for (sum, s) in self.along.iter_mut().zip(row) {
                    *sum += (s - 1.0).clamp(0.0, MAX_EXCESS);
                }
            }
            self.cells.extend(self.along.chunks(CELL_PX).map(|sums| share * sums.iter().sum::<f32>()));
        }
        self.spread(&gaussian_kernel(config.sigma_px / CELL_PX as f64), across, down);
        for (y, row) in signal.chunks_exact_mut(columns).enumerate() {
            let (above, below, v) = between(y, rows_a_cell, down);
            self.along.clear();
            let (top, bottom) =
                (&self.cells[above * across..][..across], &self.cells[below * across..][..across]);
            self.along.extend(top.iter().zip(bottom).map(|(a, b)| a + v * (b - a)));
            add_between_cells(&self.along, row);
        }
    }

    /// Blurs the cells; the signal beyond the picture's border is zero.
    fn spread(&mut self, kernel: &[f32], across: usize, down: usize) {
        let reach = kernel.len() / 2;
        for row in self.cells.chunks_exact_mut(across) {
            dark_pad(row, reach, &mut self.padded);
            correlate(&self.padded, kernel, row);
        }
        for x in 0..across {
            self.along.clear();
            self.along.extend((0..down).map(|y| self.cells[y * across + x]));
            dark_pad(&self.along, reach, &mut self.padded);
            correlate(&self.padded, kernel, &mut self.along);
            for (y, value) in self.along.iter().enumerate() {
                self.cells[y * across + x] = *value;
            }
        }
    }
}

/// Returns true if any pixel of a row is above white. It reads the whole row: a search with an early exit
/// would test one pixel at a time.
fn is_bright(row: &[f32]) -> bool {
    row.iter().filter(|s| **s > 1.0).count() > 0
}

/// Adds the cells of a row to its pixels: linear interpolation between the cells' centres, constant beyond
/// the outer centres.
fn add_between_cells(cells: &[f32], row: &mut [f32]) {
    let (before, after) = row.split_at_mut((CELL_PX / 2).min(row.len()));
    let first = cells.first().copied().unwrap_or(0.0);
    before.iter_mut().for_each(|pixel| *pixel += first);
    let next = cells.iter().skip(1).chain(cells.last());
    for ((left, right), pixels) in cells.iter().zip(next).zip(after.chunks_mut(CELL_PX)) {
        for (i, pixel) in pixels.iter_mut().enumerate() {
            *pixel += left + (i as f32 + 0.5) / CELL_PX as f32 * (right - left);
        }
    }
}

fn dark_pad(row: &[f32], reach: usize, padded: &mut Vec<f32>) {
    pad(row, reach, reach, padded);
    let end = padded.len() - reach;
    padded[..reach].fill(0.0);
    padded[end..].fill(0.0);
}

/// Returns the two cells whose centres enclose a row, and the relative position of the row between them.
fn between(row: usize, side: usize, cells: usize) -> (usize, usize, f32) {
    let position = ((row as f32 + 0.5) / side as f32 - 0.5).clamp(0.0, (cells - 1) as f32);
    let first = position as usize;
    (first, (first + 1).min(cells - 1), position - first as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_halo_has_its_share_of_the_flux_and_its_width() {
        let (columns, rows) = (320, 240);
        let mut signal = vec![0.0_f32; columns * rows];
        for y in 112..120 {
            signal[y * columns + 152..y * columns + 160].fill(11.0);
        }
        let before = signal.clone();
        let config = BloomConfig { share: 0.2, sigma_px: 16.0 };
        Bloom::default().add(&config, &mut signal, columns, 1);
        let halo: Vec<f64> = signal.iter().zip(&before).map(|(a, b)| f64::from(a - b)).collect();
        let sum: f64 = halo.iter().sum();
        // 64 pixels, each 10 above white; sums in f32.
        assert!((sum - 0.2 * 640.0).abs() < 0.05, "{sum}");
        let variance = halo
            .iter()
            .enumerate()
            .map(|(i, h)| {
                let x = (i % columns) as f64 - 155.5;
                x * x * h / sum
            })
            .sum::<f64>();
        // The source's cell (64/12), the interpolation between cells (2 × 64/12), and the tails truncated at
        // 4 σ (0.1 %).
        let theory = 256.0 + 64.0 / 12.0 + 64.0 / 6.0;
        assert!((variance / theory - 1.0).abs() < 0.02, "{variance} {theory}");
    }

    #[test]
    fn without_a_glint_nothing_changes() {
        let mut signal = vec![1.0_f32; 6400];
        Bloom::default().add(&BloomConfig::default(), &mut signal, 80, 2);
        assert!(signal.iter().all(|&s| s == 1.0));
    }
}
