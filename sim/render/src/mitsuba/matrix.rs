//! Text form of a coordinate transformation.

use nalgebra::{Rotation3, Vector3};

/// Sixteen numbers, row by row, of the transformation from an object's axes to the target frame.
pub(super) fn matrix(rotation: &Rotation3<f64>, translation: &Vector3<f64>) -> String {
    let homogeneous = rotation.to_homogeneous().append_translation(translation);
    let rows: Vec<String> =
        homogeneous.row_iter().flat_map(|row| [0, 1, 2, 3].map(|i| row[i].to_string())).collect();
    rows.join(" ")
}
