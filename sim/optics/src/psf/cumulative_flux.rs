//! Shapes without a closed integral over a pixel: a table of the cumulative flux, C(x, y) = ∫^x ∫^y I.
//!
//! The flux of a pixel is C at two of its corners minus C at the other two, for any pixel size in the table's
//! units. Pixel integration therefore needs no oversampling, all pixels together hold the flux of the table,
//! and an image that is wider at one position of the field needs no further table. Between its nodes C is
//! Lagrange's polynomial through 6 × 6 of them.

use std::sync::Arc;

use super::pixels_within::pixels_within;
use crate::{ImagePoint, Stamp};

/// CumulativeFlux shape, centred on the origin.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CumulativeFlux {
    table: Arc<Table>,
    /// Pixels per unit of the table, along columns and along rows.
    unit_px: [f64; 2],
}

#[derive(Debug, PartialEq)]
struct Table {
    /// Values of C row by row, with [`GUARD`] additional nodes on every side of the drawn area.
    nodes: Vec<f64>,
    stride: usize,
    columns: Axis,
    rows: Axis,
    /// Largest density at or beyond each radius of a grid.
    envelope: Vec<f64>,
    envelope_step: f64,
}

/// Nodes along an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Axis {
    /// Coordinate of the first node that is not a guard.
    origin: f64,
    step: f64,
    cells: usize,
    parity: Parity,
}

/// Symmetry of C about the origin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Parity {
    /// C(−x) = −C(x): only the positive side is stored.
    Odd,
    /// No symmetry: both sides are stored.
    None,
}

/// Number of nodes beyond the outermost cells that the interpolation there needs.
const GUARD: usize = 2;

/// Interpolation along an axis: six nodes from `first` on, with their weights.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stencil {
    first: usize,
    weights: [f64; 6],
}

/// Column edges, and values of C at them along a row, reused from stamp to stamp.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Edges {
    columns: Vec<Stencil>,
    above: Vec<f64>,
    below: Vec<f64>,
}

impl CumulativeFlux {
    /// Creates a circularly symmetric shape in the table's units. `density` is the flux per unit of area at a
    /// radius; the table extends to `radius` along each axis. `step` is a tenth of the finest structure or
    /// less.
    pub(super) fn radial(density: impl Fn(f64) -> f64, step: f64, radius: f64, unit_px: [f64; 2]) -> Self {
        let cells = (radius / step).ceil().max(1.0) as usize;
        let profile = RadialProfile::new(density, 0.5 * step, 3 * (cells + GUARD));
        let nodes_a_row = cells + 1 + 2 * GUARD;
        let size = cells + GUARD;
        let mut nodes = vec![0.0; nodes_a_row * nodes_a_row];
        let at = |i: usize, j: usize| (j + GUARD) * nodes_a_row + i + GUARD;
        // Gauss's three-point rule along each side of a cell.
        let gauss = [(-0.6_f64.sqrt(), 5.0 / 18.0), (0.0, 4.0 / 9.0), (0.6_f64.sqrt(), 5.0 / 18.0)];
        let cell = |i: usize, j: usize| {
            let mut sum = 0.0;
            for (v, weight_v) in gauss {
                let y = (j as f64 + 0.5 + 0.5 * v) * step;
                for (u, weight_u) in gauss {
                    let x = (i as f64 + 0.5 + 0.5 * u) * step;
                    sum += weight_u * weight_v * profile.value_at((x * x + y * y).sqrt());
                }
            }
            sum * step * step
        };
        // The cells on the two sides of the diagonal hold equal flux.
        for j in 0..size {
            for i in 0..=j {
                let light = cell(i, j);
                nodes[at(i + 1, j + 1)] = light;
                nodes[at(j + 1, i + 1)] = light;
            }
        }
        for j in 1..=size {
            for i in 1..=size {
                nodes[at(i, j)] += nodes[at(i - 1, j)] + nodes[at(i, j - 1)] - nodes[at(i - 1, j - 1)];
            }
        }
        // C is odd along each axis: the guards before the origin mirror the first nodes.
        for j in 0..nodes_a_row {
            for k in 1..=GUARD {
                nodes[j * nodes_a_row + GUARD - k] = -nodes[j * nodes_a_row + GUARD + k];
            }
        }
        for k in 1..=GUARD {
            for i in 0..nodes_a_row {
                nodes[(GUARD - k) * nodes_a_row + i] = -nodes[(GUARD + k) * nodes_a_row + i];
            }
        }
        let axis = Axis { origin: 0.0, step, cells, parity: Parity::Odd };
        let envelope = running_maximum(profile.values[GUARD..].to_vec());
        let table = Table {
            nodes,
            stride: nodes_a_row,
            columns: axis,
            rows: axis,
            envelope,
            envelope_step: profile.step,
        };
        Self { table: Arc::new(table), unit_px }
    }

