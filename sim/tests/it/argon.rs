//! Simulation of the scenario `argon`, for tests and benchmarks.

use serde::de::DeserializeOwned;

// Imported from the including program: the library's unit tests refer to the crate by another name.
use super::{Simulation, TrajectorySource};

const ARGON: &str = include_str!("../../../scenarios/argon.toml");

/// Returns the scenario as a table.
pub(crate) fn table() -> toml::Table {
    ARGON.parse().unwrap()
}

/// Returns a section of the scenario `argon`; a missing section counts as empty.
pub(crate) fn section<T: DeserializeOwned>(table: &toml::Table, name: &str) -> T {
    let empty = toml::Value::Table(toml::Table::new());
    table.get(name).unwrap_or(&empty).clone().try_into().unwrap()
}

/// Returns the simulation of the scenario `argon`.
pub(crate) fn simulation() -> Simulation {
    let table = table();
    Simulation {
        seed: section(&table, "seed"),
        catalog: section(&table, "catalog"),
        trajectory: TrajectorySource::MeanElements(section(&table, "orbit")),
        attitude_profile: None,
        schedule: section(&table, "schedule"),
        attitude: section(&table, "attitude"),
        knowledge: section(&table, "knowledge"),
        mounting: section(&table, "mounting"),
        camera: section(&table, "camera"),
        psf: section(&table, "psf"),
        optics: section(&table, "optics"),
        radiometry: section(&table, "radiometry"),
        background: section(&table, "background"),
        sensor: section(&table, "sensor"),
        shutter: section(&table, "shutter"),
        roi: Some(section(&table, "roi")),
        zero_suppression_dn: None,
        target: section(&table, "target"),
        solar_system: section(&table, "solar_system"),
    }
}
