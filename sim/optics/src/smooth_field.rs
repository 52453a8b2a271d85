//! Smooth field over the detector, given by its values at the nodes of a grid and bilinear between them.
//!
//! A row of the field consists of a few straight pieces: it is computed on demand, row by row, and never
//! stored for a whole image.

use std::sync::Arc;

/// Number of nodes along each side of the detector.
pub const NODES: usize = 17;

/// Grid of nodes over a detector with a given number of columns and rows.
#[derive(Debug, Clone, PartialEq)]
pub struct NodeGrid {
    columns: usize,
    rows: usize,
    /// Relative position of each column between the node before it and the next node, 0 to 1.
    across: Vec<f64>,
    /// First column at or after each node.
    starts: [usize; NODES],
    /// Weight of each node, along columns and along rows, in the mean over all pixels.
    column_weights: [f64; NODES],
    row_weights: [f64; NODES],
}

impl NodeGrid {
    /// Creates the grid of a detector.
    pub fn new(columns: usize, rows: usize) -> Self {
        let before = |x: usize| between_nodes(x, columns).0;
        Self {
            columns,
            rows,
            across: (0..columns).map(|x| between_nodes(x, columns).1).collect(),
            starts: std::array::from_fn(|node| (0..columns).find(|&x| before(x) >= node).unwrap_or(columns)),
            column_weights: mean_weights(columns),
            row_weights: mean_weights(rows),
        }
    }

    /// Position of node `i` of the grid, counted row by row: column and row, px.
    pub fn node_position(&self, i: usize) -> (f64, f64) {
        (node_coordinate(i % NODES, self.columns), node_coordinate(i / NODES, self.rows))
    }
}

/// A field over the detector, bilinear between its nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct SmoothField {
    grid: Arc<NodeGrid>,
    /// Values at the nodes, row by row.
    values: [f64; NODES * NODES],
}

impl SmoothField {
    /// Creates the field with these values at the nodes, row by row.
    pub fn new(grid: Arc<NodeGrid>, values: [f64; NODES * NODES]) -> Self {
        Self { grid, values }
    }

    /// Number of columns and of rows.
    pub fn size(&self) -> (usize, usize) {
        (self.grid.columns, self.grid.rows)
    }

    /// Mean over all pixels.
    pub fn mean(&self) -> f64 {
        let mut mean = 0.0;
        for (i, value) in self.values.iter().enumerate() {
            mean += self.grid.column_weights[i % NODES] * self.grid.row_weights[i / NODES] * value;
        }
        mean
    }

    /// Largest value of the field, which occurs at a node.
    pub fn largest(&self) -> f64 {
        self.values.iter().copied().fold(0.0, f64::max)
    }

    /// Value of the field at a pixel; 0 outside the detector.
    pub fn value_at(&self, x: usize, y: usize) -> f64 {
        let Some(&across) = self.grid.across.get(x).filter(|_| y < self.grid.rows) else { return 0.0 };
        let (before, _) = between_nodes(x, self.grid.columns);
        let (row, down) = between_nodes(y, self.grid.rows);
        let (from, to) =
            (self.value_between_rows(row, down, before), self.value_between_rows(row, down, before + 1));
        from + across * (to - from)
    }

    /// Writes the field of the pixels of a row from column `x` on to `out`; entries outside the detector are
    /// unchanged.
    #[inline(always)]
    pub fn span(&self, x: usize, y: usize, out: &mut [f64]) {
        let (row, down) = between_nodes(y, self.grid.rows);
        let end = x + out.len();
        for node in 0..NODES - 1 {
            let (first, last) = (self.grid.starts[node].max(x), self.grid.starts[node + 1].min(end));
            if first >= last {
                continue;
            }
            let (from, to) =
                (self.value_between_rows(row, down, node), self.value_between_rows(row, down, node + 1));
            let step = to - from;
            let Some(across) = self.grid.across.get(first..last) else { return };
            for (out, across) in out[first - x..last - x].iter_mut().zip(across) {
                *out = from + across * step;
            }
        }
    }

