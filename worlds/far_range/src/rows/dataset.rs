//! A directory of images to be processed, rendered by Boresight or from another source.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use contract::{Calibration, Camera, Frame, Mounting, OutOfRange, Readout, Telemetry, bounds};
use files::toml_table::{self, TomlTable};
use files::{
    FileError, FileLocation, RequiredSize, locate_alone, locate_image, parse_utc, read_image, refuse_twice,
};
use hifitime::Epoch;
use pipeline::far_range::FarRangeConfig;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::rows::TelemetryRow;
use crate::rows::telemetry::read_with_lines;

/// Contents of `camera.toml`: the data that a pipeline receives before the first frame, except the stars.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CameraFile {
    /// Bit depth of the analogue-digital converter, 1 to 16.
    #[schemars(range(min = 1, max = 16))]
    pub bit_depth: u8,
    /// Limiting magnitude V of the built-in catalogue's stars that are listed for the pipeline if the dataset
    /// has no `stars.csv`, −2 to 15; default 7.
    #[serde(default = "default_magnitude_limit")]
    #[schemars(range(min = -2, max = 15))]
    pub magnitude_limit: f64,
    /// UTC time to which proper motion is applied in the star list, for example 2012-04-25T00:00:00Z;
    /// default: the time of the first frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub star_epoch_utc: Option<String>,
    /// Calibrated gain, bias, read noise and saturation; without them, the built-in pipeline cannot fit
    /// centroids.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub readout: Option<Readout>,
    /// Calibrated point-spread function, detector, brightness scale and attitude knowledge; an absent value
    /// is unknown.
    #[serde(default, skip_serializing_if = "is_unknown")]
    pub calibration: Calibration,
    /// Threshold of the zero suppression: pixels up to this digital number are 0 in the images, 0 to 65535;
    /// default: no zero suppression.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub zero_suppression_dn: Option<u16>,
    /// Nominal camera.
    pub camera: Camera,
    /// Nominal mounting; default: the camera axes coincide with the body axes.
    #[serde(default)]
    pub mounting: Mounting,
    /// Parameters of the built-in pipeline; default: its default parameters.
    #[serde(default)]
    pub far_range: FarRangeConfig,
}

fn is_unknown(calibration: &Calibration) -> bool {
    *calibration == Calibration::default()
}

fn default_magnitude_limit() -> f64 {
    7.0
}

impl CameraFile {
    /// Reads and checks the file.
    ///
    /// # Errors
    /// [`FileError::Io`]; [`FileError::Toml`] with line and column for invalid TOML, for a wrong, unknown or
    /// missing field, and for a value outside its range.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        toml_table::read(path)
    }

    /// Writes the file.
    ///
    /// # Errors
    /// [`FileError::OutputTaken`] if the file exists; [`FileError::Io`] if it cannot be written;
    /// [`FileError::Value`] for a value that could not be read back.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        toml_table::write(self, path)
    }
}

impl TomlTable for CameraFile {
    fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "")?;
        self.calibration.check()?;
        self.far_range.check().map_err(|error| error.under("far_range"))?;
        self.star_epoch_utc.as_ref().map_or(Ok(()), |text| {
            let refused = |expected| OutOfRange::new("star_epoch_utc", text, expected);
            parse_utc(text).map(|_| ()).map_err(refused)
        })
    }
}

/// Images with their telemetry and their camera, checked for completeness.
#[derive(Debug, Clone)]
pub struct Dataset {
    camera: CameraFile,
    frames: Vec<DatasetFrame>,
}

/// One frame of a dataset, whose image has not been read yet.
#[derive(Debug, Clone, PartialEq)]
pub struct DatasetFrame {
    /// Path of the image.
    path: PathBuf,
    row: TelemetryRow,
}

