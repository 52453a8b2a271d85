//! Directory of images: fields as listed in its `telemetry.csv`, or whole frames in the order of their names.

use std::fs;
use std::path::{Path, PathBuf};

use contract::Camera;
use contract::docking::{DockingSetup, Field, FieldTelemetry};
use files::{FileError, FileLocation, RequiredSize, locate_alone, locate_image, read_image, refuse_twice};

use super::video_frame::{Format, VideoFrame};
use crate::rows::telemetry::FieldRow;

/// A field of a directory, whose image has not been read yet.
pub(super) struct ListedField {
    path: PathBuf,
    row: FieldRow,
    camera: Camera,
}

/// Returns the fields that a directory's table lists. The existence of each image is checked, but none is
/// read yet.
pub(super) fn list_fields(
    directory: &Path,
    rows: Vec<(u64, FieldRow)>,
    setup: &DockingSetup,
) -> Result<Vec<ListedField>, FileError> {
    let table = directory.join("telemetry.csv");
    let root = directory.canonicalize().map_err(|source| FileError::io(directory, "open", source))?;
    let locate = |(line, row): (u64, FieldRow)| {
        let camera = camera_of(&table, line, &row, setup)?.clone();
        match locate_image(directory, &root, row.file.as_deref()) {
            Ok(path) => Ok(ListedField { path, row, camera }),
            Err(reason) => Err(FileError::MissingImage {
                path: table.clone(),
                line,
                frame: row.field,
                file: row.file.unwrap_or_default(),
                reason,
            }),
        }
    };
    let fields: Vec<ListedField> = rows.into_iter().map(locate).collect::<Result<_, _>>()?;
    refuse_twice(&table, "field", fields.iter().map(|field| (field.row.field, field.path.as_path())))?;
    Ok(fields)
}

/// Reads the image of a field that a row of a directory's `telemetry.csv` names; `None` if the row names no
/// image. Other images of the directory may be missing.
///
/// # Errors
/// [`FileError::Value`] for a camera that is not in the setup, and for an image that is missing, outside the
/// directory or of another size; the errors of reading the image.
pub fn read_listed_field(
    directory: &Path,
    row: &FieldRow,
    setup: &DockingSetup,
) -> Result<Option<Field>, FileError> {
    let Some(file) = row.file.as_deref() else { return Ok(None) };
    let path = locate_alone(directory, file, &format!("file of field {}", row.field))?;
    let Some(camera) = setup.cameras.get(row.telemetry.camera) else {
        let expected = format!("0 to {}, the index of a camera", setup.cameras.len().saturating_sub(1));
        let field = format!("camera of field {}", row.field);
        let table = directory.join("telemetry.csv");
        return Err(FileError::value(&table, FileLocation::Whole, field, row.telemetry.camera, expected));
    };
    let listed = ListedField { path, row: row.clone(), camera: camera.clone() };
    listed.read(setup).map(|(field, _)| Some(field))
}

/// Returns the camera of a row, which must be in the setup.
pub(super) fn camera_of<'a>(
    table: &Path,
    line: u64,
    row: &FieldRow,
    setup: &'a DockingSetup,
) -> Result<&'a Camera, FileError> {
    let camera = row.telemetry.camera;
    setup.cameras.get(camera).ok_or_else(|| {
        let expected = format!("0 to {}, the index of a camera", setup.cameras.len().saturating_sub(1));
        FileError::value(table, FileLocation::Line(line), "camera", camera, expected)
    })
}

impl ListedField {
    /// Reads the image of the field.
    pub(super) fn read(&self, setup: &DockingSetup) -> Result<(Field, FieldTelemetry), FileError> {
        let camera = &self.camera;
        let (columns, rows) = (camera.columns, self.row.lines.rows(camera.rows));
        let size = RequiredSize { columns, rows, whose: "the size of such a field of the camera" };
        let image = read_image(&self.path, Some(size))?;
        let frame = image.into_frame(&self.path, self.row.field, setup.bit_depth, None)?;
        let field = Field::new(frame, self.row.lines, camera.rows);
        field
            .map(|field| (field, self.row.telemetry))
            .map_err(|source| FileError::contract(&self.path, source))
    }
}

/// Returns the PNG images of a directory in the order of their names, as whole frames.
///
/// Digits in names are compared as numbers: `frame10.png` comes after `frame9.png`.
pub(super) fn by_name(directory: &Path) -> Result<Vec<PathBuf>, FileError> {
    let error = |source| FileError::io(directory, "open", source);
    let mut images = Vec::new();
    for entry in fs::read_dir(directory).map_err(error)? {
        let path = entry.map_err(error)?.path();
        let is_image = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png"));
        if is_image && path.is_file() {
            images.push(path);
        }
    }
    if images.is_empty() {
        let expected = "telemetry.csv, or images *.png";
        return Err(FileError::value(directory, FileLocation::Whole, "number of images", 0, expected));
    }
    images.sort_by_cached_key(|path| natural_key(path));
    Ok(images)
}

/// Reads an image as a whole frame.
pub(super) fn read_frame(path: &Path, index: u64, format: &Format) -> Result<VideoFrame, FileError> {
    let &Format { columns, rows, .. } = format;
    let whose = "the size of the camera; images of single fields need a telemetry.csv";
    let image = read_image(path, Some(RequiredSize { columns, rows, whose }))?;
    let frame = image.into_frame(path, index, format.bit_depth, None)?;
    Ok(VideoFrame { index, dn: frame.dn().to_vec() })
}

/// A part of a name: text, or a number represented by the count of its digits and the digits (after removal
/// of leading zeros, more digits are a larger number).
#[derive(PartialEq, Eq, PartialOrd, Ord)]
enum NamePart {
    Number(usize, String),
    Text(String),
}

fn natural_key(path: &Path) -> (Vec<NamePart>, PathBuf) {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let part = |run: &[char]| {
        let text: String = run.iter().collect();
        if run.first().is_some_and(char::is_ascii_digit) {
            let digits = text.trim_start_matches('0');
            NamePart::Number(digits.len(), digits.to_owned())
        } else {
            NamePart::Text(text)
        }
    };
    let letters: Vec<char> = name.chars().collect();
    let parts = letters.chunk_by(|a, b| a.is_ascii_digit() == b.is_ascii_digit()).map(part).collect();
    // The path makes the order of names that differ only in leading zeros definite.
    (parts, path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_ordered_by_their_numbers() {
        let mut names =
            ["f10.png", "f9.png", "f009.png", "e99999999999999999999999.png", "f1.png"].map(PathBuf::from);
        names.sort_by_cached_key(|path| natural_key(path));
        let order =
            ["e99999999999999999999999.png", "f1.png", "f009.png", "f9.png", "f10.png"].map(PathBuf::from);
        assert_eq!(names, order);
    }
}
