//! Test that marks and cross of a docking target are in the field.

use contract::Camera;
use contract::docking::{Pose, TargetModel};
use nalgebra::Vector3;
use sim::truth::approach::target_from_camera;

/// Corners of the marks and ends of the cross, in the target frame, m.
pub fn corners(target: &TargetModel) -> Vec<Vector3<f64>> {
    let marks = target.marks.iter().flatten().map(|[x, y]| Vector3::new(*x, *y, 0.0));
    let (l, w, b) = (target.cross.half_length_m, 0.5 * target.cross.width_m, target.cross.height_m);
    let cross = [(l, w), (l, -w), (-l, w), (-l, -w), (w, l), (-w, l), (w, -l), (-w, -l)];
    marks.chain(cross.into_iter().map(|(x, y)| Vector3::new(x, y, b))).collect()
}

/// Returns true if all corners are at least `margin_px` from the border of the image of a camera without
/// distortion.
pub fn are_inside(camera: &Camera, pose: &Pose, corners: &[Vector3<f64>], margin_px: f64) -> bool {
    let (focal_x_px, focal_y_px) = camera.focal_length_px();
    corners.iter().all(|corner| {
        let x = target_from_camera(pose).transpose() * (corner - pose.position_m);
        let column = camera.principal_x_px + focal_x_px * x.x / x.z;
        let row = camera.principal_y_px + focal_y_px * x.y / x.z;
        let inside = |v: f64, n: usize| (margin_px - 0.5..=n as f64 - 0.5 - margin_px).contains(&v);
        x.z > 0.0 && inside(column, camera.columns) && inside(row, camera.rows)
    })
}
