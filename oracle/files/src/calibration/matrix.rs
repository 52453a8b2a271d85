//! Numbers, matrices and coefficients of a calibration, in the notations of the formats.

use std::path::Path;

use super::lens::LensCalibration;
use super::tree::{Content, Node};
use crate::{FileError, FileLocation};

/// Names of OpenCV's coefficients of distortion, in their order.
const COEFFICIENTS: [&str; 14] =
    ["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6", "s1", "s2", "s3", "s4", "τx", "τy"];
/// Lengths of OpenCV's vectors of coefficients.
const LENGTHS: [usize; 5] = [4, 5, 8, 12, 14];
/// The models that Boresight has, for messages.
pub(super) const SUPPORTED: &str =
    "radial and tangential distortion, k1, k2, p1, p2, k3 (OpenCV's default, plumb_bob, radtan)";

/// Creates the error of a value.
pub(super) fn wrong(path: &Path, field: &str, node: &Node, expected: &str) -> FileError {
    FileError::value(path, FileLocation::Line(node.line), field, node.shown(), expected)
}

/// Creates the error of a missing key of a table.
pub(super) fn missing(path: &Path, table: &Node, field: &str, expected: &str) -> FileError {
    FileError::value(path, FileLocation::Line(table.line), field, "missing", expected)
}

/// Returns a finite number. OpenCV writes `1.`, `.5` and `1e-02`.
pub(super) fn number(path: &Path, field: &str, node: &Node) -> Result<f64, FileError> {
    let parsed = node.scalar().and_then(|text| text.parse::<f64>().ok());
    parsed.filter(|value| value.is_finite()).ok_or_else(|| wrong(path, field, node, "a finite number"))
}

/// Returns the number of columns or rows.
pub(super) fn side(path: &Path, field: &str, node: &Node) -> Result<usize, FileError> {
    const MAX: f64 = contract::Camera::MAX_SIDE_PX as f64;
    let parsed = number(path, field, node)?;
    let is_side = (1.0..=MAX).contains(&parsed) && parsed.fract() == 0.0;
    is_side
        .then_some(parsed as usize)
        .ok_or_else(|| wrong(path, field, node, "a whole number from 1 to 16384"))
}

/// Returns the columns and rows of a list of two numbers.
pub(super) fn size(path: &Path, field: &str, node: &Node) -> Result<[usize; 2], FileError> {
    match &node.content {
        Content::List(items, 2) if items.len() == 2 => {
            let mut sides = [0; 2];
            for (side_px, item) in sides.iter_mut().zip(items) {
                *side_px = side(path, field, item)?;
            }
            Ok(sides)
        }
        _ => Err(wrong(path, field, node, "a list of two numbers, columns and rows")),
    }
}

/// Returns the numbers of a matrix row by row: of a table with `rows`, `cols` and `data`, of a list, or of a
/// list of rows.
pub(super) fn numbers(path: &Path, field: &str, node: &Node) -> Result<Vec<f64>, FileError> {
    match &node.content {
        Content::Table(_) => {
            let data = node.get("data").ok_or_else(|| {
                missing(path, node, &format!("{field}.data"), "the numbers of a matrix, a list")
            })?;
            let found = numbers(path, &format!("{field}.data"), data)?;
            let length = stated_length(path, field, node)?;
            if length.is_some_and(|length| length != found.len()) {
                let expected = "as many numbers as rows times columns";
                let place = FileLocation::Line(data.line);
                let value = format!("a list of {}", found.len());
                return Err(FileError::value(path, place, format!("{field}.data"), value, expected));
            }
            Ok(found)
        }
        Content::List(items, count) => {
            let mut found = Vec::new();
            for item in items {
                match &item.content {
                    Content::List(..) => found.extend(numbers(path, field, item)?),
                    _ => found.push(number(path, field, item)?),
                }
            }
            if *count > items.len() {
                return Err(wrong(path, field, node, "the few numbers of a matrix of a camera"));
            }
            Ok(found)
        }
        Content::Scalar(_) => Err(wrong(path, field, node, "a matrix: rows, cols, data, or a list")),
    }
}

/// Returns the product of `rows` and `cols` of a matrix; `None` without them.
fn stated_length(path: &Path, field: &str, node: &Node) -> Result<Option<usize>, FileError> {
    let (Some(rows), Some(columns)) = (node.get("rows"), node.get("cols")) else { return Ok(None) };
    let mut length = 1_usize;
    for (key, side) in [("rows", rows), ("cols", columns)] {
        let field = format!("{field}.{key}");
        let stated = number(path, &field, side)?;
        if !((0.0..=64.0).contains(&stated) && stated.fract() == 0.0) {
            return Err(wrong(path, &field, side, "a whole number from 0 to 64"));
        }
        length *= stated as usize;
    }
    Ok(Some(length))
}

