//! Scenario of a world, and the constants of its files and scores.

use contract::Interface as _;
use files::Failure;
use scenario::run_file::{RunFile, ScenarioFile};
use serde_json::{Value, json};

use super::WorldFrames;
use crate::any_world::{Options, ScenarioSource};

/// Constants of a world.
#[derive(Debug, Clone, Copy)]
pub struct WorldFacts {
    /// File of a dataset with the data that a pipeline receives before the first frame.
    pub setup_file: &'static str,
    /// Table of a run directory with one row for every frame of the truth.
    pub truth_file: &'static str,
    /// File beside the measurements that scoring also reads, if it exists.
    pub evidence_file: Option<&'static str>,
    /// Rate by which runs are judged, a figure of the score.
    pub headline: &'static str,
    /// True if consecutive groups of frames are separated in time, so that errors in one group are
    /// independent of the next.
    pub are_groups_apart: bool,
    /// Name of the format for viewing images.
    pub pictures: &'static str,
}

/// A scenario of a world, ready to run.
pub trait WorldScenario: WorldFrames {
    /// Constants of the world.
    const FACTS: WorldFacts;
    /// Code of the world in files and on the command line. It is also the name of the built-in pipeline, and
    /// of that pipeline's table in a scenario.
    const CODE: &'static str = Self::Scenario::WORLD;

    /// Scenarios of the world.
    type Scenario: ScenarioFile;

    /// Checks all values of a scenario and prepares its simulator.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the first invalid value, or for an option that the world does not
    /// support.
    fn prepare(source: &ScenarioSource, scenario: &Self::Scenario, options: Options)
    -> Result<Self, Failure>;

    /// Returns the content of `run.toml`.
    fn run_file(&self) -> &RunFile<Self::Scenario>;

    /// Returns the scenario.
    fn scenario(&self) -> &Self::Scenario {
        &self.run_file().scenario
    }

    /// Returns the summary of a scenario check: as JSON, and as text for the user.
    fn summary(&self) -> (Value, String) {
        let (name, frames) = (&self.run_file().name, self.frame_count());
        let text = format!("{name}: {frames} {}s, no mistake found", Self::Interface::IMAGE);
        (json!({ "scenario": name, "ok": true, "world": Self::CODE, "frames": frames }), text)
    }

    /// Returns warnings about values that are permitted and may be unintended, in addition to those that look
    /// wrong by a factor of a thousand.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }
}
