//! The pipeline that a study tries.
use std::path::Path;

use files::Failure;
use files::sha256::{hex, sha256_hex};
use run::pipeline_choice::PipelineChoice;
use run::{AnyFactory, AnyScenario, AnyWorld};

use crate::definition::Study;

/// Digits of a study's hash in the line that replays a case.
const SHORT_HASH: usize = 12;

/// The pipeline that a study tries, built anew for every case: one that a command line can name ([`PipelineChoice`]), or one of the
/// caller's own, alive in this process. Cases ask it from several threads at once.
pub trait StudyPipeline: Sync {
    /// Refuses a scenario of a world that it is not for, before anything is written.
    ///
    /// # Errors
    /// A [`Failure`] that says what was expected.
    fn check(&self, scenario: &dyn AnyScenario) -> Result<(), Failure>;

    /// SHA-256 of what its answers depend on, as far as it can be known, so that rows of two pipelines never mix; none for the built-in
    /// pipeline of a world, whose parameters are the scenario's.
    fn hash(&self, world: &dyn AnyWorld) -> Option<[u8; 32]>;

    /// What runs a case of a study again, as a reader would type it; `path` is the study's file.
    fn replay(&self, study: &Study, path: &Path, case: u64) -> String;

    /// The factory of the pipeline for a case. A program finds its images in `scratch`.
    ///
    /// # Errors
    /// A [`Failure`] when there is no such pipeline in the world of the scenario.
    fn factory(&self, scenario: &dyn AnyScenario, scratch: &Path) -> Result<AnyFactory, Failure>;
}

impl Study {
    /// The hash of rows by a pipeline.
    pub fn hash_with(&self, pipeline: &dyn StudyPipeline) -> String {
        match pipeline.hash(self.scenario().world()) {
            Some(own) => sha256_hex(format!("{} {}", self.hash(), hex(own))),
            None => self.hash().to_owned(),
        }
    }
}

impl StudyPipeline for PipelineChoice {
    fn check(&self, scenario: &dyn AnyScenario) -> Result<(), Failure> {
        scenario.world().check_choice(scenario, self)
    }

    fn hash(&self, world: &dyn AnyWorld) -> Option<[u8; 32]> {
        PipelineChoice::hash(self, world.code())
    }

    fn replay(&self, study: &Study, path: &Path, case: u64) -> String {
        let mut words = ["boresight", "study", "replay"].map(str::to_owned).to_vec();
        words.push(path.display().to_string());
        words.extend(["--case".to_owned(), case.to_string()]);
        let hash: String = study.hash_with(self).chars().take(SHORT_HASH).collect();
        words.extend(["--hash".to_owned(), hash]);
        let world = study.scenario().world();
        words.extend(self.arguments(world.code()));
        words.extend(["--save-frames", world.pictures()].map(str::to_owned));
        command_line(&words)
    }

    fn factory(&self, scenario: &dyn AnyScenario, scratch: &Path) -> Result<AnyFactory, Failure> {
        scenario.world().factory(scenario, self, scratch)
    }
}

/// Words as a shell takes them.
pub fn command_line(words: &[String]) -> String {
    // A word of a command line has no zero byte.
    shlex::try_join(words.iter().map(String::as_str)).unwrap_or_else(|_| words.join(" "))
}
