//! Processing of pixels in chunks: each operation is done on all pixels of a chunk before the next, many at a
//! time in wide registers. The operations per pixel and the order of all sums are the same on every machine,
//! independent of its registers.

use pulp::Simd;

use super::unknowns::{GLOBALS, LOCALS};

/// Number of pixels in a chunk.
pub(super) const CHUNK: usize = 32;

/// Ideal image coordinates of N pixels, px.
#[derive(Debug, Clone)]
pub(super) struct IdealPositions<const N: usize> {
    pub(super) u: [f64; N],
    pub(super) v: [f64; N],
}

/// Blurred step of an edge at N pixels.
#[derive(Debug, Clone)]
pub(super) struct Steps<const N: usize> {
    /// Distance across the edge in units of its blur.
    pub(super) z: [f64; N],
    /// F: 0 far outside, 1 far inside.
    pub(super) inside: [f64; N],
    /// dF/dz; not set where the edge is far.
    pub(super) density: [f64; N],
    /// dF/d(share of the blur on pixels); not set where the edge is far.
    pub(super) by_grid: [f64; N],
    /// True if any pixel is within the edge's blur.
    pub(super) is_near: bool,
}

impl<const N: usize> Steps<N> {
    pub(super) const FAR: Self =
        Self { z: [0.0; N], inside: [0.0; N], density: [0.0; N], by_grid: [0.0; N], is_near: false };
}

/// Coverage at N pixels with its derivatives.
#[derive(Debug, Clone)]
pub(super) struct Coverages<const N: usize> {
    pub(super) value: [f64; N],
    pub(super) by: [[f64; N]; GLOBALS],
    /// True if side faces are visible. Otherwise the derivatives with respect to their brightness are zero.
    pub(super) has_sides: bool,
}

impl<const N: usize> Coverages<N> {
    pub(super) const NONE: Self = Self { value: [0.0; N], by: [[0.0; N]; GLOBALS], has_sides: false };
}

/// Number of columns of the equations: DN, plate, two slopes, beyond the rim, coverage; then derivatives of
/// the coverage, and a zero column that makes the number a multiple of [`ACROSS`].
pub(super) const COLUMNS: usize = 20;
pub(super) const FIRST_GLOBAL: usize = 1 + LOCALS;

/// Equations of a chunk, column by column, with the columns of the side faces last.
pub(super) type Equations = [[f64; CHUNK]; COLUMNS];

/// Number of partial sums of a product: pixels k, k + 8, k + 16 … of each chunk.
const PARTS: usize = 8;

/// Number of columns multiplied with two other columns at a time. Their sums fit in registers.
const ACROSS: usize = 4;

/// Sums of products of the equations' columns.
#[derive(Debug, Clone)]
pub(super) struct Gram {
    parts: [[[f64; PARTS]; COLUMNS]; COLUMNS],
}

impl Gram {
    pub(super) const ZERO: Self = Self { parts: [[[0.0; PARTS]; COLUMNS]; COLUMNS] };

    /// Adds the products of the first `columns` columns, a multiple of four. If `is_first`, starts anew with
    /// the products of all columns. Computes the upper triangle and a little of the lower.
    #[inline(always)]
    pub(super) fn add<S: Simd>(&mut self, simd: S, equations: &Equations, columns: usize, is_first: bool) {
        let columns = if is_first { COLUMNS } else { columns.min(COLUMNS) };
        for i in (0..columns).step_by(2) {
            let (first, second) = (S::as_simd_f64s(&equations[i]).0, S::as_simd_f64s(&equations[i + 1]).0);
            for j in ((i - i % ACROSS)..columns).step_by(ACROSS) {
                let others = [0, 1, 2, 3].map(|k: usize| S::as_simd_f64s(&equations[j + k]).0);
                // Number of registers in a row of partial sums.
                let registers = PARTS / S::F64_LANES;
                for part in 0..registers {
                    let mut sums = [[simd.splat_f64s(0.0); ACROSS]; 2];
                    for at in (part..first.len()).step_by(registers) {
                        for (k, other) in others.iter().enumerate() {
                            let other = other[at];
                            sums[0][k] = simd.add_f64s(sums[0][k], simd.mul_f64s(first[at], other));
                            sums[1][k] = simd.add_f64s(sums[1][k], simd.mul_f64s(second[at], other));
                        }
                    }
                    for (sums, row) in sums.iter().zip([i, i + 1]) {
                        for (k, sum) in sums.iter().enumerate() {
                            let total = &mut S::as_mut_simd_f64s(&mut self.parts[row][j + k]).0[part];
                            *total = if is_first { *sum } else { simd.add_f64s(*total, *sum) };
                        }
                    }
                }
            }
        }
    }

    /// Returns the sum of the products of columns `i` and `j`, with `j` not before `i`.
    pub(super) fn column_product(&self, i: usize, j: usize) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.parts[i][j];
        ((a + e) + (c + g)) + ((b + f) + (d + h))
    }
}