    /// Upper bound, close to the maximum, of the field along a row of pixels: the largest value at the ends
    /// of the row and at the node columns.
    pub fn largest_of_row(&self, y: usize) -> f64 {
        let (row, down) = between_nodes(y, self.grid.rows);
        (0..NODES).map(|i| self.value_between_rows(row, down, i)).fold(0.0, f64::max)
    }

    /// Value of the field at the column of node `i`, at the fraction `down` of the distance from a row of
    /// nodes to the next.
    #[inline(always)]
    fn value_between_rows(&self, row: usize, down: f64, i: usize) -> f64 {
        let (above, below) = (self.values[row * NODES + i], self.values[(row + 1) * NODES + i]);
        above + down * (below - above)
    }
}

/// Pixel position of node `i` along `n` pixels.
fn node_coordinate(i: usize, n: usize) -> f64 {
    i as f64 * (n as f64 - 1.0) / (NODES - 1) as f64
}

/// Returns the node before pixel `i` of `n`, and the relative position of the pixel between this node and the
/// next, 0 to 1.
fn between_nodes(i: usize, n: usize) -> (usize, f64) {
    let at = i as f64 * (NODES - 1) as f64 / (n as f64 - 1.0).max(1.0);
    let before = (at as usize).min(NODES - 2);
    (before, at - before as f64)
}

/// Weight of each node in the mean over `n` pixels in a line.
fn mean_weights(n: usize) -> [f64; NODES] {
    let mut weights = [0.0; NODES];
    for i in 0..n {
        let (before, part) = between_nodes(i, n);
        weights[before] += (1.0 - part) / n as f64;
        weights[before + 1] += part / n as f64;
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Field with the values x² + 3y at the nodes.
    fn field(columns: usize, rows: usize) -> SmoothField {
        let grid = Arc::new(NodeGrid::new(columns, rows));
        let values = std::array::from_fn(|i| {
            let (x, y) = grid.node_position(i);
            x * x + 3.0 * y
        });
        SmoothField::new(grid, values)
    }

    #[test]
    fn a_row_has_the_values_of_its_pixels_at_any_size() {
        for (columns, rows) in [(752, 580), (17, 17), (16, 5), (2, 1), (1, 1), (300, 200)] {
            let field = field(columns, rows);
            let mut row = vec![f64::NAN; columns];
            let mut sum = 0.0;
            for y in 0..rows {
                field.span(0, y, &mut row);
                for (x, value) in row.iter().enumerate() {
                    assert_eq!(*value, field.value_at(x, y), "({x}, {y}) of {columns} × {rows}");
                }
                let largest = row.iter().copied().fold(0.0, f64::max);
                assert!(field.largest_of_row(y) >= largest * (1.0 - 1e-15), "row {y} of {columns} × {rows}");
                let mut part = [f64::NAN; 7];
                let x = (5 * y) % columns;
                let part = &mut part[..(columns - x).min(7)];
                field.span(x, y, part);
                assert_eq!(part, &row[x..x + part.len()], "({x}, {y}) of {columns} × {rows}");
                sum += row.iter().sum::<f64>();
            }
            let mean = sum / (columns * rows) as f64;
            assert!((field.mean() - mean).abs() <= 1e-12 * mean, "{columns} × {rows}");
        }
    }

    /// A parabola lies below its chord by at most step²/4; a plane is reproduced to rounding.
    #[test]
    fn between_nodes_the_field_is_bilinear() {
        let field = field(161, 81);
        for (x, y) in [(0, 0), (10, 5), (7, 33), (160, 80)] {
            let exact = (x * x + 3 * y) as f64;
            assert!((0.0..=25.0 + 1e-9).contains(&(field.value_at(x, y) - exact)), "({x}, {y})");
        }
        assert!((field.value_at(7, 33) - (70.0 + 99.0)).abs() < 1e-9);
        assert_eq!((field.value_at(161, 0), field.value_at(0, 81)), (0.0, 0.0));
    }
}
