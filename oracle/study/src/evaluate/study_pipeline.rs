//! Pipeline under test in a study.
use std::path::Path;

use files::Failure;
use files::sha256::{hex, sha256_hex};
use run::pipeline_choice::PipelineChoice;
use run::{AnyFactory, AnyScenario, AnyWorld};

use crate::definition::Study;

/// Number of digits of a study's hash in the command that replays a case.
const SHORT_HASH: usize = 12;

/// Pipeline under test in a study, created anew for every case: either one that a command line can name
/// ([`PipelineChoice`]), or an object of the caller in this process. Several threads call it at once.
pub trait StudyPipeline: Sync {
    /// Rejects a scenario of a world that the pipeline does not support, before anything is written.
    ///
    /// # Errors
    /// A [`Failure`] that states the expected world.
    fn check(&self, scenario: &AnyScenario) -> Result<(), Failure>;

    /// Returns the SHA-256 of everything that the pipeline's outcomes depend on, as far as it can be
    /// determined, which keeps rows of two pipelines apart. `None` for the built-in pipeline of a world,
    /// whose parameters belong to the scenario.
    fn hash(&self, world: &dyn AnyWorld) -> Option<[u8; 32]>;

    /// Returns the command that runs a case of a study again, as a user would type it; `path` is the study's
    /// file.
    fn replay(&self, study: &Study, path: &Path, case: u64) -> String;

    /// Returns the factory of the pipeline for a case. An external program finds its images in `scratch`.
    ///
    /// # Errors
    /// A [`Failure`] when the world of the scenario has no such pipeline.
    fn factory(&self, scenario: &AnyScenario, scratch: &Path) -> Result<AnyFactory, Failure>;
}

impl Study {
    /// Returns the hash of the rows that a pipeline produces.
    pub fn hash_with(&self, pipeline: &dyn StudyPipeline) -> String {
        match pipeline.hash(self.scenario().world()) {
            Some(own) => sha256_hex(format!("{} {}", self.hash(), hex(own))),
            None => self.hash().to_owned(),
        }
    }
}

impl StudyPipeline for PipelineChoice {
    fn check(&self, scenario: &AnyScenario) -> Result<(), Failure> {
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
        words.extend(["--save-frames", world.facts().pictures].map(str::to_owned));
        command_line(&words)
    }

    fn factory(&self, scenario: &AnyScenario, scratch: &Path) -> Result<AnyFactory, Failure> {
        scenario.world().factory(scenario, self, scratch)
    }
}

/// Joins words to a command line, quoted for a shell.
pub fn command_line(words: &[String]) -> String {
    // A command-line argument contains no zero byte, the only cause of an error here.
    shlex::try_join(words.iter().map(String::as_str)).unwrap_or_else(|_| words.join(" "))
}
