//! ROS: camera_info files in YAML, and printed messages `sensor_msgs/CameraInfo`.

use std::path::Path;

use super::lens::LensCalibration;
use super::matrix::{number, plain, wrong};
use super::opencv::{coefficients, list, matrix_numbers};
use super::tree::Node;
use crate::FileError;

/// Returns true if a table has the key that every camera_info has.
pub(super) fn is_camera_info(table: &Node) -> bool {
    table.get("distortion_model").is_some()
        && ["camera_matrix", "K", "k"].iter().any(|key| table.get(key).is_some())
}

/// Refuses the camera_info of a part of the image.
pub(super) fn check(path: &Path, table: &Node) -> Result<(), FileError> {
    // A message states matrix and size of the full image, of which binning and region select a part.
    for key in ["binning_x", "binning_y"] {
        if let Some(binning) = table.get(key).filter(|node| node.scalar().is_some())
            && number(path, key, binning)? > 1.0
        {
            return Err(wrong(path, key, binning, "0 or 1: the calibration is that of the full image"));
        }
    }
    let region = table.get("roi").map(Node::entries).unwrap_or_default();
    for (key, node) in region.iter().filter(|(key, _)| plain(key) != "dorectify") {
        let field = format!("roi.{key}");
        if node.scalar().is_some() && number(path, &field, node)? != 0.0 {
            return Err(wrong(path, &field, node, "0: the calibration is that of the full image"));
        }
    }
    Ok(())
}

/// Returns the camera_info file of a calibration with a size. The projection matrix is that of a single
/// camera whose images are rectified without zoom.
pub(super) fn yaml(lens: &LensCalibration, [columns, rows]: [usize; 2]) -> String {
    let matrix = matrix_numbers(lens);
    let ([fx, fy], [cx, cy]) = (lens.focal_px, lens.principal_px);
    let projection = [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0];
    let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let block = |key: &str, rows: usize, numbers: &[f64]| {
        let columns = numbers.len() / rows;
        format!("{key}:\n  rows: {rows}\n  cols: {columns}\n  data: [{}]\n", list(numbers))
    };
    format!(
        "image_width: {columns}\nimage_height: {rows}\ncamera_name: camera\n{}distortion_model: plumb_bob\n{}{}{}",
        block("camera_matrix", 3, &matrix),
        block("distortion_coefficients", 1, &coefficients(lens)),
        block("rectification_matrix", 3, &identity),
        block("projection_matrix", 3, &projection),
    )
}
