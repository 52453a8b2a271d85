//! Unit vectors in the columns of a table.

use contract::Direction;
use nalgebra::Vector3;

/// What [`direction`] expects, for messages.
pub(crate) const EXPECTED: &str = "components of a unit vector, norm 1 within 1e-5";

/// The direction of three components. A norm within 1e-12 of one is kept to the bit, so that a file can be read
/// back exactly; one within 1e-5 is normalised; any other is refused.
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
