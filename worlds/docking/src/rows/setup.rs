//! `setup.toml`: the data that a docking pipeline receives before the first field.

use std::path::Path;

use contract::docking::{DockingSetup, TargetModel};
use contract::{Camera, OutOfRange, bounds};
use files::FileError;
use files::toml_table::{self, TomlTable};
use pipeline::docking::DockingConfig;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Cameras, dimensions of the target, and parameters of the built-in pipeline.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetupFile {
    /// Bit depth of the digitiser, 1 to 16.
    #[schemars(range(min = 1, max = 16))]
    pub bit_depth: u8,
    /// Dimensions of the target.
    pub target: TargetModel,
    /// Nominal cameras (lenses), at least one, all with the same number of columns and rows.
    #[schemars(length(min = 1))]
    pub cameras: Vec<Camera>,
    /// Parameters of the built-in pipeline; default: its default parameters.
    #[serde(default)]
    pub docking: DockingConfig,
}

impl SetupFile {
    /// Creates the file contents from a setup and a configuration.
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

    /// Returns the setup that a pipeline receives.
    pub fn setup(&self) -> DockingSetup {
        DockingSetup { cameras: self.cameras.clone(), bit_depth: self.bit_depth, target: self.target.clone() }
    }
}

impl TomlTable for SetupFile {
    fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "")?;
        let Some(first) = self.cameras.first() else { return Ok(()) };
        for (index, camera) in self.cameras.iter().enumerate() {
            if (camera.columns, camera.rows) != (first.columns, first.rows) {
                let size = format!("{} × {}", camera.columns, camera.rows);
                let expected =
                    format!("{} × {}, the columns and rows of the first camera", first.columns, first.rows);
                return Err(OutOfRange::new(format!("cameras[{index}]"), size, expected));
            }
        }
        self.target.check()?;
        self.docking.check().map_err(|error| error.under("docking"))
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use tempfile::tempdir;

    use sim::docking::{DockingSimulation, DockingSimulator};
    use toml::Table;

    use super::*;

    const SCENARIO: &str = include_str!("../../../../scenarios/docking.toml");

    #[test]
    fn each_value_outside_its_range_is_named_with_its_line() {
        let directory = tempdir().unwrap();
        let mut scenario: Table = SCENARIO.parse().unwrap();
        let pipeline: DockingConfig = scenario.remove("docking").unwrap().try_into().unwrap();
        scenario.retain(|key, _| key != "title" && key != "world");
        let simulation: DockingSimulation = scenario.try_into().unwrap();
        let simulator = DockingSimulator::new(&simulation, Path::new(".")).unwrap();
        let good = SetupFile::new(&simulator.setup(), &pipeline);
        let good_path = directory.path().join("good.toml");
        good.write(&good_path).unwrap();
        assert_eq!(SetupFile::read(&good_path).unwrap(), good);
        let text = fs::read_to_string(&good_path).unwrap();
        for (key, table, number, path) in [
            ("bit_depth", "", "17", "bit_depth"),
            ("focal_length_mm", "[[cameras]]", "1e300", "cameras[0].focal_length_mm"),
            ("thickness_m", "[target.cross]", "-1.0", "target.cross.thickness_m"),
            ("post_width_m", "[target.cross]", "0.5", "target.cross.post_width_m"),
            ("depth_m", "[target.station]", "nan", "target.station.depth_m"),
            (
                "forgetting_attitude",
                "[docking.paper_portions]",
                "2.0",
                "docking.paper_portions.forgetting_attitude",
            ),
            ("field_gate", "[docking.motion]", "0.0", "docking.motion.field_gate"),
        ] {
            let start = text.find(table).unwrap();
            let start = start + text[start..].find(&format!("{key} = ")).unwrap();
            let end = start + text[start..].find('\n').unwrap();
            let wrong = directory.path().join("wrong.toml");
            fs::write(&wrong, format!("{}{key} = {number}{}", &text[..start], &text[end..])).unwrap();
            let message = SetupFile::read(&wrong).unwrap_err().to_string();
            let line = 1 + text[..start].matches('\n').count();
            assert!(message.contains(&format!("wrong.toml:{line}:")), "{message}");
            assert!(
                message.contains(&format!("{path}: is ")) && message.contains(", expected "),
                "{message}"
            );
        }
    }
}
