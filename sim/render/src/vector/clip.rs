//! Clipping of polygons by a plane.

use nalgebra::Vector3;

/// Writes the part of a closed polygon where `height` ≥ 0 into `kept` (Sutherland and Hodgman, CACM 17,
/// 1974). `height` must be an affine function of position. The pieces of a divided polygon stay joined by
/// edges along the cut, which cover no area.
pub(super) fn keep_above(
    polygon: &[Vector3<f64>],
    kept: &mut Vec<Vector3<f64>>,
    height: impl Fn(&Vector3<f64>) -> f64,
) {
    kept.clear();
    let Some(last) = polygon.last() else { return };
    let (mut previous, mut previous_height) = (last, height(last));
    for point in polygon {
        let point_height = height(point);
        if (point_height >= 0.0) != (previous_height >= 0.0) {
            let part = previous_height / (previous_height - point_height);
            kept.push(previous + (point - previous) * part);
        }
        if point_height >= 0.0 {
            kept.push(*point);
        }
        (previous, previous_height) = (point, point_height);
    }
}
