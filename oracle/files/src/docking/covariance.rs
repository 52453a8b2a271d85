//! A symmetric matrix of six as 21 cells of a table: the upper triangle, row by row.

use nalgebra::{Matrix6, Vector6};

use crate::FileError;
use crate::csv::table::CsvRow;

/// Cells of the upper triangle.
pub(super) const CELLS: usize = 21;

/// The names of the cells, from those of the six.
macro_rules! upper_triangle {
    ($($name:literal)+) => {
        $crate::docking::covariance::upper_triangle!(@ [] $($name)+)
    };
    (@ [$($cell:expr,)*] $first:literal $($rest:literal)*) => {
        $crate::docking::covariance::upper_triangle!(
            @ [$($cell,)* concat!("cov_", $first, "_", $first), $(concat!("cov_", $first, "_", $rest),)*] $($rest)*
        )
    };
    (@ [$($cell:expr,)*]) => {
        [$($cell),*]
    };
}

pub(super) use upper_triangle;

/// The places of the upper triangle, row by row.
fn triangle_indices() -> impl Iterator<Item = (usize, usize)> {
    (0..6).flat_map(|i| (i..6).map(move |j| (i, j)))
}

/// The cells of a covariance; `scale` takes each of the six to the unit of the file.
pub(super) fn to_cells(covariance: &Matrix6<f64>, scale: &Vector6<f64>) -> [f64; CELLS] {
    let mut cells = [0.0; CELLS];
    for (cell, (i, j)) in cells.iter_mut().zip(triangle_indices()) {
        *cell = covariance[(i, j)] * scale[i] * scale[j];
    }
    cells
}

/// The covariance as it comes back from its cells.
#[expect(clippy::indexing_slicing, reason = "the places are those of a matrix of six")]
pub(super) fn as_filed(covariance: &Matrix6<f64>, scale: &Vector6<f64>) -> Matrix6<f64> {
    let mut filed = Matrix6::zeros();
    for (i, j) in triangle_indices() {
        let entry = covariance[(i, j)] * scale[i] * scale[j] / (scale[i] * scale[j]);
        filed[(i, j)] = entry;
        filed[(j, i)] = entry;
    }
    filed
}

/// The covariance that the cells of these columns say, if they say one.
#[expect(clippy::indexing_slicing, reason = "the places are those of a matrix of six")]
pub(super) fn from_cells(
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
