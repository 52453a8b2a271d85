//! Scenarios that are embedded in the binary.
use std::path::Path;
use std::sync::LazyLock;

use super::FarRangeScenario;
use crate::run_file::ScenarioFile;

/// A file of the directory `scenarios/`, embedded in the binary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BuiltIn {
    /// Name on the command line.
    pub name: &'static str,
    /// TOML text of the file.
    pub text: &'static str,
}

/// Built-in scenarios, by name.
pub const BUILT_IN: &[BuiltIn] = &[
    BuiltIn { name: "argon", text: include_str!("../../../scenarios/argon.toml") },
    BuiltIn { name: "argon-numerical", text: include_str!("../../../scenarios/argon-numerical.toml") },
    BuiltIn { name: "docking", text: DOCKING },
    BuiltIn { name: "starting-point", text: STARTING_POINT },
];

/// Returns true if a scenario has the same orbits and images as the built-in `argon`, and counts errors
/// within the same limits. Only then are the figures published in the paper shown beside its figures.
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

/// Approach to the station, with a comment on every line: the built-in `docking`, and the output of `scenario
/// new --world docking`.
pub const DOCKING: &str = include_str!("../../../scenarios/docking.toml");

/// Small scenario with a comment on every line: the default output of `scenario new`.
pub const STARTING_POINT: &str = include_str!("../../../scenarios/starting-point.toml");
