//! Kalibr: `camchain.yaml`, and the `sensor.yaml` of a camera in data sets of the same authors.

use std::path::Path;

use super::lens::LensCalibration;
use super::matrix::{add_coefficients, check_model, missing, numbers, pinhole, plain, size, wrong};
use super::opencv::list;
use super::tree::{Content, Node};
use crate::{FileError, FileLocation};

/// Keys of the coefficients: of a camchain, of a sensor, and of programs that read both.
const COEFFICIENTS: [&str; 3] = ["distortion_coeffs", "distortion_coefficients", "distortion"];

/// Returns true if a table is a camera of a camchain.
pub(super) fn is_camera(table: &Node) -> bool {
    let is_list = |key: &str| matches!(table.get(key).map(|node| &node.content), Some(Content::List(..)));
    is_list("intrinsics") && (table.get("camera_model").is_some() || table.get("distortion_model").is_some())
}

/// Returns the calibration of a camera of a camchain.
pub(super) fn lens(path: &Path, name: &str, table: &Node) -> Result<LensCalibration, FileError> {
    let field = |key: &str| if name.is_empty() { key.to_owned() } else { format!("{name}.{key}") };
    if let Some(model) = table.get("camera_model")
        && model.scalar().map(plain).as_deref() != Some("pinhole")
    {
        let expected = "pinhole: Boresight lacks the cameras omni, ds and eucm of Kalibr";
        return Err(wrong(path, &field("camera_model"), model, expected));
    }
    let key = field("intrinsics");
    let expected = "four numbers: fu, fv, pu, pv";
    let node = table.get("intrinsics").ok_or_else(|| missing(path, table, &key, expected))?;
    let found = numbers(path, &key, node)?;
    let [fx, fy, cx, cy] = found.as_slice() else { return Err(wrong(path, &key, node, expected)) };
    let mut lens = pinhole(path, &key, node, [*fx, *fy], [*cx, *cy])?;
    if let Some(node) = table.get("resolution") {
        lens.size_px = Some(size(path, &field("resolution"), node)?);
    }
    let model = table.get("distortion_model");
    if let Some(model) = model {
        check_model(path, &field("distortion_model"), model, &["", "none"])?;
    }
    let coefficients = COEFFICIENTS.iter().find_map(|key| table.get(key).map(|node| (field(key), node)));
    let is_without = model.and_then(Node::scalar).is_some_and(|model| matches!(&*plain(model), "" | "none"));
    match coefficients {
        Some((key, node)) => add_coefficients(path, &key, node, &mut lens)?,
        None if is_without => {}
        None => {
            let expected = "four coefficients k1, k2, p1, p2";
            return Err(missing(path, table, &field("distortion_coeffs"), expected));
        }
    }
    Ok(lens)
}

/// Returns the camchain of a calibration with a size: one camera, `cam0`.
///
/// # Errors
/// [`FileError::Value`] if k3 is not 0: the radtan of Kalibr ends with k2.
pub(super) fn yaml(
    path: &Path,
    lens: &LensCalibration,
    [columns, rows]: [usize; 2],
) -> Result<String, FileError> {
    let ([k1, k2, k3], [p1, p2]) = (lens.radial, lens.tangential);
    if k3 != 0.0 {
        let expected =
            "0: the distortion radtan of Kalibr has k1, k2, p1 and p2 alone; export to opencv or ros";
        return Err(FileError::value(path, FileLocation::Whole, "radial[2] (k3)", k3, expected));
    }
    let ([fx, fy], [cx, cy]) = (lens.focal_px, lens.principal_px);
    Ok(format!(
        "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [{}]\n  distortion_model: radtan\n  intrinsics: \
         [{}]\n  resolution: [{columns}, {rows}]\n",
        list(&[k1, k2, p1, p2]),
        list(&[fx, fy, cx, cy]),
    ))
}