    /// Creates a shape from the flux in each cell of a grid, row by row, with a sum of 1. The cells are
    /// `step_px` wide; the middle of the first cell is at `first_px` from the centre of the image, along
    /// columns and along rows.
    pub(super) fn cells(light: &[f64], columns: usize, step_px: f64, first_px: [f64; 2]) -> Self {
        let rows = light.len() / columns.max(1);
        let stride = columns + 1 + 2 * GUARD;
        let mut nodes = vec![0.0; stride * (rows + 1 + 2 * GUARD)];
        let mut densities: Vec<f64> = Vec::new();
        for (j, row) in light.chunks_exact(columns.max(1)).enumerate() {
            let mut sum = 0.0;
            for (i, &cell) in row.iter().enumerate() {
                sum += cell;
                let node = (j + 1 + GUARD) * stride + i + 1 + GUARD;
                nodes[node] = nodes[node - stride] + sum;
                let (x, y) = (first_px[0] + i as f64 * step_px, first_px[1] + j as f64 * step_px);
                // The farthest corner of the cell.
                let ring = (libm::hypot(x, y) / step_px + 0.75).ceil() as usize;
                densities.resize(densities.len().max(ring + 1), 0.0);
                densities[ring] = densities[ring].max(cell / (step_px * step_px));
            }
        }
        // Beyond the grid there is no flux: C is constant.
        for row in nodes.chunks_exact_mut(stride) {
            let last = row[stride - 1 - GUARD];
            row[stride - GUARD..].fill(last);
        }
        let last = (rows + GUARD) * stride;
        for k in 1..=GUARD {
            nodes.copy_within(last..last + stride, last + k * stride);
        }
        let axis = |cells: usize, first: f64| Axis {
            origin: first - 0.5 * step_px,
            step: step_px,
            cells,
            parity: Parity::None,
        };
        let table = Table {
            nodes,
            stride,
            columns: axis(columns, first_px[0]),
            rows: axis(rows, first_px[1]),
            envelope: running_maximum(densities),
            envelope_step: step_px,
        };
        Self { table: Arc::new(table), unit_px: [1.0, 1.0] }
    }

    /// Distance from the centre beyond which no pixel holds `floor_e`, px; 0 if no pixel does.
    pub(super) fn reach_px(&self, electrons: f64, floor_e: f64, scale: f64) -> f64 {
        let [unit_x, unit_y] = self.unit_px.map(|unit| unit * scale);
        let density = floor_e / electrons * unit_x * unit_y;
        let bright = self.table.envelope.partition_point(|&largest| largest > density);
        if bright == 0 {
            return 0.0;
        }
        let radius = bright as f64 * self.table.envelope_step;
        0.5 + radius.min(self.table.columns.farthest().max(self.table.rows.farthest())) * unit_x.max(unit_y)
    }

    /// Adds the images of `points`, `scale` times as wide, to a stamp that covers them.
    pub(super) fn draw(
        &self,
        points: &[ImagePoint],
        electrons: f64,
        reach_px: f64,
        scale: f64,
        edges: &mut Edges,
        stamp: &mut Stamp,
    ) {
        let [per_x, per_y] = self.unit_px.map(|unit| 1.0 / (unit * scale));
        let (right, bottom) = (stamp.x + stamp.columns, stamp.y + stamp.rows);
        for point in points {
            let at = point.position;
            let x = pixels_within((at.x, at.x), reach_px, right);
            let y = pixels_within((at.y, at.y), reach_px, bottom);
            let (x, y) = ((x.0.max(stamp.x), x.1), (y.0.max(stamp.y), y.1));
            if x.0 >= x.1 || y.0 >= y.1 {
                continue;
            }
            let column = |i: usize| self.table.columns.stencil((i as f64 - 0.5 - at.x) * per_x);
            edges.columns.clear();
            edges.columns.extend((x.0..=x.1).map(column));
            let row = |j: usize| self.table.rows.stencil((j as f64 - 0.5 - at.y) * per_y);
            self.table.interpolate_row(&edges.columns, &row(y.0), &mut edges.above);
            let flux = electrons * point.share;
            for j in y.0..y.1 {
                self.table.interpolate_row(&edges.columns, &row(j + 1), &mut edges.below);
                let start = (j - stamp.y) * stamp.stride + x.0 - stamp.x;
                let pixels = &mut stamp.electrons[start..start + x.1 - x.0];
                for ((pixel, above), below) in
                    pixels.iter_mut().zip(edges.above.windows(2)).zip(edges.below.windows(2))
                {
                    *pixel += flux * ((below[1] - below[0]) - (above[1] - above[0]));
                }
                std::mem::swap(&mut edges.above, &mut edges.below);
            }
        }
    }