/// Returns a calibration without distortion from a camera matrix [fx 0 cx; 0 fy cy; 0 0 1].
pub(super) fn lens_of_matrix(path: &Path, field: &str, node: &Node) -> Result<LensCalibration, FileError> {
    let found = numbers(path, field, node)?;
    let [fx, skew, cx, a, fy, cy, b, c, one] = found.as_slice() else {
        return Err(wrong(path, field, node, "a matrix of 3 × 3 numbers"));
    };
    let refused = |name: &str, value: f64, expected: &str| {
        let place = FileLocation::Line(node.line);
        Err(FileError::value(path, place, format!("{field}, {name}"), value, expected))
    };
    if *skew != 0.0 {
        return refused("skew (row 0, column 1)", *skew, "0: Boresight has cameras without skew");
    }
    for (name, value, expected) in [
        ("row 1, column 0", a, 0.0),
        ("row 2, column 0", b, 0.0),
        ("row 2, column 1", c, 0.0),
        ("row 2, column 2", one, 1.0),
    ] {
        if *value != expected {
            return refused(name, *value, &format!("{expected}, as in a matrix [fx 0 cx; 0 fy cy; 0 0 1]"));
        }
    }
    pinhole(path, field, node, [*fx, *fy], [*cx, *cy])
}

/// Returns a calibration without distortion from focal lengths and principal point, px.
pub(super) fn pinhole(
    path: &Path,
    field: &str,
    node: &Node,
    focal_px: [f64; 2],
    principal_px: [f64; 2],
) -> Result<LensCalibration, FileError> {
    for (name, value) in ["fx", "fy"].iter().zip(focal_px) {
        if value <= 0.0 {
            let place = FileLocation::Line(node.line);
            let expected = "a focal length in pixels, above 0";
            return Err(FileError::value(path, place, format!("{field}, {name}"), value, expected));
        }
    }
    Ok(LensCalibration { size_px: None, focal_px, principal_px, radial: [0.0; 3], tangential: [0.0; 2] })
}

/// Adds OpenCV's coefficients of distortion, in its order, to a calibration. Coefficients of models that
/// Boresight lacks must be 0.
pub(super) fn add_coefficients(
    path: &Path,
    field: &str,
    node: &Node,
    lens: &mut LensCalibration,
) -> Result<(), FileError> {
    let found = numbers(path, field, node)?;
    if !(found.is_empty() || LENGTHS.contains(&found.len())) {
        let expected = "4, 5, 8, 12 or 14 coefficients in OpenCV's order, k1, k2, p1, p2, k3, …";
        let place = FileLocation::Line(node.line);
        return Err(FileError::value(path, place, field, format!("a list of {}", found.len()), expected));
    }
    for (index, (name, value)) in COEFFICIENTS.iter().zip(&found).enumerate().skip(5) {
        if *value != 0.0 {
            let model = match index {
                5..8 => "the rational model (k4, k5, k6)",
                8..12 => "the thin prism model (s1 to s4)",
                _ => "the model of a tilted sensor (τx, τy)",
            };
            let expected = format!("0: Boresight lacks {model}; it has {SUPPORTED}");
            let place = FileLocation::Line(node.line);
            return Err(FileError::value(path, place, format!("{field}, {name}"), value, expected));
        }
    }
    let coefficient = |index: usize| found.get(index).copied().unwrap_or(0.0);
    lens.radial = [coefficient(0), coefficient(1), coefficient(4)];
    lens.tangential = [coefficient(2), coefficient(3)];
    Ok(())
}

/// Words of another tool for the model of distortion that Boresight has.
const BROWN_CONRADY: [&str; 10] = [
    "plumbbob",
    "radtan",
    "radialtangential",
    "brown",
    "brownconrady",
    "opencv",
    "standard",
    "pinhole",
    "perspective",
    "default",
];

/// Checks the name of a model of distortion or of a camera, without regard to case and punctuation.
pub(super) fn check_model(path: &Path, field: &str, node: &Node, more: &[&str]) -> Result<(), FileError> {
    let word = plain(node.scalar().unwrap_or("a list"));
    if BROWN_CONRADY.contains(&word.as_str()) || more.contains(&word.as_str()) {
        return Ok(());
    }
    Err(wrong(path, field, node, &format!("a model that Boresight has: {SUPPORTED}")))
}

/// Returns a name in small letters and digits alone.
pub(super) fn plain(name: &str) -> String {
    name.chars()
        .filter(|letter| letter.is_ascii_alphanumeric())
        .map(|letter| letter.to_ascii_lowercase())
        .collect()
}
