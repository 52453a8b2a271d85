//! Unit vectors in the columns of a table.

use contract::Direction;
use nalgebra::Vector3;

/// Description of the input of [`direction`], for messages.
pub(crate) const EXPECTED: &str = "components of a unit vector, norm 1 within 1e-5";

/// Returns the direction of three components. A norm within 1e-12 of one is kept bit for bit, which makes
/// reading a file back exact; a norm within 1e-5 is normalised; any other norm is rejected.
pub(crate) fn direction<F>(xyz: [f64; 3]) -> Option<Direction<F>> {
    let vector = Vector3::from(xyz);
    let error = (vector.norm() - 1.0).abs();
    if error < 1e-12 {
        Some(Direction::from_unit(vector))
    } else if error < 1e-5 {
        Direction::from_vector(vector).ok()
    } else {
        None
    }
}
