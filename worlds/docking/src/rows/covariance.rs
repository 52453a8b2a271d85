//! Symmetric 6 × 6 matrix as 21 cells of a table: the upper triangle, row by row.

use files::{CsvRow, FileError};
use nalgebra::{Matrix6, Vector6};

/// Number of cells in the upper triangle.
pub(crate) const CELLS: usize = 21;

/// Returns the names of the cells, built from the names of the six variables.
macro_rules! upper_triangle {
    ($($name:literal)+) => {
        $crate::rows::covariance::upper_triangle!(@ [] $($name)+)
    };
    (@ [$($cell:expr,)*] $first:literal $($rest:literal)*) => {
        $crate::rows::covariance::upper_triangle!(
            @ [$($cell,)* concat!("cov_", $first, "_", $first), $(concat!("cov_", $first, "_", $rest),)*] $($rest)*
        )
    };
    (@ [$($cell:expr,)*]) => {
        [$($cell),*]
    };
}

pub(crate) use upper_triangle;

/// Returns the row and column indices of the upper triangle, row by row.
fn triangle_indices() -> impl Iterator<Item = (usize, usize)> {
    (0..6).flat_map(|i| (i..6).map(move |j| (i, j)))
}

/// Returns the cells of a covariance; `scale` converts each of the six variables to the unit of the file.
pub(crate) fn to_cells(covariance: &Matrix6<f64>, scale: &Vector6<f64>) -> [f64; CELLS] {
    let mut cells = [0.0; CELLS];
    for (cell, (i, j)) in cells.iter_mut().zip(triangle_indices()) {
        *cell = covariance[(i, j)] * scale[i] * scale[j];
    }
    cells
}

/// Returns the covariance after conversion to the cells of a file and back.
#[expect(clippy::indexing_slicing, reason = "the indices are those of a 6 × 6 matrix")]
pub(crate) fn as_filed(covariance: &Matrix6<f64>, scale: &Vector6<f64>) -> Matrix6<f64> {
    let mut filed = Matrix6::zeros();
    for (i, j) in triangle_indices() {
        let entry = covariance[(i, j)] * scale[i] * scale[j] / (scale[i] * scale[j]);
        filed[(i, j)] = entry;
        filed[(j, i)] = entry;
    }
    filed
}

/// Returns the covariance in the cells of `columns`, if present.
#[expect(clippy::indexing_slicing, reason = "the indices are those of a 6 × 6 matrix")]
pub(crate) fn from_cells(
    row: &CsvRow<'_>,
    columns: [&'static str; CELLS],
    cells: Option<[f64; CELLS]>,
    scale: &Vector6<f64>,
) -> Result<Option<Matrix6<f64>>, FileError> {
    let Some(cells) = cells else { return Ok(None) };
    let mut covariance = Matrix6::zeros();
    for ((value, column), (i, j)) in cells.into_iter().zip(columns).zip(triangle_indices()) {
        if i == j && value < 0.0 {
            return Err(row.error(column, "a variance, 0 or greater"));
        }
        let entry = value / (scale[i] * scale[j]);
        covariance[(i, j)] = entry;
        covariance[(j, i)] = entry;
    }
    Ok(Some(covariance))
}