impl Dataset {
    /// Opens a directory: `camera.toml`, `telemetry.csv`, and the images named in the latter. No image is
    /// read yet, but the existence of each is checked, so a missing image is reported before the first is
    /// processed.
    ///
    /// Images must lie inside the directory after symbolic links are resolved: a table from an untrusted
    /// source cannot make Boresight read other files.
    ///
    /// # Errors
    /// [`FileError::MissingImage`] that names the frame whose image is not named, does not exist or is
    /// outside the directory; the errors of [`CameraFile::read`] and [`crate::rows::read_telemetry`].
    pub fn open(directory: &Path) -> Result<Self, FileError> {
        let camera = CameraFile::read(&directory.join("camera.toml"))?;
        let table = directory.join("telemetry.csv");
        let rows = read_with_lines(&table)?;
        if !rows.is_empty() && rows.iter().all(|(_, row)| row.file.is_none()) {
            let expected = "names of images; a run keeps its images with --save-frames";
            let file = "empty in every row";
            return Err(FileError::value(&table, FileLocation::Header, "file", file, expected));
        }
        let root = directory.canonicalize().map_err(|source| FileError::io(directory, "open", source))?;
        let locate =
            |(line, row): (u64, TelemetryRow)| match locate_image(directory, &root, row.file.as_deref()) {
                Ok(path) => Ok(DatasetFrame { path, row }),
                Err(reason) => Err(FileError::MissingImage {
                    path: table.clone(),
                    line,
                    frame: row.frame,
                    file: row.file.unwrap_or_default(),
                    reason,
                }),
            };
        let frames: Vec<DatasetFrame> = rows.into_iter().map(locate).collect::<Result<_, _>>()?;
        refuse_unnamed(&table, &frames)?;
        refuse_twice(&table, "frame", frames.iter().map(|frame| (frame.row.frame, frame.path.as_path())))?;
        Ok(Self { camera, frames })
    }

    /// Returns the camera file.
    pub fn camera(&self) -> &CameraFile {
        &self.camera
    }

    /// Returns the frames in ascending order; never empty.
    pub fn frames(&self) -> &[DatasetFrame] {
        &self.frames
    }

    /// Returns the time to which proper motion is applied in the star list.
    pub fn star_epoch(&self) -> Option<Epoch> {
        let given = self.camera.star_epoch_utc.as_deref().and_then(|text| parse_utc(text).ok());
        given.or_else(|| self.frames.first().map(|frame| frame.row.telemetry.time))
    }

    /// Reads the image of a frame.
    ///
    /// # Errors
    /// The errors of [`files::read_frame`]; [`FileError::Value`] for an image whose size differs from that of
    /// the camera.
    pub fn read(&self, frame: &DatasetFrame) -> Result<Frame, FileError> {
        self.camera.read_image(&frame.path, &frame.row)
    }
}

impl CameraFile {
    /// Reads the image of a frame of this camera.
    fn read_image(&self, path: &Path, row: &TelemetryRow) -> Result<Frame, FileError> {
        let Camera { columns, rows, .. } = self.camera;
        let image = read_image(path, Some(RequiredSize { columns, rows, whose: "the size in camera.toml" }))?;
        image.metadata.check(path, row.frame, &row.telemetry)?;
        image.into_frame(path, row.frame, self.bit_depth, row.windows.clone())
    }

    /// Reads the image that a row of a directory's `telemetry.csv` names; `None` if the row names no image.
    /// Other images of the directory may be missing.
    ///
    /// # Errors
    /// [`FileError::Value`] for an image that is missing or outside the directory; the errors of
    /// [`Dataset::read`].
    pub fn read_listed(&self, directory: &Path, row: &TelemetryRow) -> Result<Option<Frame>, FileError> {
        let Some(file) = row.file.as_deref() else { return Ok(None) };
        let path = locate_alone(directory, file, &format!("file of frame {}", row.frame))?;
        self.read_image(&path, row).map(Some)
    }
}

/// Rejects an image in the directories of the named images that no row of the telemetry names: its row is
/// missing.
fn refuse_unnamed(table: &Path, frames: &[DatasetFrame]) -> Result<(), FileError> {
    let named: BTreeSet<&Path> = frames.iter().map(|frame| frame.path.as_path()).collect();
    let extension = |path: &Path| path.extension().map(|e| e.to_ascii_lowercase());
    let extensions: BTreeSet<_> = named.iter().filter_map(|path| extension(path)).collect();
    let folders: BTreeSet<&Path> = named.iter().filter_map(|path| path.parent()).collect();
    for folder in folders {
        let error = |source| FileError::io(folder, "open", source);
        for entry in fs::read_dir(folder).map_err(error)? {
            let path = entry.map_err(error)?.path();
            if extension(&path).is_some_and(|e| extensions.contains(&e)) && !named.contains(path.as_path()) {
                let expected = "an image that a row names: the telemetry of this image is missing";
                return Err(FileError::value(table, FileLocation::Header, "file", path.display(), expected));
            }
        }
    }
    Ok(())
}

impl DatasetFrame {
    /// Returns the number of the frame.
    pub fn number(&self) -> u64 {
        self.row.frame
    }

    /// Returns the telemetry of the frame.
    pub fn telemetry(&self) -> &Telemetry {
        &self.row.telemetry
    }

    /// Returns the path of the image.
    pub fn path(&self) -> &Path {
        &self.path
    }
}
