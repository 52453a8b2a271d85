//! Pipelines of docking.

use std::path::Path;

use contract::docking::{Field, FieldTelemetry};
use files::Failure;
use pipeline::docking::{DockingConfig, DockingFactory};
use run::world::{FactoryOf, WorldPipelines};

use super::mission::DockingMission;
use crate::scenario::DockingScenario;
use crate::video::write_field;

impl WorldPipelines for DockingMission {
    type Config = DockingConfig;

    fn config(scenario: &DockingScenario) -> &DockingConfig {
        &scenario.docking
    }

    fn built_in(config: &DockingConfig) -> Result<FactoryOf<Self>, Failure> {
        let factory = DockingFactory::new(config.clone());
        Ok(Box::new(factory.map_err(|error| Failure::Usage(error.to_string()))?))
    }

    /// Writes a PNG, which contains only the pixels.
    fn write_image(field: &Field, _: &FieldTelemetry, path: &Path) -> Result<(), String> {
        write_field(path, field).map_err(|error| error.to_string())
    }
}
