//! The scenario whose figures the paper publishes.

use std::path::Path;
use std::sync::LazyLock;

use scenario::built_in;
use scenario::run_file::ScenarioFile;

use super::FarRangeScenario;

/// Returns true if a scenario has the same orbits and images as the built-in `argon`, and counts errors
/// within the same limits. Only then are the figures published in the paper shown beside its figures.
pub fn is_argon(scenario: &FarRangeScenario) -> bool {
    static ARGON: LazyLock<Option<FarRangeScenario>> = LazyLock::new(|| {
        let built_in = built_in("argon")?;
        FarRangeScenario::parse(Path::new("argon"), built_in.text).ok()
    });
    ARGON.as_ref().is_some_and(|argon| {
        argon.orbit == scenario.orbit
            && argon.schedule == scenario.schedule
            && argon.score.within_deg == scenario.score.within_deg
    })
}
