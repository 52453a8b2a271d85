//! Camera of Table 1 without distortion: its projection is one line, which the tests compute independently.

use contract::{Camera, PixelPoint};
use nalgebra::Vector3;

pub(crate) const COLUMNS: usize = 752;
pub(crate) const ROWS: usize = 580;

pub(crate) fn camera() -> Camera {
    Camera {
        columns: COLUMNS,
        rows: ROWS,
        focal_length_mm: 20.187,
        pixel_width_um: 8.6,
        pixel_height_um: 8.3,
        principal_x_px: 395.0,
        principal_y_px: 288.0,
        radial: [0.0; 3],
        tangential: [0.0; 2],
    }
}

/// Pixel position of a direction in the camera frame.
pub(crate) fn pixel(direction: Vector3<f64>) -> PixelPoint {
    let (fx, fy) = (20.187e3 / 8.6, 20.187e3 / 8.3);
    PixelPoint::new(395.0 + fx * direction.x / direction.z, 288.0 + fy * direction.y / direction.z)
}
