//! Calibrations of cameras by other tools: OpenCV, ROS and Kalibr.
//!
//! A file is read as a tree ([`tree`]), in which each format finds its cameras; one of them is a
//! [`LensCalibration`], which is converted to the camera of the contract and back.

#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod distortion;
mod kalibr;
mod lens;
mod matrix;
mod opencv;
mod ros;
#[cfg(test)]
mod tests;
mod tree;

use std::path::Path;

use self::tree::{Content, Node, refused};
use crate::FileError;

pub use self::lens::{Conversion, LensCalibration};

/// Format of a calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CalibrationFormat {
    /// OpenCV's FileStorage, YAML.
    OpenCvYaml,
    /// OpenCV's FileStorage, JSON.
    OpenCvJson,
    /// The `camchain.yaml` of Kalibr.
    Kalibr,
    /// The camera_info of ROS, YAML.
    Ros,
}

/// Camera of a file, before its values are read: a camera with a model that Boresight lacks does not hinder
/// the others.
enum Candidate<'a> {
    /// Pair of camera matrix and coefficients, of OpenCV or ROS.
    Matrix {
        name: String,
        root: &'a Node,
        table: &'a Node,
        matrix: (&'a str, &'a Node),
        distortion: Option<&'a (String, Node)>,
    },
    /// Camera of a camchain.
    Kalibr { name: String, table: &'a Node },
}

impl Candidate<'_> {
    fn name(&self) -> &str {
        match self {
            Self::Matrix { name, .. } | Self::Kalibr { name, .. } => name,
        }
    }

    fn lens(&self, path: &Path) -> Result<LensCalibration, FileError> {
        match self {
            Self::Kalibr { name, table } => kalibr::lens(path, name, table),
            Self::Matrix { root, table, matrix, distortion, .. } => {
                if ros::is_camera_info(table) {
                    ros::check(path, table)?;
                    return opencv::lens(path, [table, table], *matrix, *distortion);
                }
                opencv::lens(path, [root, table], *matrix, *distortion)
            }
        }
    }
}

/// Returns the cameras of a file: those of its root, or those of the tables and lists in it, each with the
/// keys that lead to it. The depth of the tree is limited.
fn candidates(root: &Node) -> Vec<Candidate<'_>> {
    candidates_below(root, root, "")
}

fn candidates_below<'a>(root: &'a Node, node: &'a Node, name: &str) -> Vec<Candidate<'a>> {
    if kalibr::is_camera(node) {
        return vec![Candidate::Kalibr { name: name.to_owned(), table: node }];
    }
    let here = opencv::candidates(root, node, name);
    if !here.is_empty() {
        return here;
    }
    let inner = |key: &str| if name.is_empty() { key.to_owned() } else { format!("{name}.{key}") };
    match &node.content {
        Content::Scalar(_) => Vec::new(),
        Content::Table(entries) => {
            entries.iter().flat_map(|(key, child)| candidates_below(root, child, &inner(key))).collect()
        }
        Content::List(items, _) => items
            .iter()
            .enumerate()
            .flat_map(|(index, child)| candidates_below(root, child, &inner(&index.to_string())))
            .collect(),
    }
}

/// Reads the calibration of a camera. `name` selects one of several cameras: `cam0` of a camchain, `1` of the
/// matrices M1 and D1 of OpenCV's stereo sample, `left` of `K_left` or of a table `left`.
///
/// # Errors
/// [`FileError::Io`]; [`FileError::Format`] for a file that is no YAML or JSON, and for one without a camera,
/// without the named one, or with several where none is named; [`FileError::Value`] with its line for a wrong
/// or missing value and for a model of distortion that [`LensCalibration`] does not have.
pub fn read_calibration(path: &Path, name: Option<&str>) -> Result<LensCalibration, FileError> {
    parse_calibration(path, &tree::read_text(path)?, name)
}

/// Parses the text of a calibration, as [`read_calibration`] reads a file.
///
/// # Errors
/// Those of [`read_calibration`].
pub fn parse_calibration(path: &Path, text: &str, name: Option<&str>) -> Result<LensCalibration, FileError> {
    let root = tree::parse(path, text)?;
    let candidates = candidates(&root);
    let names = || {
        let names: Vec<&str> = candidates.iter().take(20).map(Candidate::name).collect();
        names.join(", ")
    };
    let found = match (candidates.as_slice(), name) {
        ([], _) => {
            let keys: Vec<&str> = root.entries().iter().take(12).map(|(key, _)| key.as_str()).collect();
            let found = if keys.is_empty() { "none".to_owned() } else { keys.join(", ") };
            return Err(refused(
                path,
                format!(
                    "it has no camera, expected camera_matrix and distortion_coefficients (OpenCV, ROS), or cam0 \
                     with intrinsics (Kalibr); keys found: {found}"
                ),
            ));
        }
        ([one], None) => Some(one),
        (_, None) => {
            let reason = format!("it has several cameras, expected one of them with --name: {}", names());
            return Err(refused(path, reason));
        }
        (all, Some(name)) => all.iter().find(|candidate| candidate.name() == name),
    };
    match found {
        Some(candidate) => candidate.lens(path),
        None => {
            let reason = match names().as_str() {
                "" => "its camera has no name, expected no --name".to_owned(),
                names => format!("it has no camera of the name given by --name, expected one of: {names}"),
            };
            Err(refused(path, reason))
        }
    }
}

/// Returns the text of a calibration in a format.
///
/// # Errors
/// [`FileError::Value`] for a value that the format cannot state: k3 in Kalibr, a missing size in Kalibr and
/// ROS. `path` is the file for the message.
pub fn calibration_text(
    path: &Path,
    lens: &LensCalibration,
    format: CalibrationFormat,
) -> Result<String, FileError> {
    let size = lens.size_px.ok_or_else(|| {
        let expected = "the number of columns and rows";
        FileError::value(path, crate::FileLocation::Whole, "size", "missing", expected)
    });
    match format {
        CalibrationFormat::OpenCvYaml => Ok(opencv::yaml(lens)),
        CalibrationFormat::OpenCvJson => Ok(opencv::json(lens)),
        CalibrationFormat::Kalibr => kalibr::yaml(path, lens, size?),
        CalibrationFormat::Ros => Ok(ros::yaml(lens, size?)),
    }
}

/// Returns a number with a point and, in an exponent, a sign, as YAML 1.1 requires; reading it gives the same
/// number.
fn decimal(number: f64) -> String {
    let text = format!("{number:?}");
    match text.split_once('e') {
        None => text,
        Some((mantissa, exponent)) => {
            let point = if mantissa.contains('.') { "" } else { ".0" };
            let sign = if exponent.starts_with('-') { "" } else { "+" };
            format!("{mantissa}{point}e{sign}{exponent}")
        }
    }
}
