//! Cameras for new scenarios and for single pictures: the tables of geometry, detector and optics.

use std::path::{Path, PathBuf};

use config::toml_file;
use contract::{Camera, OutOfRange};
use files::Failure;
use scenario::CAMERAS;
use serde::{Deserialize, Serialize};
use sim::SimError;
use sim::optics::{OpticsConfig, PsfConfig, RadiometryConfig};
use sim::sensor::SensorConfig;

/// Content of a camera file: tables with the names and keys of a scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraPreset {
    /// Geometry of the camera.
    pub camera: Camera,
    /// Detector.
    pub sensor: SensorConfig,
    /// Point-spread function of the optics.
    pub psf: PsfConfig,
    /// Variation of the optics over the field; absent: none.
    #[serde(default)]
    pub optics: OpticsConfig,
    /// Conversion from magnitudes to photoelectrons.
    pub radiometry: RadiometryConfig,
}

/// A camera with the text that it was read from, which locates mistakes.
#[derive(Debug, Clone)]
pub struct CameraSource {
    /// Name of the built-in camera, or path of the file.
    pub name: String,
    /// Tables of the camera.
    pub preset: CameraPreset,
    /// Directory that relative paths in the file refer to.
    pub folder: PathBuf,
    file: PathBuf,
    text: String,
}

impl CameraSource {
    /// Returns the built-in camera with a name; `None` if there is none.
    ///
    /// # Errors
    /// A [`Failure`] with the location of a mistake in the built-in file.
    pub fn built_in(name: &str) -> Result<Option<Self>, Failure> {
        let Some(camera) = CAMERAS.iter().find(|camera| camera.name == name) else { return Ok(None) };
        let file = PathBuf::from(format!("scenarios/cameras/{name}.toml"));
        Self::parse(name, PathBuf::new(), file, camera.text.to_owned()).map(Some)
    }

    /// Reads a camera: the name of a built-in one, or the path of a TOML file.
    ///
    /// # Errors
    /// [`Failure::Usage`] when there is no such camera, with the nearest name or all names; a [`Failure`]
    /// with the location of the first mistake in the file.
    pub fn read(word: &str) -> Result<Self, Failure> {
        if let Some(built_in) = Self::built_in(word)? {
            return Ok(built_in);
        }
        let file = PathBuf::from(word);
        let text = toml_file::read_text(&file).map_err(|error| {
            let names = CAMERAS.iter().map(|camera| camera.name);
            let hint = match toml_file::nearest(word, names.clone()) {
                Some(nearest) => format!("did you mean `{nearest}`?"),
                None => format!("built-in cameras: {}", names.collect::<Vec<_>>().join(", ")),
            };
            Failure::Usage(format!(
                "`{word}` is neither a built-in camera nor a TOML file that can be read ({error}); {hint}"
            ))
        })?;
        let folder = file.parent().map(Path::to_path_buf).unwrap_or_default();
        Self::parse(word, folder, file, text)
    }

    fn parse(name: &str, folder: PathBuf, file: PathBuf, text: String) -> Result<Self, Failure> {
        let preset = toml_file::parse(&file, &text)?;
        Ok(Self { name: name.to_owned(), preset, folder, file, text })
    }

    /// Adds the location in the file to an error about a value that the simulator refuses.
    pub fn explain(&self, error: SimError) -> Failure {
        match error {
            SimError::OutOfRange(error) => self.out_of_range(&error),
            error => error.into(),
        }
    }

    fn out_of_range(&self, error: &OutOfRange) -> Failure {
        toml_file::out_of_range(&self.file, &self.text, error).into()
    }
}
