//! OpenCV's FileStorage, YAML and JSON: calibrations as its samples and other programs name their values.

use std::fmt::Write as _;
use std::path::Path;

use super::lens::LensCalibration;
use super::matrix::{SUPPORTED, add_coefficients, check_model, lens_of_matrix, plain, side, size, wrong};
use super::tree::{Content, Node};
use super::{Candidate, decimal};
use crate::FileError;

/// Names of a camera matrix, in small letters and digits: those of the calibration samples of OpenCV, of ROS
/// messages, and of programs in Python.
const MATRICES: [&str; 13] = [
    "cameramatrix",
    "cammatrix",
    "cammtx",
    "cameramat",
    "cameraintrinsics",
    "intrinsicmatrix",
    "intrinsicsmatrix",
    "intrinsicmtx",
    "intrinsics",
    "intrinsic",
    "mtx",
    "k",
    "m",
];
/// Names of the coefficients of distortion, in small letters and digits.
const DISTORTIONS: [&str; 17] = [
    "distortioncoefficients",
    "distortioncoefficient",
    "distortioncoefficents",
    "distortioncoeffs",
    "distortioncoeff",
    "distcoefficients",
    "distcoeffs",
    "distcoeff",
    "distcoefs",
    "distortion",
    "distortions",
    "distmatrix",
    "distmtx",
    "distvec",
    "dists",
    "dist",
    "d",
];
/// Words that name one of several cameras, before or after the name of a value.
const CAMERAS: [&str; 10] = ["l", "r", "left", "right", "rgb", "ir", "color", "depth", "cam", "camera"];
/// Names of widths and heights of images, and of both as a list.
const WIDTHS: [&str; 5] = ["imagewidth", "imgwidth", "framewidth", "width", "w"];
const HEIGHTS: [&str; 5] = ["imageheight", "imgheight", "frameheight", "height", "h"];
const SIZES: [&str; 6] = ["imagesize", "imgsize", "imageresolution", "resolution", "framesize", "size"];
/// Names of the model of a lens.
const MODELS: [&str; 5] = ["distortionmodel", "cameramodel", "lensmodel", "modeltype", "cameratype"];

/// Returns the word for one of several cameras in a key that is a value's name with that word before or after
/// it; empty for the name alone.
fn camera_word(key: &str, names: &[&str]) -> Option<String> {
    let key = plain(key);
    names.iter().find_map(|name| {
        let word = key.strip_prefix(name).or_else(|| key.strip_suffix(name))?;
        let letters = word.trim_matches(|letter: char| letter.is_ascii_digit());
        let is_word = word.len() - letters.len() <= 2 && (letters.is_empty() || CAMERAS.contains(&letters));
        is_word.then(|| word.to_owned())
    })
}

/// Returns the cameras of a table: its pairs of a camera matrix and coefficients with the same word.
pub(super) fn candidates<'a>(root: &'a Node, table: &'a Node, group: &str) -> Vec<Candidate<'a>> {
    let is_matrix = |node: &Node| !matches!(node.content, Content::Scalar(_));
    let mut found: Vec<Candidate> = Vec::new();
    for (key, node) in table.entries().iter().filter(|(_, node)| is_matrix(node)) {
        let Some(word) = camera_word(key, &MATRICES) else { continue };
        let distortion = table.entries().iter().find(|(key, node)| {
            is_matrix(node) && camera_word(key, &DISTORTIONS).is_some_and(|other| other == word)
        });
        let name = [group, word.as_str()].iter().filter(|part| !part.is_empty()).copied().collect::<Vec<_>>();
        let name = name.join(".");
        // The first of several names for the same camera.
        if found.iter().all(|earlier| earlier.name() != name) {
            found.push(Candidate::Matrix { name, root, table, matrix: (key, node), distortion });
        }
    }
    found
}

/// Returns the value of the first key with one of these names.
fn named<'a>(table: &'a Node, names: &[&str]) -> Option<&'a (String, Node)> {
    names.iter().find_map(|name| table.entries().iter().find(|(key, _)| plain(key) == *name))
}

/// Returns the number of columns and rows that a table states.
fn size_px(path: &Path, table: &Node) -> Result<Option<[usize; 2]>, FileError> {
    if let (Some((width, columns)), Some((height, rows))) = (named(table, &WIDTHS), named(table, &HEIGHTS)) {
        return Ok(Some([side(path, width, columns)?, side(path, height, rows)?]));
    }
    match named(table, &SIZES) {
        Some((key, node)) if matches!(node.content, Content::List(..)) => size(path, key, node).map(Some),
        Some((key, node)) if matches!(node.content, Content::Table(_)) => {
            match (named(node, &WIDTHS), named(node, &HEIGHTS)) {
                (Some((_, columns)), Some((_, rows))) => {
                    Ok(Some([side(path, key, columns)?, side(path, key, rows)?]))
                }
                _ => Ok(None),
            }
        }
        _ => Ok(None),
    }
}

