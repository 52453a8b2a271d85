//! Scenarios that are embedded in the binary.
use std::path::Path;
use std::sync::LazyLock;

use super::FarRangeScenario;
use crate::run_file::ScenarioFile;

/// A file of the folder `scenarios/`, embedded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BuiltIn {
    /// Name on the command line.
    pub name: &'static str,
    /// The TOML text.
    pub text: &'static str,
}

/// Every built-in scenario, by name.
pub const BUILT_IN: &[BuiltIn] = &[
    BuiltIn { name: "argon", text: include_str!("../../../scenarios/argon.toml") },
    BuiltIn { name: "docking", text: DOCKING },
    BuiltIn { name: "starting-point", text: STARTING_POINT },
];

/// Whether a scenario flies what the built-in `argon` flies, the same orbits and the same images, and counts errors within the same
/// limits. Only then do the figures that the paper publishes stand beside its own.
pub fn is_argon(scenario: &FarRangeScenario) -> bool {
    static ARGON: LazyLock<Option<FarRangeScenario>> = LazyLock::new(|| {
        let built_in = BUILT_IN.iter().find(|built_in| built_in.name == "argon")?;
        FarRangeScenario::parse(Path::new("argon"), built_in.text).ok()
    });
    ARGON.as_ref().is_some_and(|argon| {
        argon.orbit == scenario.orbit
            && argon.schedule == scenario.schedule
            && argon.score.within_deg == scenario.score.within_deg
    })
}

/// The approach to the station, a comment on every line: the built-in `docking`, and what `scenario new --world docking`
/// writes.
pub const DOCKING: &str = include_str!("../../../scenarios/docking.toml");

/// A small scenario with a comment on every line: what `scenario new` writes unless told otherwise.
pub const STARTING_POINT: &str = include_str!("../../../scenarios/starting-point.toml");