    /// Fraction of the flux in the pixel under the centre.
    pub(super) fn peak_share(&self) -> f64 {
        let [half_x, half_y] = self.unit_px.map(|unit| 0.5 / unit);
        let columns = [-half_x, half_x].map(|x| self.table.columns.stencil(x));
        let mut row = Vec::new();
        let mut across = |y: f64| {
            self.table.interpolate_row(&columns, &self.table.rows.stencil(y), &mut row);
            row[1] - row[0]
        };
        across(half_y) - across(-half_y)
    }
}

impl Table {
    /// Computes C at the column edges and one row edge.
    fn interpolate_row(&self, columns: &[Stencil], row: &Stencil, values: &mut Vec<f64>) {
        let start = row.first * self.stride;
        let lines: [&[f64]; 6] =
            std::array::from_fn(|k| &self.nodes[start + k * self.stride..][..self.stride]);
        values.clear();
        values.extend(columns.iter().map(|column| {
            let mut sum = 0.0;
            for (line, weight) in lines.iter().zip(row.weights) {
                let nodes = &line[column.first..column.first + 6];
                let along: f64 = nodes.iter().zip(column.weights).map(|(node, weight)| node * weight).sum();
                sum += weight * along;
            }
            sum
        }));
    }
}

impl Axis {
    /// Largest distance of the axis from the origin.
    fn farthest(&self) -> f64 {
        (self.origin + self.cells as f64 * self.step).abs().max(self.origin.abs())
    }

    fn stencil(&self, at: f64) -> Stencil {
        let (along, sign) = match self.parity {
            Parity::Odd => (at.abs(), if at < 0.0 { -1.0 } else { 1.0 }),
            Parity::None => (at, 1.0),
        };
        let node_position = ((along - self.origin) / self.step).clamp(0.0, self.cells as f64);
        let cell = (node_position as usize).min(self.cells - 1);
        Stencil { first: cell, weights: lagrange(node_position - cell as f64).map(|weight| sign * weight) }
    }
}

/// Weights of the values at −2, −1, 0, 1, 2, 3 in Lagrange's polynomial through them, at `t`.
fn lagrange(t: f64) -> [f64; 6] {
    let [a, b, c, d, e, f] = [t + 2.0, t + 1.0, t, t - 1.0, t - 2.0, t - 3.0];
    let (ab, ef) = (a * b, e * f);
    [
        b * c * d * ef / -120.0,
        a * c * d * ef / 24.0,
        ab * d * ef / -12.0,
        ab * c * ef / 12.0,
        ab * c * d * f / -24.0,
        ab * c * d * e / 120.0,
    ]
}

/// Radial function at equal steps, with guards on the other side of the centre.
struct RadialProfile {
    values: Vec<f64>,
    step: f64,
}

impl RadialProfile {
    /// Samples `count` steps: √2 times the number of half cells along a side of the table, which includes its
    /// corner.
    fn new(density: impl Fn(f64) -> f64, step: f64, count: usize) -> Self {
        let mut values: Vec<f64> = (0..=count + 3).map(|i| density(i as f64 * step)).collect();
        let mirrored = [values[2], values[1]];
        values.splice(0..0, mirrored);
        Self { values, step }
    }

    fn value_at(&self, radius: f64) -> f64 {
        let node_position = radius / self.step;
        let cell = node_position as usize;
        let nodes = &self.values[cell..cell + 6];
        nodes.iter().zip(lagrange(node_position - cell as f64)).map(|(value, weight)| value * weight).sum()
    }
}

/// Returns for each index the largest absolute value there or later.
fn running_maximum(mut values: Vec<f64>) -> Vec<f64> {
    let mut largest = 0.0_f64;
    for value in values.iter_mut().rev() {
        largest = largest.max(value.abs());
        *value = largest;
    }
    values
}