/// Refuses the lenses of OpenCV's modules `fisheye` and `omnidir`, which have coefficients of other meaning.
fn check_lens(path: &Path, table: &Node) -> Result<(), FileError> {
    for (key, node) in table.entries() {
        let (name, value) = (plain(key), node.scalar().map(plain));
        let is_set =
            value.as_deref().is_some_and(|value| !matches!(value, "0" | "false" | "no" | "off" | ""));
        if ["fisheyemodel", "fisheye", "isfisheye", "usefisheye"].contains(&name.as_str()) && is_set {
            return Err(wrong(
                path,
                key,
                node,
                &format!("0: Boresight lacks fisheye lenses; it has {SUPPORTED}"),
            ));
        }
        if name == "xi" {
            let expected =
                format!("no key `xi`: Boresight lacks omnidirectional cameras; it has {SUPPORTED}");
            return Err(wrong(path, key, node, &expected));
        }
        // The coefficients k4 to k6 of the rational model are checked with the others.
        if MODELS.contains(&name.as_str()) && node.scalar().is_some() {
            check_model(path, key, node, &["", "none", "rationalpolynomial", "mono", "monocular"])?;
        }
    }
    Ok(())
}

/// Returns the calibration of a pair of camera matrix and coefficients.
pub(super) fn lens(
    path: &Path,
    [root, table]: [&Node; 2],
    (key, matrix): (&str, &Node),
    distortion: Option<&(String, Node)>,
) -> Result<LensCalibration, FileError> {
    for table in [root, table] {
        check_lens(path, table)?;
    }
    let mut lens = lens_of_matrix(path, key, matrix)?;
    let Some((key, coefficients)) = distortion else {
        let expected = "coefficients of distortion beside the camera matrix (4 of 0 for none), under a name as \
                        distortion_coefficients, dist_coeffs or D";
        return Err(super::matrix::missing(path, matrix, "distortion_coefficients", expected));
    };
    add_coefficients(path, key, coefficients, &mut lens)?;
    // Beside the matrix, at the root, or in a table of the root, as `calibration_info`.
    let inner = root.entries().iter().map(|(_, node)| node).filter(|node| node.get("data").is_none());
    for table in [table, root].into_iter().chain(inner) {
        lens.size_px = size_px(path, table)?;
        if lens.size_px.is_some() {
            break;
        }
    }
    Ok(lens)
}

/// Returns the rows of the camera matrix in one list.
pub(super) fn matrix_numbers(lens: &LensCalibration) -> [f64; 9] {
    let ([fx, fy], [cx, cy]) = (lens.focal_px, lens.principal_px);
    [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0]
}

/// Returns the coefficients in OpenCV's order, k1, k2, p1, p2, k3.
pub(super) fn coefficients(lens: &LensCalibration) -> [f64; 5] {
    let ([k1, k2, k3], [p1, p2]) = (lens.radial, lens.tangential);
    [k1, k2, p1, p2, k3]
}

/// Returns numbers as a list, with `, ` between them.
pub(super) fn list(numbers: &[f64]) -> String {
    numbers.iter().map(|number| decimal(*number)).collect::<Vec<_>>().join(", ")
}

/// Returns the file of OpenCV's FileStorage in YAML, with the keys of its calibration sample.
pub(super) fn yaml(lens: &LensCalibration) -> String {
    let mut text = "%YAML:1.0\n---\n".to_owned();
    if let Some([columns, rows]) = lens.size_px {
        // Formatting into a string does not fail.
        let _ = write!(text, "image_width: {columns}\nimage_height: {rows}\n");
    }
    for (key, rows, columns, numbers) in [
        ("camera_matrix", 3, 3, matrix_numbers(lens).as_slice()),
        ("distortion_coefficients", 5, 1, coefficients(lens).as_slice()),
    ] {
        let _ = write!(
            text,
            "{key}: !!opencv-matrix\n   rows: {rows}\n   cols: {columns}\n   dt: d\n   data: [ {} ]\n",
            list(numbers)
        );
    }
    text
}

/// Returns the file of OpenCV's FileStorage in JSON, with the keys of its calibration sample.
pub(super) fn json(lens: &LensCalibration) -> String {
    let mut parts = Vec::new();
    if let Some([columns, rows]) = lens.size_px {
        parts.push(format!("    \"image_width\": {columns},\n    \"image_height\": {rows}"));
    }
    for (key, rows, columns, numbers) in [
        ("camera_matrix", 3, 3, matrix_numbers(lens).as_slice()),
        ("distortion_coefficients", 5, 1, coefficients(lens).as_slice()),
    ] {
        parts.push(format!(
            "    \"{key}\": {{\n        \"type_id\": \"opencv-matrix\",\n        \"rows\": {rows},\n        \
             \"cols\": {columns},\n        \"dt\": \"d\",\n        \"data\": [{}]\n    }}",
            list(numbers)
        ));
    }
    format!("{{\n{}\n}}\n", parts.join(",\n"))
}
