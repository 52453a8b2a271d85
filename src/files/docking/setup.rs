//! `setup.toml`: what a docking pipeline knows before the first field.

use std::path::Path;

use contract::Camera;
use contract::docking::{DockingSetup, TargetModel};
use pipeline::PipelineError;
use pipeline::docking::DockingConfig;
use serde::{Deserialize, Serialize};

use super::super::FileError;
use super::super::error::{Place, create_new};
use crate::toml_file;

/// The cameras, the target's dimensions, and parameters of the built-in pipeline.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SetupFile {
    /// Bits of the digitiser, 1 to 16.
    pub bit_depth: u8,
    /// The target's dimensions.
    pub target: TargetModel,
    /// Nominal cameras (lenses), at least one, all with the same columns and rows.
    pub cameras: Vec<Camera>,
    /// Parameters of the built-in pipeline; without it, its defaults.
    #[serde(default)]
    pub docking: DockingConfig,
}

impl SetupFile {
    /// Of a setup and a configuration.
    pub fn new(setup: &DockingSetup, docking: &DockingConfig) -> Self {
        Self {
            bit_depth: setup.bit_depth,
            target: setup.target.clone(),
            cameras: setup.cameras.clone(),
            docking: docking.clone(),
        }
    }

    /// Reads and checks the file.
    ///
    /// # Errors
    /// [`FileError::Toml`] with line and column for what is not TOML or has a wrong, unknown or missing field;
    /// [`FileError::Contract`] or [`FileError::Value`] for a number outside its range.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let text = toml_file::read_text(path).map_err(|source| FileError::io(path, "read", source))?;
        let file: Self = toml_file::parse(path, &text).map_err(FileError::Toml)?;
        file.check(path)?;
        Ok(file)
    }

    /// Writes the file.
    ///
    /// # Errors
    /// [`FileError::Io`] when it exists or cannot be written; as [`SetupFile::read`] for what could not be read back.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        self.check(path)?;
        let text = toml::to_string(self).map_err(|error| FileError::format(path, "TOML", error))?;
        let mut file = create_new(path)?;
        std::io::Write::write_all(&mut file, text.as_bytes())
            .map_err(|source| FileError::io(path, "write", source))
    }

    /// What a pipeline is told.
    pub fn setup(&self) -> DockingSetup {
        DockingSetup { cameras: self.cameras.clone(), bit_depth: self.bit_depth, target: self.target.clone() }
    }

    fn check(&self, path: &Path) -> Result<(), FileError> {
        let error = |field: &str, value: String, expected: &str| {
            Err(FileError::value(path, Place::Header, field, value, expected))
        };
        if !(1..=16).contains(&self.bit_depth) {
            return error("bit_depth", self.bit_depth.to_string(), "1 to 16");
        }
        let Some(first) = self.cameras.first() else {
            return error("cameras", "an empty list".to_owned(), "at least one camera");
        };
        for camera in &self.cameras {
            camera.check().map_err(|source| FileError::contract(path, source))?;
            if (camera.columns, camera.rows) != (first.columns, first.rows) {
                let size = format!("{} × {}", camera.columns, camera.rows);
                return error("cameras", size, "columns and rows of the first camera");
            }
        }
        self.check_target().or_else(|(field, value)| error(field, value, "finite, greater than 0"))?;
        match self.docking.check() {
            Err(PipelineError::Parameter { field, value, expected }) => {
                error(&format!("docking.{field}"), value, expected)
            }
            Err(PipelineError::Contract(source)) => Err(FileError::contract(path, source)),
            Ok(()) => Ok(()),
        }
    }

    /// The lengths that formulas divide by.
    fn check_target(&self) -> Result<(), (&'static str, String)> {
        let target = &self.target;
        for (field, value) in [
            ("target.plate_radius_m", target.plate_radius_m),
            ("target.mark_circle_radius_m", target.mark_circle_radius_m),
            ("target.cross.height_m", target.cross.height_m),
            ("target.cross.half_length_m", target.cross.half_length_m),
            ("target.cross.width_m", target.cross.width_m),
            ("target.docking_unit.radius_m", target.docking_unit.radius_m),
            ("target.station.radius_m", target.station.radius_m),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err((field, value.to_string()));
            }
        }
        Ok(())
    }
}
