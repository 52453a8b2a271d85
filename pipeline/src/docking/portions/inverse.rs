//! Inverses of information matrices.

use nalgebra::{Cholesky, Const, DimMin, SMatrix};

/// Returns the inverse of a symmetric positive definite matrix whose rows have different units. The matrix is
/// first scaled to a unit diagonal, so no digits are lost to metres and radians. Returns `None` when it is
/// singular.
pub(in crate::docking) fn inverse<const N: usize>(matrix: &SMatrix<f64, N, N>) -> Option<SMatrix<f64, N, N>>
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    let scale = matrix.diagonal().map(|d| 1.0 / d.sqrt());
    if !scale.iter().all(|s| s.is_finite()) {
        return None;
    }
    let scaled = SMatrix::<f64, N, N>::from_fn(|i, j| matrix[(i, j)] * scale[i] * scale[j]);
    let inverse = Cholesky::new(scaled)?.inverse();
    let inverse =
        SMatrix::<f64, N, N>::from_fn(|i, j| 0.5 * (inverse[(i, j)] + inverse[(j, i)]) * scale[i] * scale[j]);
    inverse.iter().all(|v| v.is_finite()).then_some(inverse)
}
